//! The collision shape of a bridge member: a convex polyhedron or a triangle mesh.

use super::convex::{Convex, SurfacePoint};
use super::mesh_shape::MeshShape;
use super::query_types::HullProbe;
use crate::frames::{Enu, Vec3};
use crate::scenario::bridges::Solid;

/// A collision shape.
#[derive(Debug, Clone)]
pub enum MemberShape {
    /// A convex polyhedron.
    Convex(Convex),
    /// A triangle mesh.
    Mesh(Box<MeshShape>),
}

impl MemberShape {
    /// Creates the shape of a member's solid.
    #[must_use]
    pub fn new(solid: &Solid) -> Self {
        let mesh = solid.surface.as_ref().and_then(|surface| MeshShape::new(solid, surface));
        mesh.map_or_else(|| Self::Convex(Convex::new(solid)), |mesh| Self::Mesh(Box::new(mesh)))
    }

    /// Returns the corners of the axis-aligned bounding box in meters.
    #[must_use]
    pub fn bounds(&self) -> (Vec3<Enu>, Vec3<Enu>) {
        match self {
            Self::Convex(convex) => convex.bounds(),
            Self::Mesh(mesh) => mesh.bounds(),
        }
    }

    /// Returns the nearest surface point; its distance is negative inside.
    #[must_use]
    pub fn nearest(&self, p: Vec3<Enu>) -> SurfacePoint {
        match self {
            Self::Convex(convex) => convex.nearest(p),
            Self::Mesh(mesh) => mesh.nearest(p),
        }
    }

    /// Returns the nearest surface point if it is at most `max_m` away, or if the point is inside.
    #[must_use]
    pub fn nearest_within(&self, p: Vec3<Enu>, max_m: f64) -> Option<SurfacePoint> {
        match self {
            Self::Convex(convex) => Some(convex.nearest(p)).filter(|near| near.distance_m <= max_m),
            Self::Mesh(mesh) => mesh.nearest_within(p, max_m),
        }
    }

    /// Returns the distance along a ray to the surface and the normal there. A ray that starts inside hits at distance 0.
    #[must_use]
    pub fn ray(&self, origin: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64) -> Option<(f64, Vec3<Enu>)> {
        match self {
            Self::Convex(convex) => convex.ray(origin, direction, max_m),
            Self::Mesh(mesh) => mesh.ray(origin, direction, max_m),
        }
    }

    /// Returns the distances along a ray at which it enters and leaves the shape, in order.
    #[must_use]
    pub fn passages(&self, origin: Vec3<Enu>, direction: Vec3<Enu>, length_m: f64) -> Vec<(f64, f64)> {
        match self {
            Self::Convex(convex) => {
                let enter = convex.ray(origin, direction, length_m);
                let leave = enter.and_then(|_| convex.ray(origin + direction * length_m, -direction, length_m));
                enter.zip(leave).map(|((enter_m, _), (leave_m, _))| (enter_m, length_m - leave_m)).into_iter().collect()
            }
            Self::Mesh(mesh) => mesh.passages(origin, direction, length_m),
        }
    }

    /// Calls `offer` with the surface points that a probe touches or almost touches, and the probe's radius. A ball has one contact with a
    /// convex shape. A capsule has contacts at both ends, and also between the ends if it lies across an edge.
    pub fn contacts(&self, probe: &HullProbe, margin_m: f64, mut offer: impl FnMut(SurfacePoint, f64)) {
        match (self, *probe) {
            (Self::Convex(convex), HullProbe::Ball { center_m, radius_m }) => offer(convex.nearest(center_m), radius_m),
            (Self::Convex(convex), HullProbe::Capsule { a_m, b_m, radius_m }) => {
                let ends = [convex.nearest(a_m), convex.nearest(b_m)];
                ends.into_iter().for_each(|near| offer(near, radius_m));
                if let Some(near) = convex.interior_minimum(a_m, b_m, [&ends[0], &ends[1]], radius_m + margin_m) {
                    offer(near, radius_m);
                }
            }
            (Self::Mesh(mesh), HullProbe::Ball { radius_m, .. } | HullProbe::Capsule { radius_m, .. }) => {
                mesh.contacts(probe, margin_m, |near| offer(near, radius_m));
            }
        }
    }
}
