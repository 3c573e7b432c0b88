//! Table of the messages that the equipment handles.

use super::inbound::PayloadMessage;
use super::{PayloadLink, camera_params, gimbal_messages, video_reports};
use crate::endpoint::component_ids::{AUTOPILOT, CAMERA, GIMBAL};
use mavlink::MessageData;
use spandrel_mavlink::codec::ReceivedFrame;
use spandrel_mavlink::dialect::*;
use spandrel_mavlink::ftp::FtpPacket;

macro_rules! handlers {
    ($($name:ident $data:ident $handler:path),* $(,)?) => {
        /// IDs of the messages that the equipment handles.
        pub(crate) const HANDLED: &[u32] = &[$($data::ID),*];

        fn dispatch(p: &mut PayloadLink, message: &MavMessage, arrival: &mut PayloadMessage) {
            match message {
                $(MavMessage::$name(body) => $handler(p, body, arrival),)*
                _ => {}
            }
        }
    };
}

handlers! {
    GIMBAL_MANAGER_SET_ATTITUDE GIMBAL_MANAGER_SET_ATTITUDE_DATA gimbal_messages::attitude,
    GIMBAL_MANAGER_SET_PITCHYAW GIMBAL_MANAGER_SET_PITCHYAW_DATA gimbal_messages::pitch_yaw,
    GIMBAL_DEVICE_SET_ATTITUDE GIMBAL_DEVICE_SET_ATTITUDE_DATA gimbal_messages::device_attitude,
    GIMBAL_MANAGER_SET_MANUAL_CONTROL GIMBAL_MANAGER_SET_MANUAL_CONTROL_DATA gimbal_messages::manual_control,
    PARAM_EXT_REQUEST_LIST PARAM_EXT_REQUEST_LIST_DATA camera_params::list,
    PARAM_EXT_REQUEST_READ PARAM_EXT_REQUEST_READ_DATA camera_params::read,
    PARAM_EXT_SET PARAM_EXT_SET_DATA camera_params::set,
    VIDEO_STREAM_STATUS VIDEO_STREAM_STATUS_DATA video_reports::status,
}

impl PayloadLink {
    /// Handles a message addressed to the camera, to the component that owns the gimbal and the lamp, or to all
    /// components.
    pub(crate) fn receive(&mut self, component: u8, frame: &ReceivedFrame, a: &mut PayloadMessage) {
        match (component, &frame.message) {
            (0 | AUTOPILOT, Some(message)) => dispatch(self, message, a),
            (CAMERA, _) => self.receive_as_camera(frame, a),
            _ => {}
        }
    }

    /// Handles a message beside an external autopilot, which is the gimbal manager: addressed to the camera, to the gimbal device
    /// or to all components.
    pub(crate) fn receive_beside_autopilot(&mut self, component: u8, frame: &ReceivedFrame, a: &mut PayloadMessage) {
        match (component, &frame.message) {
            (CAMERA, _) => self.receive_as_camera(frame, a),
            (0 | GIMBAL, Some(message @ MavMessage::GIMBAL_DEVICE_SET_ATTITUDE(_))) => dispatch(self, message, a),
            (
                0,
                Some(
                    message @ (MavMessage::VIDEO_STREAM_STATUS(_)
                    | MavMessage::PARAM_EXT_REQUEST_LIST(_)
                    | MavMessage::PARAM_EXT_REQUEST_READ(_)
                    | MavMessage::PARAM_EXT_SET(_)),
                ),
            ) => dispatch(self, message, a),
            _ => {}
        }
    }

    fn receive_as_camera(&mut self, frame: &ReceivedFrame, a: &mut PayloadMessage) {
        match &frame.message {
            Some(MavMessage::FILE_TRANSFER_PROTOCOL(request)) => {
                self.files.receive((a.link, a.from), &FtpPacket::read(&request.payload), a.input.clock.now);
            }
            Some(
                message @ (MavMessage::PARAM_EXT_REQUEST_LIST(_)
                | MavMessage::PARAM_EXT_REQUEST_READ(_)
                | MavMessage::PARAM_EXT_SET(_)),
            ) => dispatch(self, message, a),
            None if frame.message_id == PARAM_EXT_SET_DATA::ID => camera_params::unknown_type(&frame.payload(255), a),
            _ => {}
        }
    }
}
