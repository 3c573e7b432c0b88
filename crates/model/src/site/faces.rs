//! Faces of bridge members, used to place defects.

use crate::frames::{Enu, Vec3};
use crate::math;
use crate::scenario::bridges::Solid;

/// A planar face of a member, with a point on it.
#[derive(Debug, Clone)]
pub(super) struct MemberFace {
    /// Point on the face, m.
    pub(super) point_m: Vec3<Enu>,
    /// Outward unit normal.
    pub(super) normal: Vec3<Enu>,
    corners_m: Vec<Vec3<Enu>>,
}

/// Returns the face of a solid that contains a point, with the point projected onto its plane; `None` if there is none.
pub(super) fn face_at(solid: &Solid, point_m: Vec3<Enu>) -> Option<MemberFace> {
    /// Maximum distance from a face at which a point counts as on the face, m.
    const FACE_TOLERANCE_M: f64 = 0.002;
    let mut best: Option<(f64, MemberFace)> = None;
    // A surface can have a million faces, of which few are near the point.
    let may_contain = |indices: &&Vec<u32>| solid.is_convex() || is_in_bounds(solid, indices, point_m, FACE_TOLERANCE_M);
    for indices in solid.faces.iter().filter(may_contain) {
        let corners_m: Vec<Vec3<Enu>> = indices.iter().filter_map(|k| solid.vertices_m.get(*k as usize).copied()).collect();
        let normal = polygon_normal(&corners_m);
        let Some(corner) = corners_m.first() else { continue };
        let off = (point_m - *corner).dot(normal);
        let face = MemberFace { point_m: point_m - normal * off, normal, corners_m };
        let apart = off.abs().max(-face.edge_distance_m(face.point_m));
        if apart < best.as_ref().map_or(FACE_TOLERANCE_M, |b| b.0) {
            best = Some((apart, face));
        }
    }
    best.map(|b| b.1)
}

/// Returns whether a point is in the bounding box of a face, or near it.
fn is_in_bounds(solid: &Solid, face: &[u32], point_m: Vec3<Enu>, margin_m: f64) -> bool {
    let corners = || face.iter().filter_map(|k| solid.vertices_m.get(*k as usize));
    (0..3).all(|axis| {
        let value = point_m.array()[axis];
        corners().any(|corner| corner.array()[axis] <= value + margin_m)
            && corners().any(|corner| corner.array()[axis] >= value - margin_m)
    })
}

/// Returns all faces of a solid, each with the mean of its corners as its point.
pub(super) fn faces(solid: &Solid) -> impl Iterator<Item = MemberFace> + '_ {
    solid.faces.iter().map(|indices| {
        let corners_m: Vec<Vec3<Enu>> = indices.iter().filter_map(|k| solid.vertices_m.get(*k as usize).copied()).collect();
        let sum = corners_m.iter().fold(Vec3::zero(), |sum, corner| sum + *corner);
        MemberFace { point_m: sum / corners_m.len().max(1) as f64, normal: polygon_normal(&corners_m), corners_m }
    })
}

/// Returns the unit normal of a planar polygon by Newell's method, which is robust against collinear corners.
fn polygon_normal(corners_m: &[Vec3<Enu>]) -> Vec3<Enu> {
    let count = corners_m.len();
    (0..count).fold(Vec3::zero(), |sum, k| sum + corners_m[k].cross(corners_m[(k + 1) % count])).unit()
}

impl MemberFace {
    /// Returns the distance, in meters, from a point in the face's plane to the nearest edge; negative outside the
    /// face.
    pub(super) fn edge_distance_m(&self, point_m: Vec3<Enu>) -> f64 {
        let count = self.corners_m.len();
        (0..count)
            .map(|k| {
                let (a, b) = (self.corners_m[k], self.corners_m[(k + 1) % count]);
                self.normal.cross(b - a).unit().dot(point_m - a)
            })
            .fold(f64::INFINITY, f64::min)
    }

    /// Returns the same face with another point on it.
    pub(super) fn at(&self, point_m: Vec3<Enu>) -> Self {
        Self { point_m, ..self.clone() }
    }

    /// Returns the smallest and the largest coordinate of the corners in a direction, m.
    pub(super) fn extent_m(&self, direction: Vec3<Enu>) -> (f64, f64) {
        math::range(self.corners_m.iter().map(|corner| corner.dot(direction)))
    }

    /// Returns the distance from a point in the face's plane to its boundary in a direction, m; `None` if the point is outside. The face
    /// is convex.
    pub(super) fn boundary_m(&self, point_m: Vec3<Enu>, direction: Vec3<Enu>) -> Option<f64> {
        let count = self.corners_m.len();
        let mut least = f64::INFINITY;
        for k in 0..count {
            let (a, b) = (self.corners_m[k], self.corners_m[(k + 1) % count]);
            let inward = self.normal.cross(b - a).unit();
            let (height_m, approach) = (inward.dot(point_m - a), -inward.dot(direction));
            if height_m < 0.0 {
                return None;
            }
            if approach > 1e-9 {
                least = least.min(height_m / approach);
            }
        }
        Some(least)
    }

    /// Returns the direction of the face's longest edge.
    pub(super) fn long_axis(&self) -> Vec3<Enu> {
        let count = self.corners_m.len();
        let edges = (0..count).map(|k| self.corners_m[(k + 1) % count] - self.corners_m[k]);
        edges.fold(Vec3::zero(), |best, e| if e.norm() > best.norm() { e } else { best }).unit()
    }
}
