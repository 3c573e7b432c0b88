//! Incoming messages: routes each frame, then handles those addressed to this vehicle by a message table.
#![allow(deprecated, reason = "clients still send what MAVLink has superseded")]

use super::camera::stream;
use super::commands::{self, VehicleCommand};
use super::inbound::InboundMessage;
use super::link::PeerLink;
use super::signing_policy::FrameAdmission;
use super::snapshot::VehicleSnapshot;
use super::streams::{AUTOPILOT, CAMERA, STREAMS};
use super::{
    CommandContext, Endpoint, LinkId, aux_functions, camera_params, control, events, ftp, param_and_mission_services, shell,
};
use crate::autopilot::Autopilot;
use mavlink::MessageData;
use spandrel_mavlink::codec::{Decoder, ReceivedFrame};
use spandrel_mavlink::dialect::*;
use spandrel_mavlink::router;
use spandrel_model::time::SimTime;

const COMMAND_ACK: u32 = 77;

macro_rules! handlers {
    ($($name:ident $data:ident $handler:path),* $(,)?) => {
        /// IDs of all messages that the vehicle handles; the fuzz tests mutate each of them.
        pub const HANDLED: &[u32] = &[COMMAND_LONG_DATA::ID, COMMAND_INT_DATA::ID, $($data::ID),*];

        fn dispatch(endpoint: &mut Endpoint, message: &MavMessage, arrival: &mut InboundMessage) {
            match message {
                $(MavMessage::$name(body) => $handler(endpoint, body, arrival),)*
                _ => {}
            }
        }
    };
}

handlers! {
    HEARTBEAT HEARTBEAT_DATA control::heartbeat,
    MANUAL_CONTROL MANUAL_CONTROL_DATA control::manual_control,
    RC_CHANNELS_OVERRIDE RC_CHANNELS_OVERRIDE_DATA control::channels,
    SET_MODE SET_MODE_DATA control::set_mode,
    SET_POSITION_TARGET_LOCAL_NED SET_POSITION_TARGET_LOCAL_NED_DATA control::local_target,
    SET_POSITION_TARGET_GLOBAL_INT SET_POSITION_TARGET_GLOBAL_INT_DATA control::global_target,
    SET_ATTITUDE_TARGET SET_ATTITUDE_TARGET_DATA control::attitude_target,
    GIMBAL_MANAGER_SET_ATTITUDE GIMBAL_MANAGER_SET_ATTITUDE_DATA control::gimbal_attitude,
    GIMBAL_MANAGER_SET_PITCHYAW GIMBAL_MANAGER_SET_PITCHYAW_DATA control::gimbal_pitch_yaw,
    GIMBAL_DEVICE_SET_ATTITUDE GIMBAL_DEVICE_SET_ATTITUDE_DATA control::gimbal_device,
    GIMBAL_MANAGER_SET_MANUAL_CONTROL GIMBAL_MANAGER_SET_MANUAL_CONTROL_DATA control::gimbal_manual,
    FOLLOW_TARGET FOLLOW_TARGET_DATA control::follow_target,
    GLOBAL_POSITION_INT GLOBAL_POSITION_INT_DATA control::other_position,
    REQUEST_EVENT REQUEST_EVENT_DATA events::request,
    SERIAL_CONTROL SERIAL_CONTROL_DATA shell::bytes,
    TIMESYNC TIMESYNC_DATA param_and_mission_services::timesync,
    PING PING_DATA param_and_mission_services::ping,
    REQUEST_DATA_STREAM REQUEST_DATA_STREAM_DATA param_and_mission_services::data_stream,
    FILE_TRANSFER_PROTOCOL FILE_TRANSFER_PROTOCOL_DATA ftp::request,
    PARAM_REQUEST_LIST PARAM_REQUEST_LIST_DATA param_and_mission_services::param_list,
    PARAM_REQUEST_READ PARAM_REQUEST_READ_DATA param_and_mission_services::param_read,
    PARAM_SET PARAM_SET_DATA param_and_mission_services::param_set,
    PARAM_EXT_REQUEST_LIST PARAM_EXT_REQUEST_LIST_DATA camera_params::list,
    PARAM_EXT_REQUEST_READ PARAM_EXT_REQUEST_READ_DATA camera_params::read,
    PARAM_EXT_SET PARAM_EXT_SET_DATA camera_params::set,
    MISSION_REQUEST_LIST MISSION_REQUEST_LIST_DATA param_and_mission_services::mission_list,
    MISSION_REQUEST_INT MISSION_REQUEST_INT_DATA param_and_mission_services::mission_item_int,
    MISSION_REQUEST MISSION_REQUEST_DATA param_and_mission_services::mission_item,
    MISSION_COUNT MISSION_COUNT_DATA param_and_mission_services::mission_count,
    MISSION_ITEM_INT MISSION_ITEM_INT_DATA param_and_mission_services::mission_receive_int,
    MISSION_ITEM MISSION_ITEM_DATA param_and_mission_services::mission_receive,
    MISSION_CLEAR_ALL MISSION_CLEAR_ALL_DATA param_and_mission_services::mission_clear,
    MISSION_ACK MISSION_ACK_DATA param_and_mission_services::mission_ack,
    MISSION_SET_CURRENT MISSION_SET_CURRENT_DATA param_and_mission_services::mission_set_current,
    MISSION_REQUEST_PARTIAL_LIST MISSION_REQUEST_PARTIAL_LIST_DATA param_and_mission_services::mission_request_partial,
    MISSION_WRITE_PARTIAL_LIST MISSION_WRITE_PARTIAL_LIST_DATA param_and_mission_services::mission_write_partial,
    VIDEO_STREAM_STATUS VIDEO_STREAM_STATUS_DATA stream::status,
    LOG_REQUEST_LIST LOG_REQUEST_LIST_DATA param_and_mission_services::log_list,
    LOG_REQUEST_DATA LOG_REQUEST_DATA_DATA param_and_mission_services::log_data,
    LOG_REQUEST_END LOG_REQUEST_END_DATA param_and_mission_services::log_end,
    LOG_ERASE LOG_ERASE_DATA param_and_mission_services::log_erase,
}

impl Endpoint {
    /// Returns the tokens of lockstep responses in a datagram, from admitted senders. `receive` processes the datagram later.
    #[must_use]
    pub fn lockstep_answers(&self, id: LinkId, bytes: &[u8]) -> Vec<i64> {
        let Some(link) = self.links.get(&id) else { return Vec::new() };
        // Check with a copy: recording the frame would make it a replay when it is processed.
        let mut guard = self.guard.clone();
        let mut admitted =
            |frame: &ReceivedFrame| guard.as_mut().map_or(FrameAdmission::Execute, |guard| guard.admit(frame, link.kind));
        let frames = Decoder::new().datagram(bytes);
        frames
            .iter()
            .filter_map(|frame| Some((frame, self.step_token(link, frame)?)))
            .filter(|(frame, _)| admitted(frame) == FrameAdmission::Execute)
            .map(|(_, token)| token)
            .collect()
    }

    /// Returns the token of a frame that answers a lockstep request; responses to other systems are routed normally.
    fn step_token(&self, link: &PeerLink, frame: &ReceivedFrame) -> Option<i64> {
        let Some(MavMessage::TIMESYNC(sync)) = &frame.message else { return None };
        let (system, component) = router::target(frame);
        let ours = system == 0 || (system == self.system_id && matches!(component, 0 | AUTOPILOT));
        Some(sync.ts1).filter(|token| ours && sync.tc1 != 0 && link.is_answer(*token))
    }

    /// Processes a datagram received on a link.
    pub fn receive(&mut self, id: LinkId, bytes: &[u8], view: &VehicleSnapshot, autopilot: &mut Autopilot) {
        let Some(link) = self.links.get_mut(&id) else { return };
        let before = link.decoder.bad_bytes();
        let kind = link.kind;
        let frames = link.decoder.datagram(bytes);
        self.bad_bytes += link.decoder.bad_bytes() - before;
        for frame in frames {
            let admitted = self.guard.as_mut().map_or(FrameAdmission::Execute, |guard| guard.admit(&frame, kind));
            if admitted == FrameAdmission::Execute
                && self.links.get(&id).is_some_and(|link| self.step_token(link, &frame).is_some())
            {
                self.join(id);
                continue;
            }
            if admitted != FrameAdmission::Reject {
                self.wake(id, &frame, view.now);
                self.route(id, &frame, view.now);
            }
            if admitted == FrameAdmission::Execute {
                self.handle_frame(id, &frame, view, autopilot);
            }
        }
    }

    /// Starts the streams of a link when a heartbeat arrives.
    fn wake(&mut self, from: LinkId, frame: &ReceivedFrame, now: SimTime) {
        if frame.message_id == HEARTBEAT_DATA::ID
            && let Some(link) = self.links.get_mut(&from)
        {
            link.wake(now);
        }
    }

    fn route(&mut self, from: LinkId, frame: &ReceivedFrame, now: SimTime) {
        // Reject frames that impersonate the vehicle's own components.
        if frame.system_id == self.system_id && matches!(frame.component_id, AUTOPILOT | CAMERA) {
            return;
        }
        self.router.note(from, frame);
        let all: Vec<LinkId> = self.links.keys().copied().collect();
        let onward = self.router.targets_of(from, frame, &all);
        if onward.is_empty() || !self.links.get_mut(&from).is_some_and(|link| link.may_forward(now)) {
            return;
        }
        for onward in onward {
            let to_all = router::target(frame).0 == 0;
            if let Some(link) = self.links.get_mut(&onward).filter(|link| !(link.answers_only && to_all)) {
                link.forward(frame.bytes.clone());
            }
        }
    }

    /// Records inputs that affect the vehicle, with their sender, for the digest. Sequence numbers, checksums and client clocks
    /// are excluded.
    fn record_for_digest(&mut self, frame: &ReceivedFrame) {
        let clocked = match frame.message_id {
            // Time requests: they don't affect the vehicle, and they contain wall time.
            TIMESYNC_DATA::ID | PING_DATA::ID => return,
            // The sender's time_boot_ms, at the start of the payload.
            SET_POSITION_TARGET_LOCAL_NED_DATA::ID | SET_POSITION_TARGET_GLOBAL_INT_DATA::ID | SET_ATTITUDE_TARGET_DATA::ID => {
                size_of::<u32>()
            }
            id if HANDLED.contains(&id) => 0,
            _ => return,
        };
        self.acted.extend(frame.message_id.to_le_bytes());
        self.acted.extend([frame.system_id, frame.component_id]);
        self.acted.extend(&frame.payload(255)[clocked..]);
    }

    /// Returns the inputs recorded since the last call, for the digest.
    pub fn take_digest_input(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.acted)
    }

    /// Handles a frame addressed to this system: by default as the autopilot component; the camera component has commands,
    /// settings and files of its own.
    fn handle_frame(&mut self, id: LinkId, frame: &ReceivedFrame, view: &VehicleSnapshot, autopilot: &mut Autopilot) {
        let (system, component) = router::target(frame);
        if system != 0 && system != self.system_id {
            return;
        }
        if component == CAMERA
            && let Some(link) = self.links.get_mut(&id)
        {
            link.use_camera();
        }
        self.record_for_digest(frame);
        let mut arrival = InboundMessage { link: id, from: (frame.system_id, frame.component_id), view, autopilot };
        match (component, VehicleCommand::of(frame)) {
            (0 | AUTOPILOT | CAMERA, Some(command)) => self.command(&command, &mut arrival),
            (0 | AUTOPILOT, None) => match &frame.message {
                Some(message) => dispatch(self, message, &mut arrival),
                None => self.answer_unreadable(frame, &mut arrival),
            },
            (CAMERA, None) => self.handle_camera_frame(frame, &mut arrival),
            _ => {}
        }
    }

    fn handle_camera_frame(&mut self, frame: &ReceivedFrame, a: &mut InboundMessage) {
        match &frame.message {
            Some(MavMessage::FILE_TRANSFER_PROTOCOL(request)) => ftp::request_of_camera(self, request, a),
            Some(
                message @ (MavMessage::PARAM_EXT_REQUEST_LIST(_)
                | MavMessage::PARAM_EXT_REQUEST_READ(_)
                | MavMessage::PARAM_EXT_SET(_)),
            ) => dispatch(self, message, a),
            None if frame.message_id == PARAM_EXT_SET_DATA::ID => camera_params::unknown_type(self, &frame.payload(255), a),
            _ => {}
        }
    }

    /// Executes a received command or a button's command. Returns `None` if the link was closed.
    pub(super) fn execute(&mut self, command: &VehicleCommand, a: &mut InboundMessage) -> Option<MavResult> {
        let link = self.links.get_mut(&a.link)?;
        let mut context = CommandContext {
            view: a.view.with_payload(&self.payload).for_link(link.kind),
            autopilot: &mut *a.autopilot,
            payload: &mut self.payload,
            link,
            texts: &mut self.texts,
            params: &mut self.params,
            storage: &mut self.storage,
            restart: &mut self.restart,
            faults: &mut self.injections,
            requested_mode: &mut self.chosen,
            report: &mut self.events.asked,
            calibration: &mut self.calibration,
        };
        let before = context.params.changes();
        let result = commands::handle(command, &mut context);
        if self.params.changes() != before {
            self.parameters_changed(a.autopilot);
        }
        Some(result)
    }

    fn command(&mut self, command: &VehicleCommand, a: &mut InboundMessage) {
        let done = match aux_functions::command(self, command, a) {
            Some(result) => Some(result),
            None => self.execute(command, a),
        };
        let Some(result) = done else { return };
        let component = if command.component == CAMERA { CAMERA } else { AUTOPILOT };
        let number = command.number.to_le_bytes();
        // Encoded manually because the command number may be unknown to the dialect.
        let payload = [number[0], number[1], result as u8, 0, 0, 0, 0, 0, command.from.0, command.from.1];
        if let Some(link) = self.links.get_mut(&a.link) {
            link.send_payload(component, COMMAND_ACK, &payload);
            let view = a.view.with_payload(&self.payload).for_link(link.kind);
            for row in std::mem::take(&mut link.after_acknowledgement) {
                if let Some(message) = STREAMS[row].build(&view) {
                    link.send(STREAMS[row].component, &message);
                }
            }
        }
    }

    /// Handles messages that contain an enum value unknown to the dialect.
    fn answer_unreadable(&mut self, frame: &ReceivedFrame, a: &mut InboundMessage) {
        let p = frame.payload(255);
        match frame.message_id {
            SET_MODE_DATA::ID => control::enter_mode(self, u32::from_le_bytes([p[0], p[1], p[2], p[3]]), a),
            SET_POSITION_TARGET_LOCAL_NED_DATA::ID | SET_POSITION_TARGET_GLOBAL_INT_DATA::ID => {
                self.warn_all("Setpoint rejected: unsupported coordinate frame", a.view.now);
            }
            MISSION_ITEM_INT_DATA::ID | MISSION_ITEM_DATA::ID => param_and_mission_services::unknown_item(self, p[37], a),
            MISSION_REQUEST_LIST_DATA::ID | MISSION_CLEAR_ALL_DATA::ID => param_and_mission_services::unknown_plan(self, p[2], a),
            MISSION_COUNT_DATA::ID | MISSION_REQUEST_INT_DATA::ID | MISSION_REQUEST_DATA::ID => {
                param_and_mission_services::unknown_plan(self, p[4], a);
            }
            PARAM_SET_DATA::ID => param_and_mission_services::unknown_type(self, &p[6..22], a),
            _ => {}
        }
    }

    /// Sends a message to a link.
    pub(super) fn answer(&mut self, id: LinkId, message: &MavMessage) {
        self.answer_as(AUTOPILOT, id, message);
    }

    /// Sends a message to a link from a component.
    pub(super) fn answer_as(&mut self, component: u8, id: LinkId, message: &MavMessage) {
        if let Some(link) = self.links.get_mut(&id) {
            link.send(component, message);
        }
    }
}
