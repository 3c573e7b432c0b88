//! Visual attention: what each picture shows, by geometry and light.

use serde::Serialize;
use spandrel_mavlink::telemetry::{Flight, Frame};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::PlacedDefect;
use spandrel_model::site::bridge_closures::BridgeClosures;
use spandrel_model::site::{CameraPose, DefectView, Site};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{Camera, Lamp, Vehicle};
use std::collections::BTreeSet;
use std::sync::Arc;

/// What the scorer asks of the site; the site itself answers, and tests answer with what they have built.
pub trait SiteSurvey: std::fmt::Debug + Send + Sync {
    /// The session's defects.
    fn defects(&self) -> &[PlacedDefect];
    /// How each defect within reach shows in a picture.
    fn view_defects(&self, pose: &CameraPose, camera: &Camera, lamp: &Lamp, at: SimTime) -> Vec<DefectView>;
    /// Name of the nearest thing within `max_m`, for messages.
    fn name_near(&self, position_m: Vec3<Enu>, max_m: f64, at: SimTime) -> Option<String>;
    /// The same where traffic was stopped and let go so; `None` where none moves.
    fn with_closures(&self, _: BridgeClosures) -> Option<Arc<dyn SiteSurvey>> {
        None
    }
}

/// A survey that knows when traffic was stopped and let go in a flight.
#[must_use]
pub fn with_traffic_at(survey: Arc<dyn SiteSurvey>, flight: &Flight) -> Arc<dyn SiteSurvey> {
    let gates = gates(flight);
    if gates.is_empty() { survey } else { survey.with_closures(gates).unwrap_or(survey) }
}

/// When traffic was stopped and let go in a flight.
#[must_use]
pub fn gates(flight: &Flight) -> BridgeClosures {
    BridgeClosures::from_codes(flight.traffic.all().iter().map(|said| said.2))
}

impl SiteSurvey for Site {
    fn defects(&self) -> &[PlacedDefect] {
        Self::defects(self)
    }
    fn view_defects(&self, pose: &CameraPose, camera: &Camera, lamp: &Lamp, at: SimTime) -> Vec<DefectView> {
        Self::view_defects(self, pose, camera, lamp, at)
    }
    fn name_near(&self, position_m: Vec3<Enu>, max_m: f64, at: SimTime) -> Option<String> {
        self.nearest(position_m, max_m, at).map(|nearest| self.object_name(nearest.object))
    }
    fn with_closures(&self, gates: BridgeClosures) -> Option<Arc<dyn SiteSurvey>> {
        Some(Arc::new(Self::with_closures(self, gates)))
    }
}

/// Fields of view that differ by less are the same, rad: the wire tells degrees in 24 bits.
const SAME_RAD: f64 = 1e-6;

/// One picture.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Snapshot {
    /// Frame of the press, from 1.
    pub frame: u32,
    /// Since lift-off, s.
    pub t_s: f64,
    /// It shows at least one defect that no earlier picture has shown.
    pub hit: bool,
    /// Defects that it is the first to show.
    pub found: Vec<u32>,
    /// What it was pointed at and how that failed or not.
    pub views: Vec<DefectSighting>,
}

/// One defect in one picture.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DefectSighting {
    /// Defect.
    pub defect: u32,
    /// All conditions hold.
    pub shown: bool,
    /// Conditions that fail.
    pub fails: Vec<String>,
}

/// Judges every picture taken in `frames`. A frame holds one press at most: pictures of one frame are one press.
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
            .flat_map(|(time, _, _)| views(flight, *time, vehicle, survey))
            .collect();
        let shown = views.iter().filter(|view| view.shown).map(|view| view.defect);
        let found: Vec<u32> = shown.filter(|defect| hit_before.insert(*defect)).collect();
        let t_s = (frame.time - first.time).s();
        judged.push(Snapshot { frame: frame.index, t_s, hit: !found.is_empty(), found, views });
    }
    judged
}

fn views(flight: &Flight, time: SimTime, vehicle: &Vehicle, survey: &dyn SiteSurvey) -> Vec<DefectSighting> {
    let Some(pose) = pose(flight, time, vehicle) else { return Vec::new() };
    let looks = survey.view_defects(&pose, &camera(flight, time, &vehicle.camera), &vehicle.lamp, time);
    looks.iter().filter(|look| look.in_frame || look.hit).map(view).collect()
}

/// The camera with the field of view that it had; who says none has a fixed lens.
#[must_use]
pub fn camera(flight: &Flight, time: SimTime, camera: &Camera) -> Camera {
    match flight.field_of_view.at(time) {
        Some(hfov_rad) if (hfov_rad - camera.hfov_rad).abs() > SAME_RAD => Camera { hfov_rad, ..*camera },
        _ => *camera,
    }
}

/// Where the camera was.
#[must_use]
pub fn pose(flight: &Flight, time: SimTime, vehicle: &Vehicle) -> Option<CameraPose> {
    let state = flight.between(time)?;
    let gimbal_rad = flight.gimbal.at(time).unwrap_or(0.0);
    let lamp_on = flight.light.at(time).unwrap_or(false);
    Some(CameraPose::on(&vehicle.camera, (state.position_m, state.ned_from_frd), gimbal_rad, lamp_on))
}

fn view(look: &DefectView) -> DefectSighting {
    DefectSighting { defect: look.defect_id, shown: look.hit, fails: look.reasons() }
}
