//! Joystick buttons (MANUAL_CONTROL) and the actions that parameters assign to them.

use super::params::Params;
use crate::endpoint::component_ids::AUTOPILOT;
use crate::endpoint::vehicle_command::VehicleCommand;
use spandrel_mavlink::contract::stick_request::StickRequest;
use spandrel_mavlink::dialect::{MANUAL_CONTROL_DATA, MavCmd, MavStandardMode};

/// Number of buttons that have a parameter; other buttons are ignored.
pub const BUTTON_COUNT: usize = 16;
/// Names of the button parameters.
pub const PARAMETER_NAMES: [&str; BUTTON_COUNT] = [
    "BTN0_FUNCTION",
    "BTN1_FUNCTION",
    "BTN2_FUNCTION",
    "BTN3_FUNCTION",
    "BTN4_FUNCTION",
    "BTN5_FUNCTION",
    "BTN6_FUNCTION",
    "BTN7_FUNCTION",
    "BTN8_FUNCTION",
    "BTN9_FUNCTION",
    "BTN10_FUNCTION",
    "BTN11_FUNCTION",
    "BTN12_FUNCTION",
    "BTN13_FUNCTION",
    "BTN14_FUNCTION",
    "BTN15_FUNCTION",
];
/// The last known button state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ButtonState {
    down: Option<u16>,
}

impl ButtonState {
    /// Returns the buttons pressed since the last message. Buttons already down when a client takes control don't count
    /// as pressed.
    pub fn of(&mut self, m: &MANUAL_CONTROL_DATA) -> impl Iterator<Item = usize> + use<> {
        let before = self.down.replace(m.buttons).unwrap_or(m.buttons);
        let fresh = m.buttons & !before;
        (0..BUTTON_COUNT).filter(move |k| fresh & 1 << k != 0)
    }
}

/// Vehicle state that button actions depend on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ButtonContext {
    /// Whether the lamp is on.
    pub lamp_on: bool,
    /// Gimbal pitch relative to the horizon, degrees.
    pub pitch_deg: f64,
    /// Minimum and maximum gimbal pitch, degrees.
    pub pitch_range_deg: (f64, f64),
    /// Takeoff height above home, m.
    pub take_off_m: f64,
}

/// Gimbal pitch change per press, degrees.
const PITCH_STEP_DEG: f64 = 10.0;
/// MAV_FRAME_GLOBAL_RELATIVE_ALT: altitude relative to home.
const RELATIVE_ALT_FRAME: u8 = 3;

/// Returns the command assigned to a button, executed and rejected like a received command. `None` if no action is
/// assigned.
pub(super) fn command(button: usize, params: &Params, context: &ButtonContext, from: (u8, u8)) -> Option<VehicleCommand> {
    use MavCmd as M;
    let standard = |mode: MavStandardMode| (M::MAV_CMD_DO_SET_STANDARD_MODE, [f64::from(mode as u32), 0.0, 0.0]);
    let aim = |pitch_deg: f64| {
        let (low, high) = context.pitch_range_deg;
        (M::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, [pitch_deg.clamp(low, high), f64::NAN, f64::NAN])
    };
    let (number, [a, b, c]) = match params.whole(PARAMETER_NAMES[button])? {
        1 => (M::MAV_CMD_COMPONENT_ARM_DISARM, [1.0, 0.0, 0.0]),
        2 => (M::MAV_CMD_COMPONENT_ARM_DISARM, [0.0; 3]),
        3 => (M::MAV_CMD_NAV_TAKEOFF, [0.0; 3]),
        4 => (M::MAV_CMD_NAV_LAND, [0.0; 3]),
        5 => (M::MAV_CMD_NAV_RETURN_TO_LAUNCH, [0.0; 3]),
        6 => (M::MAV_CMD_NAV_LOITER_UNLIM, [0.0; 3]),
        7 => standard(MavStandardMode::MAV_STANDARD_MODE_POSITION_HOLD),
        8 => standard(MavStandardMode::MAV_STANDARD_MODE_ALTITUDE_HOLD),
        9 => (M::MAV_CMD_MISSION_START, [0.0; 3]),
        10 => (M::MAV_CMD_IMAGE_START_CAPTURE, [0.0, 0.0, 1.0]),
        11 => (M::MAV_CMD_ILLUMINATOR_ON_OFF, [f64::from(u8::from(!context.lamp_on)), 0.0, 0.0]),
        12 => aim(0.0),
        13 => aim(context.pitch_deg + PITCH_STEP_DEG),
        14 => aim(context.pitch_deg - PITCH_STEP_DEG),
        15 => {
            let (command, [response, number, ..]) = StickRequest::Next.command(0);
            (command, [f64::from(response), f64::from(number), 0.0])
        }
        _ => return None,
    };
    let p = [a, b, c, 0.0, 0.0, 0.0, if number == M::MAV_CMD_NAV_TAKEOFF { context.take_off_m } else { 0.0 }];
    let number = number as u16;
    Some(VehicleCommand { number, p, frame: RELATIVE_ALT_FRAME, component: AUTOPILOT, system: 0, from, whole: false, own: false })
}
