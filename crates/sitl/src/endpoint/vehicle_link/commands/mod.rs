//! Commands to the autopilot, one file per group. Every command is answered immediately.

mod flight;
mod storage;
mod take_off;

use super::VehicleLink;
use super::inbound::InboundMessage;
use crate::autopilot::AutopilotRequest;
use crate::endpoint::payload::commands as payload;
use crate::endpoint::vehicle_command::VehicleCommand;
use spandrel_mavlink::dialect::MavResult;

/// Executes a command, either received or issued by the vehicle itself, and returns its result. This includes equipment
/// commands.
pub(crate) fn execute(c: &VehicleCommand, v: &mut VehicleLink, a: &mut InboundMessage) -> MavResult {
    flight::handle(c, v, a)
        .or_else(|| point_at(c, v, a))
        .or_else(|| payload::handle(c, a.input, a.payload))
        .or_else(|| payload::handle_inspector(c, a.input, a.payload))
        .unwrap_or(MavResult::MAV_RESULT_UNSUPPORTED)
}

/// Handles commands that point the gimbal at a position. The vehicle also turns toward this position.
fn point_at(c: &VehicleCommand, v: &mut VehicleLink, a: &mut InboundMessage) -> Option<MavResult> {
    let target = payload::region_of_interest::target(c, a.input)?;
    let result = payload::handle(c, a.input, a.payload);
    let is_accepted = result == Some(MavResult::MAV_RESULT_ACCEPTED);
    if is_accepted || target.is_none() {
        a.autopilot.request(AutopilotRequest::LookAt(target), a.now());
    }
    if !is_accepted && target.is_none() {
        v.warn("ROI cleared; gimbal control is unchanged");
        return Some(MavResult::MAV_RESULT_ACCEPTED);
    }
    result
}
