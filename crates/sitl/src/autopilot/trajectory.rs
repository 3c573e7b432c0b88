//! The way through a mission's waypoints as a function of time: straight legs, rounded corners, bounded acceleration and jerk.
//!
//! Arc length `s` runs along the polyline of the waypoints. Within `reach` of a corner the direction turns smoothly from one leg's to the
//! next one's, so that position, velocity and acceleration are continuous. The speed along `s` obeys the corners and ends ahead.

use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::math;

/// Largest acceleration on a mission's way, m/s² (PX4: MPC_ACC_HOR 3; less, because light wind takes its share of the tilt).
const HORIZONTAL_M_S2: f64 = 2.0;
const VERTICAL_M_S2: f64 = 1.5;
/// Largest jerk along a leg and in a corner, m/s³ (PX4: MPC_JERK_AUTO 4).
const JERK_M_S3: f64 = 4.0;
const CORNER_JERK_M_S3: f64 = 2.5;
/// The speed follows its limit with this time constant, s.
const APPROACH_S: f64 = 0.25;
/// A corner is cut by at most this share of the waypoint's radius, and by at most so much, m.
const CUT_SHARE: f64 = 0.5;
const CUT_MOST_M: f64 = 2.0;
/// A corner is cut by this much for each metre of reach and unit of turned direction: 3/16 for the cubic blend below.
const CUT_PER_REACH: f64 = 0.1875;
/// Steeper legs than this are climbs: their speed is the climb's, not the mission's (sine of the slope, 60 degrees).
const STEEP: f64 = 0.866;
/// Waypoints nearer to each other than this are one, m.
const SAME_PLACE_M: f64 = 0.01;
/// What is left of a velocity off the way decays at this rate, 1/s (estimate: its jerk at 1 m/s is below 7 m/s³).
const JOIN_PER_S: f64 = 1.5;
/// The plan runs freely while the aircraft is this near to it, and waits for it from here on, m (estimate).
const FREE_M: f64 = 1.0;
const WAITS_M: f64 = 3.0;

/// A place to fly to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Waypoint {
    /// Where, m.
    pub position_m: Vec3<Ned>,
    /// Speed on the way to it, m/s; `None`: the usual one.
    pub speed_m_s: Option<f64>,
    /// It counts as reached within, m.
    pub accept_m: f64,
}

/// How fast the aircraft may go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedLimits {
    /// Where a leg names none, m/s.
    pub default_m_s: f64,
    /// At most, m/s.
    pub max_m_s: f64,
    /// Climb, m/s.
    pub up_m_s: f64,
    /// Descent, m/s.
    pub down_m_s: f64,
}

/// Accelerations that a plan may ask for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AccelerationLimits {
    horizontal_m_s2: f64,
    vertical_m_s2: f64,
}

impl AccelerationLimits {
    /// For an aircraft that can accelerate this much: the plan leaves half of it, and most of the climb's, to wind and errors.
    #[must_use]
    pub fn within(horizontal_m_s2: f64, vertical_m_s2: f64) -> Self {
        Self {
            horizontal_m_s2: HORIZONTAL_M_S2.min(0.5 * horizontal_m_s2),
            vertical_m_s2: VERTICAL_M_S2.min(0.7 * vertical_m_s2),
        }
    }

    /// Largest acceleration in a direction, m/s².
    fn along(&self, direction: Vec3<Ned>) -> f64 {
        let unit = direction.unit();
        (self.horizontal_m_s2 / unit.horizontal_norm().max(1e-9)).min(self.vertical_m_s2 / unit.down().abs().max(1e-9))
    }
}

/// Position, velocity and acceleration of the plan at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TrajectoryPoint {
    /// m.
    pub position_m: Vec3<Ned>,
    /// m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// m/s².
    pub acceleration_m_s2: Vec3<Ned>,
}

/// A straight part of the way.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Segment {
    from_m: Vec3<Ned>,
    to: Waypoint,
    unit: Vec3<Ned>,
    start_m: f64,
    length_m: f64,
    /// Half the length of the corner at its end, m; 0 at the last.
    reach_m: f64,
    /// Speed that this corner allows, m/s; 0 at the last.
    corner_m_s: f64,
    /// Largest acceleration along it, m/s².
    max_m_s2: f64,
}

/// The way with the progress on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    bounds: AccelerationLimits,
    legs: Vec<Segment>,
    along_m: f64,
    speed_m_s: f64,
    push_m_s2: f64,
    /// What is left of the state that the way was joined with.
    joining: TrajectoryPoint,
}

impl Trajectory {
    /// A way from a state of motion through waypoints; it ends at rest at the last. `None` without any.
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
        Some(Self { bounds, legs, along_m: 0.0, speed_m_s, push_m_s2: 0.0, joining })
    }

    /// The same way with other waypoints ahead: from the leg to the first of them on. False where it is not on this way.
    pub fn extend(&mut self, waypoints: &[Waypoint]) -> bool {
        let Some(first) = waypoints.first() else { return false };
        let now = self.leg_at(self.along_m);
        // A corner that is being flown still needs the leg before it.
        let keep = if now > 0 && self.along_m < self.legs[now].start_m + self.legs[now - 1].reach_m { now - 1 } else { now };
        let leads_there = |leg: &Segment| (leg.to.position_m - first.position_m).norm() < SAME_PLACE_M;
        let Some(next) = (keep..self.legs.len()).find(|k| leads_there(&self.legs[*k])) else { return false };
        let start = self.legs[keep];
        let kept = self.legs[keep..next].iter().map(|leg| leg.to);
        let ahead: Vec<Waypoint> = kept.chain(waypoints.iter().copied()).collect();
        self.along_m -= start.start_m;
        self.legs = legs(start.from_m, &ahead, &self.bounds);
        true
    }

    /// Whether the plan has flown through a place of this way that is not its end.
    #[must_use]
    pub fn has_passed(&self, place_m: Vec3<Ned>) -> bool {
        let through = self.legs.iter().rev().skip(1);
        through.filter(|leg| (leg.to.position_m - place_m).norm() < SAME_PLACE_M).any(|leg| self.along_m >= leg.end_m())
    }

    /// Goes on for one step. `behind_m` is how far the aircraft is from where it should be.
    pub fn advance(&mut self, speeds: &SpeedLimits, behind_m: f64, dt_s: f64) -> TrajectoryPoint {
        let waits = ((WAITS_M - behind_m) / (WAITS_M - FREE_M)).clamp(0.0, 1.0);
        let allowed = self.allowed_m_s(speeds) * waits;
        let most = self.legs[self.leg_at(self.along_m)].max_m_s2;
        let wish = ((allowed - self.speed_m_s) / APPROACH_S).clamp(-most, most);
        self.push_m_s2 += (wish - self.push_m_s2).clamp(-JERK_M_S3 * dt_s, JERK_M_S3 * dt_s);
        self.speed_m_s += self.push_m_s2 * dt_s;
        if self.speed_m_s < 0.0 {
            (self.speed_m_s, self.push_m_s2) = (0.0, 0.0);
        }
        self.along_m = (self.along_m + self.speed_m_s * dt_s).min(self.length_m());
        self.settle(dt_s);
        self.planned()
    }

    /// Critically damped decay, of third order: the acceleration stays continuous.
    fn settle(&mut self, dt_s: f64) {
        let (k, off) = (JOIN_PER_S, &mut self.joining);
        let jerk = off.acceleration_m_s2 * (-3.0 * k) + off.velocity_m_s * (-3.0 * k * k) + off.position_m * (-k * k * k);
        off.acceleration_m_s2 += jerk * dt_s;
        off.velocity_m_s += off.acceleration_m_s2 * dt_s;
        off.position_m += off.velocity_m_s * dt_s;
    }

    /// Where the plan is now.
    #[must_use]
    pub fn planned(&self) -> TrajectoryPoint {
        let (place, along, bend) = self.shape(self.along_m);
        TrajectoryPoint {
            position_m: place + self.joining.position_m,
            velocity_m_s: along * self.speed_m_s + self.joining.velocity_m_s,
            acceleration_m_s2: along * self.push_m_s2 + bend * (self.speed_m_s * self.speed_m_s) + self.joining.acceleration_m_s2,
        }
    }

    fn length_m(&self) -> f64 {
        self.legs.last().map_or(0.0, Segment::end_m)
    }

    fn leg_at(&self, along_m: f64) -> usize {
        self.legs.iter().position(|leg| along_m < leg.end_m()).unwrap_or(self.legs.len() - 1)
    }

    /// Place and its first and second derivative by arc length.
    fn shape(&self, along_m: f64) -> (Vec3<Ned>, Vec3<Ned>, Vec3<Ned>) {
        let k = self.leg_at(along_m);
        let leg = &self.legs[k];
        if leg.reach_m > 0.0 && along_m > leg.end_m() - leg.reach_m {
            return leg.corner(&self.legs[k + 1], along_m);
        }
        if let Some(before) = k.checked_sub(1).map(|k| &self.legs[k]).filter(|b| along_m < leg.start_m + b.reach_m) {
            return before.corner(leg, along_m);
        }
        (leg.from_m + leg.unit * (along_m - leg.start_m), leg.unit, Vec3::zero())
    }

    /// Speed that leg and corners ahead allow here, m/s.
    fn allowed_m_s(&self, speeds: &SpeedLimits) -> f64 {
        let now = self.leg_at(self.along_m);
        let mut allowed = self.legs[now].speed_m_s(speeds);
        if let Some(before) = now.checked_sub(1).map(|k| &self.legs[k])
            && self.along_m < self.legs[now].start_m + before.reach_m
        {
            allowed = allowed.min(before.corner_m_s);
        }
        // The speed follows late by the time constant.
        let lead_m = self.speed_m_s * APPROACH_S;
        for (k, leg) in self.legs.iter().enumerate().skip(now) {
            let after = self.legs.get(k + 1).map_or(0.0, |next| next.speed_m_s(speeds).min(leg.corner_m_s));
            let left_m = (leg.end_m() - leg.reach_m - self.along_m - lead_m).max(0.0);
            allowed = allowed.min(braking_speed(left_m, leg.max_m_s2, after));
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
        let wanted = self.to.speed_m_s.unwrap_or(speeds.default_m_s).min(speeds.max_m_s).max(0.1);
        if down.abs() > STEEP { climb.min(wanted / flat.max(1e-9)) } else { climb.min(wanted) }
    }

    /// The blend to the next leg: the direction turns by the cubic 3x² - 2x³.
    fn corner(&self, next: &Self, along_m: f64) -> (Vec3<Ned>, Vec3<Ned>, Vec3<Ned>) {
        let reach = self.reach_m;
        let x = ((along_m - (self.end_m() - reach)) / (2.0 * reach)).clamp(0.0, 1.0);
        let (turned, sum) = (x * x * (3.0 - 2.0 * x), x * x * x * (1.0 - 0.5 * x));
        let turn = next.unit - self.unit;
        let from = self.to.position_m - self.unit * reach;
        let place = from + self.unit * (2.0 * reach * x) + turn * (2.0 * reach * sum);
        (place, self.unit + turn * turned, turn * (6.0 * x * (1.0 - x) / (2.0 * reach)))
    }
}

/// Speed at which a way can be braked in time to another speed, the ramp of the deceleration included, m/s.
fn braking_speed(left_m: f64, most_m_s2: f64, after_m_s: f64) -> f64 {
    let ramp = 4.0 * most_m_s2 * most_m_s2 / JERK_M_S3;
    let speed = 0.5 * ((ramp * ramp + 4.0 * (2.0 * most_m_s2 * left_m + after_m_s * after_m_s)).sqrt() - ramp);
    speed.max(after_m_s)
}

/// Legs from a place through waypoints, with their corners.
fn legs(from_m: Vec3<Ned>, waypoints: &[Waypoint], bounds: &AccelerationLimits) -> Vec<Segment> {
    let mut legs: Vec<Segment> = Vec::with_capacity(waypoints.len());
    let mut at = from_m;
    for (k, to) in waypoints.iter().enumerate() {
        let way = to.position_m - at;
        let length_m = way.norm();
        // A lone place where the aircraft is already is a way, too.
        if length_m < SAME_PLACE_M && (!legs.is_empty() || k + 1 < waypoints.len()) {
            continue;
        }
        let start_m = legs.last().map_or(0.0, Segment::end_m);
        let unit = if length_m > 0.0 { way / length_m } else { Vec3::new(1.0, 0.0, 0.0) };
        legs.push(Segment {
            from_m: at,
            to: *to,
            unit,
            start_m,
            length_m,
            reach_m: 0.0,
            corner_m_s: 0.0,
            max_m_s2: bounds.along(unit),
        });
        at = to.position_m;
    }
    for k in 1..legs.len() {
        let (reach_m, corner_m_s) = corner(&legs[k - 1], &legs[k], bounds);
        (legs[k - 1].reach_m, legs[k - 1].corner_m_s) = (reach_m, corner_m_s);
    }
    legs
}

/// Half the length of the corner between two legs, m, and the speed that its acceleration and jerk allow, m/s.
fn corner(leg: &Segment, next: &Segment, bounds: &AccelerationLimits) -> (f64, f64) {
    let turn = next.unit - leg.unit;
    let bend = turn.norm();
    let room = 0.5 * leg.length_m.min(next.length_m);
    if bend < 1e-6 || room <= 0.0 {
        return (0.0, f64::INFINITY);
    }
    let cut_m = (CUT_SHARE * leg.to.accept_m).min(CUT_MOST_M);
    let reach = room.min(cut_m / (CUT_PER_REACH * bend));
    let by_acceleration = (bounds.along(turn) * 2.0 * reach / (1.5 * bend)).sqrt();
    let by_jerk = math::cbrt(CORNER_JERK_M_S3 * 4.0 * reach * reach / (6.0 * bend));
    (reach, by_acceleration.min(by_jerk))
}
