//! Follows a moving target: PX4's follow-me (FLW_TGT_*) and ArduCopter's FOLLOW (FOLL_*).

use crate::autopilot::control::shaper::heading_of;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::math;
use spandrel_model::time::SimTime;

/// Timeout for target reports, s (PX4 and ArduCopter: 3 s).
const TARGET_TIMEOUT_S: f64 = 3.0;
/// Minimum target speed for a valid course, m/s (PX4: 1 m/s).
const MIN_COURSE_SPEED_M_S: f64 = 1.0;
/// Minimum time between positions for a velocity estimate, s; over shorter intervals, noise would dominate (estimate).
const MIN_REPORT_INTERVAL_S: f64 = 0.2;
/// Distance below which the heading no longer tracks the target, m.
const HEADING_MIN_DISTANCE_M: f64 = 0.5;

/// Vehicle position relative to the target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FollowPosition {
    /// At a distance from the target and an angle from its course (PX4).
    Around {
        /// Horizontal distance, m.
        distance_m: f64,
        /// Angle from the course, rad clockwise.
        angle_rad: f64,
        /// Height above the target or home, m.
        height_m: f64,
        /// Whether the height is relative to the target rather than home.
        relative_to_target: bool,
    },
    /// At an offset: north, east and down, or forward, right and down relative to the target's course (ArduCopter).
    Offset {
        /// Offset, m. `None` uses the offset at the first report.
        offset_m: Option<[f64; 3]>,
        /// Whether the offset rotates with the target's course.
        rotates_with_course: bool,
    },
}

/// Follow mode settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FollowRule {
    /// Whether the mode is enabled (`FOLL_ENABLE`).
    pub enabled: bool,
    /// Position relative to the target.
    pub position: FollowPosition,
    /// Maximum distance at which a target is followed, m (`FOLL_DIST_MAX`).
    pub max_distance_m: f64,
    /// Maximum speed, m/s (`FLW_TGT_MAX_VEL`).
    pub max_speed_m_s: f64,
    /// Weight of the previous velocity in the smoothed velocity, 0 to 1 (`FLW_TGT_RS`).
    pub smoothing: f64,
}

impl Default for FollowRule {
    fn default() -> Self {
        let place = FollowPosition::Around { distance_m: 8.0, angle_rad: math::PI, height_m: 8.0, relative_to_target: false };
        Self { enabled: true, position: place, max_distance_m: f64::INFINITY, max_speed_m_s: 5.0, smoothing: 0.1 }
    }
}

/// A target report.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FollowTarget {
    /// Position relative to the origin, m.
    pub position_m: Vec3<Ned>,
    /// Velocity, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Heading, rad, if reported.
    pub heading_rad: Option<f64>,
}

/// The latest target report and the state derived from it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Follower {
    latest: Option<(FollowTarget, SimTime)>,
    course_rad: Option<f64>,
    offset_m: Option<Vec3<Ned>>,
}

impl Follower {
    /// Starts following: takes the course and the offset from the next reports.
    pub fn begin(&mut self) {
        (self.course_rad, self.offset_m) = (None, None);
    }

    /// Returns the velocity, in m/s, of a target that reports only positions, computed from its last two positions.
    #[must_use]
    pub fn target_velocity(&self, position_m: Vec3<Ned>, now: SimTime) -> Vec3<Ned> {
        let recent = self.latest.map(|(before, at)| (before, (now - at).s())).filter(|(_, age_s)| *age_s <= TARGET_TIMEOUT_S);
        match recent {
            Some((before, age_s)) if age_s >= MIN_REPORT_INTERVAL_S => (position_m - before.position_m) * (1.0 / age_s),
            Some((before, _)) => before.velocity_m_s,
            None => Vec3::zero(),
        }
    }

    /// Handles a target report.
    pub fn report(&mut self, target: FollowTarget, rule: &FollowRule, now: SimTime) {
        let known = self.latest.filter(|(_, at)| (now - *at).s() <= TARGET_TIMEOUT_S).map(|(known, _)| known.velocity_m_s);
        let before = known.unwrap_or(target.velocity_m_s);
        let smooth = rule.smoothing.clamp(0.0, 0.99);
        let velocity_m_s = before * smooth + target.velocity_m_s * (1.0 - smooth);
        self.latest = Some((FollowTarget { velocity_m_s, ..target }, now));
        let moving = target.velocity_m_s.horizontal_norm() > MIN_COURSE_SPEED_M_S;
        let course = moving.then(|| heading_of(target.velocity_m_s, 0.0)).flatten();
        self.course_rad = target.heading_rad.or(course).or(self.course_rad);
    }

    /// Returns the extrapolated target, or `None` if its reports have timed out or it is too far from `here_m`. The timeout
    /// scales with `client_speed_factor`.
    #[must_use]
    pub fn target(&self, rule: &FollowRule, here_m: Vec3<Ned>, client_speed_factor: f64, now: SimTime) -> Option<FollowTarget> {
        let (target, at) = self.latest?;
        let age_s = (now - at).s();
        let position_m = target.position_m + target.velocity_m_s * age_s;
        let far = (position_m - here_m).norm() > rule.max_distance_m;
        (age_s <= TARGET_TIMEOUT_S * client_speed_factor && !far).then_some(FollowTarget { position_m, ..target })
    }

    /// Returns the desired vehicle position for a target, in meters.
    pub fn desired_position(
        &mut self,
        target: &FollowTarget,
        rule: &FollowRule,
        here_m: Vec3<Ned>,
        home_m: Option<Vec3<Ned>>,
    ) -> Vec3<Ned> {
        let there = target.position_m;
        let turned = |angle: f64, [forward, right, down]: [f64; 3]| {
            let (s, c) = math::sin_cos(angle);
            Vec3::<Ned>::new(c * forward - s * right, s * forward + c * right, down)
        };
        match rule.position {
            FollowPosition::Around { distance_m, angle_rad, height_m, relative_to_target: over_target } => {
                // Until the target moves, assume a course for which the vehicle is already at the configured angle.
                let bearing = heading_of(here_m - there, HEADING_MIN_DISTANCE_M).unwrap_or(0.0);
                let course = *self.course_rad.get_or_insert(math::wrap_pi(bearing - angle_rad));
                let flat = turned(course + angle_rad, [distance_m, 0.0, 0.0]);
                let ground = if over_target { there } else { home_m.unwrap_or(there) };
                Vec3::new(there.north() + flat.north(), there.east() + flat.east(), ground.down() - height_m)
            }
            FollowPosition::Offset { offset_m: Some(offset), rotates_with_course: along_course } => {
                let course = self.course_rad.filter(|_| along_course).unwrap_or(0.0);
                there + turned(course, offset)
            }
            FollowPosition::Offset { offset_m: None, .. } => there + *self.offset_m.get_or_insert(here_m - there),
        }
    }
}
