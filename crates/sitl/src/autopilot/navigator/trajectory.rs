//! Time-parameterized trajectory through mission waypoints: straight legs, rounded corners, limited acceleration and jerk.
//!
//! Arc length `s` runs along the polyline of the waypoints. Within `reach` of a corner the direction turns smoothly
//! from one leg to the next, so position, velocity and acceleration are continuous. The corners and the end of the path
//! limit the speed along `s`.

use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::math;

/// Maximum acceleration in missions, m/s² (PX4: MPC_ACC_HOR 3; lower here to leave part of the tilt for wind).
const MAX_HORIZONTAL_ACCELERATION_M_S2: f64 = 2.0;
const MAX_VERTICAL_ACCELERATION_M_S2: f64 = 1.5;
/// Maximum jerk along a leg and in a corner, m/s³ (PX4: MPC_JERK_AUTO 4).
const MAX_JERK_M_S3: f64 = 4.0;
const MAX_CORNER_JERK_M_S3: f64 = 2.5;
/// Time constant with which the speed approaches its limit, s.
const SPEED_TIME_CONSTANT_S: f64 = 0.25;
/// Maximum corner cut, as a fraction of the acceptance radius and as a distance, m.
const CORNER_CUT_FRACTION: f64 = 0.5;
const MAX_CORNER_CUT_M: f64 = 2.0;
/// Corner cut per meter of reach and unit of direction change: 3/16 for the cubic blend below.
const CORNER_CUT_PER_REACH: f64 = 0.1875;
/// Sine of the slope above which a leg is flown at climb or descent speed (60 degrees).
const STEEP_SLOPE_SINE: f64 = 0.866;
/// Distance below which waypoints count as identical, m.
const COINCIDENT_DISTANCE_M: f64 = 0.01;
/// Decay rate of the initial cross-track velocity, 1/s (estimate: for 1 m/s, the jerk is below 7 m/s³).
const JOIN_DECAY_RATE_PER_S: f64 = 1.5;
/// Tracking errors at which the plan starts to slow down and at which it stops, m (estimate).
const SLOWDOWN_ERROR_M: f64 = 1.0;
const STOP_ERROR_M: f64 = 3.0;

/// A position to fly to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Waypoint {
    /// Position, m.
    pub position_m: Vec3<Ned>,
    /// Speed toward it, m/s; `None` for the default.
    pub speed_m_s: Option<f64>,
    /// Acceptance radius, m.
    pub acceptance_radius_m: f64,
}

/// Speed limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedLimits {
    /// Default leg speed, m/s.
    pub default_speed_m_s: f64,
    /// Maximum speed, m/s.
    pub max_m_s: f64,
    /// Climb rate, m/s.
    pub up_m_s: f64,
    /// Descent rate, m/s.
    pub down_m_s: f64,
}

/// Acceleration limits of a plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AccelerationLimits {
    horizontal_acceleration_m_s2: f64,
    vertical_acceleration_m_s2: f64,
}

impl AccelerationLimits {
    /// Creates limits for an aircraft with this acceleration. Reserves 50% of the horizontal and 30% of the vertical
    /// acceleration for wind and control errors.
    #[must_use]
    pub fn within(horizontal_acceleration_m_s2: f64, vertical_acceleration_m_s2: f64) -> Self {
        Self {
            horizontal_acceleration_m_s2: MAX_HORIZONTAL_ACCELERATION_M_S2.min(0.5 * horizontal_acceleration_m_s2),
            vertical_acceleration_m_s2: MAX_VERTICAL_ACCELERATION_M_S2.min(0.7 * vertical_acceleration_m_s2),
        }
    }

    /// Maximum acceleration in a direction, m/s².
    fn along(&self, direction: Vec3<Ned>) -> f64 {
        let unit = direction.unit();
        (self.horizontal_acceleration_m_s2 / unit.horizontal_norm().max(1e-9))
            .min(self.vertical_acceleration_m_s2 / unit.down().abs().max(1e-9))
    }
}

/// Position, velocity and acceleration of the plan at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TrajectoryPoint {
    /// Position, m.
    pub position_m: Vec3<Ned>,
    /// Velocity, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Acceleration, m/s².
    pub acceleration_m_s2: Vec3<Ned>,
}

/// A straight leg.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Segment {
    from_m: Vec3<Ned>,
    to: Waypoint,
    unit: Vec3<Ned>,
    start_m: f64,
    length_m: f64,
    /// Half the length of the corner at its end, m; 0 for the last leg.
    reach_m: f64,
    /// Speed limit of that corner, m/s; 0 for the last leg.
    corner_speed_m_s: f64,
    /// Maximum acceleration along the leg, m/s².
    max_acceleration_m_s2: f64,
}

/// The trajectory and its progress.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    bounds: AccelerationLimits,
    legs: Vec<Segment>,
    path_distance_m: f64,
    speed_m_s: f64,
    acceleration_m_s2: f64,
    /// Remaining offset from the motion state at the time of joining.
    join_offset: TrajectoryPoint,
}

impl Trajectory {
    /// Creates a trajectory from a motion state through waypoints. It ends at rest at the last waypoint. Returns `None`
    /// if there are no waypoints.
    #[must_use]
    pub fn join(from: TrajectoryPoint, waypoints: &[Waypoint], bounds: AccelerationLimits) -> Option<Self> {
        let legs = legs(from.position_m, waypoints, &bounds);
        let first = legs.first()?;
        let speed_m_s = from.velocity_m_s.dot(first.unit).max(0.0);
        let joining = TrajectoryPoint {
            position_m: Vec3::zero(),
            velocity_m_s: from.velocity_m_s - first.unit * speed_m_s,
            acceleration_m_s2: from.acceleration_m_s2,
        };
        Some(Self { bounds, legs, path_distance_m: 0.0, speed_m_s, acceleration_m_s2: 0.0, join_offset: joining })
    }

    /// Replaces the waypoints from the first of `waypoints` onward. Returns false if that waypoint is not on this
    /// trajectory.
    pub fn extend(&mut self, waypoints: &[Waypoint]) -> bool {
        let Some(first) = waypoints.first() else { return false };
        let now = self.leg_at(self.path_distance_m);
        // A corner in progress still needs its incoming leg.
        let keep =
            if now > 0 && self.path_distance_m < self.legs[now].start_m + self.legs[now - 1].reach_m { now - 1 } else { now };
        let leads_there = |leg: &Segment| (leg.to.position_m - first.position_m).norm() < COINCIDENT_DISTANCE_M;
        let Some(next) = (keep..self.legs.len()).find(|k| leads_there(&self.legs[*k])) else { return false };
        let start = self.legs[keep];
        let kept = self.legs[keep..next].iter().map(|leg| leg.to);
        let ahead: Vec<Waypoint> = kept.chain(waypoints.iter().copied()).collect();
        self.path_distance_m -= start.start_m;
        self.legs = legs(start.from_m, &ahead, &self.bounds);
        true
    }

    /// Returns true if the plan has passed a waypoint other than the last.
    #[must_use]
    pub fn has_passed(&self, position_m: Vec3<Ned>) -> bool {
        let through = self.legs.iter().rev().skip(1);
        through
            .filter(|leg| (leg.to.position_m - position_m).norm() < COINCIDENT_DISTANCE_M)
            .any(|leg| self.path_distance_m >= leg.end_m())
    }

    /// Advances the plan by one step. `behind_m` is the aircraft's tracking error.
    pub fn advance(&mut self, speeds: &SpeedLimits, behind_m: f64, dt_s: f64) -> TrajectoryPoint {
        let waits = ((STOP_ERROR_M - behind_m) / (STOP_ERROR_M - SLOWDOWN_ERROR_M)).clamp(0.0, 1.0);
        let allowed = self.allowed_speed_m_s(speeds) * waits;
        let max_m_s2 = self.legs[self.leg_at(self.path_distance_m)].max_acceleration_m_s2;
        let wanted = ((allowed - self.speed_m_s) / SPEED_TIME_CONSTANT_S).clamp(-max_m_s2, max_m_s2);
        self.acceleration_m_s2 += (wanted - self.acceleration_m_s2).clamp(-MAX_JERK_M_S3 * dt_s, MAX_JERK_M_S3 * dt_s);
        self.speed_m_s += self.acceleration_m_s2 * dt_s;
        if self.speed_m_s < 0.0 {
            (self.speed_m_s, self.acceleration_m_s2) = (0.0, 0.0);
        }
        self.path_distance_m = (self.path_distance_m + self.speed_m_s * dt_s).min(self.length_m());
        self.decay_join_offset(dt_s);
        self.planned()
    }

    /// Third-order critically damped decay, which keeps the acceleration continuous.
    fn decay_join_offset(&mut self, dt_s: f64) {
        let (k, off) = (JOIN_DECAY_RATE_PER_S, &mut self.join_offset);
        let jerk = off.acceleration_m_s2 * (-3.0 * k) + off.velocity_m_s * (-3.0 * k * k) + off.position_m * (-k * k * k);
        off.acceleration_m_s2 += jerk * dt_s;
        off.velocity_m_s += off.acceleration_m_s2 * dt_s;
        off.position_m += off.velocity_m_s * dt_s;
    }

    /// Current state of the plan.
    #[must_use]
    pub fn planned(&self) -> TrajectoryPoint {
        let (place, along, bend) = self.shape(self.path_distance_m);
        TrajectoryPoint {
            position_m: place + self.join_offset.position_m,
            velocity_m_s: along * self.speed_m_s + self.join_offset.velocity_m_s,
            acceleration_m_s2: along * self.acceleration_m_s2
                + bend * (self.speed_m_s * self.speed_m_s)
                + self.join_offset.acceleration_m_s2,
        }
    }

    fn length_m(&self) -> f64 {
        self.legs.last().map_or(0.0, Segment::end_m)
    }

    fn leg_at(&self, path_distance_m: f64) -> usize {
        self.legs.iter().position(|leg| path_distance_m < leg.end_m()).unwrap_or(self.legs.len() - 1)
    }

    /// Position and its first and second derivatives with respect to arc length.
    fn shape(&self, path_distance_m: f64) -> (Vec3<Ned>, Vec3<Ned>, Vec3<Ned>) {
        let k = self.leg_at(path_distance_m);
        let leg = &self.legs[k];
        if leg.reach_m > 0.0 && path_distance_m > leg.end_m() - leg.reach_m {
            return leg.corner(&self.legs[k + 1], path_distance_m);
        }
        if let Some(before) = k.checked_sub(1).map(|k| &self.legs[k]).filter(|b| path_distance_m < leg.start_m + b.reach_m) {
            return before.corner(leg, path_distance_m);
        }
        (leg.from_m + leg.unit * (path_distance_m - leg.start_m), leg.unit, Vec3::zero())
    }

    /// Speed limit at this point from the leg and the corners ahead, m/s.
    fn allowed_speed_m_s(&self, speeds: &SpeedLimits) -> f64 {
        let now = self.leg_at(self.path_distance_m);
        let mut allowed = self.legs[now].speed_m_s(speeds);
        if let Some(before) = now.checked_sub(1).map(|k| &self.legs[k])
            && self.path_distance_m < self.legs[now].start_m + before.reach_m
        {
            allowed = allowed.min(before.corner_speed_m_s);
        }
        // The speed lags its limit by the time constant.
        let lead_m = self.speed_m_s * SPEED_TIME_CONSTANT_S;
        for (k, leg) in self.legs.iter().enumerate().skip(now) {
            let after = self.legs.get(k + 1).map_or(0.0, |next| next.speed_m_s(speeds).min(leg.corner_speed_m_s));
            let left_m = (leg.end_m() - leg.reach_m - self.path_distance_m - lead_m).max(0.0);
            allowed = allowed.min(braking_speed(left_m, leg.max_acceleration_m_s2, after));
        }
        allowed
    }
}

impl Segment {
    fn end_m(&self) -> f64 {
        self.start_m + self.length_m
    }

    fn speed_m_s(&self, speeds: &SpeedLimits) -> f64 {
        let (flat, down) = (self.unit.horizontal_norm(), self.unit.down());
        let vertical = if down < 0.0 { speeds.up_m_s } else { speeds.down_m_s };
        let climb = vertical / down.abs().max(1e-9);
        let wanted = self.to.speed_m_s.unwrap_or(speeds.default_speed_m_s).min(speeds.max_m_s).max(0.1);
        if down.abs() > STEEP_SLOPE_SINE { climb.min(wanted / flat.max(1e-9)) } else { climb.min(wanted) }
    }

    /// Blend into the next leg: the direction follows the cubic 3x² - 2x³.
    fn corner(&self, next: &Self, path_distance_m: f64) -> (Vec3<Ned>, Vec3<Ned>, Vec3<Ned>) {
        let reach = self.reach_m;
        let x = ((path_distance_m - (self.end_m() - reach)) / (2.0 * reach)).clamp(0.0, 1.0);
        let (turned, sum) = (x * x * (3.0 - 2.0 * x), x * x * x * (1.0 - 0.5 * x));
        let turn = next.unit - self.unit;
        let from = self.to.position_m - self.unit * reach;
        let place = from + self.unit * (2.0 * reach * x) + turn * (2.0 * reach * sum);
        (place, self.unit + turn * turned, turn * (6.0 * x * (1.0 - x) / (2.0 * reach)))
    }
}

/// Maximum speed from which the vehicle can brake to another speed in the remaining distance, including the deceleration ramp,
/// m/s.
fn braking_speed(left_m: f64, max_acceleration_m_s2: f64, after_m_s: f64) -> f64 {
    let ramp = 4.0 * max_acceleration_m_s2 * max_acceleration_m_s2 / MAX_JERK_M_S3;
    let speed = 0.5 * ((ramp * ramp + 4.0 * (2.0 * max_acceleration_m_s2 * left_m + after_m_s * after_m_s)).sqrt() - ramp);
    speed.max(after_m_s)
}

/// Builds the legs through the waypoints, with their corners.
fn legs(from_m: Vec3<Ned>, waypoints: &[Waypoint], bounds: &AccelerationLimits) -> Vec<Segment> {
    let mut legs: Vec<Segment> = Vec::with_capacity(waypoints.len());
    let mut at = from_m;
    for (k, to) in waypoints.iter().enumerate() {
        let offset = to.position_m - at;
        let length_m = offset.norm();
        // A single waypoint at the current position is still a valid trajectory.
        if length_m < COINCIDENT_DISTANCE_M && (!legs.is_empty() || k + 1 < waypoints.len()) {
            continue;
        }
        let start_m = legs.last().map_or(0.0, Segment::end_m);
        let unit = if length_m > 0.0 { offset / length_m } else { Vec3::new(1.0, 0.0, 0.0) };
        legs.push(Segment {
            from_m: at,
            to: *to,
            unit,
            start_m,
            length_m,
            reach_m: 0.0,
            corner_speed_m_s: 0.0,
            max_acceleration_m_s2: bounds.along(unit),
        });
        at = to.position_m;
    }
    for k in 1..legs.len() {
        let (reach_m, corner_m_s) = corner(&legs[k - 1], &legs[k], bounds);
        (legs[k - 1].reach_m, legs[k - 1].corner_speed_m_s) = (reach_m, corner_m_s);
    }
    legs
}

/// Half the length of the corner between two legs, m, and the speed limit from its acceleration and jerk, m/s.
fn corner(leg: &Segment, next: &Segment, bounds: &AccelerationLimits) -> (f64, f64) {
    let turn = next.unit - leg.unit;
    let bend = turn.norm();
    let room = 0.5 * leg.length_m.min(next.length_m);
    if bend < 1e-6 || room <= 0.0 {
        return (0.0, f64::INFINITY);
    }
    let cut_m = (CORNER_CUT_FRACTION * leg.to.acceptance_radius_m).min(MAX_CORNER_CUT_M);
    let reach = room.min(cut_m / (CORNER_CUT_PER_REACH * bend));
    let by_acceleration = (bounds.along(turn) * 2.0 * reach / (1.5 * bend)).sqrt();
    let by_jerk = math::cbrt(MAX_CORNER_JERK_M_S3 * 4.0 * reach * reach / (6.0 * bend));
    (reach, by_acceleration.min(by_jerk))
}
