//! Stick positions for a desired velocity and line of sight.

use super::config::PilotConfig;
use super::perception::MotionState;
use super::stick_response::StickAxes;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;

/// Heading loop gain of the trained pilot, 1/s (estimate).
const YAW_GAIN_PER_S: f64 = 1.3;
/// Fraction of the perceived speed error that a trained pilot adds to the stick command (estimate).
const SPEED_FEEDBACK_GAIN: f64 = 0.35;

/// Heading (clockwise from north) and elevation of a line of sight, rad.
pub(super) fn heading_and_elevation(look: Vec3<Enu>) -> (f64, f64) {
    (math::atan2(look.east(), look.north()), math::asin(look.up()))
}

/// Returns the stick axes for a desired velocity and line of sight, using the pilot's learned model of the aircraft.
pub(super) fn sticks(wanted: Vec3<Enu>, belief: &MotionState, look: Option<Vec3<Enu>>, config: &PilotConfig) -> StickAxes {
    let limits = &config.vehicle.limits;
    let gain = config.skill.gain;
    let push = wanted + (wanted - belief.velocity_m_s) * (SPEED_FEEDBACK_GAIN * gain);
    let (s, c) = math::sin_cos(belief.yaw_rad);
    let forward = push.east() * s + push.north() * c;
    let right = push.east() * c - push.north() * s;
    let up = push.up();
    let climb = if up > 0.0 { limits.climb_m_s } else { limits.descend_m_s };
    // A near-vertical line of sight does not define a heading.
    let turn =
        look.filter(|l| l.horizontal_norm() > 0.2).map_or(0.0, |l| math::wrap_pi(heading_and_elevation(l).0 - belief.yaw_rad));
    [
        forward / limits.forward_m_s,
        right / limits.sideways_speed_m_s,
        up / climb,
        turn * YAW_GAIN_PER_S * gain / limits.yaw_rate_rad_s,
    ]
    .map(|axis| axis.clamp(-1.0, 1.0))
}
