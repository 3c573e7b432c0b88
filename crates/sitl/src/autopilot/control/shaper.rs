//! Shapes position and velocity targets into a velocity that the aircraft can follow, with limited acceleration and
//! jerk and timely braking.

use super::gains::Gains;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::math;

/// Time constant of the final approach to the target velocity, s.
const APPROACH_TIME_CONSTANT_S: f64 = 0.25;
/// Time to build up full acceleration, s.
pub const ACCELERATION_RAMP_S: f64 = 0.15;
/// Time to build up full horizontal acceleration in a mission or return, s (estimate: a tilt rate of about 50 deg/s).
pub const AUTO_ACCELERATION_RAMP_S: f64 = 0.5;

/// Fraction of the jerk that the end of an acceleration uses. The rest lets the acceleration follow the plan.
const JERK_RESERVE: f64 = 0.8;

/// Motion limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionLimits {
    /// Horizontal acceleration, m/s².
    pub horizontal_acceleration_m_s2: f64,
    /// Vertical acceleration, m/s².
    pub vertical_acceleration_m_s2: f64,
    /// Time to build up full horizontal acceleration, s.
    pub acceleration_ramp_s: f64,
    /// Time to build up full vertical acceleration, s.
    pub vertical_ramp_s: f64,
}

impl MotionLimits {
    /// Returns the airframe's limits in automatic modes.
    #[must_use]
    pub fn automatic(gains: &Gains) -> Self {
        let (horizontal_m_s2, vertical_m_s2) = (0.7 * gains.acceleration_m_s2, 0.7 * gains.climb_acceleration_m_s2);
        Self {
            horizontal_acceleration_m_s2: horizontal_m_s2,
            vertical_acceleration_m_s2: vertical_m_s2,
            acceleration_ramp_s: ACCELERATION_RAMP_S,
            vertical_ramp_s: ACCELERATION_RAMP_S,
        }
    }

    /// Returns the horizontal and vertical jerk, m/s³.
    fn jerk_m_s3(&self) -> (f64, f64) {
        (self.horizontal_acceleration_m_s2 / self.acceleration_ramp_s, self.vertical_acceleration_m_s2 / self.vertical_ramp_s)
    }
}

/// Velocity and acceleration setpoints for the velocity loop.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MotionShaper {
    /// Velocity, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Acceleration, m/s².
    pub acceleration_m_s2: Vec3<Ned>,
}

impl MotionShaper {
    /// Resets the shaper to a velocity with zero acceleration.
    pub fn start(&mut self, velocity_m_s: Vec3<Ned>) {
        *self = Self { velocity_m_s, acceleration_m_s2: Vec3::zero() };
    }

    /// Advances one step toward a target velocity.
    pub fn advance(&mut self, target_velocity_m_s: Vec3<Ned>, limits: &MotionLimits, dt_s: f64) {
        let left = target_velocity_m_s - self.velocity_m_s;
        let wanted = left / APPROACH_TIME_CONSTANT_S;
        let (flat_jerk, vertical_jerk) = limits.jerk_m_s3();
        let flat_max = limits.horizontal_acceleration_m_s2.min(ending_acceleration(left.horizontal_norm(), flat_jerk));
        let vertical_max = limits.vertical_acceleration_m_s2.min(ending_acceleration(left.down().abs(), vertical_jerk));
        let flat = Vec3::<Ned>::new(wanted.north(), wanted.east(), 0.0).limited(flat_max);
        let down = wanted.down().clamp(-vertical_max, vertical_max);
        let step = flat + Vec3::new(0.0, 0.0, down) - self.acceleration_m_s2;
        let horizontal = Vec3::<Ned>::new(step.north(), step.east(), 0.0).limited(flat_jerk * dt_s);
        let max_step = vertical_jerk * dt_s;
        self.acceleration_m_s2 += horizontal + Vec3::new(0.0, 0.0, step.down().clamp(-max_step, max_step));
        self.velocity_m_s += self.acceleration_m_s2 * dt_s;
    }
}

/// Acceleration from which a jerk leads to zero while the speed changes by `left_m_s`, m/s², less a reserve so that the speed does not
/// overshoot.
fn ending_acceleration(left_m_s: f64, jerk_m_s3: f64) -> f64 {
    (2.0 * JERK_RESERVE * jerk_m_s3 * left_m_s).sqrt()
}

/// Speed from which the given deceleration stops the vehicle at the target: proportional to the distance near the
/// target, and to the square root of the distance farther away.
#[must_use]
pub fn approach_speed(distance_m: f64, gain: f64, deceleration_m_s2: f64) -> f64 {
    let bend = deceleration_m_s2 / (gain * gain);
    let d = distance_m.abs();
    let speed = if d < bend { gain * d } else { (2.0 * deceleration_m_s2 * (d - 0.5 * bend)).sqrt() };
    speed.copysign(distance_m)
}

/// Velocity toward a target within speed limits (horizontal, up, down; m/s).
#[must_use]
pub fn velocity_toward(gains: &Gains, from_m: Vec3<Ned>, to_m: Vec3<Ned>, horizontal: f64, up: f64, down: f64) -> Vec3<Ned> {
    let offset = to_m - from_m;
    let flat = Vec3::<Ned>::new(offset.north(), offset.east(), 0.0);
    let distance = flat.norm();
    let speed = approach_speed(distance, gains.position, 0.4 * gains.acceleration_m_s2).min(horizontal);
    let vertical = approach_speed(offset.down(), gains.height, 0.4 * gains.climb_acceleration_m_s2).clamp(-up, down);
    let flat = if distance > 1e-9 { flat * (speed / distance) } else { Vec3::zero() };
    Vec3::new(flat.north(), flat.east(), vertical)
}

/// Position at which the vehicle comes to rest from this velocity, m.
#[must_use]
pub fn stopping_point(gains: &Gains, position_m: Vec3<Ned>, velocity_m_s: Vec3<Ned>) -> Vec3<Ned> {
    let speed = velocity_m_s.horizontal_norm();
    let ahead = speed * (0.2 + 0.5 * speed / gains.acceleration_m_s2);
    let down = velocity_m_s.down();
    let below = down * (0.15 + 0.5 * down.abs() / gains.climb_acceleration_m_s2);
    let k = if speed > 1e-6 { ahead / speed } else { 0.0 };
    position_m + Vec3::new(velocity_m_s.north() * k, velocity_m_s.east() * k, below)
}

/// Heading of a direction, rad, or `None` if its horizontal length is below `least_m`.
#[must_use]
pub fn heading_of(direction: Vec3<Ned>, least_m: f64) -> Option<f64> {
    (direction.horizontal_norm() > least_m).then(|| math::atan2(direction.east(), direction.north()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_approach_speed_is_continuous_and_brakes_in_time() {
        let (gain, a) = (1.0, 2.0);
        let bend = 2.0;
        let step = approach_speed(bend + 1e-9, gain, a) - approach_speed(bend - 1e-9, gain, a);
        assert!(step.abs() < 1e-8);
        assert!((approach_speed(-10.0, gain, a) + 36.0_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn prop_shaped_stop_does_not_overshoot() {
        // Sport, and position mode with its jerk of 8 m/s³.
        for (acceleration_m_s2, acceleration_ramp_s) in [(4.0, ACCELERATION_RAMP_S), (5.0, 5.0 / 8.0)] {
            let limits = MotionLimits {
                horizontal_acceleration_m_s2: acceleration_m_s2,
                vertical_acceleration_m_s2: 2.0,
                acceleration_ramp_s,
                vertical_ramp_s: ACCELERATION_RAMP_S,
            };
            let mut shaper = MotionShaper::default();
            shaper.start(Vec3::new(8.0, 0.0, 0.0));
            let mut least: f64 = 8.0;
            for _ in 0..2000 {
                shaper.advance(Vec3::zero(), &limits, 0.0025);
                least = least.min(shaper.velocity_m_s.north());
            }
            // In m/s. Even drifting backward at a tenth of walking speed would be noticeable.
            assert!(least > -0.15 && shaper.velocity_m_s.norm() < 1e-3, "{acceleration_m_s2}: {least}");
        }
    }
}
