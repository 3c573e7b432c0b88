//! Acro mode: the sticks control body rates. As with ArduCopter's default trainer, released sticks level the vehicle and the lean
//! angle is limited.

use super::core::Autopilot;
use super::modes::Setpoint;
use spandrel_model::frames::Vec3;
use spandrel_model::math;

/// Leveling gain, 1/s, and the maximum lean angle it counts, rad (ArduCopter: ACRO_BAL_ROLL 1, ACRO_LEVEL_MAX_ANGLE 30 degrees).
const LEVEL_PER_S: f64 = 1.0;
const LEVEL_MOST_RAD: f64 = 0.524;
/// Gain of the rate limit near the maximum lean angle, 1/s (estimate: slower than the attitude loop to prevent overshoot).
const LIMIT_PER_S: f64 = 4.0;

impl Autopilot {
    pub(super) fn acro(&mut self) -> Setpoint {
        let (s, l) = (self.links.sticks, self.airframe.limits);
        let (roll, pitch, yaw) = self.estimate.attitude.euler();
        let most = self.gains.tilt_rad;
        let lean_rate = |stick: f64, angle: f64| {
            let wish = stick * l.rate_rad_s - LEVEL_PER_S * angle.clamp(-LEVEL_MOST_RAD, LEVEL_MOST_RAD);
            wish.clamp(LIMIT_PER_S * (-most - angle), LIMIT_PER_S * (most - angle))
        };
        let rates_rad_s = Vec3::new(lean_rate(s.right, roll), lean_rate(-s.forward, pitch), s.yaw * l.yaw_rate_rad_s);
        let low = math::lerp(self.gains.hover_n, self.gains.thrust_min_n, (-s.up).clamp(0.0, 1.0));
        let thrust_n = if s.up > 0.0 { math::lerp(self.gains.hover_n, self.gains.thrust_max_n, s.up) } else { low };
        self.landing_detector.wanted_down_m_s = if s.up < -0.5 { l.descend_m_s } else { 0.0 };
        // A mode with heading hold continues from this heading.
        self.navigator.yaw_rad = yaw;
        self.navigator.yaw_rate_rad_s = 0.0;
        Setpoint::Spin { rates_rad_s, thrust_n }
    }
}
