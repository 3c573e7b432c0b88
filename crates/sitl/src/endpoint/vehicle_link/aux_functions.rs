//! ArduPilot's auxiliary functions by number: switches on transmitter channels (RCn_OPTION) and DO_AUX_FUNCTION.

use super::inbound::InboundMessage;
use super::switch_position::SwitchPosition;
use super::{VehicleLink, commands, manual, mode_requests};
use crate::autopilot::{AutopilotRequest, FlightMode};
use crate::endpoint::component_ids::AUTOPILOT;
use crate::endpoint::payload::commands as payload;
use crate::endpoint::vehicle_command::VehicleCommand;
use mavlink::MessageData;
use spandrel_mavlink::dialect::{
    MISSION_CURRENT_DATA, MISSION_ITEM_INT_DATA, MavCmd, MavFrame, MavMissionType, MavResult, RC_CHANNELS_OVERRIDE_DATA,
};
use spandrel_mavlink::units::deg_e7;

/// Command number in ArduPilot's dialect. Not supported as a mission item.
const DO_AUX_FUNCTION: u16 = 218;
/// Maximum throttle pulse width that counts as throttle down, microseconds (ArduPilot: RC3_MIN and RC3_DZ).
const MAX_THROTTLE_DOWN_US: u16 = 1_030;
/// Minimum height of the takeoff item added before the first saved waypoint, m (ArduPilot: SAVE_WP).
const MIN_TAKEOFF_HEIGHT_M: f32 = 1.0;
/// First channel that is not a stick.
const FIRST_SWITCH_CHANNEL: usize = 5;

/// Functions that enter a mode, with Copter's mode number (ArduPilot: RC_Channel::AUX_FUNC).
const MODE_FUNCTIONS: &[(u16, u32)] = &[
    (4, 6),
    (16, 3),
    (18, 9),
    (33, 17),
    (42, 21),
    (52, 1),
    (55, 4),
    (56, 5),
    (57, 23),
    (68, 0),
    (69, 16),
    (70, 2),
    (72, 7),
    (99, 27),
];

/// Runs the function of every switch that has moved. The first reading of a switch does not count as a movement.
pub(super) fn read_switches(v: &mut VehicleLink, c: &RC_CHANNELS_OVERRIDE_DATA, a: &mut InboundMessage) {
    for (k, us) in manual::aux_channels(c).into_iter().enumerate() {
        if !manual::VALID_PULSES_US.contains(&us) {
            continue;
        }
        let position = SwitchPosition::from_pulse(us);
        let moved = v.switches[k].replace(position).is_some_and(|before| before != position);
        let function = v.params.switch_function(FIRST_SWITCH_CHANNEL + k).filter(|function| moved && *function > 0);
        if let Some(function) = function {
            run(v, function, position, a);
        }
    }
}

/// Handles DO_AUX_FUNCTION: parameter 1 is the function, 2 the switch level. Returns `None` for other commands and for
/// flavors without switches.
pub(crate) fn command(v: &mut VehicleLink, c: &VehicleCommand, a: &mut InboundMessage) -> Option<MavResult> {
    if c.number != DO_AUX_FUNCTION || v.params.switch_function(FIRST_SWITCH_CHANNEL).is_none() {
        return None;
    }
    let Some(position) = c.finite_param(1).and_then(SwitchPosition::from_number) else {
        return Some(MavResult::MAV_RESULT_DENIED);
    };
    let function = c.finite_param(0).filter(|function| (0.0..=f64::from(u16::MAX)).contains(function));
    let done = function.is_some_and(|function| run(v, function as u16, position, a));
    Some(if done { MavResult::MAV_RESULT_ACCEPTED } else { MavResult::MAV_RESULT_FAILED })
}

/// Runs an auxiliary function. Returns false if this vehicle does not support it.
fn run(v: &mut VehicleLink, function: u16, position: SwitchPosition, a: &mut InboundMessage) -> bool {
    let high = position == SwitchPosition::High;
    if let Some((_, mode)) = MODE_FUNCTIONS.iter().find(|(known, _)| *known == function) {
        switch_mode(v, *mode, high, a);
        return true;
    }
    let on = f64::from(u8::from(high));
    match function {
        7 if high => save_waypoint(v, a),
        9 if high => run_equipment_command(v, MavCmd::MAV_CMD_IMAGE_START_CAPTURE, [0.0, 0.0, 1.0], a),
        11 => {
            a.autopilot.request(AutopilotRequest::EnableFence(high), a.now());
        }
        24 if high => restart_mission(v, a),
        28 if position != SwitchPosition::Middle => run_equipment_command(v, MavCmd::MAV_CMD_DO_SET_RELAY, [0.0, on, 0.0], a),
        41 | 153 if position != SwitchPosition::Middle => arm(v, high, a),
        58 if high => {
            v.plans.clear_mission();
            v.update_autopilot_plan(MavMissionType::MAV_MISSION_TYPE_MISSION, a.aircraft.plane, a.autopilot);
        }
        7 | 9 | 24 | 28 | 41 | 58 | 153 => {}
        _ => return false,
    }
    true
}

/// Enters the mode when the switch goes high. When it leaves high, the mode switch selects the mode again.
fn switch_mode(v: &mut VehicleLink, mode: u32, high: bool, a: &mut InboundMessage) {
    let shown = v.flavor.row_of(a.autopilot.status().mode, v.requested_mode).number;
    if high {
        mode_requests::enter_mode(v, mode, a);
    } else if shown == mode
        && let Some(mode) = v.mode_switch.and_then(|position| mode_requests::mode_for_switch(v, position))
    {
        mode_requests::enter_mode(v, mode, a);
    }
}

fn arm(v: &mut VehicleLink, arms: bool, a: &mut InboundMessage) {
    let p = [f64::from(u8::from(arms)), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    commands::execute(&own(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, p, v.system_id), v, a);
}

fn run_equipment_command(v: &VehicleLink, command: MavCmd, [p1, p2, p3]: [f64; 3], a: &mut InboundMessage) {
    let command = own(command, [p1, p2, p3, 0.0, 0.0, 0.0, 0.0], v.system_id);
    payload::handle(&command, a.input, a.payload);
}

fn own(command: MavCmd, p: [f64; 7], system: u8) -> VehicleCommand {
    let from = (system, AUTOPILOT);
    VehicleCommand { number: command as u16, p, frame: 0, component: AUTOPILOT, system, from, whole: false, own: true }
}

fn restart_mission(v: &mut VehicleLink, a: &mut InboundMessage) {
    a.autopilot.set_mission_current(0, true);
    v.announce(MISSION_CURRENT_DATA::ID);
}

/// Appends the vehicle's position to the mission, as a landing if the throttle is down and as a waypoint otherwise.
/// Adds a takeoff item before the first item. Does nothing in AUTO or while disarmed.
fn save_waypoint(v: &mut VehicleLink, a: &mut InboundMessage) {
    let status = a.autopilot.status();
    let Some(home) =
        status.home_m.filter(|_| status.armed && status.mode != FlightMode::Mission && a.autopilot.estimate().position_valid)
    else {
        return;
    };
    let here = a.autopilot.estimate().position_m;
    let geo = a.aircraft.plane.geo_from_enu(here.enu());
    let over_home_m = (home.down() - here.down()) as f32;
    let down = v.manual.pulses_us(a.now()).is_some_and(|pulses| pulses[2] <= MAX_THROTTLE_DOWN_US);
    let item = |command, (x, y), z| MISSION_ITEM_INT_DATA {
        command,
        frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
        x,
        y,
        z,
        autocontinue: 1,
        mission_type: MavMissionType::MAV_MISSION_TYPE_MISSION,
        ..Default::default()
    };
    let here = (deg_e7(geo.latitude_deg), deg_e7(geo.longitude_deg));
    if v.plans.mission().is_empty() {
        v.plans.add(item(MavCmd::MAV_CMD_NAV_TAKEOFF, (0, 0), over_home_m.max(MIN_TAKEOFF_HEIGHT_M)));
    }
    let command = if down { MavCmd::MAV_CMD_NAV_LAND } else { MavCmd::MAV_CMD_NAV_WAYPOINT };
    v.plans.add(item(command, here, over_home_m));
    v.update_autopilot_plan(MavMissionType::MAV_MISSION_TYPE_MISSION, a.aircraft.plane, a.autopilot);
}
