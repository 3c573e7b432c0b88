//! A convex polyhedron and the questions one may ask of it. Its signed distance is a convex function, which makes the nearest point of
//! a capsule's axis a one-dimensional search with one answer.

use crate::base::frames::{Enu, Vec3};
use crate::scenario::bridges::Solid;

/// Rounds of the golden-section search along a capsule's axis: the bracket shrinks below 1e-6 of its length.
const SEARCH_ROUNDS: usize = 30;
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// One face: its plane and its corners, counter-clockwise seen from outside.
#[derive(Debug, Clone, PartialEq)]
struct Face {
    normal: Vec3<Enu>,
    offset: f64,
    corners: Vec<Vec3<Enu>>,
}

/// A convex polyhedron ready for queries.
#[derive(Debug, Clone, PartialEq)]
pub struct Convex {
    faces: Vec<Face>,
    low_m: Vec3<Enu>,
    high_m: Vec3<Enu>,
}

/// A point of the surface and how far it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// Signed distance, m; negative inside.
    pub distance_m: f64,
    /// The surface point, m.
    pub point_m: Vec3<Enu>,
    /// Outward unit normal towards the query point.
    pub normal: Vec3<Enu>,
}

impl Convex {
    /// From a member's solid.
    #[must_use]
    pub fn new(solid: &Solid) -> Self {
        let faces =
            solid.faces.iter().map(|face| Face::new(face.iter().map(|k| solid.vertices_m[*k as usize]).collect())).collect();
        let fold = |pick: fn(f64, f64) -> f64, start: f64| {
            let a = solid.vertices_m.iter().fold([start; 3], |a, v| {
                let v = v.array();
                [pick(a[0], v[0]), pick(a[1], v[1]), pick(a[2], v[2])]
            });
            Vec3::new(a[0], a[1], a[2])
        };
        Self { faces, low_m: fold(f64::min, f64::INFINITY), high_m: fold(f64::max, f64::NEG_INFINITY) }
    }

    /// Corners of the axis-aligned box around it, m.
    #[must_use]
    pub fn bounds(&self) -> (Vec3<Enu>, Vec3<Enu>) {
        (self.low_m, self.high_m)
    }

    /// The nearest surface point.
    #[must_use]
    pub fn nearest(&self, p: Vec3<Enu>) -> SurfacePoint {
        let mut inside = (f64::NEG_INFINITY, 0);
        let mut best = (f64::INFINITY, Vec3::zero());
        for (k, face) in self.faces.iter().enumerate() {
            let height = face.normal.dot(p) - face.offset;
            if height > inside.0 {
                inside = (height, k);
            }
            // Only faces that the point lies before can hold the nearest point, and none nearer than its plane.
            if height > 0.0 && height * height < best.0 {
                let q = face.nearest(p, height);
                let d = (p - q).norm_squared();
                if d < best.0 {
                    best = (d, q);
                }
            }
        }
        let face = &self.faces[inside.1];
        if inside.0 <= 0.0 {
            return SurfacePoint { distance_m: inside.0, point_m: p - face.normal * inside.0, normal: face.normal };
        }
        let distance_m = best.0.sqrt();
        let normal = if distance_m > 1e-9 { (p - best.1) / distance_m } else { face.normal };
        SurfacePoint { distance_m, point_m: best.1, normal }
    }

    /// Distance along a ray to the surface and the normal there; a ray that starts inside hits at once.
    #[must_use]
    pub fn ray(&self, origin: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64) -> Option<(f64, Vec3<Enu>)> {
        let (mut enter, mut leave) = (f64::NEG_INFINITY, max_m);
        let mut normal = -direction;
        for face in &self.faces {
            let height = face.normal.dot(origin) - face.offset;
            let rate = face.normal.dot(direction);
            if rate == 0.0 {
                if height > 0.0 {
                    return None;
                }
                continue;
            }
            let t = -height / rate;
            if rate < 0.0 {
                if t > enter {
                    (enter, normal) = (t, face.normal);
                }
            } else {
                leave = leave.min(t);
            }
            if enter > leave {
                return None;
            }
        }
        if leave < 0.0 {
            return None;
        }
        Some((enter.max(0.0), if enter > 0.0 { normal } else { -direction }))
    }

    /// Where along the segment (0 at `a`, 1 at `b`) the signed distance is least.
    #[must_use]
    pub fn nearest_on_segment(&self, a: Vec3<Enu>, b: Vec3<Enu>) -> f64 {
        let value = |t: f64| self.nearest(a.lerp(b, t)).distance_m;
        let (mut low, mut high) = (0.0, 1.0);
        let (mut x, mut y) = (1.0 - GOLDEN, GOLDEN);
        let (mut fx, mut fy) = (value(x), value(y));
        for _ in 0..SEARCH_ROUNDS {
            if fx <= fy {
                (high, y, fy) = (y, x, fx);
                x = high - GOLDEN * (high - low);
                fx = value(x);
            } else {
                (low, x, fx) = (x, y, fy);
                y = low + GOLDEN * (high - low);
                fy = value(y);
            }
        }
        0.5 * (low + high)
    }
}

impl Face {
    fn new(corners: Vec<Vec3<Enu>>) -> Self {
        // Newell's sum: exact for planar polygons whatever corners are close together.
        let mut sum = Vec3::zero();
        for k in 0..corners.len() {
            sum += (corners[k] - corners[0]).cross(corners[(k + 1) % corners.len()] - corners[0]);
        }
        let normal = sum.unit();
        let offset = corners.iter().map(|c| normal.dot(*c)).sum::<f64>() / corners.len() as f64;
        Self { normal, offset, corners }
    }

    /// Nearest point of the polygon to a point at `height` over its plane.
    fn nearest(&self, p: Vec3<Enu>, height: f64) -> Vec3<Enu> {
        let foot = p - self.normal * height;
        let mut best = (f64::INFINITY, foot);
        let mut within = true;
        let n = self.corners.len();
        for k in 0..n {
            let (a, b) = (self.corners[k], self.corners[(k + 1) % n]);
            let edge = b - a;
            if self.normal.dot(edge.cross(foot - a)) < 0.0 {
                within = false;
                let t = ((foot - a).dot(edge) / edge.norm_squared()).clamp(0.0, 1.0);
                let q = a + edge * t;
                let d = (p - q).norm_squared();
                if d < best.0 {
                    best = (d, q);
                }
            }
        }
        if within { foot } else { best.1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::RandomStream;
    use crate::scenario::bridges::solid::{Builder, Placement};

    /// m; rounding at the scale of the test shapes.
    const ROUNDING_M: f64 = 1e-12;

    fn cube() -> Convex {
        let mut b = Builder::new("t", Placement::new(Vec3::zero(), 90.0));
        b.block("cube", 12, [-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]);
        Convex::new(&b.finish()[0].solid)
    }

    #[test]
    fn exact_distances_to_a_cube() {
        let cube = cube();
        let root3 = 3f64.sqrt();
        for (p, d) in [([3.0, 0.0, 0.0], 2.0), ([2.0, 2.0, 2.0], root3), ([0.0, 0.0, 0.5], -0.5), ([2.0, 2.0, 0.0], 2f64.sqrt())]
        {
            let near = cube.nearest(Vec3::new(p[0], p[1], p[2]));
            assert!((near.distance_m - d).abs() < ROUNDING_M, "{p:?} {near:?}");
        }
    }

    #[test]
    fn prop_a_ray_ends_on_the_surface() {
        let cube = cube();
        let mut random = RandomStream::new(5, "rays");
        for _ in 0..2000 {
            let origin = Vec3::new(random.range(-4.0, 4.0), random.range(-4.0, 4.0), random.range(1.5, 4.0));
            let direction = Vec3::new(random.normal(), random.normal(), random.normal()).unit();
            if let Some((t, _)) = cube.ray(origin, direction, 50.0) {
                assert!(cube.nearest(origin + direction * t).distance_m.abs() < 1e-9);
            } else {
                let clear = (0..500).all(|k| cube.nearest(origin + direction * (f64::from(k) * 0.1)).distance_m > 0.0);
                assert!(clear);
            }
        }
    }

    #[test]
    fn exact_a_segment_across_an_edge_is_nearest_at_the_edge() {
        let cube = cube();
        let t = cube.nearest_on_segment(Vec3::new(0.0, 2.0, 2.0), Vec3::new(0.0, 2.0, -6.0));
        assert!((cube.nearest(Vec3::new(0.0, 2.0, 2.0 - 8.0 * t)).distance_m - 1.0).abs() < ROUNDING_M);
    }
}
