//! Visual attention: determines which defects each picture shows, based on geometry and lighting.

use super::image_quality::{CameraMotion, ImageQuality, angle_rad};
use serde::Serialize;
use spandrel_mavlink::telemetry::{Flight, Frame};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::PlacedDefect;
use spandrel_model::site::bridge_closures::BridgeClosures;
use spandrel_model::site::changes::SiteChanges;
use spandrel_model::site::inspector_walks::InspectorWalks;
use spandrel_model::site::{CameraPose, DefectView, Site};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{Camera, Lamp, Vehicle};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Site queries needed for scoring. [`Site`] implements this trait; tests use their own implementations.
pub trait SiteSurvey: std::fmt::Debug + Send + Sync {
    /// Returns the session's defects.
    fn defects(&self) -> &[PlacedDefect];
    /// Returns the visibility of each defect in range in a picture taken with these settings.
    fn view_defects(&self, pose: &CameraPose, camera: &Camera, lamp: &Lamp, at: SimTime) -> Vec<DefectView>;
    /// Returns the name of the nearest object within `max_m`, for messages to the pilot.
    fn nearest_object_name(&self, position_m: Vec3<Enu>, max_m: f64, at: SimTime) -> Option<String>;
    /// Returns the site with the bridges, the lanes and the ground; `None` if they are unknown.
    fn site(&self) -> Option<&Site> {
        None
    }
    /// Returns a copy of the site with these bridge closures and walks of the inspector; `None` if nothing moves on the site.
    fn with_changes(&self, _: SiteChanges) -> Option<Arc<dyn SiteSurvey>> {
        None
    }
}

/// Applies the changes of the site during a flight.
#[must_use]
pub fn with_flight_changes(survey: Arc<dyn SiteSurvey>, flight: &Flight) -> Arc<dyn SiteSurvey> {
    let changes = site_changes(flight);
    if changes.is_empty() { survey } else { survey.with_changes(changes).unwrap_or(survey) }
}

/// Returns the bridge closures and the walks of the inspector during a flight.
#[must_use]
pub fn site_changes(flight: &Flight) -> SiteChanges {
    SiteChanges {
        closures: BridgeClosures::from_codes(flight.traffic.all().iter().map(|said| said.2)),
        walks: InspectorWalks::from_codes(flight.walks.all().iter().map(|said| said.2)),
    }
}

impl SiteSurvey for Site {
    fn defects(&self) -> &[PlacedDefect] {
        Self::defects(self)
    }
    fn view_defects(&self, pose: &CameraPose, camera: &Camera, lamp: &Lamp, at: SimTime) -> Vec<DefectView> {
        Self::view_defects(self, pose, camera, lamp, at)
    }
    fn nearest_object_name(&self, position_m: Vec3<Enu>, max_m: f64, at: SimTime) -> Option<String> {
        self.nearest(position_m, max_m, at).map(|nearest| self.object_name(nearest.object))
    }
    fn site(&self) -> Option<&Site> {
        Some(self)
    }
    fn with_changes(&self, changes: SiteChanges) -> Option<Arc<dyn SiteSurvey>> {
        Some(Arc::new(Self::with_changes(self, changes)))
    }
}

/// Difference below which two fields of view count as equal, rad. Telemetry sends degrees with 24-bit precision.
const FOV_TOLERANCE_RAD: f64 = 1e-6;
/// Time before a picture over which the camera's rotation is measured: the interval of the gimbal's status messages.
const ROTATION_INTERVAL: SimTime = SimTime::from_ms(100);

/// Evaluation of one picture.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Snapshot {
    /// Frame number of the picture, from 1.
    pub frame: u32,
    /// Time since lift-off, s.
    pub t_s: f64,
    /// Whether the picture shows at least one new defect.
    pub hit: bool,
    /// IDs of the defects first shown in this picture.
    pub found: Vec<u32>,
    /// All defects in view, each with its failed conditions.
    pub views: Vec<DefectSighting>,
}

/// Returns the IDs of all defects that the pictures show.
#[must_use]
pub fn found_defects(pictures: &[Snapshot]) -> BTreeSet<u32> {
    pictures.iter().flat_map(|picture| picture.found.iter().copied()).collect()
}

/// Visibility of one defect in one picture.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DefectSighting {
    /// Defect number, from 1.
    pub defect: u32,
    /// Whether all conditions for a hit are met.
    pub shown: bool,
    /// Unmet conditions, as text.
    pub fails: Vec<String>,
    /// Measured image quality. Affects only the certification profile.
    pub quality: ImageQuality,
}

/// Evaluates all pictures taken in `frames`. Multiple pictures in one frame count as one.
#[must_use]
pub fn snapshots(flight: &Flight, frames: &[Frame], vehicle: &Vehicle, survey: &dyn SiteSurvey) -> Vec<Snapshot> {
    let Some(first) = frames.first() else { return Vec::new() };
    let mut hit_before = BTreeSet::new();
    let mut judged = Vec::new();
    for (i, frame) in frames.iter().enumerate().filter(|(_, frame)| frame.snapshot) {
        let since = i.checked_sub(1).map_or(SimTime::from_ns(frame.time.ns() - 1), |k| frames[k].time);
        let views: Vec<DefectSighting> = flight
            .snapshots
            .between(since, frame.time)
            .iter()
            .flat_map(|(time, _, _)| sightings_at(flight, *time, vehicle, survey))
            .collect();
        let shown = views.iter().filter(|view| view.shown).map(|view| view.defect);
        let found: Vec<u32> = shown.filter(|defect| hit_before.insert(*defect)).collect();
        let t_s = (frame.time - first.time).s();
        judged.push(Snapshot { frame: frame.index, t_s, hit: !found.is_empty(), found, views });
    }
    judged
}

fn sightings_at(flight: &Flight, time: SimTime, vehicle: &Vehicle, survey: &dyn SiteSurvey) -> Vec<DefectSighting> {
    let Some(pose) = pose(flight, time, vehicle) else { return Vec::new() };
    let camera = camera(flight, time, &vehicle.camera);
    let motion = camera_motion(flight, time, vehicle);
    let looks = survey.view_defects(&pose, &camera, &vehicle.lamp, time);
    let sighting = |look: &DefectView| {
        let placed = survey.defects().iter().find(|defect| defect.id == look.defect_id);
        let to_defect = placed.map_or(pose.forward, |defect| defect.position_m - pose.position_m);
        DefectSighting {
            defect: look.defect_id,
            shown: look.hit,
            fails: look.reasons(),
            quality: ImageQuality::measure(look, to_defect, &camera, &motion),
        }
    };
    looks.iter().filter(|look| look.in_frame || look.hit).map(sighting).collect()
}

/// Returns the camera's velocity and rotation rate at `time`; zero if the telemetry does not cover it.
fn camera_motion(flight: &Flight, time: SimTime, vehicle: &Vehicle) -> CameraMotion {
    let velocity_m_s = flight.between(time).map_or_else(Vec3::zero, |state| state.motion.velocity_m_s);
    let axis = |at: SimTime| pose(flight, at, vehicle).map(|pose| pose.forward);
    let turned_rad = axis(time).zip(axis(time - ROTATION_INTERVAL)).map_or(0.0, |(now, before)| angle_rad(now, before));
    CameraMotion { velocity_m_s, rotation_rad_s: turned_rad / ROTATION_INTERVAL.s() }
}

/// Returns the camera with the recorded field of view. If none was recorded, the camera has a fixed lens.
#[must_use]
pub fn camera(flight: &Flight, time: SimTime, camera: &Camera) -> Camera {
    match flight.field_of_view.at(time) {
        Some(hfov_rad) if (hfov_rad - camera.hfov_rad).abs() > FOV_TOLERANCE_RAD => Camera { hfov_rad, ..*camera },
        _ => *camera,
    }
}

/// Returns the camera pose at `time`; `None` if the telemetry does not cover it.
#[must_use]
pub fn pose(flight: &Flight, time: SimTime, vehicle: &Vehicle) -> Option<CameraPose> {
    let state = flight.between(time)?;
    let gimbal_rad = flight.gimbal.at(time).unwrap_or(0.0);
    let lamp_on = flight.light.at(time).unwrap_or(false);
    Some(CameraPose::on_aircraft(&vehicle.camera, state.motion.pose(), gimbal_rad, lamp_on))
}
