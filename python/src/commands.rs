//! MAVLink messages that scripts send through the package.

use spandrel_mavlink::dialect::{MavCmd, MavMessage};
use spandrel_mavlink::station;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::geodesy::LocalPlane;

/// Creates a command to the autopilot; missing parameters are 0.
pub fn long(command: MavCmd, params: &[f32]) -> MavMessage {
    MavMessage::COMMAND_LONG(station::command(1, 1, command, station::params(params)))
}

/// Creates a command at a position in the scenario's frame (east, north, up, in meters).
pub fn at_place(command: MavCmd, params: &[f32], place_m: Vec3<Enu>, plane: &LocalPlane) -> MavMessage {
    MavMessage::COMMAND_INT(station::command_at(1, 1, command, station::params(params), plane.geo_from_enu(place_m)))
}
