//! Messages sent by ground station clients: heartbeats, commands, and position mode selection.

use super::dialect::{
    COMMAND_INT_DATA, COMMAND_LONG_DATA, HEARTBEAT_DATA, MavAutopilot, MavCmd, MavFrame, MavMessage, MavModeFlag,
    MavStandardMode, MavState, MavType,
};
use super::units::deg_e7;
use spandrel_model::geodesy::Geo;

/// PX4's main mode number for "Position" (POSCTL).
const PX4_POSITION_MODE: f32 = 3.0;
/// ArduCopter's mode number for "Loiter". Unlike PosHold, it limits the speed at full stick.
const COPTER_LOITER_MODE: f32 = 5.0;

/// Creates a ground station heartbeat.
#[must_use]
pub fn heartbeat() -> MavMessage {
    MavMessage::HEARTBEAT(HEARTBEAT_DATA {
        mavtype: MavType::MAV_TYPE_GCS,
        autopilot: MavAutopilot::MAV_AUTOPILOT_INVALID,
        mavlink_version: 3,
        ..HEARTBEAT_DATA::default()
    })
}

/// Creates a heartbeat for a companion component that does not control the vehicle, such as the monitor or an observer.
/// The dialect's default cannot be used, because it reports an armed vehicle.
#[must_use]
pub fn companion_heartbeat() -> MavMessage {
    MavMessage::HEARTBEAT(HEARTBEAT_DATA {
        mavtype: MavType::MAV_TYPE_ONBOARD_CONTROLLER,
        autopilot: MavAutopilot::MAV_AUTOPILOT_INVALID,
        base_mode: MavModeFlag::empty(),
        system_status: MavState::MAV_STATE_ACTIVE,
        mavlink_version: 3,
        ..HEARTBEAT_DATA::default()
    })
}

/// Creates a command for a vehicle component, with confirmation 0.
#[must_use]
pub fn command(system: u8, component: u8, command: MavCmd, params: [f32; 7]) -> COMMAND_LONG_DATA {
    COMMAND_LONG_DATA {
        command,
        param1: params[0],
        param2: params[1],
        param3: params[2],
        param4: params[3],
        param5: params[4],
        param6: params[5],
        param7: params[6],
        target_system: system,
        target_component: component,
        confirmation: 0,
    }
}

/// Creates a command with a position, which replaces parameters 5 to 7. The altitude is above mean sea level.
#[must_use]
pub fn command_at(system: u8, component: u8, command: MavCmd, params: [f32; 4], place: Geo) -> COMMAND_INT_DATA {
    COMMAND_INT_DATA {
        command,
        frame: MavFrame::MAV_FRAME_GLOBAL,
        param1: params[0],
        param2: params[1],
        param3: params[2],
        param4: params[3],
        x: deg_e7(place.latitude_deg),
        y: deg_e7(place.longitude_deg),
        z: place.altitude_m as f32,
        target_system: system,
        target_component: component,
        ..COMMAND_INT_DATA::default()
    }
}

/// Returns the first `N` parameters of a command. Missing parameters are 0.
#[must_use]
pub fn params<const N: usize>(given: &[f32]) -> [f32; N] {
    std::array::from_fn(|k| given.get(k).copied().unwrap_or(0.0))
}

/// Returns the command that selects position mode, where the sticks command velocity. Uses the mode numbers of PX4 and
/// ArduPilot, and the standard mode for other autopilots.
#[must_use]
pub fn position_mode(autopilot: Option<MavAutopilot>) -> (MavCmd, [f32; 7]) {
    let (command, [a, b]) = match autopilot {
        Some(MavAutopilot::MAV_AUTOPILOT_PX4) => (MavCmd::MAV_CMD_DO_SET_MODE, [1.0, PX4_POSITION_MODE]),
        Some(MavAutopilot::MAV_AUTOPILOT_ARDUPILOTMEGA) => (MavCmd::MAV_CMD_DO_SET_MODE, [1.0, COPTER_LOITER_MODE]),
        _ => (MavCmd::MAV_CMD_DO_SET_STANDARD_MODE, [MavStandardMode::MAV_STANDARD_MODE_POSITION_HOLD as u32 as f32, 0.0]),
    };
    (command, [a, b, 0.0, 0.0, 0.0, 0.0, 0.0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_position_mode_uses_each_autopilots_mode_number() {
        let asked = |autopilot| {
            let (command, params) = position_mode(autopilot);
            (command, params[0], params[1])
        };
        assert_eq!(asked(Some(MavAutopilot::MAV_AUTOPILOT_PX4)), (MavCmd::MAV_CMD_DO_SET_MODE, 1.0, 3.0));
        assert_eq!(asked(Some(MavAutopilot::MAV_AUTOPILOT_ARDUPILOTMEGA)), (MavCmd::MAV_CMD_DO_SET_MODE, 1.0, 5.0));
        // The parameter is MAV_STANDARD_MODE_POSITION_HOLD.
        assert_eq!(asked(None), (MavCmd::MAV_CMD_DO_SET_STANDARD_MODE, 1.0, 0.0));
    }
}
