//! MAVLink messages that scripts send through the package.

use spandrel_mavlink::dialect::{COMMAND_INT_DATA, COMMAND_LONG_DATA, MavCmd, MavFrame, MavMessage};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::geodesy::LocalPlane;

/// Creates a command to the autopilot; missing parameters are 0.
pub fn long(command: MavCmd, params: &[f32]) -> MavMessage {
    let p = |k: usize| params.get(k).copied().unwrap_or(0.0);
    MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
        command,
        param1: p(0),
        param2: p(1),
        param3: p(2),
        param4: p(3),
        param5: p(4),
        param6: p(5),
        param7: p(6),
        target_system: 1,
        target_component: 1,
        confirmation: 0,
    })
}

/// Creates a command at a position in the scenario's frame (east, north, up), m.
pub fn at_place(command: MavCmd, params: &[f32], place_m: Vec3<Enu>, plane: &LocalPlane) -> MavMessage {
    let p = |k: usize| params.get(k).copied().unwrap_or(0.0);
    let geo = plane.geo_from_enu(place_m);
    MavMessage::COMMAND_INT(COMMAND_INT_DATA {
        command,
        frame: MavFrame::MAV_FRAME_GLOBAL,
        param1: p(0),
        param2: p(1),
        param3: p(2),
        param4: p(3),
        x: (1e7 * geo.latitude_deg).round() as i32,
        y: (1e7 * geo.longitude_deg).round() as i32,
        z: geo.altitude_m as f32,
        target_system: 1,
        target_component: 1,
        ..COMMAND_INT_DATA::default()
    })
}
