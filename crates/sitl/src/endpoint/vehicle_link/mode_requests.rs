//! Mode changes requested by messages and by a transmitter's mode switch.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use super::VehicleLink;
use super::inbound::InboundMessage;
use super::manual;
use crate::autopilot::RequestOutcome;
use spandrel_mavlink::dialect::{MavModeFlag, MavSeverity, RC_CHANNELS_OVERRIDE_DATA, SET_MODE_DATA};

/// Upper limits of the first five positions of a six-position mode switch, microseconds (ArduPilot: RC_Channel,
/// read_6pos_switch).
const POSITION_LIMITS_US: [u16; 5] = [1230, 1360, 1490, 1620, 1749];
const MODE_PARAMS: [&str; 6] = ["FLTMODE1", "FLTMODE2", "FLTMODE3", "FLTMODE4", "FLTMODE5", "FLTMODE6"];

/// Enters the mode assigned to the mode switch's new position (FLTMODE_CH).
pub(super) fn apply_mode_switch(v: &mut VehicleLink, c: &RC_CHANNELS_OVERRIDE_DATA, a: &mut InboundMessage) {
    let pulses = manual::aux_channels(c);
    let channel = v.params.whole("FLTMODE_CH").and_then(|channel| usize::try_from(channel - 5).ok());
    let Some(pulse) = channel.and_then(|k| pulses.get(k)).filter(|us| manual::VALID_PULSES_US.contains(us)) else { return };
    let position = POSITION_LIMITS_US.iter().filter(|end| *pulse > **end).count();
    if v.mode_switch.replace(position) == Some(position) {
        return;
    }
    if let Some(mode) = mode_for_switch(v, position) {
        enter_mode(v, mode, a);
    }
}

/// Returns the mode assigned to a mode switch position.
pub(super) fn mode_for_switch(v: &VehicleLink, position: usize) -> Option<u32> {
    v.params.whole(MODE_PARAMS.get(position)?).map(i32::unsigned_abs)
}

pub(super) fn set_mode(v: &mut VehicleLink, m: &SET_MODE_DATA, a: &mut InboundMessage) {
    if !v.flavor.custom_flag || m.base_mode.contains(MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED) {
        enter_mode(v, m.custom_mode, a);
    }
}

/// Enters a mode. SET_MODE has no acknowledgment, so a rejection is sent as a text.
pub(super) fn enter_mode(v: &mut VehicleLink, custom_mode: u32, a: &mut InboundMessage) {
    let now = a.now();
    let outcome = match v.flavor.row(custom_mode) {
        Some(row) => v.flavor.enter(row, &mut v.requested_mode, a.autopilot, now),
        None => RequestOutcome::Denied(format!("No such mode {custom_mode}")),
    };
    if let RequestOutcome::TemporarilyRejected(reason) | RequestOutcome::Denied(reason) | RequestOutcome::Failed(reason) = outcome
    {
        v.push_text(MavSeverity::MAV_SEVERITY_CRITICAL, &reason);
    }
}
