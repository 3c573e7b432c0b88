//! Checks a telemetry log: whether it is one, whether its end is missing, and whether the vehicle file matches it.

use super::log_file::LogFile;
use crate::errors::AppError;
use spandrel_mavlink::telemetry::sample::{self, SampleContent, SampleValue};
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::scenario::Scenario;
use spandrel_model::vehicle::{Camera, Vehicle};
use std::collections::BTreeMap;
use std::ops::ControlFlow;

/// Maximum difference between a camera's field of view in the log and in its vehicle file, deg: vehicle files state it
/// to the nearest degree.
const MAX_FIELD_OF_VIEW_DIFFERENCE_DEG: f64 = 0.5;

/// Returns the error for a file that contains no MAVLink messages.
///
/// # Errors
/// Returns an error if the file cannot be read.
pub fn foreign_file_error(log: &LogFile) -> Result<AppError, AppError> {
    let head = log.head()?;
    let found = match std::str::from_utf8(&head) {
        Ok("") => "the file is empty",
        Ok(text) if !text.contains('\0') => "the file contains text",
        Ok(_) | Err(_) => "the file contains no MAVLink messages",
    };
    Ok(AppError::invalid(format!(
        "{}: not a telemetry log: {found}; a telemetry log (.tlog) contains MAVLink frames, each after an 8-byte timestamp",
        log.path().display()
    )))
}

/// Returns warnings about a log that can be scored.
///
/// # Errors
/// Returns an error if the file cannot be read.
pub fn warnings(log: &LogFile, scenario: &Scenario, vehicle: &Vehicle) -> Result<Vec<String>, AppError> {
    let path = log.path().display();
    let mut fields_of_view = FieldsOfView::default();
    let plane = LocalPlane::new(scenario.origin);
    let complete = log.read_records(&mut |record| {
        fields_of_view.receive(record.frame, &plane);
        ControlFlow::Continue(())
    });
    let complete = complete.map_err(|error| AppError::invalid(format!("{path}: cannot read: {error}")))?;
    let mut warnings = Vec::new();
    let left_over = log.len() - complete;
    if left_over > 0 {
        let bytes = if left_over == 1 { "byte is" } else { "bytes are" };
        warnings.push(format!(
            "{path}: the last {left_over} {bytes} not a complete record: the log was probably cut off, so the end of the flight may be missing"
        ));
    }
    if let Some((low, high)) = fields_of_view.of_vehicle().filter(|seen| !fits(*seen, &vehicle.camera)) {
        warnings.push(format!(
            "{path}: the aircraft that flew was not '{}': the camera's field of view is {} in the log, but {} in the vehicle file",
            vehicle.id,
            range(low, high),
            range(narrowest_rad(&vehicle.camera), vehicle.camera.hfov_rad)
        ));
    }
    Ok(warnings)
}

/// The range of the horizontal fields of view that each system's camera reported, rad.
#[derive(Debug, Default)]
struct FieldsOfView {
    seen_rad: BTreeMap<u8, (f64, f64)>,
    /// The system that sends the true state.
    vehicle: Option<u8>,
}

impl FieldsOfView {
    fn receive(&mut self, frame: &[u8], plane: &LocalPlane) {
        let Some(sample) = sample::read(frame, plane) else { return };
        match sample.content {
            SampleContent::Truth(_) => {
                self.vehicle.get_or_insert(sample.sender.0);
            }
            SampleContent::Value(SampleValue::FieldOfView(rad)) => {
                let (low, high) = self.seen_rad.entry(sample.sender.0).or_insert((rad, rad));
                (*low, *high) = (low.min(rad), high.max(rad));
            }
            SampleContent::Value(_) => {}
        }
    }

    fn of_vehicle(&self) -> Option<(f64, f64)> {
        self.seen_rad.get(&self.vehicle?).copied()
    }
}

/// Returns the horizontal field of view of a camera at its longest focal length, rad.
fn narrowest_rad(camera: &Camera) -> f64 {
    camera.zoomed(camera.zoom_max).hfov_rad
}

/// Returns whether a camera can have all fields of view in a range, rad.
fn fits((low, high): (f64, f64), camera: &Camera) -> bool {
    let tolerance_rad = MAX_FIELD_OF_VIEW_DIFFERENCE_DEG.to_radians();
    low >= narrowest_rad(camera) - tolerance_rad && high <= camera.hfov_rad + tolerance_rad
}

/// Formats a range of angles in degrees, or a single angle if both limits are equal.
fn range(low_rad: f64, high_rad: f64) -> String {
    let [low, high] = [low_rad, high_rad].map(|rad| format!("{:.1}", rad.to_degrees()));
    if low == high { format!("{low} deg") } else { format!("{low} to {high} deg") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::shipped;

    fn camera(name: &str) -> Camera {
        let text = shipped::VEHICLES.iter().find(|(stem, _)| *stem == name).unwrap().1;
        spandrel_model::vehicle::read(name, text).unwrap().camera
    }

    #[test]
    fn exact_field_of_view_fits_only_lenses_that_can_have_it() {
        let (fixed, zoom) = (camera("phantom2"), camera("m30"));
        let wide = (fixed.hfov_rad, fixed.hfov_rad);
        let half_zoomed = zoom.zoomed(0.5 * (1.0 + zoom.zoom_max)).hfov_rad;
        assert!(fits(wide, &fixed) && fits(wide, &zoom));
        assert!(fits((half_zoomed, zoom.hfov_rad), &zoom) && !fits((half_zoomed, zoom.hfov_rad), &fixed));
        assert!(!fits(wide, &camera("elios3")));
        assert_eq!(range(1.0, 1.0), "57.3 deg");
        assert_eq!(range(0.5, 1.0), "28.6 to 57.3 deg");
    }
}
