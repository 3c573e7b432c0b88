//! Extents of members in the axes of a run.

use crate::frames::{Enu, Vec3};
use crate::math;
use crate::scenario::bridges::Solid;

/// Horizontal axes: along and across a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    pub(super) along: Vec3<Enu>,
    pub(super) across: Vec3<Enu>,
}

/// Smallest and largest coordinates, m: along, across, up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extent {
    pub(super) along_m: (f64, f64),
    pub(super) across_m: (f64, f64),
    pub(super) up_m: (f64, f64),
}

impl Frame {
    /// Creates the frame whose first axis is the horizontal part of a direction; east if it has none.
    pub(super) fn along(direction: Vec3<Enu>) -> Self {
        let level = Vec3::new(direction.east(), direction.north(), 0.0);
        let along = if level.norm() > 1e-6 { level.unit() } else { Vec3::new(1.0, 0.0, 0.0) };
        Self { along, across: Vec3::new(-along.north(), along.east(), 0.0) }
    }

    /// Returns the extent of a solid.
    pub(super) fn extent(&self, solid: &Solid) -> Extent {
        let range = |direction: Vec3<Enu>| math::range(solid.vertices_m.iter().map(|vertex| vertex.dot(direction)));
        Extent { along_m: range(self.along), across_m: range(self.across), up_m: range(Vec3::new(0.0, 0.0, 1.0)) }
    }
}

impl Extent {
    /// Returns the smallest extent that contains both.
    pub(super) fn with(&self, other: &Self) -> Self {
        let wider = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
        Self {
            along_m: wider(self.along_m, other.along_m),
            across_m: wider(self.across_m, other.across_m),
            up_m: wider(self.up_m, other.up_m),
        }
    }

    /// Returns whether the two are at most `gap_m` apart.
    pub(super) fn touches(&self, other: &Self, gap_m: f64) -> bool {
        gap(self.along_m, other.along_m) <= gap_m
            && gap(self.across_m, other.across_m) <= gap_m
            && gap(self.up_m, other.up_m) <= gap_m
    }

    /// Returns the horizontal distance from a point with these coordinates, m.
    pub(super) fn level_distance_m(&self, along_m: f64, across_m: f64) -> f64 {
        math::hypot(gap(self.along_m, (along_m, along_m)), gap(self.across_m, (across_m, across_m)))
    }
}

/// Returns the distance between two intervals; 0 if they overlap.
fn gap(a: (f64, f64), b: (f64, f64)) -> f64 {
    (a.0 - b.1).max(b.0 - a.1).max(0.0)
}

/// Returns the length of the overlap of two intervals; negative if they are apart.
pub(super) fn overlap_m(a: (f64, f64), b: (f64, f64)) -> f64 {
    a.1.min(b.1) - a.0.max(b.0)
}
