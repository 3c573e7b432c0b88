//! Manual modes: attitude, height or velocity from the sticks, and the locks that hold position with the sticks centered.

use super::core::Autopilot;
use super::modes::Setpoint;
use super::shaper::{JERK_S, MotionLimits, stopping_point};
use super::velocity::AttitudeThrustSetpoint;
use super::{FlightMode, Sticks};
use spandrel_model::frames::{Ned, Rotation, Vec3};
use spandrel_model::math;

/// Time to build up full yaw rate, s.
const YAW_SPOOL_S: f64 = 0.3;
/// Maximum lead of the heading setpoint over the actual heading, rad.
const YAW_LEAD_RAD: f64 = 0.6;
/// Yaw rate above which the rate is controlled instead of the heading, rad/s, and the maximum lead in that case, rad.
const TURNING_RAD_S: f64 = 0.1;
const TURNING_LEAD_RAD: f64 = 0.08;
/// Yaw rate below which the heading is captured, rad/s. With the yaw loop's lag of a few tenths of a second, it then moves by
/// less than half a degree.
const CAPTURED_RAD_S: f64 = 0.02;
/// Speed below which the position is locked with the sticks centered, m/s.
const LOCK_M_S: f64 = 0.15;
/// Tilt in manual flight without position, as a fraction of the maximum.
const BLIND_TILT_SHARE: f64 = 0.6;
/// Fraction of the slow-down time in which the plan stops. The loop lag takes the rest.
const SLOW_DOWN_SHARE: f64 = 0.55;
/// Maximum correction speed toward a lock, m/s.
pub(super) const LOCK_SPEED_M_S: f64 = 2.0;

impl Autopilot {
    pub(super) fn stick_yaw(&mut self, dt_s: f64) {
        let most = self.airframe.limits.yaw_rate_rad_s.min(self.tuning.rules.envelope.manual_yaw_rad_s);
        let rate = self.links.sticks.yaw * most;
        self.turn_at(rate, dt_s);
    }

    /// Turns at a rate, rad/s. At zero rate, the heading is captured where the nose comes to rest; capturing it earlier would
    /// make the nose swing back.
    pub(super) fn turn_at(&mut self, rate: f64, dt_s: f64) {
        let turning = (self.estimate.attitude * self.estimate.rates_rad_s).down();
        let c = &mut self.navigator;
        if rate != 0.0 {
            c.heading_free = true;
        } else if turning.abs() < CAPTURED_RAD_S && c.yaw_rate_rad_s.abs() < CAPTURED_RAD_S {
            c.heading_free = false;
        }
        let before = self.navigator.yaw_rate_rad_s;
        self.advance_heading(rate, dt_s);
        if rate == 0.0 && self.navigator.heading_free {
            self.navigator.yaw_rad = self.estimate.attitude.yaw_rad();
            // The rate loop lags by the inverse of its gain. With this lead the nose brakes as planned.
            let braking = if dt_s > 0.0 { (self.navigator.yaw_rate_rad_s - before) / dt_s } else { 0.0 };
            self.navigator.yaw_brake_rad_s = braking / self.gains.yaw_rate;
        }
    }

    /// Advances the heading setpoint at a rate that builds up gradually, rad/s.
    pub(super) fn advance_heading(&mut self, rate: f64, dt_s: f64) {
        let step = self.airframe.limits.yaw_rate_rad_s / YAW_SPOOL_S * dt_s;
        let c = &mut self.navigator;
        c.yaw_brake_rad_s = 0.0;
        c.yaw_rate_rad_s += (rate - c.yaw_rate_rad_s).clamp(-step, step);
        let nose = self.estimate.attitude.yaw_rad();
        let most = if c.yaw_rate_rad_s.abs() > TURNING_RAD_S { TURNING_LEAD_RAD } else { YAW_LEAD_RAD };
        let lead = math::wrap_pi(c.yaw_rad + c.yaw_rate_rad_s * dt_s - nose).clamp(-most, most);
        c.yaw_rad = math::wrap_pi(nose + lead);
    }

    pub(super) fn stick_climb(&self) -> f64 {
        let (up, l, set) = (self.links.sticks.up, &self.airframe.limits, &self.tuning.rules.envelope);
        if up > 0.0 { -up * l.climb_m_s.min(set.manual_up_m_s) } else { -up * l.descend_m_s.min(set.manual_down_m_s) }
    }

    /// Roll and pitch from the sticks, rad. Combined tilt does not exceed the limit of one axis.
    fn stick_tilt(&self, share: f64) -> (f64, f64) {
        let Sticks { forward, right, .. } = self.links.sticks;
        let most =
            self.gains.tilt_rad.min(self.tuning.rules.envelope.manual_tilt_rad) * share / math::hypot(forward, right).max(1.0);
        (right * most, -forward * most)
    }

    pub(super) fn stabilized(&mut self, dt_s: f64) -> Setpoint {
        self.stick_yaw(dt_s);
        let up = self.links.sticks.up;
        let tilt = self.stick_tilt(1.0);
        let hover = self.gains.hover_n;
        let thrust_n = if up > 0.0 {
            math::lerp(hover, self.gains.thrust_max_n, up)
        } else {
            math::lerp(hover, self.gains.thrust_min_n, -up)
        };
        self.landing_detector.wanted_down_m_s = if up < -0.5 { self.airframe.limits.descend_m_s } else { 0.0 };
        let attitude = Rotation::from_euler(tilt.0, tilt.1, self.navigator.yaw_rad);
        Setpoint::AttitudeThrust(AttitudeThrustSetpoint { attitude, thrust_n })
    }

    pub(super) fn altitude(&mut self, dt_s: f64) -> Setpoint {
        self.stick_yaw(dt_s);
        let share = if self.status.mode == FlightMode::Altitude { 1.0 } else { BLIND_TILT_SHARE };
        let tilt = self.stick_tilt(share);
        let limits = self.stick_limits();
        let velocity =
            self.with_locks(Vec3::new(0.0, 0.0, self.stick_climb()), false, self.links.sticks.up == 0.0, &limits, dt_s);
        self.navigator.horizontal_lock = None;
        Setpoint::Level { motion: self.motion(velocity), tilt }
    }

    pub(super) fn position(&mut self, dt_s: f64) -> Setpoint {
        self.stick_yaw(dt_s);
        let (s, l) = (self.links.sticks, self.airframe.limits);
        let (sine, cosine) = math::sin_cos(self.estimate.attitude.yaw_rad());
        let most = self.tuning.rules.envelope.manual_m_s;
        let (forward, right) = (s.forward * l.forward_m_s.min(most), s.right * l.sideward_m_s.min(most));
        let wish = Vec3::new(cosine * forward - sine * right, sine * forward + cosine * right, self.stick_climb());
        let limits = self.stick_limits();
        let centred = s.forward == 0.0 && s.right == 0.0;
        let velocity = self.with_locks(wish, centred, s.up == 0.0, &limits, dt_s);
        if let (Some((n, e)), Some(d)) = (self.navigator.horizontal_lock, self.navigator.height_lock_down_m) {
            self.status.target_m = Some(Vec3::new(n, e, d));
        }
        Setpoint::Velocity(self.motion(velocity))
    }

    pub(super) fn stick_limits(&self) -> MotionLimits {
        let l = &self.airframe.limits;
        let plan_s = (SLOW_DOWN_SHARE * l.slow_down_time_s).max(0.1);
        MotionLimits {
            horizontal_m_s2: (l.forward_m_s.max(l.sideward_m_s) / plan_s).min(self.gains.acceleration_m_s2),
            vertical_m_s2: (l.climb_m_s.max(l.descend_m_s) / plan_s).min(self.gains.climb_acceleration_m_s2),
            build_up_s: JERK_S,
        }
    }

    /// Shapes a velocity from the sticks. With centered sticks and low speed, position and height are locked.
    pub(super) fn with_locks(
        &mut self,
        wish: Vec3<Ned>,
        flat_free: bool,
        down_free: bool,
        limits: &MotionLimits,
        dt_s: f64,
    ) -> Vec3<Ned> {
        let planned = self.shaper.velocity_m_s;
        self.shaper.advance(wish, limits, dt_s);
        let e = &self.estimate;
        let rest = stopping_point(&self.gains, e.position_m, e.velocity_m_s);
        let c = &mut self.navigator;
        if !flat_free {
            c.horizontal_lock = None;
        } else if c.horizontal_lock.is_none() && planned.horizontal_norm() < LOCK_M_S {
            c.horizontal_lock = Some((rest.north(), rest.east()));
        }
        if !down_free {
            c.height_lock_down_m = None;
        } else if c.height_lock_down_m.is_none() && planned.down().abs() < LOCK_M_S {
            c.height_lock_down_m = Some(rest.down());
        }
        let mut velocity = self.shaper.velocity_m_s;
        if let Some((n, e_)) = c.horizontal_lock {
            let way = Vec3::<Ned>::new(n - e.position_m.north(), e_ - e.position_m.east(), 0.0);
            velocity += (way * self.gains.position).limited(LOCK_SPEED_M_S);
        }
        if let Some(d) = c.height_lock_down_m {
            let speed = self.gains.height * (d - e.position_m.down());
            velocity += Vec3::new(0.0, 0.0, speed.clamp(-LOCK_SPEED_M_S, LOCK_SPEED_M_S));
        }
        velocity
    }
}
