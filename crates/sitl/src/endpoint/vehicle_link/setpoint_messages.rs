//! Handles offboard setpoint messages.

use super::VehicleLink;
use super::inbound::InboundMessage;
use super::offboard::{self, SetpointResult};
use crate::autopilot::{AutopilotRequest, FlightMode, LandedState};
use spandrel_mavlink::dialect::{
    SET_ATTITUDE_TARGET_DATA, SET_POSITION_TARGET_GLOBAL_INT_DATA, SET_POSITION_TARGET_LOCAL_NED_DATA,
};

/// Applies a setpoint, or reports and ignores it if it is invalid.
fn apply_setpoint(v: &mut VehicleLink, reading: SetpointResult, a: &mut InboundMessage) {
    match reading {
        Ok(setpoint) => {
            a.autopilot.offboard(setpoint, a.now());
            enter_setpoint_mode(v, a);
        }
        Err(why) => v.warn_of_stream(why, a.now()),
    }
}

/// Enters the setpoint mode if the current mode accepts setpoints directly. Ends a takeoff that has left the ground.
fn enter_setpoint_mode(v: &VehicleLink, a: &mut InboundMessage) {
    let status = a.autopilot.status();
    let is_guided = v.is_guided(a.autopilot);
    let waits = matches!(status.mode, FlightMode::Hold | FlightMode::Takeoff) && status.landed == LandedState::InAir;
    if is_guided && waits && status.failsafe.is_none() {
        a.autopilot.request(AutopilotRequest::SetMode(FlightMode::Offboard), a.now());
    }
}

pub(super) fn local_target(v: &mut VehicleLink, t: &SET_POSITION_TARGET_LOCAL_NED_DATA, a: &mut InboundMessage) {
    apply_setpoint(v, offboard::local(t, &a.view(v)), a);
}

pub(super) fn global_target(v: &mut VehicleLink, t: &SET_POSITION_TARGET_GLOBAL_INT_DATA, a: &mut InboundMessage) {
    apply_setpoint(v, offboard::global(t, &a.view(v)), a);
}

pub(super) fn attitude_target(v: &mut VehicleLink, t: &SET_ATTITUDE_TARGET_DATA, a: &mut InboundMessage) {
    apply_setpoint(v, offboard::attitude(t, &a.autopilot.tuning), a);
}
