//! Bridge geometry: a bridge type turns its numbers into members. A new type is one new file here plus one variant.

pub mod arch;
pub mod suspension;

use crate::base::frames::{Enu, Vec3};

/// One structural member. What collides, what is drawn, what carries defects and what is exported is this solid and nothing else.
#[derive(Debug, Clone, PartialEq)]
pub struct Member {
    /// Unique within the site, e.g. `arch/rib-left/07`.
    pub name: String,
    /// AASHTO MBEI element number.
    pub element: u32,
    /// The member's solid, in site coordinates.
    pub solid: Solid,
}

/// A closed convex polyhedron.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Corners, m.
    pub vertices_m: Vec<Vec3<Enu>>,
    /// Planar faces: corner indices counter-clockwise seen from outside, three or more each.
    pub faces: Vec<Vec<u32>>,
}

/// A lane or walkway along which traffic moves: a polyline on the deck's upper surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Lane {
    /// Which bridge.
    pub bridge: usize,
    /// Points in the direction of travel, m.
    pub points_m: Vec<Vec3<Enu>>,
    /// Vehicles or pedestrians.
    pub walkway: bool,
}
