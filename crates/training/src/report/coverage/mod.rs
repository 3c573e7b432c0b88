//! Surface coverage: the inspectable surface that the pictures capture well, the reasons why the rest does not count,
//! and the part of the rest that was in the camera's view during the flight. The scorer's functions evaluate size,
//! angle and light.

mod element;
mod outcome;
mod patches;
mod sight;

pub use element::{AveragePicture, ElementSurface, SurfaceCoverage};
pub use outcome::SurfaceOutcome;
pub use sight::{REQUIRED_GSD_M, reach_m};

use super::context::ReviewContext;
use super::pictures::ReviewedPicture;
use element::BestPicture;
use patches::{SurfacePatch, inspectable};
use sight::is_clear;
use spandrel_model::elements::Element;
use spandrel_model::frames::Vec3;
use spandrel_model::math;
use spandrel_model::site::CameraPose;
use spandrel_model::site::visibility::{MAX_INCIDENCE_RAD, lamp_lux, required_illuminance_lux};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Camera;
use spandrel_monitor::measures::attention;
use spandrel_monitor::measures::image_quality::exposure_s;
use std::collections::BTreeMap;

/// Maximum motion blur, px (the published limit for defect detection).
pub const MAX_MOTION_BLUR_PX: f64 = 1.0;
/// A surface counts as background beyond this multiple of the distance at which pixels have the required size.
const BACKGROUND_DISTANCE_FACTOR: f64 = 3.0;
/// Sampling interval for evaluating the camera's view during the flight.
const VIEW_SAMPLE_INTERVAL: SimTime = SimTime::from_ms(2_000);
/// Size of the cells in which patches with the same orientation share ambient light, m.
const LIGHT_CELL_SIZE_M: f64 = 5.0;

/// A surface patch and the best picture of it.
struct EvaluatedPatch {
    patch: SurfacePatch,
    in_view: bool,
    best: Option<BestPicture>,
}

/// Computes the surface coverage of a session.
#[must_use]
pub fn compute_coverage(scene: &ReviewContext<'_>, pictures: &[ReviewedPicture]) -> SurfaceCoverage {
    let whole = inspectable(scene).into_iter().map(|patch| EvaluatedPatch { patch, in_view: false, best: None });
    let mut pieces: Vec<EvaluatedPatch> = whole.collect();
    let mut light = LightCache { scene, cells: BTreeMap::new() };
    for picture in pictures {
        add_picture(&mut pieces, picture, &mut light);
    }
    add_flight(&mut pieces, scene);
    let mut elements: BTreeMap<Element, ElementSurface> = BTreeMap::new();
    for piece in &pieces {
        let SurfacePatch { element, area_m2, .. } = piece.patch;
        elements.entry(element).or_default().add(area_m2, piece.surface_outcome(), piece.best.as_ref());
    }
    SurfaceCoverage { elements }
}

impl EvaluatedPatch {
    fn surface_outcome(&self) -> SurfaceOutcome {
        let unpictured = if self.in_view { SurfaceOutcome::NotPhotographed } else { SurfaceOutcome::NeverInView };
        self.best.map_or(unpictured, |best| best.outcome)
    }
}

/// Returns the distance in meters and the cosine of the incidence angle for a patch that is inside the image and faces
/// the camera. Does not check for a clear line of sight.
fn in_image(patch: &SurfacePatch, pose: &CameraPose, camera: &Camera, farthest_m: f64) -> Option<(f64, f64)> {
    let to = patch.point_m - pose.position_m;
    let away_m = to.norm();
    let cosine = -to.dot(patch.normal) / away_m.max(f64::MIN_POSITIVE);
    if away_m > farthest_m || cosine <= 0.0 {
        return None;
    }
    let depth = to.dot(pose.forward);
    let down = pose.forward.cross(pose.right);
    let half = |px: u32| 0.5 * f64::from(px) / camera.focal_px();
    let inside = depth > 0.0
        && to.dot(pose.right).abs() <= half(camera.width_px) * depth
        && to.dot(down).abs() <= half(camera.height_px) * depth;
    inside.then_some((away_m, cosine))
}

fn add_picture(pieces: &mut [EvaluatedPatch], picture: &ReviewedPicture, light: &mut LightCache<'_>) {
    let (pose, camera) = (&picture.pose, &picture.camera);
    let reach = reach_m(camera);
    for piece in pieces {
        let Some((away_m, cosine)) = in_image(&piece.patch, pose, camera, BACKGROUND_DISTANCE_FACTOR * reach) else { continue };
        // Best possible outcome of this picture. If an equal or better picture is known, the line of sight is not
        // tested.
        let most = if away_m > reach {
            SurfaceOutcome::TooFar
        } else if cosine < math::cos(MAX_INCIDENCE_RAD) {
            SurfaceOutcome::TooOblique
        } else {
            SurfaceOutcome::Shown
        };
        let gsd_m = away_m / camera.focal_px();
        let worse = |best: &BestPicture| (best.outcome, -best.gsd_m) < (most, -gsd_m);
        if !piece.best.as_ref().is_none_or(worse) || !is_clear(pose.position_m, piece.patch.sight_line_end_m, light.scene) {
            continue;
        }
        let incidence_rad = math::acos(cosine.min(1.0));
        let mut now = BestPicture { outcome: most, incidence_rad, gsd_m, blur_px: 0.0, lux: 0.0 };
        if most == SurfaceOutcome::Shown {
            (now.lux, now.blur_px) = light.with_motion_blur(&piece.patch, picture);
            now.outcome = outcome_of_light_and_blur(now.lux, now.blur_px, picture);
        }
        if piece.best.is_none_or(|best| (best.outcome, -best.gsd_m) < (now.outcome, -now.gsd_m)) {
            piece.best = Some(now);
        }
    }
}

/// Returns the outcome of a picture that meets the required pixel size and angle, based on its light and blur.
fn outcome_of_light_and_blur(lux: f64, blur_px: f64, picture: &ReviewedPicture) -> SurfaceOutcome {
    if lux < required_illuminance_lux(&picture.camera) {
        if picture.pose.lamp_on { SurfaceOutcome::DarkLampOn } else { SurfaceOutcome::DarkLampOff }
    } else if blur_px > MAX_MOTION_BLUR_PX {
        SurfaceOutcome::Blurred
    } else {
        SurfaceOutcome::Shown
    }
}

fn add_flight(pieces: &mut [EvaluatedPatch], scene: &ReviewContext<'_>) {
    let stride = (VIEW_SAMPLE_INTERVAL.s() * scene.scenario.scoring.frame_rate_hz).round().max(1.0) as usize;
    let steepest = math::cos(MAX_INCIDENCE_RAD);
    for frame in scene.frames.iter().step_by(stride) {
        let Some(pose) = attention::pose(scene.flight, frame.time, scene.vehicle) else { continue };
        let camera = attention::camera(scene.flight, frame.time, &scene.vehicle.camera);
        // Patches with a picture already have an outcome.
        for piece in pieces.iter_mut().filter(|piece| !piece.in_view && piece.best.is_none()) {
            let near = in_image(&piece.patch, &pose, &camera, reach_m(&camera));
            piece.in_view = near.is_some_and(|(_, cosine)| cosine >= steepest)
                && is_clear(pose.position_m, piece.patch.sight_line_end_m, scene);
        }
    }
}

/// Cache of ambient light by grid cell and surface orientation.
struct LightCache<'a> {
    scene: &'a ReviewContext<'a>,
    cells: BTreeMap<[i64; 6], f64>,
}

impl LightCache<'_> {
    /// Returns a patch's illuminance in a picture in lx, including lamp light, and the motion blur in px at the
    /// shortest exposure possible in this light.
    fn with_motion_blur(&mut self, patch: &SurfacePatch, picture: &ReviewedPicture) -> (f64, f64) {
        let (pose, camera) = (&picture.pose, &picture.camera);
        let lamp = lamp_lux(&self.scene.vehicle.lamp, pose, patch.point_m, patch.normal);
        let lux = lamp + self.ambient_lux(patch, picture.time);
        let velocity = self.scene.flight.between(picture.time).map_or(Vec3::zero(), |state| state.motion.velocity_m_s);
        let to = patch.point_m - pose.position_m;
        let ray = to.unit();
        let across_m_s = (velocity - ray * velocity.dot(ray)).norm();
        (lux, across_m_s * exposure_s(camera, lux) * camera.focal_px() / to.norm())
    }

    fn ambient_lux(&mut self, patch: &SurfacePatch, time: SimTime) -> f64 {
        let (p, n) = (patch.point_m.array(), patch.normal.array());
        let key =
            std::array::from_fn(
                |k| if k < 3 { (p[k] / LIGHT_CELL_SIZE_M).floor() as i64 } else { (2.0 * n[k - 3]).round() as i64 },
            );
        let scene = self.scene;
        *self.cells.entry(key).or_insert_with(|| scene.site.ambient_lux(patch.point_m, Some(patch.normal), time))
    }
}
