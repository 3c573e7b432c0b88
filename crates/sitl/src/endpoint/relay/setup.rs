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
use spandrel_model::time::SimTime;

/// Messages that the simulator, the monitor and the displays need from the autopilot, and their rates, Hz: the rates of the
/// built-in autopilot (docs/src/reference/wire.md, "Streams").
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

/// Interval after which unanswered requests are repeated, s (estimate). An autopilot drops requests while its start script runs,
/// which takes several simulated seconds at a high simulation speed.
const REPEAT_INTERVAL_S: f64 = 2.0;

impl RelayEndpoint {
    /// Requests the streams and the version after the first heartbeat of an autopilot process.
    pub(super) fn request_streams_once(&mut self) {
        if !std::mem::replace(&mut self.setup.streams, true) {
            self.request_streams();
        }
    }

    /// Repeats the requests that the autopilot has not answered. `link_now` is the clock of the links.
    pub(super) fn repeat_requests(&mut self, link_now: SimTime) {
        if link_now < self.setup.check_at {
            return;
        }
        self.setup.check_at = link_now + SimTime::from_s(REPEAT_INTERVAL_S);
        if self.setup.streams && self.report.version.is_none() {
            self.request_streams();
        }
        let known = self.report.parameters.len();
        let is_stalled = std::mem::replace(&mut self.setup.known_parameters, known) == known;
        if self.setup.parameters && is_stalled && !self.report.has_all_parameters() {
            self.request_parameters();
        }
    }

    fn request_streams(&mut self) {
        for (message, rate_hz) in STREAMS_HZ {
            self.command_autopilot(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, [message as f32, 1e6 / rate_hz]);
        }
        self.command_autopilot(MavCmd::MAV_CMD_REQUEST_MESSAGE, [AUTOPILOT_VERSION_DATA::ID as f32, 0.0]);
    }

    /// Requests all parameters, for the record of the session.
    pub fn request_parameters(&mut self) {
        self.setup.parameters = true;
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
