//! Nearest points on triangles and line segments.

use super::convex::SurfacePoint;
use crate::frames::{Enu, Vec3};

/// Returns the point on a crease that is nearest to a segment, and a rank for comparison with other creases: the distance, or
/// minus the penetration depth if the segment passes below the crease.
pub(super) fn nearest_on_crease((a, b): (Vec3<Enu>, Vec3<Enu>), (c, d): (Vec3<Enu>, Vec3<Enu>)) -> (f64, SurfacePoint) {
    let (q, e) = closest_points_of_segments((a, b), (c, d));
    let distance_m = (q - e).norm();
    let depth = depth_below((a, b), (c, d)).unwrap_or(0.0);
    let signed = if depth > 0.0 { -distance_m } else { distance_m };
    let rank = if depth > 0.0 { -depth } else { distance_m };
    (rank, SurfacePoint { distance_m: signed, point_m: e, normal: (q - e) / signed })
}

/// Returns the depth of segment a-b below segment c-d where they cross in plan view; `None` if they do not cross.
fn depth_below((a, b): (Vec3<Enu>, Vec3<Enu>), (c, d): (Vec3<Enu>, Vec3<Enu>)) -> Option<f64> {
    let (u, v, w) = (b - a, d - c, c - a);
    let turn = |p: Vec3<Enu>, q: Vec3<Enu>| p.east() * q.north() - p.north() * q.east();
    let cross = turn(u, v);
    let (s, t) = (turn(w, v) / cross, turn(w, u) / cross);
    let within = (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t);
    within.then(|| (c + v * t).up() - (a + u * s).up())
}

/// Returns the points where segments a-b and c-d are closest.
pub(super) fn closest_points_of_segments(
    (a, b): (Vec3<Enu>, Vec3<Enu>),
    (c, d): (Vec3<Enu>, Vec3<Enu>),
) -> (Vec3<Enu>, Vec3<Enu>) {
    let (s, t) = closest_fractions_of_segments((a, b), (c, d));
    (a + (b - a) * s, c + (d - c) * t)
}

/// Returns where segments a-b and c-d are closest, as fractions of each. Segment c-d must have a length.
pub(super) fn closest_fractions_of_segments((a, b): (Vec3<Enu>, Vec3<Enu>), (c, d): (Vec3<Enu>, Vec3<Enu>)) -> (f64, f64) {
    let (u, v, w) = (b - a, d - c, a - c);
    let (uu, uv, vv) = (u.norm_squared(), u.dot(v), v.norm_squared());
    let square = uu * vv - uv * uv;
    // Parallel lines have the same distance everywhere, so any starting point works.
    let s = if square > 0.0 { ((uv * v.dot(w) - vv * u.dot(w)) / square).clamp(0.0, 1.0) } else { 0.0 };
    let t = (v.dot(a + u * s - c) / vv).clamp(0.0, 1.0);
    let e = c + v * t;
    let s = if uu > 0.0 { (u.dot(e - a) / uu).clamp(0.0, 1.0) } else { 0.0 };
    (s, t)
}

/// Returns the point of segment a-b that is nearest to `p`.
pub(super) fn nearest_on_segment(p: Vec3<Enu>, a: Vec3<Enu>, b: Vec3<Enu>) -> Vec3<Enu> {
    let edge = b - a;
    a + edge * ((p - a).dot(edge) / edge.norm_squared()).clamp(0.0, 1.0)
}

/// Returns the point of triangle a-b-c that is nearest to `p`.
pub(super) fn nearest_on_triangle(p: Vec3<Enu>, a: Vec3<Enu>, b: Vec3<Enu>, c: Vec3<Enu>) -> Vec3<Enu> {
    let normal = (b - a).cross(c - a);
    let foot = p - normal * (normal.dot(p - a) / normal.norm_squared());
    let outside = |from: Vec3<Enu>, to: Vec3<Enu>| (to - from).cross(foot - from).dot(normal) < 0.0;
    if !outside(a, b) && !outside(b, c) && !outside(c, a) {
        return foot;
    }
    let on = |from: Vec3<Enu>, to: Vec3<Enu>| {
        let q = nearest_on_segment(p, from, to);
        ((p - q).norm_squared(), q)
    };
    let nearer = |a: (f64, Vec3<Enu>), b: (f64, Vec3<Enu>)| if b.0 < a.0 { b } else { a };
    nearer(nearer(on(a, b), on(b, c)), on(c, a)).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::RandomStream;

    /// Tolerance for rounding errors at the scale of the test triangles, m.
    const ROUNDING_TOLERANCE_M: f64 = 1e-9;

    #[test]
    fn prop_nearest_triangle_point_matches_sampling() {
        let mut random = RandomStream::new(4, "triangles");
        let mut point = |spread: f64| {
            Vec3::<Enu>::new(random.range(-spread, spread), random.range(-spread, spread), random.range(-spread, spread))
        };
        for _ in 0..300 {
            let (p, a, b, c) = (point(4.0), point(2.0), point(2.0), point(2.0));
            let q = nearest_on_triangle(p, a, b, c);
            for (i, j) in (0..=20).flat_map(|i| (0..=20 - i).map(move |j| (f64::from(i) / 20.0, f64::from(j) / 20.0))) {
                let other = a + (b - a) * i + (c - a) * j;
                assert!((p - q).norm() <= (p - other).norm() + ROUNDING_TOLERANCE_M);
            }
        }
    }
}
