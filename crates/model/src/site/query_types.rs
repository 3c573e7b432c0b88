//! Result types of the site's queries: surfaces, nearest points, ray hits and contacts.

use crate::frames::{Enu, Vec3};
use crate::time::SimTime;

/// Surface type for contacts, clearance and the `contact` code in telemetry (docs/src/reference/wire.md, "Scoring
/// data": 0 none, 1 bridge, 2 terrain, 3 water, 4 vehicle, 5 person, 6 other).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Surface {
    /// A bridge member.
    Bridge,
    /// The ground.
    Terrain,
    /// The water.
    Water,
    /// A car or truck in traffic, the crew's truck, or another drone.
    Vehicle,
    /// A pedestrian or the inspector.
    Person,
    /// Any other object.
    Other,
    /// The landing pad. It is solid, but contact with it is not a crash, and the clearance ignores it.
    Pad,
}

/// Identifies an object in messages: the index into [`Site::members`](super::Site::members) for bridges, otherwise a unique
/// number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ObjectId(pub u32);

/// The site's nearest point to a query point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestPoint {
    /// Distance from the query point to the surface, m; negative inside a solid.
    pub distance_m: f64,
    /// Nearest point on the surface, m.
    pub point_m: Vec3<Enu>,
    /// Outward unit normal of the surface at that point.
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

/// A contact or near-contact between a convex part of the aircraft and one object on the site.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Point on the object's surface, m.
    pub point_m: Vec3<Enu>,
    /// Outward unit normal of the object, toward the aircraft.
    pub normal: Vec3<Enu>,
    /// Gap along the normal, m; negative if the two bodies overlap.
    pub gap_m: f64,
    /// Velocity of the object at that point, m/s; nonzero for traffic.
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
        center_m: Vec3<Enu>,
        /// Radius, m.
        radius_m: f64,
    },
    /// A capsule around a segment.
    Capsule {
        /// One end of the axis, m.
        a_m: Vec3<Enu>,
        /// Other end of the axis, m.
        b_m: Vec3<Enu>,
        /// Radius, m.
        radius_m: f64,
    },
}

/// Simulation time of a query, which determines the position of moving objects.
pub type QueryTime = SimTime;
