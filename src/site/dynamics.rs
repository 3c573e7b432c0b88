//! What a session adds to the standing structure: traffic and crew, defects, light. Every question takes the static geometry's
//! own answer as an argument, so that this file knows nothing of how that is found.

use super::defects::{self, Ground};
use super::light::{Cast, LightModel};
use super::look;
use super::traffic::TrafficPlan;
use super::{At, CameraPose, DefectView, Nearest, RayHit};
use crate::base::frames::{Enu, Vec3};
use crate::base::time::SimTime;
use crate::scenario::bridges::{Lane, Member};
use crate::scenario::{PlacedDefect, Scenario};
use crate::vehicle::{Camera, Lamp};

/// Traffic plan, defects and light of one session: plain data, immutable once built.
#[derive(Debug, Clone, PartialEq)]
pub struct Dynamics {
    /// Cars, trucks, pedestrians and the crew.
    pub traffic: TrafficPlan,
    /// Sun, sky and reflections.
    pub light: LightModel,
    /// The defects of this session.
    pub defects: Vec<PlacedDefect>,
}

/// The static geometry's own queries, as [`Dynamics::build`] needs them: rays, and the nearest surface within a reach.
#[derive(Clone, Copy)]
pub struct StaticQueries<'a> {
    /// First hit of a ray.
    pub cast: Cast<'a>,
    /// Nearest surface of a point within a reach, m.
    pub nearest: &'a dyn Fn(Vec3<Enu>, f64) -> Option<Nearest>,
}

impl Dynamics {
    /// Draws traffic and defects from the seed.
    #[must_use]
    pub fn build(scenario: &Scenario, seed: u64, members: &[Member], lanes: &[Lane], still: StaticQueries) -> Self {
        let light = LightModel::new(&scenario.light, scenario.origin);
        let ambient = |p, n| light.ambient_lux(p, Some(n), SimTime::ZERO, still.cast);
        let clearance = |p| (still.nearest)(p, defects::CLEARANCE_M).map_or(f64::INFINITY, |n| n.distance_m);
        let ground = Ground { members, tasks: &scenario.tasks, cast: still.cast, ambient: &ambient, clearance_m: &clearance };
        let placed = defects::place(&scenario.defects, &ground, seed);
        Self { traffic: TrafficPlan::new(lanes, &scenario.traffic, &scenario.ground_team, seed), light, defects: placed }
    }

    /// The nearer of the static answer and traffic or crew within `max_m`.
    #[must_use]
    pub fn nearest(&self, still: Option<Nearest>, position_m: Vec3<Enu>, max_m: f64, at: At) -> Option<Nearest> {
        let reach = still.map_or(max_m, |s| s.distance_m);
        self.traffic.nearest(position_m, reach, at).or(still)
    }

    /// The nearer of the static hit and traffic or crew within `max_m`.
    #[must_use]
    pub fn ray(&self, still: Option<RayHit>, origin_m: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64, at: At) -> Option<RayHit> {
        let reach = still.map_or(max_m, |s| s.distance_m);
        self.traffic.ray(origin_m, direction, reach, at).or(still)
    }

    /// How every defect within [`look::REACH_M`] and in front shows in a picture; traffic may stand in the way, but throws no
    /// shadow.
    #[must_use]
    pub fn look(&self, pose: &CameraPose, camera: &Camera, lamp: &Lamp, at: At, still: Cast) -> Vec<DefectView> {
        let cast = |o, d, max| self.ray(still(o, d, max), o, d, max, at);
        let ambient = |p, n| self.light.ambient_lux(p, Some(n), at, still);
        self.defects.iter().filter_map(|d| look::judge(d, pose, (camera, lamp), &cast, &ambient)).collect()
    }
}
