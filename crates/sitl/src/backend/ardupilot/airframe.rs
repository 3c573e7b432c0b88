//! ArduPilot's parameters for an aircraft.
//!
//! Each value has the name and unit of ArduPilot 4.6. If 4.7 renamed it, the table contains both names: ArduPilot ignores names
//! that it does not know. Values are limited to the ranges that ArduPilot documents.

mod devices;
mod flight;
mod motors;
mod operation;
mod table;

use super::frame::{FrameError, frame};
use crate::backend::launch::{LaunchParam, LaunchSettings};
use spandrel_model::vehicle::Vehicle;
use table::Table;

/// Returns the parameters for an aircraft, in the order of the defaults file. Errors if ArduPilot has no frame for its rotors.
pub fn parameters(vehicle: &Vehicle, settings: &LaunchSettings) -> Result<Vec<LaunchParam>, FrameError> {
    let frame = frame(vehicle)?;
    let mut table = Table::default();
    motors::add(&mut table, &vehicle.at_altitude(settings.home.altitude_m), &frame);
    flight::add(&mut table, vehicle);
    devices::add(&mut table, vehicle, settings);
    operation::add(&mut table, settings);
    Ok(table.finish())
}
