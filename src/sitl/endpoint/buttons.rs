//! Buttons of a joystick (MANUAL_CONTROL) and what a press of each does: parameters say so.

use super::Payload;
use super::commands::{Command, payload};
use super::params::Params;
use super::streams::AUTOPILOT;
use super::view::View;
use crate::mav::dialect::{MANUAL_CONTROL_DATA, MavCmd, MavResult};
use crate::sitl::autopilot::{Autopilot, Mode, Outcome, Request};

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
pub struct Presses {
    down: Option<u16>,
}

impl Presses {
    /// Buttons that are pressed now and were not before. What is down when somebody takes the sticks is no press.
    pub fn of(&mut self, m: &MANUAL_CONTROL_DATA) -> impl Iterator<Item = usize> + use<> {
        let before = self.down.replace(m.buttons).unwrap_or(m.buttons);
        let fresh = m.buttons & !before;
        (0..COUNT).filter(move |k| fresh & 1 << k != 0)
    }
}

/// Who pressed, and what may be touched to obey.
pub(super) struct Press<'a, 'v> {
    /// Who pressed.
    pub from: (u8, u8),
    /// The vehicle now.
    pub view: &'a View<'v>,
    /// Camera, gimbal, lamp.
    pub payload: &'a mut Payload,
    /// Who flies.
    pub autopilot: &'a mut Autopilot,
}

/// Does what a button's parameter says; a refusal comes back as words.
pub(super) fn press(button: usize, params: &Params, x: &mut Press) -> Option<String> {
    let (on, pitch_deg) = (x.payload.lamp.on, x.view.gimbal.pitch_rad.to_degrees());
    let request = match params.whole(NAMES[button])? {
        1 => Request::Arm { force: false },
        2 => Request::Disarm { force: false },
        3 => Request::Takeoff { height_m: None },
        4 => Request::Land,
        5 => Request::SetMode(Mode::Return),
        6 => Request::SetMode(Mode::Hold),
        7 => Request::SetMode(Mode::Position),
        8 => Request::SetMode(Mode::Altitude),
        9 => Request::StartMission { first: None },
        10 => return x.act(MavCmd::MAV_CMD_IMAGE_START_CAPTURE, [0.0, 0.0, 1.0]),
        11 => return x.act(MavCmd::MAV_CMD_ILLUMINATOR_ON_OFF, [f64::from(u8::from(!on)), 0.0, 0.0]),
        12 => return x.aim(0.0),
        13 => return x.aim(pitch_deg + STEP_DEG),
        14 => return x.aim(pitch_deg - STEP_DEG),
        _ => return None,
    };
    match x.autopilot.request(request, x.view.now) {
        Outcome::Accepted | Outcome::Unsupported => None,
        Outcome::TemporarilyRejected(why) | Outcome::Denied(why) | Outcome::Failed(why) => Some(why),
    }
}

/// A press moves the gimbal by this much, degrees.
const STEP_DEG: f64 = 10.0;

impl Press<'_, '_> {
    fn aim(&mut self, pitch_deg: f64) -> Option<String> {
        let camera = &self.view.vehicle.camera;
        let (low, high) = (camera.gimbal_pitch_min_rad.to_degrees(), camera.gimbal_pitch_max_rad.to_degrees());
        self.act(MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, [pitch_deg.clamp(low, high), f64::NAN, f64::NAN])
    }

    /// As a command with these first parameters.
    fn act(&mut self, number: MavCmd, [a, b, c]: [f64; 3]) -> Option<String> {
        let p = [a, b, c, 0.0, 0.0, 0.0, 0.0];
        let command =
            Command { number: number as u16, p, frame: 0, component: AUTOPILOT, system: 0, from: self.from, whole: false };
        let done = payload::handle(&command, self.view, self.payload);
        (done != Some(MavResult::MAV_RESULT_ACCEPTED)).then(|| "Button: the payload refuses".to_owned())
    }
}
