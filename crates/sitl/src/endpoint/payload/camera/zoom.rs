//! The zoom lens: its position, target and speed.

use spandrel_model::math;
use spandrel_model::vehicle::Camera;
pub use spandrel_model::vehicle::SENSOR_WIDTH_MM;

/// Time to travel the whole zoom range, s (estimate: small motorized zooms take 2 to 4 s).
const FULL_TRAVEL_S: f64 = 3.0;
/// Number of zoom steps across the zoom range (estimate).
const STEPS: f64 = 10.0;
/// Relative tolerance within which an out-of-range focal length or field of view is clamped instead of rejected,
/// because clients round.
const RANGE_TOLERANCE: f64 = 0.01;

/// A zoom command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ZoomCommand {
    /// Number of steps toward tele.
    Step(f64),
    /// Continuous zoom as a fraction of full speed, from -1 (wide) to 1 (tele); 0 stops.
    Rate(f64),
    /// Position in the zoom range, from 0 (wide) to 1 (tele).
    Level(f64),
    /// A focal length, mm.
    FocalMm(f64),
    /// A horizontal field of view, rad.
    FieldOfView(f64),
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
enum ZoomDrive {
    #[default]
    Rest,
    To(f64),
    Rate(f64),
}

/// Lens state. The position in the range is linear in the focal length.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ZoomLens {
    level: f64,
    drive: ZoomDrive,
}

/// Returns the wide-end focal length in mm.
#[must_use]
pub fn wide_focal_length_mm(camera: &Camera) -> f64 {
    camera.focal_mm()
}

impl ZoomLens {
    /// Returns the position in the zoom range, from 0 (wide) to 1 (tele).
    #[must_use]
    pub fn level(&self) -> f64 {
        self.level
    }

    /// Returns the focal length relative to the wide end.
    #[must_use]
    pub fn ratio(&self, camera: &Camera) -> f64 {
        1.0 + self.level * (camera.zoom_max - 1.0)
    }

    /// Applies a command. Returns false if it is out of range or the lens does not zoom.
    pub fn command(&mut self, request: ZoomCommand, camera: &Camera) -> bool {
        if camera.zoom_max <= 1.0 {
            return false;
        }
        let level_of = |ratio: f64| {
            let inside = ratio >= 1.0 - RANGE_TOLERANCE && ratio <= camera.zoom_max * (1.0 + RANGE_TOLERANCE);
            inside.then(|| ((ratio - 1.0) / (camera.zoom_max - 1.0)).clamp(0.0, 1.0))
        };
        let drive = match request {
            ZoomCommand::Step(steps) if steps.is_finite() => {
                let from = if let ZoomDrive::To(target) = self.drive { target } else { self.level };
                Some(ZoomDrive::To((from + steps.clamp(-1.0, 1.0) / STEPS).clamp(0.0, 1.0)))
            }
            ZoomCommand::Rate(0.0) => Some(ZoomDrive::Rest),
            ZoomCommand::Rate(rate) if rate.is_finite() => Some(ZoomDrive::Rate(rate.clamp(-1.0, 1.0))),
            ZoomCommand::Level(level) if (0.0..=1.0).contains(&level) => Some(ZoomDrive::To(level)),
            ZoomCommand::FocalMm(mm) => level_of(mm / wide_focal_length_mm(camera)).map(ZoomDrive::To),
            ZoomCommand::FieldOfView(rad) if rad > 0.0 && rad < math::PI => {
                level_of(math::tan(0.5 * camera.hfov_rad) / math::tan(0.5 * rad)).map(ZoomDrive::To)
            }
            ZoomCommand::Step(_) | ZoomCommand::Rate(_) | ZoomCommand::Level(_) | ZoomCommand::FieldOfView(_) => None,
        };
        if let Some(drive) = drive {
            self.drive = drive;
        }
        drive.is_some()
    }

    /// Moves the lens for `dt_s` seconds. Returns true when it stops.
    pub fn step(&mut self, dt_s: f64) -> bool {
        let most = dt_s / FULL_TRAVEL_S;
        let moved = match self.drive {
            ZoomDrive::Rest => return false,
            ZoomDrive::To(target) => (target - self.level).clamp(-most, most),
            ZoomDrive::Rate(rate) => rate * most,
        };
        let before = self.level;
        self.level = match self.drive {
            // Reach the end stops exactly, so that results at the wide end are bit-identical.
            ZoomDrive::To(target) if (target - before).abs() <= most => target,
            ZoomDrive::Rest | ZoomDrive::To(_) | ZoomDrive::Rate(_) => (before + moved).clamp(0.0, 1.0),
        };
        let arrived = match self.drive {
            ZoomDrive::To(target) => self.level == target,
            ZoomDrive::Rate(rate) => self.level == if rate < 0.0 { 0.0 } else { 1.0 },
            ZoomDrive::Rest => true,
        };
        if arrived {
            self.drive = ZoomDrive::Rest;
        }
        arrived
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::frames::Vec3;

    const CAMERA: Camera = Camera {
        position_m: Vec3::new(0.0, 0.0, 0.0),
        width_px: 4000,
        height_px: 3000,
        hfov_rad: math::FRAC_PI_2,
        zoom_max: 3.0,
        f_number: 2.8,
        iso_max: 1600.0,
        max_exposure_time_s: 0.01,
        gimbal_pitch_min_rad: -1.57,
        gimbal_pitch_max_rad: 1.57,
        gimbal_rate_rad_s: 1.0,
    };
    /// Rounding tolerance for ratios and for angles in radians.
    const ROUNDING_TOLERANCE: f64 = 1e-12;

    fn at_rest(request: ZoomCommand) -> ZoomLens {
        let mut zoom = ZoomLens::default();
        assert!(zoom.command(request, &CAMERA), "{request:?}");
        let ticks = (0..10_000).take_while(|_| !zoom.step(0.01)).count();
        assert!(ticks < 10_000, "{request:?}: the lens never stops");
        zoom
    }

    #[test]
    fn exact_every_zoom_command_reaches_the_requested_focal_length() {
        // tan 45 deg is 1: the focal length is half the sensor's width, and doubling it gives a field of view of 2
        // atan(1/2).
        let field = 2.0 * math::atan2(1.0, 2.0);
        for request in [ZoomCommand::Level(0.5), ZoomCommand::FocalMm(SENSOR_WIDTH_MM), ZoomCommand::FieldOfView(field)] {
            let zoom = at_rest(request);
            assert!((zoom.ratio(&CAMERA) - 2.0).abs() < ROUNDING_TOLERANCE, "{request:?}");
            assert!((CAMERA.zoomed(zoom.ratio(&CAMERA)).hfov_rad - field).abs() < ROUNDING_TOLERANCE);
            assert!((CAMERA.zoomed(2.0).focal_px() / CAMERA.focal_px() - 2.0).abs() < ROUNDING_TOLERANCE);
        }
        assert!((at_rest(ZoomCommand::Step(1.0)).level() - 1.0 / STEPS).abs() < ROUNDING_TOLERANCE);
        assert_eq!(at_rest(ZoomCommand::Rate(0.7)).level(), 1.0);
    }

    #[test]
    fn exact_wide_end_is_restored_bit_exactly() {
        let mut zoom = at_rest(ZoomCommand::Level(0.37));
        assert!(zoom.command(ZoomCommand::Rate(-1.0), &CAMERA));
        while !zoom.step(0.0025) {}
        assert_eq!(CAMERA.zoomed(zoom.ratio(&CAMERA)), CAMERA);
    }

    #[test]
    fn exact_out_of_range_zoom_is_rejected_and_fixed_lens_rejects_all() {
        let fixed = Camera { zoom_max: 1.0, ..CAMERA };
        for request in [
            ZoomCommand::Level(1.01),
            ZoomCommand::Level(f64::NAN),
            ZoomCommand::FocalMm(1.0),
            ZoomCommand::FocalMm(20.0),
            ZoomCommand::FieldOfView(0.0),
            ZoomCommand::FieldOfView(3.0),
            ZoomCommand::Step(f64::NAN),
            ZoomCommand::Rate(f64::INFINITY),
        ] {
            assert!(!ZoomLens::default().command(request, &CAMERA), "{request:?}");
        }
        assert!(!ZoomLens::default().command(ZoomCommand::Level(0.0), &fixed));
    }

    #[test]
    fn exact_full_zoom_range_takes_the_travel_time_and_stop_holds_the_position() {
        let mut zoom = ZoomLens::default();
        zoom.command(ZoomCommand::Rate(1.0), &CAMERA);
        for _ in 0..100 {
            assert!(!zoom.step(0.01));
        }
        assert!((zoom.level() - 1.0 / FULL_TRAVEL_S).abs() < ROUNDING_TOLERANCE);
        zoom.command(ZoomCommand::Rate(0.0), &CAMERA);
        assert!(!zoom.step(1.0));
        assert!((zoom.level() - 1.0 / FULL_TRAVEL_S).abs() < ROUNDING_TOLERANCE);
    }
}
