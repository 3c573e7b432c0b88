//! Outcome of each defect and, for missed ones, how close the flight came to showing them.

use super::context::ReviewContext;
use super::words;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::PlacedDefect;
use spandrel_model::site::visibility::judge;
use spandrel_model::site::{CameraPose, DefectView};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Camera;
use spandrel_monitor::assessment::Assessment;
use spandrel_monitor::measures::attention;

/// Sampling interval of the flight.
const STEP: SimTime = SimTime::from_ms(500);
/// Stand-off of the view drawn of a missed defect, m (estimate: close enough to see a crack at the condition state limit).
const SHOWN_FROM_M: f64 = 4.0;

/// Outcome of one defect.
#[derive(Debug, Clone, PartialEq)]
pub struct DefectOutcome {
    /// The defect.
    pub defect: PlacedDefect,
    /// Number of the first picture that shows it; `None` if it was missed.
    pub found_by: Option<u32>,
    /// Best approach, if no picture shows it.
    pub chance: Option<BestApproach>,
}

/// How close the flight came to a picture of a defect.
#[derive(Debug, Clone, PartialEq)]
pub struct BestApproach {
    /// Time during which a picture would have been a hit, s.
    pub in_view_s: f64,
    /// Best moment, s since lift-off: the first that would have been a hit, otherwise the one with the fewest failed conditions.
    pub best: Option<(f64, DefectView)>,
    /// Minimum distance of the drone, m, and its time, s.
    pub nearest: (f64, f64),
}

impl DefectOutcome {
    /// Describes the outcome.
    #[must_use]
    pub fn words(&self) -> String {
        let Some(chance) = &self.chance else {
            return self.found_by.map_or_else(|| "found".into(), |number| format!("found by picture {number}"));
        };
        let (nearest_m, nearest_s) = chance.nearest;
        match &chance.best {
            Some((t_s, view)) if view.hit => format!(
                "in plain view for {} s, first at {}, but no picture was taken",
                words::number(chance.in_view_s, 1),
                words::clock(*t_s)
            ),
            Some((t_s, view)) => format!("best seen at {}, but {}", words::clock(*t_s), view.reasons().join("; ")),
            None => format!(
                "the camera never pointed at it; the drone came within {} m at {}",
                words::number(nearest_m, 1),
                words::clock(nearest_s)
            ),
        }
    }

    /// Returns a camera pose that would show the defect well.
    #[must_use]
    pub fn good_view(&self) -> CameraPose {
        let forward = self.defect.normal * -1.0;
        let up = Vec3::new(0.0, 0.0, 1.0);
        // When looking straight up or down, any horizontal direction can be "right".
        let right = if forward.up().abs() > 0.999 { Vec3::new(1.0, 0.0, 0.0) } else { forward.cross(up).unit() };
        CameraPose { position_m: self.defect.position_m + self.defect.normal * SHOWN_FROM_M, forward, right, lamp_on: true }
    }
}

/// Determines the outcomes of all defects of a session.
#[must_use]
pub fn fates(scene: &ReviewContext<'_>, assessment: &Assessment) -> Vec<DefectOutcome> {
    let each = &assessment.snapshots.each;
    let number = |id: u32| each.iter().position(|s| s.found.contains(&id)).map(|k| u32::try_from(k + 1).unwrap_or(u32::MAX));
    let fate = |defect: &PlacedDefect| {
        let found_by = number(defect.id);
        let chance = if found_by.is_none() { Some(chance(scene, defect)) } else { None };
        DefectOutcome { defect: defect.clone(), found_by, chance }
    };
    scene.site.defects().iter().map(fate).collect()
}

fn chance(scene: &ReviewContext<'_>, defect: &PlacedDefect) -> BestApproach {
    let rate_hz = scene.scenario.scoring.frame_rate_hz;
    let stride = (STEP.s() * rate_hz).round().max(1.0) as usize;
    let mut chance = BestApproach { in_view_s: 0.0, best: None, nearest: (f64::INFINITY, 0.0) };
    // The sun moves little during a flight, so its light on the defect is computed once.
    let mut ambient_lux = None;
    for frame in scene.frames.iter().step_by(stride) {
        let t_s = scene.time_since_lift_off_s(frame.time);
        let away_m = (frame.position_m - defect.position_m).norm();
        if away_m < chance.nearest.0 {
            chance.nearest = (away_m, t_s);
        }
        let Some(pose) = attention::pose(scene.flight, frame.time, scene.vehicle) else { continue };
        let camera = attention::camera(scene.flight, frame.time, &scene.vehicle.camera);
        if !could_be_visible(&pose, &camera, defect.position_m) {
            continue;
        }
        let lux = *ambient_lux.get_or_insert_with(|| scene.site.ambient_lux(defect.position_m, Some(defect.normal), frame.time));
        let cast = |from, direction, max_m| scene.site.geometry().ray(from, direction, max_m);
        let Some(view) = judge(defect, &pose, (&camera, &scene.vehicle.lamp), &cast, &|_, _| lux) else { continue };
        if !view.in_frame {
            continue;
        }
        if view.hit {
            chance.in_view_s += stride as f64 / rate_hz;
        }
        if chance.best.as_ref().is_none_or(|(_, best)| failing(&view) < failing(best)) {
            chance.best = Some((t_s, view));
        }
    }
    chance
}

/// Returns the number of failed conditions. A hidden defect ranks worse than a poorly visible one.
fn failing(view: &DefectView) -> usize {
    view.conditions().iter().filter(|holds| !**holds).count() + if view.unoccluded { 0 } else { 6 }
}

/// Returns false if the point is certainly outside the image.
fn could_be_visible(pose: &CameraPose, camera: &Camera, point_m: Vec3<Enu>) -> bool {
    let to = point_m - pose.position_m;
    let depth = to.dot(pose.forward);
    let half = 0.5 * f64::from(camera.width_px.max(camera.height_px)) / camera.focal_px();
    let down = pose.forward.cross(pose.right);
    depth > 0.0 && to.dot(pose.right).abs() <= half * depth && to.dot(down).abs() <= half * depth
}
