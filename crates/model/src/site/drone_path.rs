//! Position of a drone on its path as a function of time: it accelerates evenly, flies at its speed, brakes evenly to a stop at each
//! point, and waits there.

use crate::frames::{Enu, Vec3};
use crate::scenario::DroneSpec;

/// Acceleration and deceleration along the path, m/s² (estimate: a gentle survey flight).
pub const ACCELERATION_M_S2: f64 = 2.0;
/// Length below which the way back to the first point needs no flight, m.
const MIN_LENGTH_M: f64 = 1e-6;

/// Position and velocity at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathState {
    /// Position of the center of mass, m.
    pub position_m: Vec3<Enu>,
    /// Velocity, m/s.
    pub velocity_m_s: Vec3<Enu>,
}

/// A straight flight between two points, from rest to rest.
#[derive(Debug, Clone, PartialEq)]
struct Leg {
    from_m: Vec3<Enu>,
    to_m: Vec3<Enu>,
    /// Time after the start of the path at which it begins, s.
    begin_s: f64,
    peak_m_s: f64,
    duration_s: f64,
}

impl Leg {
    fn new(from_m: Vec3<Enu>, to_m: Vec3<Enu>, speed_m_s: f64, begin_s: f64) -> Self {
        let length_m = (to_m - from_m).norm();
        // A short leg ends before the drone reaches its speed.
        let peak_m_s = speed_m_s.min((length_m * ACCELERATION_M_S2).sqrt());
        Self { from_m, to_m, begin_s, peak_m_s, duration_s: length_m / peak_m_s + peak_m_s / ACCELERATION_M_S2 }
    }

    /// Returns the state `t_s` after the leg's beginning; it stays at the end afterward.
    fn at(&self, t_s: f64) -> PathState {
        let (left_s, ramp_s) = (self.duration_s - t_s, self.peak_m_s / ACCELERATION_M_S2);
        let along = (self.to_m - self.from_m).unit();
        let (position_m, speed_m_s) = if left_s <= 0.0 {
            (self.to_m, 0.0)
        } else if t_s < ramp_s {
            (self.from_m + along * (0.5 * ACCELERATION_M_S2 * t_s * t_s), ACCELERATION_M_S2 * t_s)
        } else if left_s < ramp_s {
            (self.to_m - along * (0.5 * ACCELERATION_M_S2 * left_s * left_s), ACCELERATION_M_S2 * left_s)
        } else {
            (self.from_m + along * (self.peak_m_s * (t_s - 0.5 * ramp_s)), self.peak_m_s)
        };
        PathState { position_m, velocity_m_s: along * speed_m_s }
    }
}

/// Path of a drone over time.
#[derive(Debug, Clone, PartialEq)]
pub struct DronePath {
    first_m: Vec3<Enu>,
    legs: Vec<Leg>,
    start_s: f64,
    /// Time after which the path repeats, s; `None` if the drone stays at the last point.
    period_s: Option<f64>,
}

impl DronePath {
    /// Creates the path of a drone that leaves its first point at `start_s`.
    #[must_use]
    pub fn new(spec: &DroneSpec, start_s: f64) -> Self {
        let first_m = spec.points_m.first().copied().unwrap_or_else(Vec3::zero);
        let (mut legs, mut here_m, mut now_s) = (Vec::new(), first_m, 0.0);
        let back = spec.repeat.then_some(first_m);
        for to_m in spec.points_m.iter().skip(1).copied().chain(back) {
            if (to_m - here_m).norm() > MIN_LENGTH_M {
                let leg = Leg::new(here_m, to_m, spec.speed_m_s, now_s);
                now_s += leg.duration_s + spec.wait_s;
                here_m = to_m;
                legs.push(leg);
            }
        }
        let period_s = (spec.repeat && !legs.is_empty()).then_some(now_s);
        Self { first_m, legs, start_s, period_s }
    }

    /// Returns the position and the velocity at a simulation time, s.
    #[must_use]
    pub fn at(&self, time_s: f64) -> PathState {
        let since_s = time_s - self.start_s;
        let since_s = self.period_s.filter(|_| since_s > 0.0).map_or(since_s, |period_s| since_s.rem_euclid(period_s));
        let begun = self.legs.partition_point(|leg| leg.begin_s < since_s);
        match begun.checked_sub(1).and_then(|k| self.legs.get(k)) {
            Some(leg) => leg.at(since_s - leg.begin_s),
            None => PathState { position_m: self.first_m, velocity_m_s: Vec3::zero() },
        }
    }

    /// Returns points along the path that are at most `step_m` apart.
    pub fn sampled(&self, step_m: f64) -> impl Iterator<Item = Vec3<Enu>> + '_ {
        sampled(self.segments(), step_m)
    }

    /// Returns the straight parts of the path, or one of length 0 at a single point.
    pub fn segments(&self) -> impl Iterator<Item = (Vec3<Enu>, Vec3<Enu>)> + '_ {
        let still = self.legs.is_empty().then_some((self.first_m, self.first_m));
        self.legs.iter().map(|leg| (leg.from_m, leg.to_m)).chain(still)
    }
}

/// Returns points along a path of straight segments that are at most `step_m` apart.
pub fn sampled(segments: impl Iterator<Item = (Vec3<Enu>, Vec3<Enu>)>, step_m: f64) -> impl Iterator<Item = Vec3<Enu>> {
    segments.flat_map(move |(from, to)| {
        let count = ((to - from).norm() / step_m).ceil().max(1.0) as u32;
        (0..=count).map(move |k| from.lerp(to, f64::from(k) / f64::from(count)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding tolerance.
    const TOLERANCE: f64 = 1e-9;

    fn spec(points_m: &[[f64; 3]], speed_m_s: f64, wait_s: f64, repeat: bool) -> DroneSpec {
        DroneSpec {
            name: "other".into(),
            vehicle: "phantom2",
            points_m: points_m.iter().map(|[e, n, u]| Vec3::new(*e, *n, *u)).collect(),
            speed_m_s,
            heading_deg: 0.0,
            at_s: 0.0,
            spread_s: 0.0,
            wait_s,
            repeat,
        }
    }

    #[test]
    fn exact_times_of_a_leg_follow_from_even_acceleration() {
        // 4 m/s after 2 s and 4 m; 12 m at 4 m/s take 3 s; 2 s and 4 m of braking: 20 m in 7 s.
        let path = DronePath::new(&spec(&[[0.0, 0.0, 10.0], [20.0, 0.0, 10.0]], 4.0, 0.0, false), 100.0);
        for (at_s, east, speed) in
            [(0.0, 0.0, 0.0), (101.0, 1.0, 2.0), (102.0, 4.0, 4.0), (105.0, 16.0, 4.0), (106.0, 19.0, 2.0), (107.0, 20.0, 0.0)]
        {
            let state = path.at(at_s);
            assert!((state.position_m - Vec3::new(east, 0.0, 10.0)).norm() < TOLERANCE, "{at_s}: {state:?}");
            assert!((state.velocity_m_s - Vec3::new(speed, 0.0, 0.0)).norm() < TOLERANCE, "{at_s}: {state:?}");
        }
        assert_eq!(path.at(1e6).position_m, Vec3::new(20.0, 0.0, 10.0), "it stays at the last point");
        // 2 m are too short for 4 m/s: 1 s to 2 m/s, 1 s of braking.
        let short = DronePath::new(&spec(&[[0.0, 0.0, 10.0], [0.0, 2.0, 10.0]], 4.0, 0.0, false), 0.0);
        assert!((short.at(1.0).velocity_m_s.north() - 2.0).abs() < TOLERANCE);
        assert!((short.at(1.5).position_m.north() - 1.75).abs() < TOLERANCE);
    }

    #[test]
    fn exact_path_repeats_after_all_legs_and_waits() {
        // Three legs of 20 m, 15 m and 25 m at 4 m/s: L/v + v/a = 7 s, 5.75 s and 8.25 s, and 1.5 s of waiting after each.
        let points = [[0.0, 0.0, 10.0], [20.0, 0.0, 10.0], [20.0, 15.0, 10.0]];
        let path = DronePath::new(&spec(&points, 4.0, 1.5, true), 3.0);
        let period_s = 7.0 + 5.75 + 8.25 + 3.0 * 1.5;
        assert!((path.period_s.unwrap() - period_s).abs() < TOLERANCE);
        assert_eq!(path.segments().count(), 3);
        for k in 0..500 {
            let at_s = 3.0 + 0.1 * f64::from(k);
            let (a, b) = (path.at(at_s), path.at(at_s + 2.0 * period_s));
            assert!((a.position_m - b.position_m).norm() < 1e-6, "{at_s}");
        }
        assert!((path.at(10.7).position_m - Vec3::new(20.0, 0.0, 10.0)).norm() < TOLERANCE, "it waits at the second point");
        assert_eq!(path.at(10.7).velocity_m_s, Vec3::zero());
        let hovering = DronePath::new(&spec(&points[..1], 4.0, 1.5, true), 3.0);
        assert_eq!(hovering.at(50.0), PathState { position_m: Vec3::new(0.0, 0.0, 10.0), velocity_m_s: Vec3::zero() });
        assert_eq!(hovering.segments().count(), 1);
    }

    #[test]
    fn prop_velocity_is_the_derivative_of_the_position() {
        let points = [[0.0, 0.0, 10.0], [20.0, 0.0, 10.0], [20.0, 1.0, 10.5], [3.0, 15.0, 30.0]];
        let path = DronePath::new(&spec(&points, 4.0, 0.7, true), 2.0);
        let step_s = 1e-3;
        for k in 0..60_000 {
            let at_s = step_s * f64::from(k);
            let (a, b) = (path.at(at_s), path.at(at_s + step_s));
            let mean = (b.position_m - a.position_m) / step_s;
            // Within one step, even acceleration changes the velocity by less than this.
            assert!((mean - a.velocity_m_s).norm() <= 1.5 * ACCELERATION_M_S2 * step_s, "{at_s}");
        }
    }
}
