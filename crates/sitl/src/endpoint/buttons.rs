//! Buttons of a joystick (MANUAL_CONTROL) and what a press of each does: parameters say so.

use super::commands::VehicleCommand;
use super::params::Params;
use super::streams::AUTOPILOT;
use spandrel_mavlink::dialect::{MANUAL_CONTROL_DATA, MavCmd, MavStandardMode};

/// Buttons that have a parameter; others do nothing.
pub const COUNT: usize = 16;
/// Their parameters.
pub const NAMES: [&str; COUNT] = [
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
/// Buttons as they were last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ButtonState {
    down: Option<u16>,
}

impl ButtonState {
    /// Buttons that are pressed now and were not before. What is down when somebody takes the sticks is no press.
    pub fn of(&mut self, m: &MANUAL_CONTROL_DATA) -> impl Iterator<Item = usize> + use<> {
        let before = self.down.replace(m.buttons).unwrap_or(m.buttons);
        let fresh = m.buttons & !before;
        (0..COUNT).filter(move |k| fresh & 1 << k != 0)
    }
}

/// What a press may need to know.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ButtonContext {
    /// The lamp is on.
    pub lamp_on: bool,
    /// Where the gimbal points, degrees about the horizon, and where it can.
    pub pitch_deg: f64,
    /// See `pitch_deg`.
    pub reach_deg: (f64, f64),
    /// Height of a take-off over home, m.
    pub take_off_m: f64,
}

/// A press moves the gimbal by this much, degrees.
const STEP_DEG: f64 = 10.0;
/// MAV_FRAME_GLOBAL_RELATIVE_ALT: heights over home.
const OVER_HOME: u8 = 3;

/// The command that a button's parameter names: it is obeyed and refused as if it had been sent.
pub(super) fn command(button: usize, params: &Params, seen: &ButtonContext, from: (u8, u8)) -> Option<VehicleCommand> {
    use MavCmd as M;
    let standard = |mode: MavStandardMode| (M::MAV_CMD_DO_SET_STANDARD_MODE, [f64::from(mode as u32), 0.0, 0.0]);
    let aim = |pitch_deg: f64| {
        let (low, high) = seen.reach_deg;
        (M::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, [pitch_deg.clamp(low, high), f64::NAN, f64::NAN])
    };
    let (number, [a, b, c]) = match params.whole(NAMES[button])? {
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
        11 => (M::MAV_CMD_ILLUMINATOR_ON_OFF, [f64::from(u8::from(!seen.lamp_on)), 0.0, 0.0]),
        12 => aim(0.0),
        13 => aim(seen.pitch_deg + STEP_DEG),
        14 => aim(seen.pitch_deg - STEP_DEG),
        _ => return None,
    };
    let p = [a, b, c, 0.0, 0.0, 0.0, if number == M::MAV_CMD_NAV_TAKEOFF { seen.take_off_m } else { 0.0 }];
    let number = number as u16;
    Some(VehicleCommand { number, p, frame: OVER_HOME, component: AUTOPILOT, system: 0, from, whole: false, own: false })
}
