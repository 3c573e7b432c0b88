//! Control of the gimbal by simple clients.
//!
//! With the built-in autopilot, any client may move the gimbal while nobody is in control. A gimbal manager of an external
//! autopilot ignores clients that have not requested control, so the relay requests it for them.

use super::RelayEndpoint;
use crate::endpoint::component_ids::AUTOPILOT;
use mavlink::MessageData;
use spandrel_mavlink::codec::ReceivedFrame;
use spandrel_mavlink::dialect::{
    GIMBAL_MANAGER_SET_ATTITUDE_DATA, GIMBAL_MANAGER_SET_MANUAL_CONTROL_DATA, GIMBAL_MANAGER_SET_PITCHYAW_DATA, MavCmd,
    MavMessage,
};
use spandrel_mavlink::station;

/// Value of a control parameter in MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE that leaves the controller unchanged.
const NO_CHANGE: f32 = -1.0;
/// Messages that move the gimbal.
const GIMBAL_MESSAGES: [u32; 3] =
    [GIMBAL_MANAGER_SET_ATTITUDE_DATA::ID, GIMBAL_MANAGER_SET_PITCHYAW_DATA::ID, GIMBAL_MANAGER_SET_MANUAL_CONTROL_DATA::ID];

impl RelayEndpoint {
    /// Requests control of the gimbal for a client that moves it while nobody is in control.
    pub(super) fn take_gimbal_control(&mut self, frame: &ReceivedFrame) {
        let moves = match &frame.message {
            Some(MavMessage::COMMAND_LONG(c)) => c.command == MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW,
            Some(MavMessage::COMMAND_INT(c)) => c.command == MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW,
            _ => GIMBAL_MESSAGES.contains(&frame.message_id),
        };
        // PX4 names itself as the controller while no client has control.
        let free = [(0, 0), (self.links.system_id(), AUTOPILOT)].contains(&self.report.gimbal_control);
        if !moves || !self.report.manages_gimbal || !free {
            return;
        }
        let client = (frame.system_id, frame.component_id);
        let params = [f32::from(client.0), f32::from(client.1), NO_CHANGE, NO_CHANGE, 0.0, 0.0, 0.0];
        let configure = MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE;
        let command = station::command(self.links.system_id(), AUTOPILOT, configure, params);
        self.send_to_autopilot(&MavMessage::COMMAND_LONG(command));
        self.report.gimbal_control = client;
    }
}
