//! The path recorded since takeoff, for Smart RTL.

use spandrel_model::frames::{Ned, Vec3};

/// Distance between recorded points, m. Path sections closer together than this form a loop (ArduCopter:
/// SRTL_ACCURACY).
const POINT_SPACING_M: f64 = 2.0;
/// Maximum number of points (ArduCopter: SRTL_POINTS).
const MAX_POINTS: usize = 300;
/// Maximum deviation of the simplified path from the recorded one, m (ArduCopter: half of SRTL_ACCURACY).
const SIMPLIFY_TOLERANCE_M: f64 = 0.5 * POINT_SPACING_M;
/// Acceptance radius of recorded points, m.
const ACCEPTANCE_RADIUS_M: f64 = 1.0;

/// The path recorded since takeoff.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FlownPath {
    points: Vec<Vec3<Ned>>,
}

impl FlownPath {
    /// Starts a new path.
    pub fn begin(&mut self, position_m: Vec3<Ned>) {
        self.points = vec![position_m];
    }

    /// Returns true if no path is recorded.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Records a position. If the path comes close to an earlier section, the loop is removed.
    pub fn record(&mut self, position_m: Vec3<Ned>) {
        let Some(last) = self.points.last() else { return };
        if (position_m - *last).norm() < POINT_SPACING_M {
            return;
        }
        let before = &self.points[..self.points.len() - 1];
        let near = before.windows(2).position(|leg| distance_to_leg(position_m, leg[0], leg[1]) < POINT_SPACING_M);
        if let Some(leg) = near {
            self.points.truncate(leg + 1);
        }
        self.points.push(position_m);
        let mut within_m = SIMPLIFY_TOLERANCE_M;
        while self.points.len() >= MAX_POINTS {
            self.simplify(within_m);
            within_m *= 2.0;
        }
    }

    /// Handles a respawn at a position on the path: removes the later points.
    pub fn truncate_to(&mut self, position_m: Vec3<Ned>) {
        let distance = |k: &usize| (self.points[*k] - position_m).norm();
        let nearest = (0..self.points.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        if let Some(nearest) = nearest {
            self.points.truncate(nearest + 1);
        }
    }

    /// Simplifies the path for a return.
    pub fn simplify_for_return(&mut self) {
        self.simplify(SIMPLIFY_TOLERANCE_M);
    }

    /// Returns the next point on the way back, and whether it is the takeoff point. Removes the point once it is
    /// reached.
    pub fn next_return_point(&mut self, here_m: Vec3<Ned>) -> Option<(Vec3<Ned>, bool)> {
        if self.points.len() > 1 && self.points.last().is_some_and(|next| (*next - here_m).norm() < ACCEPTANCE_RADIUS_M) {
            self.points.pop();
        }
        Some((*self.points.last()?, self.points.len() == 1))
    }

    /// Removes points on nearly straight sections (Ramer-Douglas-Peucker).
    fn simplify(&mut self, within_m: f64) {
        let mut keep = vec![false; self.points.len()];
        let mut parts = vec![(0, self.points.len().saturating_sub(1))];
        while let Some((first, last)) = parts.pop() {
            if let (Some(a), Some(b)) = (self.points.get(first), self.points.get(last)) {
                (keep[first], keep[last]) = (true, true);
                let off_m = |k: usize| (k, distance_to_leg(self.points[k], *a, *b));
                let farthest = (first + 1..last).map(off_m).max_by(|x, y| x.1.total_cmp(&y.1));
                if let Some((k, _)) = farthest.filter(|(_, off_m)| *off_m > within_m) {
                    parts.extend([(first, k), (k, last)]);
                }
            }
        }
        let mut kept = keep.into_iter();
        self.points.retain(|_| kept.next().unwrap_or(true));
    }
}

/// Distance from a point to a line segment, m.
fn distance_to_leg(place: Vec3<Ned>, from: Vec3<Ned>, to: Vec3<Ned>) -> f64 {
    let (leg, off) = (to - from, place - from);
    let length2 = leg.dot(leg);
    let share = if length2 > 0.0 { (off.dot(leg) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (off - leg * share).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(n: f64, e: f64, d: f64) -> Vec3<Ned> {
        Vec3::new(n, e, d)
    }

    #[test]
    fn exact_straight_legs_keep_endpoints_and_loops_are_removed() {
        let mut trail = FlownPath::default();
        trail.begin(at(0.0, 0.0, 0.0));
        // North 40 m, east 40 m, then back to the middle of the first leg.
        (1..=20).for_each(|k| trail.record(at(2.0 * f64::from(k), 0.0, 0.0)));
        (1..=20).for_each(|k| trail.record(at(40.0, 2.0 * f64::from(k), 0.0)));
        trail.simplify(SIMPLIFY_TOLERANCE_M);
        assert_eq!(trail.points, [at(0.0, 0.0, 0.0), at(40.0, 0.0, 0.0), at(40.0, 40.0, 0.0)]);
        trail.record(at(20.0, 1.0, 0.0));
        assert_eq!(trail.points, [at(0.0, 0.0, 0.0), at(20.0, 1.0, 0.0)]);
    }

    #[test]
    fn exact_long_path_respects_point_limit() {
        let mut trail = FlownPath::default();
        trail.begin(at(0.0, 0.0, 0.0));
        // A rising spiral has no straight legs and never crosses itself.
        for k in 1..20_000 {
            let angle = 0.05 * f64::from(k);
            let (s, c) = spandrel_model::math::sin_cos(angle);
            trail.record(at(50.0 * c, 50.0 * s, -3.0 * angle));
            assert!(trail.points.len() < MAX_POINTS);
        }
        assert_eq!(trail.points[0], at(0.0, 0.0, 0.0));
    }
}
