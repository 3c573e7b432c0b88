//! Oriented boxes, which represent all moving or parked objects, with exact distance, ray and contact queries.

use super::query_types::HullProbe;
use crate::frames::{Enu, Vec3};

/// A box with an arbitrary orientation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrientedBox {
    /// Center, m.
    pub center_m: Vec3<Enu>,
    /// Unit vectors along length, width and height.
    pub axes: [Vec3<Enu>; 3],
    /// Half length, width and height, m.
    pub half_m: [f64; 3],
}

/// Number of steps in the golden-section search along a capsule's axis, enough to narrow 10 m to less than a
/// micrometer.
const SEARCH_STEP_COUNT: usize = 36;
/// (√5 - 1)/2.
const INVERSE_GOLDEN_RATIO: f64 = 0.618_033_988_749_894_9;
/// Minimum capsule axis length at which the ends are separate contacts, m.
const MIN_AXIS_LENGTH_M: f64 = 1e-6;

impl OrientedBox {
    /// Returns the radius of the bounding sphere about the center, in meters.
    #[must_use]
    pub fn radius_m(&self) -> f64 {
        self.half_m.iter().map(|h| h * h).sum::<f64>().sqrt()
    }

    fn local_from_world(&self, point_m: Vec3<Enu>) -> [f64; 3] {
        let from_center = point_m - self.center_m;
        self.axes.map(|axis| axis.dot(from_center))
    }

    fn world_from_local(&self, local: [f64; 3]) -> Vec3<Enu> {
        self.axes[0] * local[0] + self.axes[1] * local[1] + self.axes[2] * local[2]
    }

    /// Returns the signed distance (m, negative inside) from a point to the nearest surface point, that surface point,
    /// and its outward unit normal.
    #[must_use]
    pub fn nearest(&self, point_m: Vec3<Enu>) -> (f64, Vec3<Enu>, Vec3<Enu>) {
        let p = self.local_from_world(point_m);
        let inside = [0, 1, 2].map(|k: usize| p[k].clamp(-self.half_m[k], self.half_m[k]));
        let away = self.world_from_local([p[0] - inside[0], p[1] - inside[1], p[2] - inside[2]]);
        let distance = away.norm();
        if distance > 0.0 {
            return (distance, self.center_m + self.world_from_local(inside), away / distance);
        }
        let depth = [0, 1, 2].map(|k: usize| self.half_m[k] - p[k].abs());
        let k = (0..3).fold(0, |best, k| if depth[k] < depth[best] { k } else { best });
        let normal = self.axes[k] * if p[k] < 0.0 { -1.0 } else { 1.0 };
        (-depth[k], point_m + normal * depth[k], normal)
    }

    /// Returns the distance and outward normal of the first hit of a ray within `max_m`. A ray that starts inside hits
    /// immediately, with its reversed direction as the normal.
    #[must_use]
    pub fn ray(&self, origin_m: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64) -> Option<(f64, Vec3<Enu>)> {
        let (mut enter, mut leave, mut normal) = (0.0_f64, max_m, -direction);
        for ((axis, half), o) in self.axes.into_iter().zip(self.half_m).zip(self.local_from_world(origin_m)) {
            let d = axis.dot(direction);
            if d.abs() < 1e-15 {
                if o.abs() > half {
                    return None;
                }
                continue;
            }
            let side = half * d.signum();
            let (near, far) = ((-side - o) / d, (side - o) / d);
            if near > enter {
                (enter, normal) = (near, axis * -d.signum());
            }
            leave = leave.min(far);
        }
        (enter <= leave).then_some((enter, normal))
    }

    /// Calls `found` with the gap, surface point and normal of each near-contact of a convex probe. A ball has one
    /// contact. A capsule has contacts at its deepest point and at both ends, so a capsule lying on a face rests on two
    /// points.
    pub fn contacts(&self, probe: &HullProbe, margin_m: f64, mut found: impl FnMut(f64, Vec3<Enu>, Vec3<Enu>)) {
        let mut test = |center: Vec3<Enu>, radius: f64| {
            let (distance, point, normal) = self.nearest(center);
            if distance - radius <= margin_m {
                found(distance - radius, point, normal);
            }
        };
        match *probe {
            HullProbe::Ball { center_m, radius_m } => test(center_m, radius_m),
            HullProbe::Capsule { a_m, b_m, radius_m } => {
                test(a_m, radius_m);
                if (b_m - a_m).norm() < MIN_AXIS_LENGTH_M {
                    return;
                }
                test(b_m, radius_m);
                let t = self.closest_fraction(a_m, b_m);
                if t > 1e-3 && t < 1.0 - 1e-3 {
                    test(a_m.lerp(b_m, t), radius_m);
                }
            }
        }
    }

    /// Returns the position of the minimum signed distance on the segment from `a` to `b`, as a fraction of its length.
    /// The distance is convex along a line, so a golden-section search finds the minimum.
    fn closest_fraction(&self, a_m: Vec3<Enu>, b_m: Vec3<Enu>) -> f64 {
        let at = |t: f64| self.nearest(a_m.lerp(b_m, t)).0;
        let (mut low, mut high) = (0.0, 1.0);
        let (mut x1, mut x2) = (1.0 - INVERSE_GOLDEN_RATIO, INVERSE_GOLDEN_RATIO);
        let (mut f1, mut f2) = (at(x1), at(x2));
        for _ in 0..SEARCH_STEP_COUNT {
            if f1 <= f2 {
                (high, x2, f2) = (x2, x1, f1);
                x1 = high - INVERSE_GOLDEN_RATIO * (high - low);
                f1 = at(x1);
            } else {
                (low, x1, f1) = (x1, x2, f2);
                x2 = low + INVERSE_GOLDEN_RATIO * (high - low);
                f2 = at(x2);
            }
        }
        0.5 * (low + high)
    }
}

/// Returns the center and radius of a probe's bounding sphere, in meters.
#[must_use]
pub fn bounding_sphere(probe: &HullProbe) -> (Vec3<Enu>, f64) {
    match *probe {
        HullProbe::Ball { center_m, radius_m } => (center_m, radius_m),
        HullProbe::Capsule { a_m, b_m, radius_m } => ((a_m + b_m) * 0.5, (b_m - a_m).norm() * 0.5 + radius_m),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> OrientedBox {
        let r = 0.5_f64.sqrt();
        OrientedBox {
            center_m: Vec3::new(10.0, 0.0, 1.0),
            axes: [Vec3::new(r, r, 0.0), Vec3::new(-r, r, 0.0), Vec3::new(0.0, 0.0, 1.0)],
            half_m: [1.0, 1.0, 1.0],
        }
    }

    #[test]
    fn exact_box_distances_match_outside_and_inside() {
        let b = cube();
        assert!((b.nearest(Vec3::new(10.0, 0.0, 5.0)).0 - 3.0).abs() < 1e-12);
        // The vertical edge at east 10 - √2.
        let (d, p, n) = b.nearest(Vec3::new(5.0, 0.0, 1.0));
        assert!((d - (5.0 - 2.0_f64.sqrt())).abs() < 1e-12);
        assert!((p.east() - (10.0 - 2.0_f64.sqrt())).abs() < 1e-12 && (n.east() + 1.0).abs() < 1e-12);
        assert!((b.nearest(Vec3::new(10.0, 0.0, 1.9)).0 + 0.1).abs() < 1e-12);
    }

    #[test]
    fn prop_rays_end_on_the_surface_and_miss_boxes_behind_them() {
        let b = cube();
        for k in 0..60 {
            let from = Vec3::new(f64::from(k) * 0.3, -7.0, f64::from(k % 7));
            let target = Vec3::new(10.0, f64::from(k % 3) * 0.2, 0.8);
            let d = (target - from).unit();
            let (t, n) = b.ray(from, d, 50.0).expect("aimed at it");
            assert!(b.nearest(from + d * t).0.abs() < 1e-9);
            assert!(n.dot(d) < 0.0);
            assert!(b.ray(from, -d, 50.0).is_none());
            assert!(b.ray(from, d, t - 0.01).is_none());
        }
    }

    #[test]
    fn exact_capsule_contacts_on_a_face_and_across_an_edge() {
        let b = cube();
        let mut gaps = Vec::new();
        let flat = HullProbe::Capsule { a_m: Vec3::new(9.5, 0.0, 2.1), b_m: Vec3::new(10.5, 0.0, 2.1), radius_m: 0.05 };
        b.contacts(&flat, 0.1, |gap, _, _| gaps.push(gap));
        assert!(gaps.len() >= 2 && gaps.iter().all(|g| (g - 0.05).abs() < 1e-9), "{gaps:?}");
        gaps.clear();
        let across = HullProbe::Capsule { a_m: Vec3::new(8.5, -3.0, 1.0), b_m: Vec3::new(8.5, 3.0, 1.0), radius_m: 0.05 };
        b.contacts(&across, 0.1, |gap, _, _| gaps.push(gap));
        // The edge at east 10 - √2 = 8.586 is 0.086 from the axis.
        assert_eq!(gaps.len(), 1);
        assert!((gaps[0] - (1.5 - 2.0_f64.sqrt() - 0.05)).abs() < 1e-6, "{gaps:?}");
    }
}
