//! Distance and ray queries on convex polyhedra. The signed distance to a convex polyhedron is a convex function, so a
//! one-dimensional search finds the nearest point on a capsule's axis.

use crate::frames::{Enu, Vec3};
use crate::scenario::bridges::Solid;

/// Maximum number of iterations in the search along a capsule's axis. The search stops earlier if the result cannot
/// improve noticeably (see [`DISTANCE_TOLERANCE_M`]).
const MAX_SEARCH_ITERATIONS: usize = 40;
/// Tolerance within which two distances count as equal, m. Identifies segments that lie flat on a face.
const DISTANCE_TOLERANCE_M: f64 = 1e-7;
/// Maximum distance from the surface at which a point gets the face's normal, m.
const CONTACT_TOLERANCE_M: f64 = 1e-9;
/// Tolerance for the cosine of the angle between the normals of a box's perpendicular faces.
const PERPENDICULAR_TOLERANCE: f64 = 1e-12;

/// A convex polyhedron, preprocessed for queries.
#[derive(Debug, Clone, PartialEq)]
pub struct Convex {
    shape: ConvexShape,
    low_m: Vec3<Enu>,
    high_m: Vec3<Enu>,
}

/// A surface point and its distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// Signed distance from the query point, m; negative inside the solid.
    pub distance_m: f64,
    /// The surface point, m.
    pub point_m: Vec3<Enu>,
    /// Outward unit normal of the surface.
    pub normal: Vec3<Enu>,
}

#[derive(Debug, Clone, PartialEq)]
enum ConvexShape {
    /// A box. Equivalent to a hull with six faces, but evaluates pairs of opposite faces together.
    Box {
        center: Vec3<Enu>,
        axes: [Vec3<Enu>; 3],
        half: [f64; 3],
    },
    Hull(Vec<HullFace>),
}

/// A face of a hull: its plane and its edges, counterclockwise seen from outside.
#[derive(Debug, Clone, PartialEq)]
struct HullFace {
    normal: Vec3<Enu>,
    offset: f64,
    edges: Vec<HullEdge>,
}

#[derive(Debug, Clone, PartialEq)]
struct HullEdge {
    start: Vec3<Enu>,
    along: Vec3<Enu>,
    /// Direction in the face's plane, perpendicular to the edge and pointing outward; not normalized.
    outward: Vec3<Enu>,
    inverse_length_squared: f64,
}

impl Convex {
    /// Creates the polyhedron from a member's solid.
    #[must_use]
    pub fn new(solid: &Solid) -> Self {
        let corners = |face: &Vec<u32>| face.iter().map(|k| solid.vertices_m[*k as usize]).collect::<Vec<_>>();
        let faces: Vec<HullFace> = solid.faces.iter().map(|face| HullFace::new(&corners(face))).collect();
        let fold = |pick: fn(f64, f64) -> f64, start: f64| {
            let a = solid.vertices_m.iter().fold([start; 3], |a, v| {
                let v = v.array();
                [pick(a[0], v[0]), pick(a[1], v[1]), pick(a[2], v[2])]
            });
            Vec3::new(a[0], a[1], a[2])
        };
        let (low_m, high_m) = (fold(f64::min, f64::INFINITY), fold(f64::max, f64::NEG_INFINITY));
        let shape = as_box(&faces).unwrap_or(ConvexShape::Hull(faces));
        Self { shape, low_m, high_m }
    }

    /// Returns the corners of the axis-aligned bounding box in meters.
    #[must_use]
    pub fn bounds(&self) -> (Vec3<Enu>, Vec3<Enu>) {
        (self.low_m, self.high_m)
    }

    /// Returns the nearest surface point.
    #[must_use]
    pub fn nearest(&self, p: Vec3<Enu>) -> SurfacePoint {
        match &self.shape {
            ConvexShape::Box { center, axes, half } => nearest_on_box(p, *center, axes, half),
            ConvexShape::Hull(faces) => nearest_on_hull(p, faces),
        }
    }

    /// Returns the distance along a ray to the surface and the normal there. A ray that starts inside hits at distance 0.
    #[must_use]
    pub fn ray(&self, origin: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64) -> Option<(f64, Vec3<Enu>)> {
        let mut clip = RayInterval { enter: f64::NEG_INFINITY, leave: max_m, normal: -direction };
        match &self.shape {
            ConvexShape::Box { center, axes, half } => {
                for k in 0..3 {
                    let (at, rate) = (axes[k].dot(origin - *center), axes[k].dot(direction));
                    clip.clip_by_plane(at - half[k], rate, || axes[k]);
                    clip.clip_by_plane(-at - half[k], -rate, || -axes[k]);
                }
            }
            ConvexShape::Hull(faces) => {
                for face in faces {
                    clip.clip_by_plane(face.normal.dot(origin) - face.offset, face.normal.dot(direction), || face.normal);
                    if clip.enter > clip.leave {
                        return None;
                    }
                }
            }
        }
        if clip.enter > clip.leave || clip.leave < 0.0 {
            return None;
        }
        Some(if clip.enter > 0.0 { (clip.enter, clip.normal) } else { (0.0, -direction) })
    }

    /// Returns the minimum of the signed distance along a segment, if it is smaller than at both ends, as for a segment across an
    /// edge. `ends` contains the surface points nearest to the ends. For a segment that lies flat on a face and extends beyond an
    /// edge, returns the point at that edge.
    #[must_use]
    pub fn interior_minimum(&self, a: Vec3<Enu>, b: Vec3<Enu>, ends: [&SurfacePoint; 2], enough_m: f64) -> Option<SurfacePoint> {
        let along = b - a;
        let length = along.norm();
        let (at_a, at_b) = (ends[0].distance_m, ends[1].distance_m);
        // Over one meter, the distance to a surface changes by at most one meter.
        if 0.5 * (at_a + at_b - length) > enough_m || length < CONTACT_TOLERANCE_M {
            return None;
        }
        let lowest = self.find_minimum(a, along, ends);
        if lowest.1.distance_m < at_a.min(at_b) - DISTANCE_TOLERANCE_M {
            return Some(lowest.1);
        }
        // If one end lies flat on a face, bisection finds the end of the flat part.
        let (from, to) = if at_a <= at_b { (a, b) } else { (b, a) };
        let least = at_a.min(at_b);
        if (at_a - at_b).abs() <= DISTANCE_TOLERANCE_M {
            return None;
        }
        let (mut flat, mut rising) = (0.0, 1.0);
        for _ in 0..MAX_SEARCH_ITERATIONS / 2 {
            let middle = 0.5 * (flat + rising);
            if self.nearest(from.lerp(to, middle)).distance_m <= least + DISTANCE_TOLERANCE_M {
                flat = middle
            } else {
                rising = middle
            }
        }
        (flat > 0.02).then(|| self.nearest(from.lerp(to, flat)))
    }

    /// Finds the point along a segment with the smallest distance. The tangents at two points bracket the minimum of a convex
    /// function, and their intersection is a lower bound.
    fn find_minimum(&self, a: Vec3<Enu>, along: Vec3<Enu>, ends: [&SurfacePoint; 2]) -> (f64, SurfacePoint) {
        let slope = |near: &SurfacePoint| near.normal.dot(along);
        let (mut left, mut right) = ((0.0, *ends[0]), (1.0, *ends[1]));
        let mut best = if ends[0].distance_m <= ends[1].distance_m { left } else { right };
        for round in 0..MAX_SEARCH_ITERATIONS {
            let (rise_left, rise_right) = (slope(&left.1), slope(&right.1));
            if rise_left >= 0.0 {
                return if left.1.distance_m <= best.1.distance_m { left } else { best };
            }
            if rise_right <= 0.0 {
                return if right.1.distance_m <= best.1.distance_m { right } else { best };
            }
            let width = right.0 - left.0;
            let step = (right.1.distance_m - left.1.distance_m - rise_right * width) / (rise_left - rise_right);
            let floor = left.1.distance_m + rise_left * step;
            if best.1.distance_m - floor < 0.1 * DISTANCE_TOLERANCE_M {
                break;
            }
            // Near a rounded minimum, tangents converge slowly from one side. A bisection in every third round keeps the bracket
            // shrinking.
            let t = left.0 + if round % 3 == 2 { 0.5 * width } else { step.clamp(0.0, width) };
            let near = self.nearest(a + along * t);
            if near.distance_m < best.1.distance_m {
                best = (t, near);
            }
            if slope(&near) < 0.0 { left = (t, near) } else { right = (t, near) }
        }
        best
    }
}

/// Part of a ray that is behind all planes tested so far.
struct RayInterval {
    enter: f64,
    leave: f64,
    normal: Vec3<Enu>,
}

impl RayInterval {
    /// Clips the interval by a plane, given the height of the ray's origin above it and the ray's rate of climb.
    fn clip_by_plane(&mut self, height: f64, rate: f64, normal: impl Fn() -> Vec3<Enu>) {
        if rate == 0.0 {
            if height > 0.0 {
                self.leave = f64::NEG_INFINITY;
            }
            return;
        }
        let t = -height / rate;
        if rate > 0.0 {
            self.leave = self.leave.min(t);
        } else if t > self.enter {
            (self.enter, self.normal) = (t, normal());
        }
    }
}

fn nearest_on_box(p: Vec3<Enu>, center: Vec3<Enu>, axes: &[Vec3<Enu>; 3], half: &[f64; 3]) -> SurfacePoint {
    let d = p - center;
    let at = [axes[0].dot(d), axes[1].dot(d), axes[2].dot(d)];
    let over = [at[0].abs() - half[0], at[1].abs() - half[1], at[2].abs() - half[2]];
    let highest = if over[0] >= over[1] && over[0] >= over[2] { 0 } else { 1 + usize::from(over[2] > over[1]) };
    let before = over.iter().filter(|o| **o > 0.0).count();
    if before <= 1 {
        // Inside the box, or in front of a single face: that face determines the nearest point.
        let normal = axes[highest] * 1f64.copysign(at[highest]);
        return SurfacePoint { distance_m: over[highest], point_m: p - normal * over[highest], normal };
    }
    let mut away = Vec3::zero();
    for k in 0..3 {
        if over[k] > 0.0 {
            away += axes[k] * over[k].copysign(at[k]);
        }
    }
    let distance_m = away.norm();
    let normal = if distance_m > CONTACT_TOLERANCE_M { away / distance_m } else { axes[highest] * 1f64.copysign(at[highest]) };
    SurfacePoint { distance_m, point_m: p - away, normal }
}

fn nearest_on_hull(p: Vec3<Enu>, faces: &[HullFace]) -> SurfacePoint {
    let mut highest = (f64::NEG_INFINITY, 0);
    let mut best = (f64::INFINITY, Vec3::zero());
    for (k, face) in faces.iter().enumerate() {
        let height = face.normal.dot(p) - face.offset;
        if height > highest.0 {
            highest = (height, k);
        }
        // Only faces that the point is in front of can contain the nearest point, and it is no closer than their plane.
        if height > 0.0 && height * height < best.0 {
            let q = face.nearest(p, height);
            let d = (p - q).norm_squared();
            if d < best.0 {
                best = (d, q);
            }
        }
    }
    let face = &faces[highest.1];
    if highest.0 <= 0.0 {
        return SurfacePoint { distance_m: highest.0, point_m: p - face.normal * highest.0, normal: face.normal };
    }
    let distance_m = best.0.sqrt();
    let normal = if distance_m > CONTACT_TOLERANCE_M { (p - best.1) / distance_m } else { face.normal };
    SurfacePoint { distance_m, point_m: best.1, normal }
}

/// Returns a box if the faces are three pairs of parallel faces that are perpendicular to each other; otherwise `None`.
fn as_box(faces: &[HullFace]) -> Option<ConvexShape> {
    if faces.len() != 6 || faces.iter().any(|f| f.edges.len() != 4) {
        return None;
    }
    let mut axes = [Vec3::zero(); 3];
    let mut half = [0.0; 3];
    let mut center = Vec3::zero();
    let mut used = [false; 6];
    for (axis, half) in axes.iter_mut().zip(&mut half) {
        let first = used.iter().position(|u| !u)?;
        let face = &faces[first];
        let other =
            (0..6).find(|k| !used[*k] && *k != first && faces[*k].normal.dot(face.normal) < PERPENDICULAR_TOLERANCE - 1.0)?;
        (used[first], used[other]) = (true, true);
        *axis = face.normal;
        *half = 0.5 * (face.offset + faces[other].offset);
        center += face.normal * (0.5 * (face.offset - faces[other].offset));
    }
    let square = axes[0].dot(axes[1]).abs() < PERPENDICULAR_TOLERANCE
        && axes[1].dot(axes[2]).abs() < PERPENDICULAR_TOLERANCE
        && axes[2].dot(axes[0]).abs() < PERPENDICULAR_TOLERANCE;
    square.then_some(ConvexShape::Box { center, axes, half })
}

impl HullFace {
    fn new(corners: &[Vec3<Enu>]) -> Self {
        // Newell's method is exact for planar polygons even if corners nearly coincide.
        let n = corners.len();
        let mut sum = Vec3::zero();
        for k in 0..n {
            sum += (corners[k] - corners[0]).cross(corners[(k + 1) % n] - corners[0]);
        }
        let normal = sum.unit();
        let offset = corners.iter().map(|c| normal.dot(*c)).sum::<f64>() / n as f64;
        let edge = |k: usize| {
            let along = corners[(k + 1) % n] - corners[k];
            HullEdge {
                start: corners[k],
                along,
                outward: along.cross(normal),
                inverse_length_squared: 1.0 / along.norm_squared(),
            }
        };
        Self { normal, offset, edges: (0..n).map(edge).collect() }
    }

    /// Returns the point of the face that is nearest to a point at `height` above its plane.
    fn nearest(&self, p: Vec3<Enu>, height: f64) -> Vec3<Enu> {
        let mut best = (f64::INFINITY, Vec3::zero());
        let mut within = true;
        for edge in &self.edges {
            let d = p - edge.start;
            if edge.outward.dot(d) > 0.0 {
                within = false;
                let t = (d.dot(edge.along) * edge.inverse_length_squared).clamp(0.0, 1.0);
                let q = edge.start + edge.along * t;
                let d = (p - q).norm_squared();
                if d < best.0 {
                    best = (d, q);
                }
            }
        }
        if within { p - self.normal * height } else { best.1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::Element;
    use crate::random::RandomStream;
    use crate::scenario::bridges::solid::{MemberBuilder, Placement};

    /// Tolerance for rounding errors at the scale of the test shapes, m.
    const ROUNDING_TOLERANCE_M: f64 = 1e-12;

    fn cube() -> Convex {
        let mut b = MemberBuilder::new("t", Placement::new(Vec3::zero(), 90.0));
        b.add_box("cube", Element::RcDeck, [-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]);
        Convex::new(&b.finish()[0].solid)
    }

    /// Returns a box, a wedge and an eight-sided rod.
    fn shapes() -> Vec<Convex> {
        let mut b = MemberBuilder::new("t", Placement::new(Vec3::new(0.3, -0.2, 0.1), 37.0));
        b.add_box("block", Element::RcDeck, [-1.0, -0.5, -0.2], [1.3, 0.4, 0.1]);
        b.add_extrusion("wedge", Element::RcArch, &[[-1.0, -0.5], [1.0, -0.3], [0.9, 0.4], [-1.0, 0.1]], -0.4, 0.3);
        b.add_rod("rod", Element::MainCable, [-1.0, 0.2, -0.4], [0.8, -0.1, 0.6], 0.3, 8);
        b.finish().iter().map(|m| Convex::new(&m.solid)).collect()
    }

    #[test]
    fn exact_cube_distances_match_the_closed_form() {
        let cube = cube();
        let root3 = 3f64.sqrt();
        for (p, d) in [([3.0, 0.0, 0.0], 2.0), ([2.0, 2.0, 2.0], root3), ([0.0, 0.0, 0.5], -0.5), ([2.0, 2.0, 0.0], 2f64.sqrt())]
        {
            let near = cube.nearest(Vec3::new(p[0], p[1], p[2]));
            assert!((near.distance_m - d).abs() < ROUNDING_TOLERANCE_M, "{p:?} {near:?}");
        }
    }

    #[test]
    fn prop_box_and_hull_queries_agree() {
        // Tolerance for rounding errors in a rotated box's corners, m.
        const TOLERANCE_M: f64 = 1e-9;
        let mut b = MemberBuilder::new("t", Placement::new(Vec3::new(11.0, -40.0, 7.0), 71.0));
        b.add_box("block", Element::RcDeck, [-3.0, -0.5, -0.2], [1.3, 0.4, 0.1]);
        let solid = &b.finish()[0].solid;
        let boxed = Convex::new(solid);
        assert!(matches!(boxed.shape, ConvexShape::Box { .. }));
        let corners = |face: &Vec<u32>| face.iter().map(|k| solid.vertices_m[*k as usize]).collect::<Vec<_>>();
        let faces: Vec<HullFace> = solid.faces.iter().map(|f| HullFace::new(&corners(f))).collect();
        let hull = Convex { shape: ConvexShape::Hull(faces), ..boxed.clone() };
        let mut random = RandomStream::new(2, "points");
        for _ in 0..3000 {
            let p = Vec3::new(11.0, -40.0, 7.0)
                + Vec3::new(random.range(-4.0, 4.0), random.range(-4.0, 4.0), random.range(-1.0, 1.0));
            let (a, b) = (boxed.nearest(p), hull.nearest(p));
            assert!(
                (a.distance_m - b.distance_m).abs() < TOLERANCE_M
                    && (a.point_m + a.normal * a.distance_m - p).norm() < TOLERANCE_M
            );
            let direction = Vec3::new(random.normal(), random.normal(), random.normal()).unit();
            let (a, b) = (boxed.ray(p, direction, 9.0), hull.ray(p, direction, 9.0));
            assert!(a.is_some() == b.is_some() && a.zip(b).is_none_or(|(a, b)| (a.0 - b.0).abs() < TOLERANCE_M), "{a:?} {b:?}");
        }
    }

    #[test]
    fn prop_rays_end_on_the_surface() {
        for shape in shapes().iter().chain([&cube()]) {
            let mut random = RandomStream::new(5, "rays");
            for _ in 0..800 {
                let origin = Vec3::new(random.range(-4.0, 4.0), random.range(-4.0, 4.0), random.range(1.5, 4.0));
                let direction = Vec3::new(random.normal(), random.normal(), random.normal()).unit();
                if let Some((t, _)) = shape.ray(origin, direction, 50.0) {
                    assert!(shape.nearest(origin + direction * t).distance_m.abs() < 1e-9);
                } else {
                    let clear = (0..500).all(|k| shape.nearest(origin + direction * (f64::from(k) * 0.1)).distance_m > 0.0);
                    assert!(clear);
                }
            }
        }
    }

    #[test]
    fn prop_interior_minimum_of_a_segment_matches_sampling() {
        // Tolerance for equal distances and for the spacing of the sample points, m.
        const TOLERANCE_M: f64 = 2e-7;
        let mut random = RandomStream::new(8, "segments");
        let mut across = 0;
        for shape in &shapes() {
            for _ in 0..1500 {
                let mut point = || Vec3::<Enu>::new(random.range(-1.6, 1.6), random.range(-1.0, 1.0), random.range(-1.0, 1.0));
                let (a, b) = (point(), point());
                let (at_a, at_b) = (shape.nearest(a), shape.nearest(b));
                let between = shape.interior_minimum(a, b, [&at_a, &at_b], f64::INFINITY);
                across += usize::from(between.is_some());
                let least =
                    [Some(at_a), Some(at_b), between].into_iter().flatten().map(|n| n.distance_m).fold(f64::INFINITY, f64::min);
                let tried =
                    (0..=400).map(|k| shape.nearest(a.lerp(b, f64::from(k) / 400.0)).distance_m).fold(f64::INFINITY, f64::min);
                assert!(least <= tried + TOLERANCE_M, "{least} but {tried}");
            }
        }
        assert!(across > 1000, "{across}");
    }

    #[test]
    fn exact_segment_across_an_edge_touches_the_edge() {
        let cube = cube();
        let (a, b) = (Vec3::new(0.0, 2.0, 2.0), Vec3::new(0.0, 2.0, -6.0));
        let near = cube.interior_minimum(a, b, [&cube.nearest(a), &cube.nearest(b)], 2.0).unwrap();
        assert!((near.distance_m - 1.0).abs() < ROUNDING_TOLERANCE_M);
        // The nearest point of a segment across the top edge at 45 degrees is on the edge.
        let (a, b) = (Vec3::new(0.0, 0.0, 2.5), Vec3::new(0.0, 2.5, 0.0));
        let near = cube.interior_minimum(a, b, [&cube.nearest(a), &cube.nearest(b)], 2.0).unwrap();
        assert!(
            (near.point_m - Vec3::new(0.0, 1.0, 1.0)).norm() < 1e-6
                && (near.distance_m - 0.125f64.sqrt()).abs() < DISTANCE_TOLERANCE_M
        );
    }

    #[test]
    fn exact_segment_flat_on_a_face_touches_its_ends_or_the_edge() {
        let cube = cube();
        let ends = |a: Vec3<Enu>, b: Vec3<Enu>| cube.interior_minimum(a, b, [&cube.nearest(a), &cube.nearest(b)], 1.0);
        assert_eq!(ends(Vec3::new(-0.5, 0.2, 1.1), Vec3::new(0.5, 0.1, 1.1)), None);
        let over = ends(Vec3::new(0.0, 0.0, 1.1), Vec3::new(0.0, 3.0, 1.1)).unwrap();
        assert!((over.point_m - Vec3::new(0.0, 1.0, 1.0)).norm() < 1e-3, "{over:?}");
        // A segment upright on its end has no interior minimum.
        assert_eq!(ends(Vec3::new(0.0, 0.0, 1.1), Vec3::new(0.0, 0.0, 2.1)), None);
    }
}
