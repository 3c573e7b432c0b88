//! ArduPilot's auxiliary functions by number: switches on transmitter channels (RCn_OPTION) and DO_AUX_FUNCTION.

use super::commands::{self, VehicleCommand};
use super::inbound::InboundMessage;
use super::streams::AUTOPILOT;
use super::{Endpoint, control, manual, param_and_mission_services};
use crate::autopilot::{AutopilotRequest, FlightMode};
use mavlink::MessageData;
use spandrel_mavlink::dialect::{
    MISSION_CURRENT_DATA, MISSION_ITEM_INT_DATA, MavCmd, MavFrame, MavMissionType, MavResult, RC_CHANNELS_OVERRIDE_DATA,
};
use spandrel_mavlink::units::deg_e7;

/// Command number in ArduPilot's dialect. Not supported as a mission item.
const DO_AUX_FUNCTION: u16 = 218;
/// Pulse thresholds of the low and high switch positions, microseconds (ArduPilot: AUX_SWITCH_PWM_TRIGGER_LOW and _HIGH).
const LOW_BELOW_US: u16 = 1_200;
const HIGH_ABOVE_US: u16 = 1_800;
/// Maximum throttle pulse that counts as throttle down, microseconds (ArduPilot: RC3_MIN and RC3_DZ).
const THROTTLE_DOWN_US: u16 = 1_030;
/// Minimum height of the takeoff item added before the first saved waypoint, m (ArduPilot: SAVE_WP).
const LEAST_TAKEOFF_M: f32 = 1.0;
/// First channel that is not a stick.
const FIRST_CHANNEL: usize = 5;

/// Functions that enter a mode, with Copter's mode number (ArduPilot: RC_Channel::AUX_FUNC).
const MODES: &[(u16, u32)] = &[
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

/// Position of a three-position switch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SwitchPosition {
    Low,
    Middle,
    High,
}

impl SwitchPosition {
    fn from_pulse(us: u16) -> Self {
        match us {
            us if us < LOW_BELOW_US => Self::Low,
            us if us > HIGH_ABOVE_US => Self::High,
            _ => Self::Middle,
        }
    }

    fn from_number(number: f64) -> Option<Self> {
        [Self::Low, Self::Middle, Self::High].into_iter().find(|level| (number - f64::from(*level as u8)).abs() < 0.5)
    }
}

/// Runs the function of every switch that has moved. The first reading of a switch does not count as a movement.
pub(super) fn read_switches(e: &mut Endpoint, c: &RC_CHANNELS_OVERRIDE_DATA, a: &mut InboundMessage) {
    for (k, us) in manual::aux_of(c).into_iter().enumerate() {
        if !manual::PULSES_US.contains(&us) {
            continue;
        }
        let level = SwitchPosition::from_pulse(us);
        let moved = e.switches[k].replace(level).is_some_and(|before| before != level);
        let function = e.params.switch_function(FIRST_CHANNEL + k).filter(|function| moved && *function > 0);
        if let Some(function) = function {
            run(e, function, level, a);
        }
    }
}

/// Handles DO_AUX_FUNCTION: parameter 1 is the function, 2 the switch level. Returns `None` for other commands and for flavours
/// without switches.
pub(super) fn command(e: &mut Endpoint, c: &VehicleCommand, a: &mut InboundMessage) -> Option<MavResult> {
    if c.number != DO_AUX_FUNCTION || e.params.switch_function(FIRST_CHANNEL).is_none() {
        return None;
    }
    let Some(level) = c.finite_param(1).and_then(SwitchPosition::from_number) else { return Some(MavResult::MAV_RESULT_DENIED) };
    let function = c.finite_param(0).filter(|function| (0.0..=f64::from(u16::MAX)).contains(function));
    let done = function.is_some_and(|function| run(e, function as u16, level, a));
    Some(if done { MavResult::MAV_RESULT_ACCEPTED } else { MavResult::MAV_RESULT_FAILED })
}

/// Runs an auxiliary function. Returns false if this vehicle does not support it.
fn run(e: &mut Endpoint, function: u16, level: SwitchPosition, a: &mut InboundMessage) -> bool {
    let high = level == SwitchPosition::High;
    if let Some((_, mode)) = MODES.iter().find(|(known, _)| *known == function) {
        switch_mode(e, *mode, high, a);
        return true;
    }
    let on = f64::from(u8::from(high));
    match function {
        7 if high => save_waypoint(e, a),
        9 if high => payload(e, MavCmd::MAV_CMD_IMAGE_START_CAPTURE, [0.0, 0.0, 1.0], a),
        11 => {
            a.autopilot.request(AutopilotRequest::EnableFence(high), a.view.now);
        }
        24 if high => restart_mission(e, a),
        28 if level != SwitchPosition::Middle => payload(e, MavCmd::MAV_CMD_DO_SET_RELAY, [0.0, on, 0.0], a),
        41 | 153 if level != SwitchPosition::Middle => arm(e, high, a),
        58 if high => {
            e.plans.drop_mission();
            param_and_mission_services::update_autopilot_plan(e, MavMissionType::MAV_MISSION_TYPE_MISSION, a.view, a.autopilot);
        }
        7 | 9 | 24 | 28 | 41 | 58 | 153 => {}
        _ => return false,
    }
    true
}

/// Enters the mode when the switch goes high. When it leaves high, the mode switch selects the mode again.
fn switch_mode(e: &mut Endpoint, mode: u32, high: bool, a: &mut InboundMessage) {
    let shown = e.flavour.row_of(a.autopilot.status().mode, e.chosen).number;
    if high {
        control::enter_mode(e, mode, a);
    } else if shown == mode
        && let Some(mode) = e.mode_switch.and_then(|position| control::mode_for_switch(e, position))
    {
        control::enter_mode(e, mode, a);
    }
}

fn arm(e: &mut Endpoint, arms: bool, a: &mut InboundMessage) {
    let p = [f64::from(u8::from(arms)), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    e.execute(&own(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, p, e.system_id), a);
}

fn payload(e: &mut Endpoint, command: MavCmd, [p1, p2, p3]: [f64; 3], a: &InboundMessage) {
    let command = own(command, [p1, p2, p3, 0.0, 0.0, 0.0, 0.0], e.system_id);
    commands::payload::handle(&command, a.view, &mut e.payload);
}

fn own(command: MavCmd, p: [f64; 7], system: u8) -> VehicleCommand {
    let from = (system, AUTOPILOT);
    VehicleCommand { number: command as u16, p, frame: 0, component: AUTOPILOT, system, from, whole: false, own: true }
}

fn restart_mission(e: &mut Endpoint, a: &mut InboundMessage) {
    a.autopilot.set_mission_current(0, true);
    e.payload.changes.add_message(MISSION_CURRENT_DATA::ID);
}

/// Appends the vehicle's position to the mission: a landing if the throttle is down, a waypoint otherwise. A takeoff item is
/// added before the first one. Does nothing in AUTO or while disarmed.
fn save_waypoint(e: &mut Endpoint, a: &mut InboundMessage) {
    let status = a.autopilot.status();
    let Some(home) =
        status.home_m.filter(|_| status.armed && status.mode != FlightMode::Mission && a.view.estimate.position_valid)
    else {
        return;
    };
    let here = a.view.estimate.position_m;
    let geo = a.view.plane.geo_from_enu(here.enu());
    let over_home_m = (home.down() - here.down()) as f32;
    let down = e.manual.pulses_us(a.view.now).is_some_and(|pulses| pulses[2] <= THROTTLE_DOWN_US);
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
    if e.plans.mission().is_empty() {
        e.plans.add(item(MavCmd::MAV_CMD_NAV_TAKEOFF, (0, 0), over_home_m.max(LEAST_TAKEOFF_M)));
    }
    let command = if down { MavCmd::MAV_CMD_NAV_LAND } else { MavCmd::MAV_CMD_NAV_WAYPOINT };
    e.plans.add(item(command, here, over_home_m));
    param_and_mission_services::update_autopilot_plan(e, MavMissionType::MAV_MISSION_TYPE_MISSION, a.view, a.autopilot);
}
