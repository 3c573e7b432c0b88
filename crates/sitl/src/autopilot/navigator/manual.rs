//! Manual modes: body rates, attitude, height or velocity from the sticks, and the locks that hold position with the sticks
//! centered. As with ArduCopter's default trainer, released sticks level the vehicle in acro mode and the lean angle is limited.

use super::Navigator;
use super::input::NavigatorInput;
use crate::autopilot::control::setpoint::Setpoint;
use crate::autopilot::control::shaper::{ACCELERATION_RAMP_S, MotionLimits, stopping_point};
use crate::autopilot::control::velocity::AttitudeThrustSetpoint;
use crate::autopilot::external_input::Sticks;
use crate::autopilot::flight_state::FlightMode;
use spandrel_model::frames::{Ned, Rotation, Vec3};
use spandrel_model::math;

/// Speed below which the position is locked with the sticks centered, m/s.
const LOCK_MAX_SPEED_M_S: f64 = 0.15;
/// Tilt limit in manual flight without a position estimate, as a fraction of the maximum tilt.
const NO_POSITION_TILT_FRACTION: f64 = 0.6;
/// Fraction of the slowdown time within which the plan stops. The rest is reserved for the loop lag.
const SLOWDOWN_TIME_FRACTION: f64 = 0.55;
/// Maximum correction speed toward a locked position, m/s.
const LOCK_CORRECTION_SPEED_M_S: f64 = 2.0;
/// Leveling gain, 1/s, and the maximum lean angle it acts on, rad (ArduCopter: ACRO_BAL_ROLL 1, ACRO_LEVEL_MAX_ANGLE 30
/// degrees).
const LEVELING_GAIN_PER_S: f64 = 1.0;
const LEVELING_MAX_ANGLE_RAD: f64 = 0.524;
/// Gain of the rate limit near the maximum lean angle, 1/s (estimate: slower than the attitude loop to prevent overshoot).
const TILT_LIMIT_GAIN_PER_S: f64 = 4.0;

impl Navigator {
    /// Vertical velocity from the sticks, m/s down.
    fn stick_climb(&self, input: &NavigatorInput) -> f64 {
        let (l, set, response) = (&input.airframe.limits, &input.tuning.rules.envelope, input.tuning.stick_response);
        let up = response.speed_fraction(input.links.sticks.up);
        let (airframe_m_s, set_m_s) =
            if up > 0.0 { (l.climb_m_s, set.manual_climb_rate_m_s) } else { (l.descend_m_s, set.manual_descent_rate_m_s) };
        -up * airframe_m_s.min(set_m_s).min(response.limits().vertical_m_s)
    }

    /// Roll and pitch from the sticks, rad. The combined tilt does not exceed the limit for a single axis.
    fn stick_tilt(&self, share: f64, input: &NavigatorInput) -> (f64, f64) {
        let Sticks { forward, right, .. } = input.links.sticks;
        let max_rad =
            input.gains.tilt_rad.min(input.tuning.rules.envelope.manual_tilt_rad) * share / math::hypot(forward, right).max(1.0);
        (right * max_rad, -forward * max_rad)
    }

    /// Sticks control roll, pitch, yaw rate and thrust.
    pub(super) fn stabilized(&mut self, input: &NavigatorInput) -> Setpoint {
        self.heading.turn_by_stick(input);
        let up = input.links.sticks.up;
        let tilt = self.stick_tilt(1.0, input);
        let hover = input.gains.hover_thrust_n;
        let thrust_n = if up > 0.0 {
            math::lerp(hover, input.gains.thrust_max_n, up)
        } else {
            math::lerp(hover, input.gains.thrust_min_n, -up)
        };
        let descent_m_s = if up < -0.5 { input.airframe.limits.descend_m_s } else { 0.0 };
        let attitude = Rotation::from_euler(tilt.0, tilt.1, self.heading.yaw_rad);
        Setpoint::AttitudeThrust { target: AttitudeThrustSetpoint { attitude, thrust_n }, descent_rate_m_s: descent_m_s }
    }

    /// Sticks control body rates and thrust.
    pub(super) fn acro(&mut self, input: &NavigatorInput) -> Setpoint {
        let (s, l) = (input.links.sticks, input.airframe.limits);
        let (roll, pitch, yaw) = input.estimate.attitude.euler();
        let max_rad = input.gains.tilt_rad;
        let lean_rate = |stick: f64, angle: f64| {
            let rate = stick * l.rate_rad_s - LEVELING_GAIN_PER_S * angle.clamp(-LEVELING_MAX_ANGLE_RAD, LEVELING_MAX_ANGLE_RAD);
            rate.clamp(TILT_LIMIT_GAIN_PER_S * (-max_rad - angle), TILT_LIMIT_GAIN_PER_S * (max_rad - angle))
        };
        let rates_rad_s = Vec3::new(lean_rate(s.right, roll), lean_rate(-s.forward, pitch), s.yaw * l.yaw_rate_rad_s);
        let low = math::lerp(input.gains.hover_thrust_n, input.gains.thrust_min_n, (-s.up).clamp(0.0, 1.0));
        let thrust_n = if s.up > 0.0 { math::lerp(input.gains.hover_thrust_n, input.gains.thrust_max_n, s.up) } else { low };
        let descent_m_s = if s.up < -0.5 { l.descend_m_s } else { 0.0 };
        // If the next mode holds the heading, it starts with the current heading.
        self.heading.yaw_rad = yaw;
        self.heading.stop();
        Setpoint::Rates { rates_rad_s, thrust_n, descent_rate_m_s: descent_m_s }
    }

    /// Sticks control roll, pitch, yaw rate and climb rate.
    pub(super) fn altitude(&mut self, input: &NavigatorInput) -> Setpoint {
        self.heading.turn_by_stick(input);
        let share = if self.modes.active == FlightMode::Altitude { 1.0 } else { NO_POSITION_TILT_FRACTION };
        let tilt = self.stick_tilt(share, input);
        let limits = self.stick_limits(0.0, input);
        let velocity = self.apply_position_locks(
            Vec3::new(0.0, 0.0, self.stick_climb(input)),
            false,
            input.links.sticks.up == 0.0,
            &limits,
            input,
        );
        self.locks.horizontal = None;
        Setpoint::Level { motion: self.motion(velocity), tilt }
    }

    /// Sticks control velocity and yaw rate.
    pub(super) fn position(&mut self, input: &NavigatorInput) -> Setpoint {
        self.heading.turn_by_stick(input);
        let (s, l) = (input.links.sticks, input.airframe.limits);
        let (sine, cosine) = math::sin_cos(input.estimate.attitude.yaw_rad());
        let response = input.tuning.stick_response;
        let max_m_s = input.tuning.rules.envelope.manual_speed_m_s.min(response.limits().horizontal_m_s);
        let forward = response.speed_fraction(s.forward) * l.forward_m_s.min(max_m_s);
        let right = response.speed_fraction(s.right) * l.sideways_speed_m_s.min(max_m_s);
        let wanted_m_s: Vec3<Ned> =
            Vec3::new(cosine * forward - sine * right, sine * forward + cosine * right, self.stick_climb(input));
        let limits = self.stick_limits(wanted_m_s.horizontal_norm(), input);
        let centered = s.forward == 0.0 && s.right == 0.0;
        let velocity = self.apply_position_locks(wanted_m_s, centered, s.up == 0.0, &limits, input);
        if let (Some((n, e)), Some(d)) = (self.locks.horizontal, self.locks.height_down_m) {
            self.report.target_m = Some(Vec3::new(n, e, d));
        }
        Setpoint::Velocity(self.motion(velocity))
    }

    /// Motion limits in manual flight toward a horizontal speed, m/s.
    fn stick_limits(&self, wanted_m_s: f64, input: &NavigatorInput) -> MotionLimits {
        let (l, response) = (&input.airframe.limits, input.tuning.stick_response.limits());
        let plan_s = (SLOWDOWN_TIME_FRACTION * l.slow_down_time_s).max(0.1);
        let braking = wanted_m_s < self.shaper.velocity_m_s.horizontal_norm();
        let response_m_s2 = if braking { response.deceleration_m_s2 } else { response.acceleration_m_s2 };
        let airframe_m_s2 = (l.forward_m_s.max(l.sideways_speed_m_s) / plan_s).min(input.gains.acceleration_m_s2);
        let vertical_m_s2 = (l.climb_m_s.max(l.descend_m_s) / plan_s).min(input.gains.climb_acceleration_m_s2);
        let horizontal_acceleration_m_s2 = airframe_m_s2.min(response_m_s2);
        let vertical_acceleration_m_s2 = vertical_m_s2.min(response.acceleration_m_s2);
        MotionLimits {
            horizontal_acceleration_m_s2,
            vertical_acceleration_m_s2,
            acceleration_ramp_s: ACCELERATION_RAMP_S.max(horizontal_acceleration_m_s2 / response.jerk_m_s3),
            vertical_ramp_s: ACCELERATION_RAMP_S.max(vertical_acceleration_m_s2 / response.jerk_m_s3),
        }
    }

    /// Shapes a velocity from the sticks. With centered sticks and low speed, position and height are locked.
    fn apply_position_locks(
        &mut self,
        target_velocity_m_s: Vec3<Ned>,
        horizontal_unlocked: bool,
        height_unlocked: bool,
        limits: &MotionLimits,
        input: &NavigatorInput,
    ) -> Vec3<Ned> {
        let planned = self.shaper.velocity_m_s;
        self.shaper.advance(target_velocity_m_s, limits, input.dt_s);
        let e = input.estimate;
        let rest = stopping_point(input.gains, e.position_m, e.velocity_m_s);
        let locks = &mut self.locks;
        if !horizontal_unlocked {
            locks.horizontal = None;
        } else if locks.horizontal.is_none() && planned.horizontal_norm() < LOCK_MAX_SPEED_M_S {
            locks.horizontal = Some((rest.north(), rest.east()));
        }
        if !height_unlocked {
            locks.height_down_m = None;
        } else if locks.height_down_m.is_none() && planned.down().abs() < LOCK_MAX_SPEED_M_S {
            locks.height_down_m = Some(rest.down());
        }
        let mut velocity = self.shaper.velocity_m_s;
        if let Some((n, e_)) = locks.horizontal {
            let offset = Vec3::<Ned>::new(n - e.position_m.north(), e_ - e.position_m.east(), 0.0);
            velocity += (offset * input.gains.position).limited(LOCK_CORRECTION_SPEED_M_S);
        }
        if let Some(d) = locks.height_down_m {
            let speed = input.gains.height * (d - e.position_m.down());
            velocity += Vec3::new(0.0, 0.0, speed.clamp(-LOCK_CORRECTION_SPEED_M_S, LOCK_CORRECTION_SPEED_M_S));
        }
        velocity
    }
}
