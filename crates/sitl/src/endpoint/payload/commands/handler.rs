//! Rows of the command tables.

use super::super::equipment::Payload;
use super::super::input::PayloadInput;
use crate::endpoint::vehicle_command::VehicleCommand;
use spandrel_mavlink::dialect::{MavCmd, MavResult};

pub(super) const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;
pub(super) const DENIED: MavResult = MavResult::MAV_RESULT_DENIED;

/// Executes a command on the equipment.
pub(super) type PayloadHandler = fn(&VehicleCommand, &PayloadInput, &mut Payload) -> MavResult;
/// A command and its handler.
pub(super) type PayloadCommand = (MavCmd, PayloadHandler);

pub(super) fn accepted_if(ok: bool) -> MavResult {
    if ok { ACCEPTED } else { DENIED }
}
