//! The site of a job, built from a scenario and a seed, and its geometry, light and visibility queries. Positions are in the
//! scenario's local frame [`Enu`], meters. All queries are pure functions of their arguments; traffic and wind take the time.

pub mod boxes;
pub mod defects;
pub mod dynamics;
mod faces;
pub mod light;
pub mod movers;
pub mod sun;
mod tracks;
pub mod traffic;
pub mod turbulence;
pub mod visibility;
pub mod wind;

pub mod bridge_closures;
pub mod convex;
pub mod geometry;
pub mod gltf;
pub mod heights;
mod nearest;
pub mod terrain;

use crate::frames::{Enu, Frd, Ned, Rotation, Vec3};
use crate::geodesy::LocalPlane;
use crate::scenario::bridges::{Lane, Member};
use crate::scenario::{PlacedDefect, Scenario};
use crate::time::SimTime;
use crate::vehicle::{Camera, Lamp};
use bridge_closures::BridgeClosures;
use dynamics::{Dynamics, StaticQueries};
use geometry::Geometry;
use std::sync::Arc;

/// Surface type for contact, clearance and the wire's `contact` code (docs/src/reference/wire.md, "Scoring data": 0 none, 1
/// bridge, 2 terrain, 3 water, 4 vehicle, 5 person, 6 other).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Surface {
    /// A bridge member.
    Bridge,
    /// The ground.
    Terrain,
    /// The water.
    Water,
    /// A car, a truck or the crew's truck.
    Vehicle,
    /// A pedestrian or the inspector.
    Person,
    /// Anything else.
    Other,
    /// The landing pad: solid, but neither a crash nor included in the clearance.
    Pad,
}

/// Identifies an object in messages: the index into [`Site::members`] for bridges, otherwise a unique number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ObjectId(pub u32);

/// The nearest point of the site to a query point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestPoint {
    /// Distance from the query point to the surface, m; negative inside a solid.
    pub distance_m: f64,
    /// The surface point, m.
    pub point_m: Vec3<Enu>,
    /// Outward unit normal at that point (from the object toward the query point).
    pub normal: Vec3<Enu>,
    /// Surface type.
    pub surface: Surface,
    /// Object ID.
    pub object: ObjectId,
}

/// The first hit of a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayHit {
    /// Distance along the ray, m.
    pub distance_m: f64,
    /// Outward unit normal of the surface.
    pub normal: Vec3<Enu>,
    /// Surface type.
    pub surface: Surface,
    /// Object ID.
    pub object: ObjectId,
}

/// A contact or near-contact between a convex part of the aircraft and one object of the site.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Point on the object's surface, m.
    pub point_m: Vec3<Enu>,
    /// Outward unit normal of the object, toward the aircraft.
    pub normal: Vec3<Enu>,
    /// Gap along the normal, m; negative when they overlap.
    pub gap_m: f64,
    /// Velocity of the object at that point, m/s (traffic moves).
    pub velocity_m_s: Vec3<Enu>,
    /// Surface type.
    pub surface: Surface,
    /// Object ID.
    pub object: ObjectId,
}

/// Convex parts of the aircraft's hull, in site coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HullProbe {
    /// A sphere.
    Ball {
        /// Center, m.
        centre_m: Vec3<Enu>,
        /// Radius, m.
        radius_m: f64,
    },
    /// A capsule around a segment.
    Capsule {
        /// One end of the axis, m.
        a_m: Vec3<Enu>,
        /// Other end, m.
        b_m: Vec3<Enu>,
        /// Radius, m.
        radius_m: f64,
    },
}

/// Simulation time of a query, which determines the position of moving objects.
pub type QueryTime = SimTime;

/// Position and orientation of a camera at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraPose {
    /// Lens position, m.
    pub position_m: Vec3<Enu>,
    /// Unit vector of the optical axis.
    pub forward: Vec3<Enu>,
    /// Unit vector toward the right side of the image.
    pub right: Vec3<Enu>,
    /// The lamp is on (it points along the optical axis).
    pub lamp_on: bool,
}

impl CameraPose {
    /// Returns the camera pose for an aircraft pose: the attitude determines the heading; the gimbal keeps roll level and holds
    /// its pitch above the horizon, rad, up positive.
    #[must_use]
    pub fn on(
        camera: &Camera,
        (position_m, ned_from_frd): (Vec3<Enu>, Rotation<Frd, Ned>),
        gimbal_rad: f64,
        lamp_on: bool,
    ) -> Self {
        let looking: Rotation<Frd, Ned> = Rotation::from_euler(0.0, gimbal_rad, ned_from_frd.yaw_rad());
        Self {
            position_m: position_m + (ned_from_frd * camera.position_m).enu(),
            forward: (looking * Vec3::new(1.0, 0.0, 0.0)).enu(),
            right: (looking * Vec3::new(0.0, 1.0, 0.0)).enu(),
            lamp_on,
        }
    }
}

/// Visibility of one defect in a photo, with each condition listed separately for reports.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DefectView {
    /// Defect ID ([`PlacedDefect::id`]).
    pub defect_id: u32,
    /// Inside the central 80 % of the image.
    pub in_frame: bool,
    /// Nothing blocks the line of sight.
    pub unoccluded: bool,
    /// Angle between the line of sight and the defect's normal, rad.
    pub incidence_rad: f64,
    /// Longest visible dimension, px.
    pub extent_px: f64,
    /// Width, px (only lines have a minimum).
    pub width_px: f64,
    /// Illuminance at the defect, lx (sun, sky, water, lamp).
    pub illuminance_lux: f64,
    /// Illuminance needed for an exposure within the camera's limits, lx.
    pub needed_lux: f64,
    /// Distance from the lens, m.
    pub distance_m: f64,
    /// A line defect, which has a minimum width.
    pub line: bool,
    /// The lamp was on.
    pub lamp_on: bool,
    /// All conditions are met.
    pub hit: bool,
}

/// The site of a job: immutable after construction; moving objects are a function of time.
#[derive(Debug, Clone)]
pub struct Site {
    geometry: Arc<Geometry>,
    lanes: Vec<Lane>,
    plane: LocalPlane,
    dynamics: Dynamics,
}

impl Site {
    /// Builds geometry, traffic, defects and light from a scenario and the session's seed (which determines defects and traffic).
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

    /// Returns all bridge members.
    #[must_use]
    pub fn members(&self) -> &[Member] {
        self.geometry.members()
    }

    /// Returns the static geometry.
    #[must_use]
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// Returns the lanes and walkways of all bridges.
    #[must_use]
    pub fn lanes(&self) -> &[Lane] {
        &self.lanes
    }

    /// Returns the local plane at the scenario origin.
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

    /// Returns the same site with the given bridge closures; static geometry is shared.
    #[must_use]
    pub fn with_closures(&self, closures: BridgeClosures) -> Self {
        let mut other = self.clone();
        other.dynamics.traffic.set_closures(closures);
        other
    }

    /// Returns the defects of the session.
    #[must_use]
    pub fn defects(&self) -> &[PlacedDefect] {
        &self.dynamics.defects
    }

    /// Returns the nearest surface within `max_m` (bridges, terrain, water, traffic, crew, truck; never the landing pad).
    #[must_use]
    pub fn nearest(&self, position_m: Vec3<Enu>, max_m: f64, at: QueryTime) -> Option<NearestPoint> {
        self.dynamics.nearest(self.geometry.nearest(position_m, max_m), position_m, max_m, at)
    }

    /// Returns the distance to the nearest solid surface of any type within `max_m` (including the landing pad). Nothing inside a
    /// sphere of this radius has contact at this time.
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
    #[allow(clippy::ptr_arg, reason = "it appends")]
    pub fn contacts(&self, probe: &HullProbe, margin_m: f64, at: QueryTime, out: &mut Vec<Contact>) {
        self.geometry.contacts(probe, margin_m, out);
        self.dynamics.traffic.contacts(probe, margin_m, at, out);
    }

    /// Returns the height of ground or pad (not water) below a point, m up.
    #[must_use]
    pub fn ground_up_m(&self, east_m: f64, north_m: f64) -> f64 {
        self.geometry.ground_up_m(east_m, north_m)
    }

    /// Returns the fraction of the upper hemisphere that is open sky, 0 to 1 (static geometry only; deterministic rays).
    #[must_use]
    pub fn sky_view(&self, position_m: Vec3<Enu>) -> f64 {
        self.dynamics.light.sky_view(position_m, &self.cast())
    }

    /// Returns the ambient illuminance (sun, sky, water, ground reflection; no lamp), lx, on a surface with this outward normal,
    /// or for `None` the mean over all orientations at a point in the air.
    #[must_use]
    pub fn ambient_lux(&self, position_m: Vec3<Enu>, normal: Option<Vec3<Enu>>, at: QueryTime) -> f64 {
        self.dynamics.light.ambient_lux(position_m, normal, at, &self.cast())
    }

    /// Returns the visibility of each defect in a photo from `pose`; only defects within 60 m in front of the camera are listed.
    #[must_use]
    pub fn view_defects(&self, pose: &CameraPose, camera: &Camera, lamp: &Lamp, at: QueryTime) -> Vec<DefectView> {
        self.dynamics.look(pose, camera, lamp, at, &self.cast())
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
