//! Requests with which the simulator sets up its link to the autopilot.

use super::RelayEndpoint;
use crate::endpoint::component_ids::AUTOPILOT;
use mavlink::MessageData;
use spandrel_mavlink::dialect::{
    ATTITUDE_DATA, AUTOPILOT_VERSION_DATA, EXTENDED_SYS_STATE_DATA, GIMBAL_MANAGER_STATUS_DATA, GLOBAL_POSITION_INT_DATA,
    GPS_RAW_INT_DATA, HOME_POSITION_DATA, LOCAL_POSITION_NED_DATA, MISSION_CURRENT_DATA, MavCmd, MavMessage,
    PARAM_REQUEST_LIST_DATA, SYS_STATUS_DATA, VFR_HUD_DATA,
};
use spandrel_mavlink::station;

/// Messages that the simulator, the monitor and the displays need from the autopilot, and their rates, Hz: the rates of the built-in
/// autopilot (docs/src/reference/wire.md, "Streams").
const STREAMS_HZ: [(u32, f32); 10] = [
    (SYS_STATUS_DATA::ID, 2.0),
    (EXTENDED_SYS_STATE_DATA::ID, 5.0),
    (ATTITUDE_DATA::ID, 50.0),
    (GLOBAL_POSITION_INT_DATA::ID, 10.0),
    (LOCAL_POSITION_NED_DATA::ID, 10.0),
    (GPS_RAW_INT_DATA::ID, 5.0),
    (VFR_HUD_DATA::ID, 10.0),
    (HOME_POSITION_DATA::ID, 0.5),
    (MISSION_CURRENT_DATA::ID, 1.0),
    (GIMBAL_MANAGER_STATUS_DATA::ID, 1.0),
];

impl RelayEndpoint {
    /// Requests the streams and the version once after the first heartbeat of an autopilot process.
    pub(super) fn request_streams(&mut self) {
        if std::mem::replace(&mut self.streams_requested, true) {
            return;
        }
        for (message, rate_hz) in STREAMS_HZ {
            self.command_autopilot(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, [message as f32, 1e6 / rate_hz]);
        }
        self.command_autopilot(MavCmd::MAV_CMD_REQUEST_MESSAGE, [AUTOPILOT_VERSION_DATA::ID as f32, 0.0]);
    }

    /// Requests all parameters, for the record of the session.
    pub fn request_parameters(&mut self) {
        let target_system = self.links.system_id();
        let list = PARAM_REQUEST_LIST_DATA { target_system, target_component: AUTOPILOT };
        self.send_to_autopilot(&MavMessage::PARAM_REQUEST_LIST(list));
    }

    fn command_autopilot(&mut self, command: MavCmd, [first, second]: [f32; 2]) {
        let params = [first, second, 0.0, 0.0, 0.0, 0.0, 0.0];
        let message = station::command(self.links.system_id(), AUTOPILOT, command, params);
        self.send_to_autopilot(&MavMessage::COMMAND_LONG(message));
    }
}
