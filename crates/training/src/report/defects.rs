//! Outcome of each defect. For missed defects, also how close the flight came to photographing them.

use super::context::ReviewContext;
use super::formatting;
use super::pictures::failed_conditions;
use crate::advice::MissedDefect;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::PlacedDefect;
use spandrel_model::site::visibility::evaluate_defect;
use spandrel_model::site::{CameraPose, DefectView};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Camera;
use spandrel_monitor::assessment::Assessment;
use spandrel_monitor::measures::attention;
use spandrel_text::{Language, text};

/// Sampling interval for finding views of a defect in the flight.
const SAMPLE_INTERVAL: SimTime = SimTime::from_ms(500);
/// Distance from which the report's drawings show missed defects, m (estimate: close enough to see a crack at the limit
/// between two condition states).
const VIEW_DISTANCE_M: f64 = 4.0;

/// Whether one defect was found, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct DefectOutcome {
    /// The defect as placed in the scene.
    pub defect: PlacedDefect,
    /// Number of the first picture that shows it; `None` if it was missed.
    pub found_by: Option<u32>,
    /// The flight's closest approach to a picture of the defect; `None` if a picture shows it.
    pub best_approach: Option<BestApproach>,
}

/// How close the flight came to a valid picture of a defect.
#[derive(Debug, Clone, PartialEq)]
pub struct BestApproach {
    /// Time during which a picture would have counted as a hit, s.
    pub in_view_s: f64,
    /// Best view and its time, s since lift-off: the first view that would have counted as a hit or, without one, the
    /// view with the fewest failed conditions.
    pub best: Option<(f64, DefectView)>,
    /// Minimum distance between drone and defect, m, and its time, s since lift-off.
    pub nearest: (f64, f64),
}

impl DefectOutcome {
    /// Describes the outcome for the report.
    #[must_use]
    pub fn description(&self, language: Language) -> String {
        let Some(approach) = &self.best_approach else {
            return match self.found_by {
                Some(picture) => text!(language, "report-defects-found-by", picture = picture),
                None => text!(language, "report-defects-found-plain"),
            };
        };
        let moment = formatting::clock(approach.moment_s());
        match &approach.best {
            Some((_, view)) if view.hit => {
                let seconds = formatting::number(approach.in_view_s, 1);
                text!(language, "report-defects-in-view", seconds = seconds, moment = moment)
            }
            Some((_, view)) => {
                let reasons = failed_conditions(view, language).join("; ");
                text!(language, "report-defects-best-seen", moment = moment, reasons = reasons)
            }
            None => {
                let distance = formatting::number(approach.nearest.0, 1);
                text!(language, "report-defects-never", distance = distance, moment = moment)
            }
        }
    }

    /// Returns how close the flight came to a picture of the defect; `None` if a picture shows it.
    #[must_use]
    pub fn missed(&self) -> Option<MissedDefect> {
        let approach = self.best_approach.as_ref()?;
        let (nearest_m, _) = approach.nearest;
        Some(MissedDefect { id: self.defect.id, t_s: approach.moment_s(), in_view_s: approach.in_view_s, nearest_m })
    }

    /// Returns a camera pose that shows the defect well.
    #[must_use]
    pub fn reference_view(&self) -> CameraPose {
        let forward = self.defect.normal * -1.0;
        let up = Vec3::new(0.0, 0.0, 1.0);
        // If the camera points straight up or down, any horizontal direction can be "right".
        let right = if forward.up().abs() > 0.999 { Vec3::new(1.0, 0.0, 0.0) } else { forward.cross(up).unit() };
        CameraPose { position_m: self.defect.position_m + self.defect.normal * VIEW_DISTANCE_M, forward, right, lamp_on: true }
    }
}

impl BestApproach {
    /// Returns the time of the best view or else of the closest approach, s since lift-off.
    #[must_use]
    pub fn moment_s(&self) -> f64 {
        self.best.as_ref().map_or(self.nearest.1, |(t_s, _)| *t_s)
    }
}

/// Determines the outcome of every defect in a session.
#[must_use]
pub fn defect_outcomes(scene: &ReviewContext<'_>, assessment: &Assessment) -> Vec<DefectOutcome> {
    let each = &assessment.snapshots.each;
    let number = |id: u32| each.iter().position(|s| s.found.contains(&id)).map(|k| u32::try_from(k + 1).unwrap_or(u32::MAX));
    let defect_outcome = |defect: &PlacedDefect| {
        let found_by = number(defect.id);
        let best_approach = if found_by.is_none() { Some(best_approach(scene, defect)) } else { None };
        DefectOutcome { defect: defect.clone(), found_by, best_approach }
    };
    scene.site.defects().iter().map(defect_outcome).collect()
}

fn best_approach(scene: &ReviewContext<'_>, defect: &PlacedDefect) -> BestApproach {
    let rate_hz = scene.scenario.scoring.frame_rate_hz;
    let stride = (SAMPLE_INTERVAL.s() * rate_hz).round().max(1.0) as usize;
    let mut best_approach = BestApproach { in_view_s: 0.0, best: None, nearest: (f64::INFINITY, 0.0) };
    // The sun hardly moves during a flight, so the ambient light on the defect is computed only once.
    let mut ambient_lux = None;
    for frame in scene.frames.iter().step_by(stride) {
        let t_s = scene.time_since_lift_off_s(frame.time);
        let away_m = (frame.position_m - defect.position_m).norm();
        if away_m < best_approach.nearest.0 {
            best_approach.nearest = (away_m, t_s);
        }
        let Some(pose) = attention::pose(scene.flight, frame.time, scene.vehicle) else { continue };
        let camera = attention::camera(scene.flight, frame.time, &scene.vehicle.camera);
        if !could_be_visible(&pose, &camera, defect.position_m) {
            continue;
        }
        let lux = *ambient_lux.get_or_insert_with(|| scene.site.ambient_lux(defect.position_m, Some(defect.normal), frame.time));
        let cast = |from, direction, max_m| scene.site.geometry().ray(from, direction, max_m);
        let Some(view) = evaluate_defect(defect, &pose, (&camera, &scene.vehicle.lamp), &cast, &|_, _| lux) else { continue };
        if !view.in_frame {
            continue;
        }
        if view.hit {
            best_approach.in_view_s += stride as f64 / rate_hz;
        }
        if best_approach.best.as_ref().is_none_or(|(_, best)| failed_condition_count(&view) < failed_condition_count(best)) {
            best_approach.best = Some((t_s, view));
        }
    }
    best_approach
}

/// Returns the number of failed conditions. An occluded defect ranks worse than a poorly visible one.
fn failed_condition_count(view: &DefectView) -> usize {
    view.conditions().iter().filter(|holds| !**holds).count() + if view.unoccluded { 0 } else { 6 }
}

/// Returns whether the point could be inside the image. This quick test may return true for points outside it.
fn could_be_visible(pose: &CameraPose, camera: &Camera, point_m: Vec3<Enu>) -> bool {
    let to = point_m - pose.position_m;
    let depth = to.dot(pose.forward);
    let half = 0.5 * f64::from(camera.width_px.max(camera.height_px)) / camera.focal_px();
    let down = pose.forward.cross(pose.right);
    depth > 0.0 && to.dot(pose.right).abs() <= half * depth && to.dot(down).abs() <= half * depth
}
