//! Parts of an aircraft's hull as obstacles for another aircraft: exact distances, rays and contacts of balls and capsules.

use super::nearest_points::closest_fractions_of_segments;
use super::query_types::HullProbe;
use crate::frames::{Enu, Vec3};

/// Sine of the angle below which two axes count as parallel, so that their ends are contacts, too (estimate: an aircraft that rests on
/// another one must not rock about a single point).
const PARALLEL_SINE: f64 = 0.1;
/// Squared length of an axis below which a capsule is a ball, m².
const MIN_AXIS_LENGTH2_M2: f64 = 1e-12;
/// Distance below which the direction between two axes is not defined, m.
const MIN_DISTANCE_M: f64 = 1e-9;

/// Axis and radius of a part of a hull. A ball has an axis of length 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HullShape {
    a_m: Vec3<Enu>,
    b_m: Vec3<Enu>,
    radius_m: f64,
}

impl HullShape {
    /// Returns the shape of a probe.
    #[must_use]
    pub fn of(probe: &HullProbe) -> Self {
        match *probe {
            HullProbe::Ball { center_m, radius_m } => Self { a_m: center_m, b_m: center_m, radius_m },
            HullProbe::Capsule { a_m, b_m, radius_m } => Self { a_m, b_m, radius_m },
        }
    }

    /// Returns a capsule between two points.
    #[must_use]
    pub fn between(a_m: Vec3<Enu>, b_m: Vec3<Enu>, radius_m: f64) -> Self {
        Self { a_m, b_m, radius_m }
    }

    fn axis_point(&self, fraction: f64) -> Vec3<Enu> {
        self.a_m.lerp(self.b_m, fraction)
    }

    /// Returns the position of the axis point nearest to a point, as a fraction of the axis.
    fn nearest_fraction(&self, point_m: Vec3<Enu>) -> f64 {
        let axis = self.b_m - self.a_m;
        let length2 = axis.norm_squared();
        if length2 < MIN_AXIS_LENGTH2_M2 { 0.0 } else { ((point_m - self.a_m).dot(axis) / length2).clamp(0.0, 1.0) }
    }

    /// Returns the positions where this axis and another one are closest, as fractions of each.
    fn closest_fractions(&self, other: &Self) -> (f64, f64) {
        if (other.b_m - other.a_m).norm_squared() < MIN_AXIS_LENGTH2_M2 {
            return (self.nearest_fraction(other.a_m), 0.0);
        }
        closest_fractions_of_segments((self.a_m, self.b_m), (other.a_m, other.b_m))
    }

    /// Returns the signed distance (m, negative inside) from a point to the nearest surface point, that surface point, and its outward
    /// unit normal.
    #[must_use]
    pub fn nearest(&self, point_m: Vec3<Enu>) -> (f64, Vec3<Enu>, Vec3<Enu>) {
        let center = self.axis_point(self.nearest_fraction(point_m));
        let normal = self.direction(point_m - center, Vec3::zero());
        ((point_m - center).norm() - self.radius_m, center + normal * self.radius_m, normal)
    }

    /// Returns the unit vector of `away`; if it is too short, one perpendicular to both axes, or else the one that points up.
    fn direction(&self, away: Vec3<Enu>, other_axis: Vec3<Enu>) -> Vec3<Enu> {
        if away.norm() > MIN_DISTANCE_M {
            return away.unit();
        }
        let across = (self.b_m - self.a_m).cross(other_axis);
        let upward = if across.up() < 0.0 { -across } else { across };
        if upward.norm() > MIN_DISTANCE_M { upward.unit() } else { Vec3::new(0.0, 0.0, 1.0) }
    }

    /// Returns the distance and outward normal of the first hit of a ray within `max_m`. A ray that starts inside hits immediately, with
    /// its reversed direction as the normal.
    #[must_use]
    pub fn ray(&self, origin_m: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64) -> Option<(f64, Vec3<Enu>)> {
        if self.nearest(origin_m).0 <= 0.0 {
            return Some((0.0, -direction));
        }
        let ends = [self.a_m, self.b_m].map(|center| entry(origin_m - center, direction, self.radius_m));
        let candidates = ends.into_iter().chain([self.cylinder_entry(origin_m, direction)]).flatten();
        let first = candidates.filter(|t| (0.0..=max_m).contains(t)).min_by(f64::total_cmp)?;
        let point = origin_m + direction * first;
        let center = self.axis_point(self.nearest_fraction(point));
        Some((first, self.direction(point - center, Vec3::zero())))
    }

    /// Returns where a ray enters the cylinder about the axis, between its ends.
    fn cylinder_entry(&self, origin_m: Vec3<Enu>, direction: Vec3<Enu>) -> Option<f64> {
        let axis = self.b_m - self.a_m;
        let length2 = axis.norm_squared();
        if length2 < MIN_AXIS_LENGTH2_M2 {
            return None;
        }
        let across = |v: Vec3<Enu>| v - axis * (v.dot(axis) / length2);
        let from = origin_m - self.a_m;
        let t = entry(across(from), across(direction), self.radius_m)?;
        (0.0..=length2).contains(&(from + direction * t).dot(axis)).then_some(t)
    }

    /// Calls `found` with the gap, surface point and normal of each near-contact of a convex probe: where the axes are nearest and, if
    /// they are almost parallel, at the ends of the probe's axis and beside the ends of this one.
    pub fn contacts(&self, probe: &HullProbe, margin_m: f64, mut found: impl FnMut(f64, Vec3<Enu>, Vec3<Enu>)) {
        let other = Self::of(probe);
        let (axis, other_axis) = (self.b_m - self.a_m, other.b_m - other.a_m);
        let mut test = |mine: f64, theirs: f64| {
            let (center, away) = (self.axis_point(mine), other.axis_point(theirs) - self.axis_point(mine));
            let gap_m = away.norm() - self.radius_m - other.radius_m;
            if gap_m <= margin_m {
                let normal = self.direction(away, other_axis);
                found(gap_m, center + normal * self.radius_m, normal);
            }
        };
        let (mine, theirs) = self.closest_fractions(&other);
        test(mine, theirs);
        let (length2, other_length2) = (axis.norm_squared(), other_axis.norm_squared());
        let sine2 = axis.cross(other_axis).norm_squared() / (length2 * other_length2);
        if length2.min(other_length2) < MIN_AXIS_LENGTH2_M2 || sine2 > PARALLEL_SINE * PARALLEL_SINE {
            return;
        }
        let ends = [0.0, 1.0].map(|end| (self.nearest_fraction(other.axis_point(end)), end));
        let beside = [0.0, 1.0].map(|end| (end, other.nearest_fraction(self.axis_point(end))));
        let mut tested = vec![(mine, theirs)];
        for pair in ends.into_iter().chain(beside) {
            let same = |a: f64, b: f64| (a - b).abs() < 1e-3;
            if !tested.iter().any(|(m, t)| same(*m, pair.0) && same(*t, pair.1)) {
                test(pair.0, pair.1);
                tested.push(pair);
            }
        }
    }
}

/// Returns the smaller t at which `from + along t` has the length `radius_m`.
fn entry(from: Vec3<Enu>, along: Vec3<Enu>, radius_m: f64) -> Option<f64> {
    let (a, b, c) = (along.norm_squared(), from.dot(along), from.norm_squared() - radius_m * radius_m);
    let root2 = b * b - a * c;
    (a > 0.0 && root2 >= 0.0).then(|| (-b - root2.sqrt()) / a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::RandomStream;

    /// Rounding tolerance, m.
    const TOLERANCE_M: f64 = 1e-9;

    fn point(random: &mut RandomStream, spread: f64) -> Vec3<Enu> {
        Vec3::new(random.range(-spread, spread), random.range(-spread, spread), random.range(-spread, spread))
    }

    fn capsule(a: [f64; 3], b: [f64; 3], radius_m: f64) -> HullProbe {
        let [a_m, b_m] = [a, b].map(|[e, n, u]| Vec3::new(e, n, u));
        HullProbe::Capsule { a_m, b_m, radius_m }
    }

    fn contacts(on: &HullProbe, probe: &HullProbe, margin_m: f64) -> Vec<(f64, Vec3<Enu>, Vec3<Enu>)> {
        let mut all = Vec::new();
        HullShape::of(on).contacts(probe, margin_m, |gap, at, normal| all.push((gap, at, normal)));
        all
    }

    #[test]
    fn exact_distances_of_a_capsule() {
        let shape = HullShape::of(&capsule([0.0, 0.0, 0.0], [2.0, 0.0, 0.0], 0.5));
        let (beside, at, normal) = shape.nearest(Vec3::new(1.0, 3.0, 0.0));
        assert_eq!((beside, at, normal), (2.5, Vec3::new(1.0, 0.5, 0.0), Vec3::new(0.0, 1.0, 0.0)));
        // Beyond the end: 5 m from it, as in a 3-4-5 triangle.
        assert_eq!(shape.nearest(Vec3::new(5.0, 0.0, 4.0)).0, 4.5);
        assert_eq!(shape.nearest(Vec3::new(1.0, 0.0, 0.0)).0, -0.5, "on the axis");
    }

    #[test]
    fn exact_contacts_of_crossed_and_parallel_capsules() {
        let below = capsule([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], 0.1);
        let across = contacts(&below, &capsule([0.3, -1.0, 0.5], [0.3, 1.0, 0.5], 0.2), 1.0);
        assert_eq!(across.len(), 1, "{across:?}");
        let (gap_m, at, normal) = across[0];
        assert!((gap_m - 0.2).abs() < TOLERANCE_M && (at - Vec3::new(0.3, 0.0, 0.1)).norm() < TOLERANCE_M, "{across:?}");
        assert!((normal - Vec3::new(0.0, 0.0, 1.0)).norm() < TOLERANCE_M);
        // A capsule that lies on a parallel one rests on the ends of the shared part: from -0.5 to 1.
        let along = contacts(&below, &capsule([-0.5, 0.0, 0.3], [1.5, 0.0, 0.3], 0.1), 0.2);
        let mut easts: Vec<f64> = along.iter().filter(|one| one.0 < 0.11).map(|one| one.1.east()).collect();
        easts.sort_by(f64::total_cmp);
        assert!(easts.len() == 2 && (easts[0] + 0.5).abs() < TOLERANCE_M && (easts[1] - 1.0).abs() < TOLERANCE_M, "{along:?}");
        // Axes that intersect still have a normal, across both.
        let through = contacts(&below, &capsule([0.0, -1.0, 0.0], [0.0, 1.0, 0.0], 0.1), 0.0);
        assert_eq!(through[0].2, Vec3::new(0.0, 0.0, 1.0), "{through:?}");
        assert_eq!(contacts(&below, &HullProbe::Ball { center_m: Vec3::new(0.0, 0.0, 2.0), radius_m: 0.5 }, 1.0), []);
    }

    #[test]
    fn prop_closest_points_match_sampling() {
        let mut random = RandomStream::new(5, "capsules");
        for k in 0..400 {
            let mut part = |is_ball: bool| {
                let (a_m, radius_m) = (point(&mut random, 2.0), random.range(0.01, 0.5));
                let b_m = if is_ball { a_m } else { point(&mut random, 2.0) };
                HullShape { a_m, b_m, radius_m }
            };
            let (mine, theirs) = (part(k % 5 == 0), part(k % 7 == 0));
            let (s, t) = mine.closest_fractions(&theirs);
            let distance_m = (mine.axis_point(s) - theirs.axis_point(t)).norm();
            for (i, j) in (0..=20).flat_map(|i| (0..=20).map(move |j| (f64::from(i) / 20.0, f64::from(j) / 20.0))) {
                assert!(distance_m <= (mine.axis_point(i) - theirs.axis_point(j)).norm() + TOLERANCE_M, "{mine:?} {theirs:?}");
            }
        }
    }

    #[test]
    fn prop_rays_end_on_the_surface_at_the_first_point_inside() {
        let mut random = RandomStream::new(6, "rays");
        let mut hits = 0;
        for k in 0..3_000 {
            let (a_m, radius_m) = (point(&mut random, 1.0), random.range(0.05, 0.6));
            let b_m = if k % 4 == 0 { a_m } else { point(&mut random, 1.0) };
            let shape = HullShape { a_m, b_m, radius_m };
            let (origin, target) = (point(&mut random, 4.0), point(&mut random, 1.0));
            let direction = (target - origin).unit();
            let hit = shape.ray(origin, direction, 10.0);
            let first = (0..10_000).map(|k| 0.001 * f64::from(k)).find(|t| shape.nearest(origin + direction * *t).0 < 0.0);
            // A ray can graze the shape between two samples.
            match (hit, first) {
                (Some((t, normal)), Some(first)) => {
                    hits += 1;
                    assert!(t <= first + TOLERANCE_M && first - t < 0.002, "{t} {first}");
                    assert!(first == 0.0 || normal.dot(direction) <= TOLERANCE_M, "{normal:?}");
                }
                (Some((t, _)), None) => assert!(shape.nearest(origin + direction * t).0.abs() < 1e-6),
                (None, Some(first)) => panic!("misses a surface at {first} m"),
                (None, None) => {}
            }
        }
        assert!(hits > 500, "{hits}");
    }
}
