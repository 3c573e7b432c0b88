//! Model of how the pilot perceives the aircraft's motion, with delay and drifting error.

use super::skill::Skill;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Drifting position error of a trained pilot, m (1 sigma per axis; estimate).
const POSITION_ERROR_M: f64 = 0.4;
/// Correlation time of the position error, s (estimate).
const POSITION_ERROR_TAU_S: f64 = 4.0;
/// Drifting relative speed error of a trained pilot (1 sigma; estimate).
const RELATIVE_SPEED_ERROR: f64 = 0.13;
/// Correlation time of the speed error, s (estimate).
const SPEED_ERROR_TAU_S: f64 = 3.0;
/// Heading error of a trained pilot, rad (1 sigma; estimate).
const HEADING_ERROR_RAD: f64 = 0.03;

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
        Self { history: VecDeque::new(), random, position, speed, heading, last_speed_ratio: 1.0 }
    }

    /// Adds the current motion to the delay line.
    pub fn observe(&mut self, motion: MotionState) {
        self.history.push_back(motion);
        while self.history.len() > 2 && self.history[1].time + SimTime::from_s(1.0) < motion.time {
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

    /// Returns the perceived motion: delayed, not extrapolated, and with drifting errors.
    pub fn estimate(&mut self, skill: &Skill, dt_s: f64) -> Option<MotionState> {
        let truth = self.delayed_view(skill.delay_s)?;
        let mut offset = [0.0; 3];
        for (axis, drift) in self.position.iter_mut().enumerate() {
            offset[axis] = drift.step(dt_s, &mut self.random) * POSITION_ERROR_M * skill.noise;
        }
        let speed_error = self.speed.step(dt_s, &mut self.random) * RELATIVE_SPEED_ERROR * skill.noise;
        let heading_error = self.heading.step(dt_s, &mut self.random) * HEADING_ERROR_RAD * skill.noise;
        self.last_speed_ratio = (1.0 + speed_error).clamp(0.4, 2.0);
        Some(MotionState {
            time: truth.time,
            position_m: truth.position_m + Vec3::new(offset[0], offset[1], offset[2]),
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

    /// Discards the history after the aircraft has been repositioned.
    pub fn reset(&mut self) {
        self.history.clear();
    }
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
