//! Camera, gimbal and lamp commands: one row per command, used for received commands and for mission items. Also the command that
//! sends the inspector to another place, which is not a mission item.

mod camera;
mod gimbal;
mod handler;
mod inspector;
mod lamp;
pub(crate) mod region_of_interest;

use super::equipment::Payload;
use super::input::PayloadInput;
use crate::endpoint::vehicle_command::VehicleCommand;
use handler::{PayloadCommand, PayloadHandler};
pub(crate) use inspector::handle as handle_inspector;
use spandrel_mavlink::dialect::{MavCmd, MavResult};

/// Commands accepted only by the autopilot component, which owns the gimbal and the lamp.
const AUTOPILOT_COMPONENT_ROWS: [&[PayloadCommand]; 2] = [gimbal::ROWS, lamp::ROWS];

/// Checks whether the payload supports this command.
pub(crate) fn is_supported(command: MavCmd) -> bool {
    camera::ROWS.iter().chain(AUTOPILOT_COMPONENT_ROWS.into_iter().flatten()).any(|(known, _)| *known == command)
}

fn row(number: u16, rows: &'static [PayloadCommand]) -> Option<PayloadHandler> {
    rows.iter().find(|(command, _)| *command as u16 == number).map(|(_, act)| *act)
}

/// Handles a command addressed to the camera component.
pub(crate) fn handle_camera(c: &VehicleCommand, input: &PayloadInput, payload: &mut Payload) -> Option<MavResult> {
    Some(row(c.number, camera::ROWS)?(c, input, payload))
}

/// Handles a command addressed to the lamp.
pub(crate) fn handle_lamp(c: &VehicleCommand, input: &PayloadInput, payload: &mut Payload) -> Option<MavResult> {
    Some(row(c.number, lamp::ROWS)?(c, input, payload))
}

/// Handles a command addressed to the autopilot component.
pub(crate) fn handle(c: &VehicleCommand, input: &PayloadInput, payload: &mut Payload) -> Option<MavResult> {
    let mounted = || AUTOPILOT_COMPONENT_ROWS.into_iter().find_map(|rows| row(c.number, rows));
    handle_camera(c, input, payload).or_else(|| Some(mounted()?(c, input, payload)))
}

/// Checks whether the payload handles this command.
pub(crate) fn handles(c: &VehicleCommand) -> bool {
    camera::ROWS.iter().chain(AUTOPILOT_COMPONENT_ROWS.into_iter().flatten()).any(|(known, _)| *known as u16 == c.number)
}

/// Returns the reason for rejecting a command, as text.
pub(crate) fn refusal_text(c: &VehicleCommand, input: &PayloadInput, payload: &Payload) -> String {
    if row(c.number, gimbal::ROWS).is_some() {
        let (gimbal, camera) = (&payload.gimbal, &input.vehicle.camera);
        if !(c.own || gimbal.accepts_control_from(c.from)) {
            return format!("gimbal is controlled by {}/{}", gimbal.control.0, gimbal.control.1);
        }
        let [low, high] = [camera.gimbal_pitch_min_rad, camera.gimbal_pitch_max_rad].map(f64::to_degrees);
        return format!("gimbal pitch range {low:.0} to {high:.0} deg, no yaw or retract");
    }
    if row(c.number, lamp::ROWS).is_some() {
        let has_lamp = input.vehicle.lamp.luminous_flux_lm > 0.0;
        return if has_lamp { "the lamp is relay 0 or servo 9 and can only be on or off" } else { "this aircraft has no lamp" }
            .into();
    }
    "the camera does not support these values or this mode".into()
}
