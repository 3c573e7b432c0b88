//! Table of the messages that the autopilot handles.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use super::inbound::InboundMessage;
use super::{
    VehicleLink, events, follow_targets, ftp, ground_station, link_services, log_messages, manual_input, mission_service,
    mode_requests, param_service, setpoint_messages, shell, terrain,
};
use mavlink::MessageData;
use spandrel_mavlink::codec::ReceivedFrame;
use spandrel_mavlink::dialect::*;

macro_rules! handlers {
    ($($name:ident $data:ident $handler:path),* $(,)?) => {
        /// IDs of the messages that the autopilot's interface handles, except for commands.
        pub(crate) const HANDLED: &[u32] = &[$($data::ID),*];

        fn dispatch(v: &mut VehicleLink, message: &MavMessage, arrival: &mut InboundMessage) {
            match message {
                $(MavMessage::$name(body) => $handler(v, body, arrival),)*
                _ => {}
            }
        }
    };
}

handlers! {
    HEARTBEAT HEARTBEAT_DATA ground_station::heartbeat,
    MANUAL_CONTROL MANUAL_CONTROL_DATA manual_input::manual_control,
    RC_CHANNELS_OVERRIDE RC_CHANNELS_OVERRIDE_DATA manual_input::channels,
    SET_MODE SET_MODE_DATA mode_requests::set_mode,
    SET_POSITION_TARGET_LOCAL_NED SET_POSITION_TARGET_LOCAL_NED_DATA setpoint_messages::local_target,
    SET_POSITION_TARGET_GLOBAL_INT SET_POSITION_TARGET_GLOBAL_INT_DATA setpoint_messages::global_target,
    SET_ATTITUDE_TARGET SET_ATTITUDE_TARGET_DATA setpoint_messages::attitude_target,
    FOLLOW_TARGET FOLLOW_TARGET_DATA follow_targets::follow_target,
    GLOBAL_POSITION_INT GLOBAL_POSITION_INT_DATA follow_targets::other_position,
    REQUEST_EVENT REQUEST_EVENT_DATA events::request,
    SERIAL_CONTROL SERIAL_CONTROL_DATA shell::bytes,
    TERRAIN_CHECK TERRAIN_CHECK_DATA terrain::check,
    TIMESYNC TIMESYNC_DATA link_services::timesync,
    PING PING_DATA link_services::ping,
    REQUEST_DATA_STREAM REQUEST_DATA_STREAM_DATA link_services::data_stream,
    FILE_TRANSFER_PROTOCOL FILE_TRANSFER_PROTOCOL_DATA ftp::request,
    PARAM_REQUEST_LIST PARAM_REQUEST_LIST_DATA param_service::list,
    PARAM_REQUEST_READ PARAM_REQUEST_READ_DATA param_service::read,
    PARAM_SET PARAM_SET_DATA param_service::set,
    MISSION_REQUEST_LIST MISSION_REQUEST_LIST_DATA mission_service::list,
    MISSION_REQUEST_INT MISSION_REQUEST_INT_DATA mission_service::item_int,
    MISSION_REQUEST MISSION_REQUEST_DATA mission_service::item,
    MISSION_COUNT MISSION_COUNT_DATA mission_service::count,
    MISSION_ITEM_INT MISSION_ITEM_INT_DATA mission_service::receive_int,
    MISSION_ITEM MISSION_ITEM_DATA mission_service::receive,
    MISSION_CLEAR_ALL MISSION_CLEAR_ALL_DATA mission_service::clear,
    MISSION_ACK MISSION_ACK_DATA mission_service::acknowledgement,
    MISSION_SET_CURRENT MISSION_SET_CURRENT_DATA mission_service::set_current,
    MISSION_REQUEST_PARTIAL_LIST MISSION_REQUEST_PARTIAL_LIST_DATA mission_service::request_partial,
    MISSION_WRITE_PARTIAL_LIST MISSION_WRITE_PARTIAL_LIST_DATA mission_service::write_partial,
    LOG_REQUEST_LIST LOG_REQUEST_LIST_DATA log_messages::list,
    LOG_REQUEST_DATA LOG_REQUEST_DATA_DATA log_messages::data,
    LOG_REQUEST_END LOG_REQUEST_END_DATA log_messages::end,
    LOG_ERASE LOG_ERASE_DATA log_messages::erase,
}

impl VehicleLink {
    /// Handles a message addressed to the autopilot or to all components.
    pub(crate) fn receive(&mut self, frame: &ReceivedFrame, a: &mut InboundMessage) {
        match &frame.message {
            Some(message) => dispatch(self, message, a),
            None => self.reject_unknown_enum(frame, a),
        }
    }

    /// Handles messages that contain an enum value unknown to the dialect.
    fn reject_unknown_enum(&mut self, frame: &ReceivedFrame, a: &mut InboundMessage) {
        let p = frame.payload(255);
        match frame.message_id {
            SET_MODE_DATA::ID => mode_requests::enter_mode(self, u32::from_le_bytes([p[0], p[1], p[2], p[3]]), a),
            SET_POSITION_TARGET_LOCAL_NED_DATA::ID | SET_POSITION_TARGET_GLOBAL_INT_DATA::ID => {
                self.warn_of_stream("Setpoint rejected: unsupported coordinate frame", a.now());
            }
            MISSION_ITEM_INT_DATA::ID | MISSION_ITEM_DATA::ID => mission_service::unknown_item(self, p[37], a),
            MISSION_REQUEST_LIST_DATA::ID | MISSION_CLEAR_ALL_DATA::ID => mission_service::unknown_plan(p[2], a),
            MISSION_COUNT_DATA::ID | MISSION_REQUEST_INT_DATA::ID | MISSION_REQUEST_DATA::ID => {
                mission_service::unknown_plan(p[4], a);
            }
            PARAM_SET_DATA::ID => param_service::unknown_type(self, &p[6..22], a),
            _ => {}
        }
    }
}
