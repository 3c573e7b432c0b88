//! The site of a job, built from a scenario and a seed, with queries about geometry, light and visibility. Positions are in the
//! scenario's local frame [`Enu`], m. All queries are pure functions of their arguments, which include the time for moving
//! objects.

pub mod aircraft_hull;
pub mod boxes;
pub mod bridge_closures;
pub mod bridge_import;
mod camera_pose;
mod causes;
pub mod changes;
pub mod close_up;
pub mod convex;
mod defect_checks;
mod defect_slots;
pub mod defects;
pub mod detection;
pub mod drone_path;
pub mod drones;
pub mod dynamics;
mod faces;
pub mod geometry;
pub mod gltf;
pub mod hand_placed;
pub mod heights;
pub mod hull_shape;
pub mod inspector_path;
pub mod inspector_walks;
mod lane_track;
pub mod light;
pub mod mean_air;
pub mod member_shape;
pub mod mesh_shape;
pub mod movers;
mod nearest_points;
pub mod outline;
pub mod plan_hull;
mod query_types;
pub mod radio_path;
mod reference_camera;
pub mod reflectors;
pub mod ropes;
pub mod section_cut;
pub mod steel;
mod steel_pieces;
pub mod sun;
pub mod terrain;
pub mod traffic;
pub mod turbulence;
pub mod visibility;
pub mod wakes;
pub mod walkable;
pub mod wind;

pub use camera_pose::CameraPose;
pub use query_types::{Contact, HullProbe, NearestPoint, ObjectId, QueryTime, RayHit, Surface};
pub use visibility::DefectView;

use crate::frames::{Enu, Vec3};
use crate::geodesy::LocalPlane;
use crate::scenario::bridges::{Lane, Member};
use crate::scenario::{DefectSpec, PlacedDefect, Scenario, Task};
use crate::vehicle::{Camera, Lamp};
use changes::SiteChanges;
use dynamics::{Dynamics, StaticQueries};
use geometry::Geometry;
use inspector_path::InspectorPath;
use std::sync::Arc;

/// A job's site. It is immutable after construction; the positions of moving objects are a function of time.
#[derive(Debug, Clone)]
pub struct Site {
    geometry: Arc<Geometry>,
    lanes: Vec<Lane>,
    plane: LocalPlane,
    dynamics: Dynamics,
}

/// Seed of a site whose random content is not used.
const ANY_SEED: u64 = 0;

impl Site {
    /// Builds a site without defects, which is much faster, for uses of the bridges, the terrain and the paths alone. Only the
    /// traffic depends on a seed then.
    #[must_use]
    pub fn without_defects(scenario: &Scenario) -> Self {
        let defects = DefectSpec { count: 0, placed: Some(Vec::new()), ..scenario.defects.clone() };
        Self::build(&Scenario { defects, ..scenario.clone() }, ANY_SEED)
    }

    /// Returns the place on a path of straight segments with the smallest clearance to the structure and the terrain; `None` if it
    /// is at least `less_than_m` everywhere.
    #[must_use]
    pub fn min_path_clearance(
        &self,
        segments: impl Iterator<Item = (Vec3<Enu>, Vec3<Enu>)>,
        less_than_m: f64,
    ) -> Option<(Vec3<Enu>, NearestPoint)> {
        segments.fold(None, |best: Option<(Vec3<Enu>, NearestPoint)>, (from, to)| {
            let limit_m = best.map_or(less_than_m, |(_, near)| near.distance_m);
            self.geometry.min_clearance(from, to, limit_m).or(best)
        })
    }

    /// Builds geometry, traffic, defects and light from a scenario and a seed. The seed determines defects and traffic.
    #[must_use]
    pub fn build(scenario: &Scenario, seed: u64) -> Self {
        let lanes: Vec<Lane> = scenario.bridges.iter().enumerate().flat_map(|(k, bridge)| bridge.lanes(k)).collect();
        let geometry = Arc::new(Geometry::new(scenario));
        let cast = |origin, direction, max_m| geometry.ray(origin, direction, max_m);
        let nearest = |position, max_m| geometry.nearest(position, max_m);
        let still = StaticQueries { cast: &cast, nearest: &nearest };
        let dynamics = Dynamics::build(scenario, seed, geometry.members(), &lanes, still);
        Self { geometry, plane: LocalPlane::new(scenario.origin), lanes, dynamics }
    }

    /// Returns the members of all bridges.
    #[must_use]
    pub fn members(&self) -> &[Member] {
        self.geometry.members()
    }

    /// Returns the static geometry: bridges, ground, water and landing pad.
    #[must_use]
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// Returns the lanes and walkways of all bridges.
    #[must_use]
    pub fn lanes(&self) -> &[Lane] {
        &self.lanes
    }

    /// Returns the local tangent plane at the scenario origin.
    #[must_use]
    pub fn plane(&self) -> &LocalPlane {
        &self.plane
    }

    /// Returns the light model.
    #[must_use]
    pub fn light(&self) -> &light::LightModel {
        &self.dynamics.light
    }

    /// Returns the traffic plan: vehicles and people, and their positions over time.
    #[must_use]
    pub fn traffic(&self) -> &traffic::TrafficPlan {
        &self.dynamics.traffic
    }

    /// Returns the drones that fly along paths of the scenario.
    #[must_use]
    pub fn drones(&self) -> &[drones::SiteDrone] {
        self.dynamics.traffic.drones().all()
    }

    /// Returns the ropes and cables that hang at the site.
    #[must_use]
    pub fn ropes(&self) -> &ropes::SiteRopes {
        self.dynamics.traffic.ropes()
    }

    /// Returns the other vehicles that share the site.
    #[must_use]
    pub fn live_drones(&self) -> &[drones::LiveDrone] {
        self.dynamics.traffic.drones().live()
    }

    /// Sets the positions of the other vehicles that share the site.
    pub fn set_live_drones(&mut self, live: Vec<drones::LiveDrone>) {
        self.dynamics.traffic.set_live_drones(live);
    }

    /// Returns a copy of the site with other bridge closures and walks. Both share the static geometry.
    #[must_use]
    pub fn with_changes(&self, changes: SiteChanges) -> Self {
        let mut other = self.clone();
        other.dynamics.traffic.set_changes(changes, &|east_m, north_m| self.ground_up_m(east_m, north_m));
        other
    }

    /// Returns whether the site has these bridge closures and walks.
    #[must_use]
    pub fn has_changes(&self, changes: &SiteChanges) -> bool {
        self.dynamics.traffic.has_changes(changes)
    }

    /// Returns the inspector's places and walks.
    #[must_use]
    pub fn inspector(&self) -> &InspectorPath {
        self.dynamics.traffic.inspector()
    }

    /// Returns the defects of the session.
    #[must_use]
    pub fn defects(&self) -> &[PlacedDefect] {
        &self.dynamics.defects
    }

    /// Returns the predicted detection of each defect in a camera's pictures, 0 to 1 ([`detection::predicted_detection`]).
    /// `tasks` are the job's tasks.
    #[must_use]
    pub fn predicted_detection(&self, tasks: &[Task], camera: &Camera) -> Vec<f64> {
        let cast = self.cast();
        self.defects().iter().map(|defect| detection::predicted_detection(defect, tasks, camera, &cast)).collect()
    }

    /// Returns the nearest surface within `max_m` (bridges, terrain, water, traffic, crew, truck; never the landing pad).
    #[must_use]
    pub fn nearest(&self, position_m: Vec3<Enu>, max_m: f64, at: QueryTime) -> Option<NearestPoint> {
        self.dynamics.nearest(self.geometry.nearest(position_m, max_m), position_m, max_m, at)
    }

    /// Returns the distance to the nearest surface of any type within `max_m`, including the landing pad. Nothing inside a sphere
    /// of this radius about the position can be in contact at this time.
    #[must_use]
    pub fn free_radius(&self, position_m: Vec3<Enu>, max_m: f64, at: QueryTime) -> Option<f64> {
        let still = self.geometry.free_radius(position_m, max_m);
        self.dynamics.traffic.nearest(position_m, still.unwrap_or(max_m), at).map(|n| n.distance_m).or(still)
    }

    /// Returns the first hit of a ray within `max_m` with any object (including landing pad and water). `direction` is a unit
    /// vector.
    #[must_use]
    pub fn ray(&self, origin_m: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64, at: QueryTime) -> Option<RayHit> {
        self.dynamics.ray(self.geometry.ray(origin_m, direction, max_m), origin_m, direction, max_m, at)
    }

    /// Appends all contacts and near-contacts (gap <= `margin_m`) of a convex probe with the site, including the landing pad.
    #[allow(clippy::ptr_arg, reason = "appends to the vector")]
    pub fn contacts(&self, probe: &HullProbe, margin_m: f64, at: QueryTime, out: &mut Vec<Contact>) {
        self.geometry.contacts(probe, margin_m, out);
        self.dynamics.traffic.contacts(probe, margin_m, at, out);
    }

    /// Returns the height of the ground or pad (not water) below a point, in meters above the origin.
    #[must_use]
    pub fn ground_up_m(&self, east_m: f64, north_m: f64) -> f64 {
        self.geometry.ground_up_m(east_m, north_m)
    }

    /// Returns the member that contains a point; `None` if no bridge does.
    #[must_use]
    pub fn member_around(&self, position_m: Vec3<Enu>) -> Option<&Member> {
        let near = self.geometry.nearest_member(position_m, 0.0)?;
        self.members().get(near.object.0 as usize)
    }

    /// Returns the height of the water's surface in meters above the origin; `None` on land.
    #[must_use]
    pub fn water_up_m(&self, east_m: f64, north_m: f64) -> Option<f64> {
        let water_m = self.geometry.terrain.water_m;
        (self.ground_up_m(east_m, north_m) < water_m).then_some(water_m)
    }

    /// Returns the height of the ground (without the pad) in meters above the origin; `None` outside of the terrain's grid.
    #[must_use]
    pub fn terrain_up_m(&self, east_m: f64, north_m: f64) -> Option<f64> {
        let ground = &self.geometry.terrain.ground;
        ground.contains(east_m, north_m).then(|| ground.ground(east_m, north_m).0)
    }

    /// Returns the distance between two heights of the terrain's grid, m.
    #[must_use]
    pub fn terrain_spacing_m(&self) -> f64 {
        self.geometry.terrain.ground.spacing_m()
    }

    /// Returns the fraction of the upper hemisphere that is open sky, 0 to 1 (static geometry only; deterministic rays).
    #[must_use]
    pub fn sky_view(&self, position_m: Vec3<Enu>) -> f64 {
        self.dynamics.light.sky_view(position_m, &self.cast())
    }

    /// Returns the ambient illuminance in lx (sun, sky, and reflection by water and ground; no lamp) on a surface with
    /// this outward normal. `None` yields the mean over all orientations at a point in the air.
    #[must_use]
    pub fn ambient_lux(&self, position_m: Vec3<Enu>, normal: Option<Vec3<Enu>>, at: QueryTime) -> f64 {
        self.dynamics.light.ambient_lux(position_m, normal, at, &self.cast())
    }

    /// Returns the visibility of each defect in a photo from `pose`; only defects within 60 m in front of the camera are listed.
    #[must_use]
    pub fn view_defects(&self, pose: &CameraPose, camera: &Camera, lamp: &Lamp, at: QueryTime) -> Vec<DefectView> {
        self.defects().iter().filter_map(|defect| self.view_defect(defect, pose, (camera, lamp), at)).collect()
    }

    /// Returns the visibility of one defect in a photo from `pose`; `None` if it isn't within 60 m in front of the camera.
    #[must_use]
    pub fn view_defect(
        &self,
        defect: &PlacedDefect,
        pose: &CameraPose,
        optics: (&Camera, &Lamp),
        at: QueryTime,
    ) -> Option<DefectView> {
        self.dynamics.view_defect(defect, pose, optics, at, &self.cast())
    }

    /// Returns the name of an object for messages, such as `arch/rib-left/07 (144)`, `car 12` or `inspector`.
    #[must_use]
    pub fn object_name(&self, object: ObjectId) -> String {
        match object {
            geometry::GROUND => "ground".into(),
            geometry::WATER => "water".into(),
            geometry::PAD => "pad".into(),
            _ => match self.members().get(object.0 as usize) {
                Some(member) => format!("{} ({})", member.name, member.element.number()),
                None => self.dynamics.traffic.name(object).unwrap_or_else(|| format!("object {}", object.0)),
            },
        }
    }

    /// Returns the ray query against static geometry.
    fn cast(&self) -> impl Fn(Vec3<Enu>, Vec3<Enu>, f64) -> Option<RayHit> + '_ {
        |origin, direction, max_m| self.geometry.ray(origin, direction, max_m)
    }
}
