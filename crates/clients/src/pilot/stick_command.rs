//! Speeds and stick positions for a desired velocity and line of sight.

use super::config::PilotConfig;
use super::hand_motion::StickAxes;
use super::perception::MotionState;
use super::track::TrackCommand;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::stick_response::StickResponse;
use spandrel_model::vehicle::FlightLimits;

/// Heading loop gain of the trained pilot, 1/s (estimate).
const YAW_GAIN_PER_S: f64 = 1.3;
/// Fraction of the perceived speed error that a trained pilot adds to the stick command (estimate).
const SPEED_FEEDBACK_GAIN: f64 = 0.35;

/// Minimum horizontal part of a line of sight that defines a heading.
pub(super) const MIN_HORIZONTAL: f64 = 0.2;

/// Returns the angle between a line of sight and the camera's optical axis, rad; counts only the elevation if the line is nearly
/// vertical.
pub(super) fn aim_error_rad(look: Vec3<Enu>, yaw_rad: f64, gimbal_pitch_rad: f64) -> f64 {
    let (heading, elevation) = heading_and_elevation(look);
    let level = look.horizontal_norm();
    let aside = if level > MIN_HORIZONTAL { math::wrap_pi(heading - yaw_rad) * level } else { 0.0 };
    math::hypot(aside, elevation - gimbal_pitch_rad)
}

/// Heading (clockwise from north) and elevation of a line of sight, rad.
pub(super) fn heading_and_elevation(look: Vec3<Enu>) -> (f64, f64) {
    (math::atan2(look.east(), look.north()), math::asin(look.up().clamp(-1.0, 1.0)))
}

/// Returns the deflections of the sticks for fractions of the airframe's full speeds: pilots know how their aircraft responds.
pub(super) fn deflections(fractions: StickAxes, limits: &FlightLimits, response: StickResponse) -> StickAxes {
    let [forward, right, up, yaw] = fractions;
    let set = response.limits();
    let climb_m_s = if up > 0.0 { limits.climb_m_s } else { limits.descend_m_s };
    let stick = |fraction: f64, airframe: f64, selected: f64| response.deflection(fraction * airframe / airframe.min(selected));
    [
        stick(forward, limits.forward_m_s, set.horizontal_m_s),
        stick(right, limits.sideways_speed_m_s, set.horizontal_m_s),
        stick(up, climb_m_s, set.vertical_m_s),
        stick(yaw, limits.yaw_rate_rad_s, set.yaw_rate_rad_s),
    ]
}

/// Returns the speeds for a command as fractions of the airframe's full speeds, using the pilot's learned model of the aircraft.
pub(super) fn sticks(wish: &TrackCommand, belief: &MotionState, config: &PilotConfig) -> StickAxes {
    let limits = &config.vehicle.limits;
    let gain = config.skill.gain;
    let wanted = wish.velocity_m_s;
    let push = if wish.hands_off { Vec3::zero() } else { wanted + (wanted - belief.velocity_m_s) * (SPEED_FEEDBACK_GAIN * gain) };
    let (s, c) = math::sin_cos(belief.yaw_rad);
    let forward = push.east() * s + push.north() * c;
    let right = push.east() * c - push.north() * s;
    let up = push.up();
    let climb = if up > 0.0 { limits.climb_m_s } else { limits.descend_m_s };
    // A near-vertical line of sight does not define a heading.
    let look = wish.line_of_sight.filter(|_| wish.turns);
    let turn = look
        .filter(|l| l.horizontal_norm() > MIN_HORIZONTAL)
        .map_or(0.0, |l| math::wrap_pi(heading_and_elevation(l).0 - belief.yaw_rad));
    [
        forward / limits.forward_m_s,
        right / limits.sideways_speed_m_s,
        up / climb,
        turn * YAW_GAIN_PER_S * gain / limits.yaw_rate_rad_s,
    ]
    .map(|axis| axis.clamp(-1.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_deflections_command_the_wanted_speeds() {
        let text = include_str!("../../../../vehicle-params/phantom2.toml");
        let limits = spandrel_model::vehicle::read("phantom2.toml", text).unwrap().limits;
        let wanted = [0.1, -0.05, -0.3, 0.2];
        for (_, response) in StickResponse::ALL {
            let sticks = deflections(wanted, &limits, response).map(|stick| response.speed_fraction(stick));
            let set = response.limits();
            let full = [
                (limits.forward_m_s, set.horizontal_m_s),
                (limits.sideways_speed_m_s, set.horizontal_m_s),
                (limits.descend_m_s, set.vertical_m_s),
                (limits.yaw_rate_rad_s, set.yaw_rate_rad_s),
            ];
            for ((fraction, (airframe, selected)), stick) in wanted.iter().zip(full).zip(sticks) {
                // The same speed, or full deflection if it is out of reach. The error is the curve's rounding.
                let speed = (fraction * airframe).clamp(-selected, selected);
                assert!((stick * airframe.min(selected) - speed).abs() < 1e-12, "{response:?} {fraction} {stick}");
            }
        }
    }
}
