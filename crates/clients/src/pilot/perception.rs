//! Model of how the pilot perceives the aircraft's motion, with delay and drifting error.

use super::skill::Skill;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Correlation time of the position error, s (estimate).
const POSITION_ERROR_TAU_S: f64 = 4.0;
/// Drifting relative speed error of a trained pilot (1 sigma; estimate).
const RELATIVE_SPEED_ERROR: f64 = 0.13;
/// Correlation time of the speed error, s (estimate).
const SPEED_ERROR_TAU_S: f64 = 3.0;
/// Heading error of a trained pilot, rad (1 sigma; estimate).
const HEADING_ERROR_RAD: f64 = 0.03;
/// Correlation time of the error in perceived distances, s (estimate: until the surface looks different).
const DISTANCE_ERROR_TAU_S: f64 = 8.0;
/// Largest distance to a surface that affects where the pilot flies, m (estimate).
pub const MAX_JUDGED_DISTANCE_M: f64 = 8.0;
/// Distance to a surface below which the position relative to it is perceived more accurately, m: the error toward the surface
/// is proportional to the distance (Weber's law; the value is an estimate).
const FULL_ERROR_DISTANCE_M: f64 = 5.0;
/// Time in which a changed judgment of distance takes effect, s (estimate: two fixations).
const JUDGMENT_TAU_S: f64 = 0.6;

/// Factor of the position errors while a cue gives the direction and the distance to the path (estimate).
const CUED_UNCERTAINTY: f64 = 0.3;

/// The nearest surface, as seen from the aircraft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearSurface {
    /// True distance, m.
    pub distance_m: f64,
    /// Unit vector from the surface to the aircraft, ENU.
    pub normal: Vec3<Enu>,
}

/// Length of the delay line, s: the longest delay and the window of the turn rate.
const HISTORY_S: f64 = 1.2;

/// Motion of the aircraft at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionState {
    /// Simulation time of the sample.
    pub time: SimTime,
    /// Position, ENU, m.
    pub position_m: Vec3<Enu>,
    /// Velocity, ENU, m/s.
    pub velocity_m_s: Vec3<Enu>,
    /// Heading, rad clockwise from north.
    pub yaw_rad: f64,
}

/// An Ornstein-Uhlenbeck process with unit variance.
#[derive(Debug, Clone, PartialEq)]
pub struct DriftProcess {
    value: f64,
    tau_s: f64,
}

impl DriftProcess {
    /// Creates the process with a value drawn from its stationary distribution.
    pub fn new(tau_s: f64, random: &mut RandomStream) -> Self {
        Self { value: random.normal(), tau_s }
    }

    /// Advances by `dt_s` and returns the new value.
    pub fn step(&mut self, dt_s: f64, random: &mut RandomStream) -> f64 {
        let keep = math::exp(-dt_s / self.tau_s);
        self.value = keep * self.value + (1.0 - keep * keep).max(0.0).sqrt() * random.normal();
        self.value
    }
}

/// Delay line and drifting errors.
#[derive(Debug, Clone, PartialEq)]
pub struct Perception {
    history: VecDeque<MotionState>,
    random: RandomStream,
    position: [DriftProcess; 3],
    speed: DriftProcess,
    heading: DriftProcess,
    distance: DriftProcess,
    judged_offset_m: Vec3<Enu>,
    /// Factor of the position errors, which is lower while a cue tells the pilot where the path is.
    uncertainty: f64,
    last_speed_ratio: f64,
}

impl Perception {
    /// Creates the perception of a pilot from a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let mut random = RandomStream::new(seed, "pilot perception");
        let position = [(); 3].map(|()| DriftProcess::new(POSITION_ERROR_TAU_S, &mut random));
        let speed = DriftProcess::new(SPEED_ERROR_TAU_S, &mut random);
        let heading = DriftProcess::new(SPEED_ERROR_TAU_S, &mut random);
        let distance = DriftProcess::new(DISTANCE_ERROR_TAU_S, &mut random);
        let judged_offset_m = Vec3::zero();
        Self {
            history: VecDeque::new(),
            random,
            position,
            speed,
            heading,
            distance,
            judged_offset_m,
            uncertainty: 1.0,
            last_speed_ratio: 1.0,
        }
    }

    /// Adds the current motion to the delay line.
    pub fn observe(&mut self, motion: MotionState) {
        self.history.push_back(motion);
        while self.history.len() > 2 && self.history[1].time + SimTime::from_s(HISTORY_S) < motion.time {
            self.history.pop_front();
        }
    }

    /// Returns the motion from `delay_s` ago without error, as it appeared on the screen.
    #[must_use]
    pub fn delayed_view(&self, delay_s: f64) -> Option<MotionState> {
        let last = self.history.back()?;
        let wanted = last.time - SimTime::from_s(delay_s);
        self.history.iter().rev().find(|m| m.time <= wanted).or_else(|| self.history.front()).copied()
    }

    /// Returns the perceived motion: delayed, not extrapolated, and with drifting errors. A pilot who underestimates the
    /// distance to a surface believes that the aircraft is closer to it, and so keeps farther away. `cued`: whether a cue
    /// tells the pilot where the path is.
    pub fn estimate(&mut self, skill: &Skill, (surface, cued): (Option<NearSurface>, bool), dt_s: f64) -> Option<MotionState> {
        let truth = self.delayed_view(skill.delay_s)?;
        let mut offset = [0.0; 3];
        for (axis, drift) in self.position.iter_mut().enumerate() {
            offset[axis] = drift.step(dt_s, &mut self.random) * skill.position_error_m;
        }
        let offset_m = damped_near(Vec3::new(offset[0], offset[1], offset[2]), surface);
        let upward = surface.map_or(1.0, |near| upward_factor(skill.upward_distance_ratio, near.normal));
        let error = math::exp(skill.distance_error * self.distance.step(dt_s, &mut self.random));
        let perceived_ratio = skill.distance_ratio * upward * error;
        let judged = surface.map_or(Vec3::zero(), |near| near.normal * ((perceived_ratio - 1.0) * near.distance_m));
        let follow = 1.0 - math::exp(-dt_s / JUDGMENT_TAU_S);
        self.uncertainty += (if cued { CUED_UNCERTAINTY } else { 1.0 } - self.uncertainty) * follow;
        self.judged_offset_m += (judged - self.judged_offset_m) * follow;
        let speed_error = self.speed.step(dt_s, &mut self.random) * RELATIVE_SPEED_ERROR * skill.noise;
        let heading_error = self.heading.step(dt_s, &mut self.random) * HEADING_ERROR_RAD * skill.noise;
        self.last_speed_ratio = (1.0 + speed_error).clamp(0.4, 2.0);
        Some(MotionState {
            time: truth.time,
            position_m: truth.position_m + (offset_m + self.judged_offset_m) * self.uncertainty,
            velocity_m_s: truth.velocity_m_s * self.last_speed_ratio,
            yaw_rad: math::wrap_pi(truth.yaw_rad + heading_error),
        })
    }

    /// Returns the ratio of perceived to true speed. A pilot who overestimates their speed flies too slowly, and vice
    /// versa.
    #[must_use]
    pub fn perceived_speed_ratio(&self) -> f64 {
        self.last_speed_ratio
    }

    /// Returns the turn rate that the picture shows over the last 0.2 s, rad/s.
    #[must_use]
    pub fn turn_rate_rad_s(&self, delay_s: f64) -> f64 {
        const WINDOW_S: f64 = 0.2;
        let views = self.delayed_view(delay_s).zip(self.delayed_view(delay_s + WINDOW_S));
        views.map_or(0.0, |(now, before)| {
            let span_s = (now.time - before.time).s();
            if span_s > 0.0 { math::wrap_pi(now.yaw_rad - before.yaw_rad) / span_s } else { 0.0 }
        })
    }

    /// Discards the history after the aircraft has been repositioned.
    pub fn reset(&mut self) {
        self.history.clear();
        self.judged_offset_m = Vec3::zero();
    }
}

/// Returns the factor of the perceived distance to a surface with this normal: `ratio` for one straight above, 1 for a wall or the
/// ground, and in between in proportion to the cosine of the angle from straight above.
fn upward_factor(ratio: f64, normal: Vec3<Enu>) -> f64 {
    1.0 + (ratio - 1.0) * (-normal.up()).clamp(0.0, 1.0)
}

/// Reduces the part of a position error that points toward a nearby surface.
fn damped_near(offset_m: Vec3<Enu>, surface: Option<NearSurface>) -> Vec3<Enu> {
    let Some(near) = surface else { return offset_m };
    let kept = (near.distance_m / FULL_ERROR_DISTANCE_M).min(1.0);
    offset_m - near.normal * (offset_m.dot(near.normal) * (1.0 - kept))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_delayed_view_has_the_configured_delay() {
        let mut eyes = Perception::new(1);
        for ms in (0..=1000).step_by(20) {
            let t = SimTime::from_ms(ms);
            eyes.observe(MotionState {
                time: t,
                position_m: Vec3::new(t.s(), 0.0, 0.0),
                velocity_m_s: Vec3::zero(),
                yaw_rad: 0.0,
            });
        }
        assert_eq!(eyes.delayed_view(0.35).map(|m| m.time), Some(SimTime::from_ms(640)));
    }

    #[test]
    fn exact_underestimated_distance_moves_the_perceived_position_toward_the_surface() {
        let mut eyes = Perception::new(1);
        let still = |ms| MotionState {
            time: SimTime::from_ms(ms),
            position_m: Vec3::new(0.0, 4.0, 0.0),
            velocity_m_s: Vec3::zero(),
            yaw_rad: 0.0,
        };
        let skill = Skill { distance_ratio: 0.75, distance_error: 0.0, position_error_m: 0.0, delay_s: 0.0, ..Skill::EXPERT };
        let wall = Some(NearSurface { distance_m: 4.0, normal: Vec3::new(0.0, 1.0, 0.0) });
        let mut belief = None;
        for ms in (0..20_000).step_by(20) {
            eyes.observe(still(ms));
            belief = eyes.estimate(&skill, (wall, false), 0.02);
        }
        let north = belief.expect("observed").position_m.north();
        assert!((north - 3.0).abs() < 1e-9, "{north}");
    }

    #[test]
    fn exact_only_distances_to_surfaces_above_look_longer() {
        let facing = |up: f64| upward_factor(1.2, Vec3::new((1.0_f64 - up * up).sqrt(), 0.0, up));
        assert_eq!((facing(0.0), facing(1.0)), (1.0, 1.0));
        assert!((facing(-1.0) - 1.2).abs() < 1e-12 && (facing(-0.5) - 1.1).abs() < 1e-12);
    }

    #[test]
    fn exact_drift_has_unit_variance() {
        // Correlated samples: 40,000 s at 0.2 s with tau 4 s are equivalent to about 5,000 independent samples; the
        // tolerance is five standard errors.
        const TOLERANCE: f64 = 0.1;
        let mut random = RandomStream::new(3, "drift");
        let mut drift = DriftProcess::new(4.0, &mut random);
        let values: Vec<f64> = (0..200_000).map(|_| drift.step(0.2, &mut random)).collect();
        let variance = values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64;
        assert!((variance - 1.0).abs() < TOLERANCE, "{variance}");
    }
}
