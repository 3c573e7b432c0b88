//! What stands at the job, built from a scenario and a seed, and the questions one may ask of it. Positions are in the
//! scenario's local frame [`Enu`], metres. All queries are pure functions of their arguments: traffic and wind take the time.

pub mod boxes;
pub mod catalogue;
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

/// What something is made of for contact, clearance and the wire's `contact` code (docs/src/reference/wire.md, "Scoring data": 0
/// none, 1 bridge, 2 terrain, 3 water, 4 vehicle, 5 person, 6 other).
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
    /// The take-off pad: solid, but neither a crash nor counted as clearance.
    Pad,
}

/// Identifies what was hit or is near, for messages: an index into [`Site::members`] for bridges, else a running number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ObjectId(pub u32);

/// The nearest point of the site to a query point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestPoint {
    /// Distance from the query point to the surface, m; negative inside a solid.
    pub distance_m: f64,
    /// The surface point, m.
    pub point_m: Vec3<Enu>,
    /// Outward unit normal there (from the object towards the query point).
    pub normal: Vec3<Enu>,
    /// What it belongs to.
    pub surface: Surface,
    /// Which object.
    pub object: ObjectId,
}

/// A ray's first hit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayHit {
    /// Distance along the ray, m.
    pub distance_m: f64,
    /// Outward unit normal.
    pub normal: Vec3<Enu>,
    /// What it belongs to.
    pub surface: Surface,
    /// Which object.
    pub object: ObjectId,
}

/// A contact or near-contact between a convex part of the aircraft and one object of the site.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Point on the object's surface, m.
    pub point_m: Vec3<Enu>,
    /// Outward unit normal of the object, towards the aircraft.
    pub normal: Vec3<Enu>,
    /// Gap along the normal, m; negative when they overlap.
    pub gap_m: f64,
    /// Velocity of the object at that point, m/s (traffic moves).
    pub velocity_m_s: Vec3<Enu>,
    /// What it belongs to.
    pub surface: Surface,
    /// Which object.
    pub object: ObjectId,
}

/// Convex parts that the aircraft's hull is made of, placed in site coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HullProbe {
    /// A ball.
    Ball {
        /// Centre, m.
        centre_m: Vec3<Enu>,
        /// Radius, m.
        radius_m: f64,
    },
    /// A capsule.
    Capsule {
        /// One end of the axis, m.
        a_m: Vec3<Enu>,
        /// Other end, m.
        b_m: Vec3<Enu>,
        /// Radius, m.
        radius_m: f64,
    },
}

/// The instant of a query: what moves is where it is at this simulation time.
pub type QueryTime = SimTime;

/// Where a camera is and how it looks at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraPose {
    /// Lens position, m.
    pub position_m: Vec3<Enu>,
    /// Unit vector of the optical axis.
    pub forward: Vec3<Enu>,
    /// Unit vector to the image's right.
    pub right: Vec3<Enu>,
    /// The lamp is on (it looks where the camera looks).
    pub lamp_on: bool,
}

impl CameraPose {
    /// The camera of an aircraft in a pose: the attitude gives the heading, the gimbal holds roll level and its pitch over the horizon, rad,
    /// up positive.
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

/// How one defect shows in a picture: every condition on its own, so that a report can name what failed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DefectView {
    /// [`PlacedDefect::id`].
    pub defect_id: u32,
    /// Inside the central 80 % of the image.
    pub in_frame: bool,
    /// Nothing stands between lens and defect.
    pub unoccluded: bool,
    /// Angle between the line of sight and the defect's normal, rad.
    pub incidence_rad: f64,
    /// Longest visible extent, px.
    pub extent_px: f64,
    /// Width across, px (only lines must pass a limit).
    pub width_px: f64,
    /// Light at the defect, lux (sun, sky, water, lamp).
    pub illuminance_lux: f64,
    /// Light needed for an exposure within the camera's limits, lux.
    pub needed_lux: f64,
    /// Distance, m.
    pub distance_m: f64,
    /// A line, whose width must pass a limit.
    pub line: bool,
    /// The lamp was on.
    pub lamp_on: bool,
    /// All conditions hold.
    pub hit: bool,
}

/// The job's site: immutable once built; what moves is a function of time.
#[derive(Debug, Clone)]
pub struct Site {
    geometry: Arc<Geometry>,
    lanes: Vec<Lane>,
    plane: LocalPlane,
    dynamics: Dynamics,
}

impl Site {
    /// Builds geometry, traffic, defects and light from a scenario and the session's seed (which decides defects and traffic).
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

    /// Every bridge member of the site.
    #[must_use]
    pub fn members(&self) -> &[Member] {
        self.geometry.members()
    }

    /// What stands still.
    #[must_use]
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// Lanes and walkways of all bridges.
    #[must_use]
    pub fn lanes(&self) -> &[Lane] {
        &self.lanes
    }

    /// The local plane of the scenario's origin.
    #[must_use]
    pub fn plane(&self) -> &LocalPlane {
        &self.plane
    }

    /// Sun, sky and what they leave in the shade.
    #[must_use]
    pub fn light(&self) -> &light::LightModel {
        &self.dynamics.light
    }

    /// Cars, trucks and people, and where they are when.
    #[must_use]
    pub fn traffic(&self) -> &traffic::TrafficPlan {
        &self.dynamics.traffic
    }

    /// The same site whose traffic was stopped and let go so; what stands still is shared.
    #[must_use]
    pub fn with_closures(&self, closures: BridgeClosures) -> Self {
        let mut other = self.clone();
        other.dynamics.traffic.set_closures(closures);
        other
    }

    /// The defects of this session.
    #[must_use]
    pub fn defects(&self) -> &[PlacedDefect] {
        &self.dynamics.defects
    }

    /// The nearest surface within `max_m` (bridges, terrain, water, traffic, crew, truck; never the pad).
    #[must_use]
    pub fn nearest(&self, position_m: Vec3<Enu>, max_m: f64, at: QueryTime) -> Option<NearestPoint> {
        self.dynamics.nearest(self.geometry.nearest(position_m, max_m), position_m, max_m, at)
    }

    /// Distance to the nearest solid thing within `max_m`, whatever it is (the pad too): what keeps inside a ball of this radius touches
    /// nothing now.
    #[must_use]
    pub fn free_radius(&self, position_m: Vec3<Enu>, max_m: f64, at: QueryTime) -> Option<f64> {
        let still = self.geometry.free_radius(position_m, max_m);
        self.dynamics.traffic.nearest(position_m, still.unwrap_or(max_m), at).map(|n| n.distance_m).or(still)
    }

    /// The first hit of a ray within `max_m`, everything included (the pad and the water too). `direction` is a unit vector.
    #[must_use]
    pub fn ray(&self, origin_m: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64, at: QueryTime) -> Option<RayHit> {
        self.dynamics.ray(self.geometry.ray(origin_m, direction, max_m), origin_m, direction, max_m, at)
    }

    /// Appends every contact or near-contact (gap <= `margin_m`) of a convex probe with the site, the pad included.
    #[allow(clippy::ptr_arg, reason = "it appends")]
    pub fn contacts(&self, probe: &HullProbe, margin_m: f64, at: QueryTime, out: &mut Vec<Contact>) {
        self.geometry.contacts(probe, margin_m, out);
        self.dynamics.traffic.contacts(probe, margin_m, at, out);
    }

    /// Height of ground or pad (not water) under a point, m up.
    #[must_use]
    pub fn ground_up_m(&self, east_m: f64, north_m: f64) -> f64 {
        self.geometry.ground_up_m(east_m, north_m)
    }

    /// Share of the upper hemisphere that is open sky, 0..1 (static geometry only; deterministic rays).
    #[must_use]
    pub fn sky_view(&self, position_m: Vec3<Enu>) -> f64 {
        self.dynamics.light.sky_view(position_m, &self.cast())
    }

    /// Ambient illuminance (sun, sky, water, ground bounce; no lamp), lux, on a surface with this outward normal, or for `None`
    /// the mean over all directions at a point in the air.
    #[must_use]
    pub fn ambient_lux(&self, position_m: Vec3<Enu>, normal: Option<Vec3<Enu>>, at: QueryTime) -> f64 {
        self.dynamics.light.ambient_lux(position_m, normal, at, &self.cast())
    }

    /// How every defect within reach shows in a picture taken from `pose`; only defects within 60 m and in front are listed.
    #[must_use]
    pub fn view_defects(&self, pose: &CameraPose, camera: &Camera, lamp: &Lamp, at: QueryTime) -> Vec<DefectView> {
        self.dynamics.look(pose, camera, lamp, at, &self.cast())
    }

    /// Name of an object for messages, e.g. `arch/rib-left/07 (144)`, `car 12`, `inspector`.
    #[must_use]
    pub fn object_name(&self, object: ObjectId) -> String {
        match object {
            geometry::GROUND => "ground".into(),
            geometry::WATER => "water".into(),
            geometry::PAD => "pad".into(),
            _ => match self.members().get(object.0 as usize) {
                Some(member) => format!("{} ({})", member.name, member.element),
                None => self.dynamics.traffic.name(object).unwrap_or_else(|| format!("object {}", object.0)),
            },
        }
    }

    /// Rays against what stands still.
    fn cast(&self) -> impl Fn(Vec3<Enu>, Vec3<Enu>, f64) -> Option<RayHit> + '_ {
        |origin, direction, max_m| self.geometry.ray(origin, direction, max_m)
    }
}
