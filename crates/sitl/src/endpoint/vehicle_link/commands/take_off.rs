//! NAV_TAKEOFF, interpreted according to the flavor's rule.

use super::super::VehicleLink;
use super::super::flavor::TakeOffRule;
use super::super::inbound::InboundMessage;
use crate::autopilot::LandedState;
use crate::endpoint::vehicle_command::VehicleCommand;
use spandrel_mavlink::dialect::MavResult;

/// Maximum height above home, m.
const MAX_HEIGHT_M: f64 = 500.0;
const DENIED: MavResult = MavResult::MAV_RESULT_DENIED;
const FAILED: MavResult = MavResult::MAV_RESULT_FAILED;

/// Returns the height above home, in meters, at which the takeoff ends (`None`: the parameter's value), or the result
/// that rejects the command.
pub(super) fn height_m(c: &VehicleCommand, v: &mut VehicleLink, a: &InboundMessage) -> Result<Option<f64>, MavResult> {
    match v.flavor.take_off {
        TakeOffRule::AboveSeaLevel => above_sea_level(c, v, a),
        TakeOffRule::AboveHomeInGuided => above_home_in_guided(c, v, a),
    }
}

/// If the altitude is missing or too close to the ground, the parameter's height is used.
fn above_sea_level(c: &VehicleCommand, v: &mut VehicleLink, a: &InboundMessage) -> Result<Option<f64>, MavResult> {
    const MIN_HEIGHT_M: f64 = 0.5;
    let relative = c.is_home_relative().ok_or(DENIED)?;
    let Some(z) = c.finite_param(6) else { return Ok(None) };
    let height_m = if relative { z } else { z - a.aircraft.plane.origin().altitude_m - a.home_height_m() };
    if height_m > MAX_HEIGHT_M {
        Err(v.deny("Takeoff height: must be at most 500 m above home"))
    } else {
        Ok(Some(height_m).filter(|height| *height >= MIN_HEIGHT_M))
    }
}

fn above_home_in_guided(c: &VehicleCommand, v: &mut VehicleLink, a: &InboundMessage) -> Result<Option<f64>, MavResult> {
    let status = a.autopilot.status();
    let why = if !v.is_guided(a.autopilot) {
        Some("Takeoff requires mode Guided")
    } else if !status.armed {
        Some("Takeoff requires armed motors")
    } else if status.landed != LandedState::OnGround {
        Some("Takeoff: already in the air")
    } else {
        None
    };
    if let Some(why) = why {
        v.warn(why);
        return Err(FAILED);
    }
    // COMMAND_LONG has no frame; COMMAND_INT must use a frame relative to home.
    if c.whole && c.is_home_relative() != Some(true) {
        return Err(DENIED);
    }
    let height = c.finite_param(6).filter(|height| *height > 0.0 && *height <= MAX_HEIGHT_M);
    if height.is_none() {
        v.warn("Takeoff height: must be > 0 and <= 500 m");
    }
    height.map(Some).ok_or(FAILED)
}
