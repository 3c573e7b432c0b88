//! Distance, ray and contact queries on triangle meshes. Parry's mesh finds the triangles and holds the pseudo-normals that tell inside
//! from outside; contacts are the points of the surface at which its distance from a probe is a local minimum, so that the edges between
//! triangles of one face never touch a probe.

use super::convex::SurfacePoint;
use super::nearest_points::{closest_points_of_segments, nearest_on_segment};
use super::query_types::HullProbe;
use crate::frames::{Enu, Vec3};
use crate::scenario::bridges::{Solid, SolidSurface};
use rapier3d::parry::bounding_volume::Aabb;
use rapier3d::parry::math::Vector;
use rapier3d::parry::partitioning::BvhNode;
use rapier3d::parry::query::{PointProjection, PointQueryWithLocation, Ray, RayCast};
use rapier3d::parry::shape::{FeatureId, TriMesh, TriMeshFlags, TrianglePointLocation};
use std::collections::BTreeMap;

/// Tolerance within which two distances count as equal, m (rounding errors at 1 km from the origin).
const DISTANCE_TOLERANCE_M: f64 = 1e-9;
/// Distance within which two contacts of a probe are one, m (below any effect on the forces).
const SAME_POINT_M: f64 = 1e-6;
/// Distance from the surface within which a point gets the triangle's normal, m.
const ON_SURFACE_M: f64 = 1e-9;
/// Share of a segment next to its ends that belongs to the ends.
const END_SHARE: f64 = 1e-9;
/// Tolerance for the cosine of the angle between the normals of triangles in one plane: 0.03 degrees.
const FLAT_TOLERANCE: f64 = 1e-7;
/// Maximum number of contacts of a probe with a mesh (estimate: the solver needs no more points to hold a rigid probe).
const MAX_CONTACTS: usize = 8;

/// A triangle mesh, preprocessed for queries.
#[derive(Debug, Clone)]
pub struct MeshShape {
    mesh: TriMesh,
    is_closed: bool,
    low_m: Vec3<Enu>,
    high_m: Vec3<Enu>,
}

/// A vertex, an edge or the inside of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Feature {
    Face(u32),
    Edge(u32, u32),
    Vertex(u32),
}

/// The point of a triangle that is nearest to a query point.
#[derive(Debug, Clone, Copy)]
struct Near {
    triangle: u32,
    feature: Feature,
    /// Pseudo-normal of the feature, not normalized.
    outward: Vec3<Enu>,
    point_m: Vec3<Enu>,
    distance_m: f64,
}

/// Triangles around a probe, and those at each of their edges and vertices.
#[derive(Debug, Default)]
struct Vicinity {
    triangles: Vec<u32>,
    at_edge: BTreeMap<(u32, u32), Vec<u32>>,
    at_vertex: BTreeMap<u32, Vec<u32>>,
}

fn vector(v: Vec3<Enu>) -> Vector {
    Vector::new(v.east(), v.north(), v.up())
}

fn enu(v: Vector) -> Vec3<Enu> {
    Vec3::new(v.x, v.y, v.z)
}

impl MeshShape {
    /// Creates the mesh of a solid with a surface of triangles; `None` if there are no triangles.
    #[must_use]
    pub fn new(solid: &Solid, surface: &SolidSurface) -> Option<Self> {
        let vertices = solid.vertices_m.iter().copied().map(vector).collect();
        let flags = if surface.is_closed {
            TriMeshFlags::ORIENTED | TriMeshFlags::FIX_INTERNAL_EDGES
        } else {
            TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED
        };
        let mesh = TriMesh::with_flags(vertices, surface.triangles.clone(), flags).ok()?;
        let bounds = mesh.local_aabb();
        Some(Self { is_closed: surface.is_closed, low_m: enu(bounds.mins), high_m: enu(bounds.maxs), mesh })
    }

    /// Returns the corners of the axis-aligned bounding box in meters.
    #[must_use]
    pub const fn bounds(&self) -> (Vec3<Enu>, Vec3<Enu>) {
        (self.low_m, self.high_m)
    }

    /// Returns the nearest surface point. The distance is negative inside a closed mesh, and never negative from an open one, which has
    /// the same normal as the direction to the point.
    #[must_use]
    pub fn nearest(&self, p: Vec3<Enu>) -> SurfacePoint {
        let (projection, (triangle, _)) = self.mesh.project_local_point_and_get_location(vector(p), false);
        self.projected(p, projection, triangle)
    }

    /// Returns the nearest surface point if it is at most `max_m` away; otherwise like [`Self::nearest`].
    #[must_use]
    pub fn nearest_within(&self, p: Vec3<Enu>, max_m: f64) -> Option<SurfacePoint> {
        // However far its surface is, a point inside is within the limit.
        let may_be_inside = self.is_closed && self.is_in_bounds(p);
        let reach_m = if may_be_inside { f64::MAX } else { max_m.next_up() };
        let found = self.mesh.project_local_point_and_get_location_with_max_dist(vector(p), false, reach_m);
        let (projection, (triangle, _)) = found?;
        Some(self.projected(p, projection, triangle)).filter(|near| near.distance_m <= max_m)
    }

    fn projected(&self, p: Vec3<Enu>, projection: PointProjection, triangle: u32) -> SurfacePoint {
        let point_m = enu(projection.point);
        let away = p - point_m;
        let distance_m = away.norm();
        let is_inside = self.is_closed && projection.is_inside && distance_m > 0.0;
        let normal = if distance_m <= ON_SURFACE_M {
            self.face_normal(triangle)
        } else if is_inside {
            -away / distance_m
        } else {
            away / distance_m
        };
        SurfacePoint { distance_m: if is_inside { -distance_m } else { distance_m }, point_m, normal }
    }

    fn face_normal(&self, triangle: u32) -> Vec3<Enu> {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a).unit()
    }

    fn corners(&self, triangle: u32) -> [Vec3<Enu>; 3] {
        self.mesh.indices()[triangle as usize].map(|k| enu(self.mesh.vertices()[k as usize]))
    }

    /// Returns the distance along a ray to the surface and the normal there. A ray that starts inside a closed mesh hits at distance 0.
    #[must_use]
    pub fn ray(&self, origin: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64) -> Option<(f64, Vec3<Enu>)> {
        // A ray that leaves the mesh first starts inside it, however far the surface is.
        let reach_m = if self.is_closed && self.is_in_bounds(origin) { f64::MAX } else { max_m.next_up() };
        let ray = Ray::new(vector(origin), vector(direction));
        let hit = self.mesh.cast_local_ray_and_get_normal(&ray, reach_m, false)?;
        if self.is_closed && hit.feature == FeatureId::Face(1) {
            return Some((0.0, -direction));
        }
        (hit.time_of_impact <= max_m).then(|| (hit.time_of_impact, enu(hit.normal)))
    }

    fn is_in_bounds(&self, p: Vec3<Enu>) -> bool {
        (0..3).all(|k| (self.low_m.array()[k]..=self.high_m.array()[k]).contains(&p.array()[k]))
    }

    /// Returns the distances along a ray at which it enters and leaves a closed mesh, in order; none for an open mesh, which has no inside.
    #[must_use]
    pub fn passages(&self, origin: Vec3<Enu>, direction: Vec3<Enu>, length_m: f64) -> Vec<(f64, f64)> {
        if !self.is_closed {
            return Vec::new();
        }
        let ray = Ray::new(vector(origin), vector(direction));
        let is_crossed = |node: &BvhNode| node.cast_ray(&ray, length_m) <= length_m;
        let crossing = |triangle: u32| {
            let hit = self.mesh.triangle(triangle).cast_local_ray_and_get_normal(&ray, length_m, false)?;
            Some((hit.time_of_impact, hit.feature == FeatureId::Face(1)))
        };
        let mut crossings: Vec<(f64, bool)> = self.mesh.bvh().leaves(is_crossed).filter_map(crossing).collect();
        crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
        // A ray through the edge between two triangles crosses both; one that touches an edge enters and leaves at one place.
        let is_same_place = |a: &(f64, bool), b: &(f64, bool)| b.0 - a.0 <= DISTANCE_TOLERANCE_M;
        let places = crossings.chunk_by(is_same_place).filter(|place| place.iter().all(|(_, leaves)| *leaves == place[0].1));
        let crossings: Vec<(f64, bool)> = places.map(|place| place[0]).collect();
        let mut passages = Vec::new();
        let mut entered = crossings.first().filter(|(_, leaves)| *leaves).map(|_| 0.0);
        for (at_m, leaves) in crossings {
            match entered {
                Some(enter_m) if leaves => {
                    passages.push((enter_m, at_m));
                    entered = None;
                }
                None if !leaves => entered = Some(at_m),
                _ => {}
            }
        }
        passages.extend(entered.map(|enter_m| (enter_m, length_m)));
        passages
    }

    /// Calls `offer` with the surface points that a probe touches or almost touches, within `margin_m` of its surface.
    pub fn contacts(&self, probe: &HullProbe, margin_m: f64, mut offer: impl FnMut(SurfacePoint)) {
        let (a_m, b_m, radius_m) = match *probe {
            HullProbe::Ball { center_m, radius_m } => (center_m, center_m, radius_m),
            HullProbe::Capsule { a_m, b_m, radius_m } => (a_m, b_m, radius_m),
        };
        let reach_m = radius_m + margin_m;
        let vicinity = self.vicinity((a_m, b_m), reach_m);
        let mut found = self.touched_by_point(a_m, &vicinity, reach_m);
        if a_m != b_m {
            found.extend(self.touched_by_point(b_m, &vicinity, reach_m));
            found.extend(self.touched_between((a_m, b_m), &vicinity, reach_m));
            let are_outside = found.iter().all(|near| near.distance_m >= 0.0);
            found.extend(are_outside.then(|| self.pierced((a_m, b_m), &vicinity)).flatten());
        }
        found.retain(|near| near.distance_m <= reach_m);
        let mut order: Vec<usize> = (0..found.len()).collect();
        order.sort_by(|k, other| found[*k].distance_m.total_cmp(&found[*other].distance_m));
        let mut kept: Vec<usize> = Vec::new();
        for k in order {
            if kept.len() < MAX_CONTACTS && !kept.iter().any(|other| is_same(&found[*other], &found[k])) {
                kept.push(k);
            }
        }
        // The solver recognizes a contact by its place in the order, which must not change with the distances.
        kept.sort_unstable();
        kept.into_iter().for_each(|k| offer(found[k]));
    }

    fn vicinity(&self, (a, b): (Vec3<Enu>, Vec3<Enu>), reach_m: f64) -> Vicinity {
        let reach = Vector::new(reach_m, reach_m, reach_m);
        let around = Aabb::new(vector(a).min(vector(b)) - reach, vector(a).max(vector(b)) + reach);
        let mut vicinity = Vicinity { triangles: self.mesh.bvh().intersect_aabb(&around).collect(), ..Vicinity::default() };
        vicinity.triangles.sort_unstable();
        for triangle in &vicinity.triangles {
            let [a, b, c] = self.mesh.indices()[*triangle as usize];
            for (from, to) in [(a, b), (b, c), (c, a)] {
                vicinity.at_edge.entry((from.min(to), from.max(to))).or_default().push(*triangle);
                vicinity.at_vertex.entry(from).or_default().push(*triangle);
            }
        }
        vicinity
    }

    /// Returns the surface points at which the distance from a point is a local minimum; only the nearest one for a point inside.
    fn touched_by_point(&self, p: Vec3<Enu>, vicinity: &Vicinity, reach_m: f64) -> Vec<SurfacePoint> {
        if self.is_closed && self.is_in_bounds(p) {
            let near = self.nearest(p);
            if near.distance_m <= 0.0 {
                return vec![near];
            }
        }
        let nearest: Vec<Near> = vicinity.triangles.iter().map(|triangle| self.nearest_on(*triangle, p)).collect();
        let within_reach = nearest.iter().filter(|near| near.distance_m <= reach_m);
        let is_minimum = |near: &&Near| self.is_local_minimum(near, vicinity, |other| self.nearest_on(other, p).distance_m);
        let faces_point = |near: &&Near| !self.is_closed || (p - near.point_m).dot(near.outward) > 0.0;
        within_reach.filter(faces_point).filter(is_minimum).map(|near| self.surface_point(near, p)).collect()
    }

    /// Returns whether no triangle at the same edge or vertex is nearer.
    fn is_local_minimum(&self, near: &Near, vicinity: &Vicinity, distance_m: impl Fn(u32) -> f64) -> bool {
        let around = match near.feature {
            Feature::Face(_) => None,
            Feature::Edge(from, to) => vicinity.at_edge.get(&(from, to)),
            Feature::Vertex(vertex) => vicinity.at_vertex.get(&vertex),
        };
        let is_nearer = |other: &u32| *other != near.triangle && distance_m(*other) < near.distance_m - DISTANCE_TOLERANCE_M;
        !around.is_some_and(|around| around.iter().any(is_nearer))
    }

    fn surface_point(&self, near: &Near, p: Vec3<Enu>) -> SurfacePoint {
        let Near { point_m, distance_m, .. } = *near;
        let normal = if distance_m > ON_SURFACE_M { (p - point_m) / distance_m } else { self.face_normal(near.triangle) };
        SurfacePoint { distance_m, point_m, normal }
    }

    fn nearest_on(&self, triangle: u32, p: Vec3<Enu>) -> Near {
        let (projection, location) = self.mesh.triangle(triangle).project_local_point_and_get_location(vector(p), false);
        let corners = self.mesh.indices()[triangle as usize];
        let (feature, outward) = match location {
            TrianglePointLocation::OnVertex(k) => {
                let vertex = corners[k as usize];
                (Feature::Vertex(vertex), self.vertex_normal(vertex))
            }
            TrianglePointLocation::OnEdge(k, _) => {
                let (from, to) = (corners[k as usize], corners[(k as usize + 1) % 3]);
                (Feature::Edge(from.min(to), from.max(to)), self.edge_normal(triangle, k as usize))
            }
            TrianglePointLocation::OnFace(..) | TrianglePointLocation::OnSolid => {
                (Feature::Face(triangle), self.face_normal(triangle))
            }
        };
        let point_m = enu(projection.point);
        Near { triangle, feature, outward, point_m, distance_m: (p - point_m).norm() }
    }

    fn vertex_normal(&self, vertex: u32) -> Vec3<Enu> {
        self.mesh.pseudo_normals().map_or(Vec3::zero(), |normals| enu(normals.vertices_pseudo_normal[vertex as usize]))
    }

    fn edge_normal(&self, triangle: u32, side: usize) -> Vec3<Enu> {
        self.mesh.pseudo_normals().map_or(Vec3::zero(), |normals| enu(normals.edges_pseudo_normal[triangle as usize][side]))
    }

    /// Returns the surface points at edges and vertices that are nearest to the inner part of a segment.
    fn touched_between(&self, (a, b): (Vec3<Enu>, Vec3<Enu>), vicinity: &Vicinity, reach_m: f64) -> Vec<SurfacePoint> {
        let along = b - a;
        let is_inner = |p: Vec3<Enu>| {
            let share = (p - a).dot(along) / along.norm_squared();
            (END_SHARE..=1.0 - END_SHARE).contains(&share)
        };
        let vertex = |k: u32| enu(self.mesh.vertices()[k as usize]);
        let mut found = Vec::new();
        let mut consider = |p: Vec3<Enu>, point_m: Vec3<Enu>, outward: Vec3<Enu>, around: &[u32]| {
            let away = p - point_m;
            let distance_m = away.norm();
            let is_candidate = is_inner(p) && distance_m <= reach_m && distance_m > ON_SURFACE_M;
            let faces_segment = !self.is_closed || away.dot(outward) > 0.0;
            let is_nearer = |other: &u32| self.nearest_on(*other, p).distance_m < distance_m - DISTANCE_TOLERANCE_M;
            if is_candidate && faces_segment && !around.iter().any(is_nearer) && !self.is_flat(around) {
                found.push(SurfacePoint { distance_m, point_m, normal: away / distance_m });
            }
        };
        for ((from, to), around) in &vicinity.at_edge {
            let (start, end) = (vertex(*from), vertex(*to));
            let (p, point_m) = closest_points_of_segments((a, b), (start, end));
            let share = (point_m - start).dot(end - start) / (end - start).norm_squared();
            if (END_SHARE..=1.0 - END_SHARE).contains(&share) {
                let indices = self.mesh.indices()[around[0] as usize];
                let side = (0..3).find(|k| indices[*k] != *from && indices[*k] != *to).map_or(0, |opposite| (opposite + 1) % 3);
                consider(p, point_m, self.edge_normal(around[0], side), around);
            }
        }
        for (k, around) in &vicinity.at_vertex {
            let point_m = vertex(*k);
            consider(nearest_on_segment(point_m, a, b), point_m, self.vertex_normal(*k), around);
        }
        found
    }

    /// Returns whether several triangles at an edge or vertex form a single plane, on which only the ends of a segment can rest.
    fn is_flat(&self, around: &[u32]) -> bool {
        let normals: Vec<Vec3<Enu>> = around.iter().map(|triangle| self.face_normal(*triangle)).collect();
        let is_same = |normal: &Vec3<Enu>| normal.dot(normals[0]).abs() > 1.0 - FLAT_TOLERANCE;
        normals.len() > 1 && normals.iter().all(is_same)
    }

    /// Returns how a segment with both ends outside is freed if it runs through the surface: from the middle of its part inside a closed
    /// mesh, or, through an open surface, the way back for its shorter part.
    fn pierced(&self, (a, b): (Vec3<Enu>, Vec3<Enu>), vicinity: &Vicinity) -> Option<SurfacePoint> {
        if vicinity.triangles.is_empty() {
            return None;
        }
        let (length_m, direction) = ((b - a).norm(), (b - a).unit());
        if let Some((enter_m, leave_m)) = self.passages(a, direction, length_m).first().copied() {
            return Some(self.nearest(a + direction * (0.5 * (enter_m + leave_m)))).filter(|near| near.distance_m < 0.0);
        }
        let (at_m, normal) = (!self.is_closed).then(|| self.ray(a, direction, length_m)).flatten()?;
        // The normal is on the side of the ray's origin.
        let is_start_short = at_m < 0.5 * length_m;
        let (short_m, normal) = if is_start_short { (at_m, -normal) } else { (length_m - at_m, normal) };
        let depth_m = short_m * direction.dot(normal).abs();
        Some(SurfacePoint { distance_m: -depth_m, point_m: a + direction * at_m, normal })
    }
}

/// Returns whether two contacts push the same point in the same direction.
fn is_same(one: &SurfacePoint, other: &SurfacePoint) -> bool {
    (one.point_m - other.point_m).norm() <= SAME_POINT_M && one.normal.dot(other.normal) > 0.0
}
