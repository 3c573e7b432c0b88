//! Received datagrams: each frame is routed, and frames addressed to this vehicle are handled by the autopilot or
//! payload interface.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use super::component_ids::{AUTOPILOT, CAMERA};
use super::inputs::{StreamInputs, payload_input};
use super::link::{FrameAdmission, LinkId, ReceivedDatagram};
use super::message_requests::{self, MessageRequest};
use super::payload::{self, PayloadMessage};
use super::simulated_aircraft::SimulatedAircraft;
use super::streams::STREAMS;
use super::vehicle_command::VehicleCommand;
use super::vehicle_link::{self, InboundMessage, aux_functions, commands};
use super::{Endpoint, payload::commands as payload_commands};
use crate::autopilot::Autopilot;
use mavlink::MessageData;
use spandrel_mavlink::codec::ReceivedFrame;
use spandrel_mavlink::dialect::*;
use spandrel_mavlink::router;

const COMMAND_ACK: u32 = 77;
const COMMANDS: [u32; 2] = [COMMAND_LONG_DATA::ID, COMMAND_INT_DATA::ID];

const ALL_HANDLED: [u32; COMMANDS.len() + vehicle_link::HANDLED.len() + payload::HANDLED.len()] = {
    let mut all = [0; COMMANDS.len() + vehicle_link::HANDLED.len() + payload::HANDLED.len()];
    let parts: [&[u32]; 3] = [&COMMANDS, vehicle_link::HANDLED, payload::HANDLED];
    let (mut at, mut part) = (0, 0);
    while part < parts.len() {
        let mut k = 0;
        while k < parts[part].len() {
            all[at] = parts[part][k];
            (at, k) = (at + 1, k + 1);
        }
        part += 1;
    }
    all
};

/// IDs of all messages that the vehicle handles; the fuzz tests mutate every one.
pub const HANDLED: &[u32] = &ALL_HANDLED;

impl Endpoint {
    /// Processes a datagram received on a link.
    pub fn receive(&mut self, id: LinkId, datagram: ReceivedDatagram, aircraft: &SimulatedAircraft, autopilot: &mut Autopilot) {
        if self.links.get(id).is_none() {
            return;
        }
        for frame in self.links.take_frames(datagram) {
            let admission = self.links.admit(id, &frame);
            if admission == FrameAdmission::Execute && self.links.is_lockstep_answer(id, &frame) {
                self.links.join_lockstep(id);
                continue;
            }
            let now = aircraft.clock.now;
            if admission != FrameAdmission::Reject {
                if frame.message_id == HEARTBEAT_DATA::ID {
                    self.links.start_streams(id, now);
                }
                self.links.route(id, &frame, now);
            }
            if admission == FrameAdmission::Execute {
                self.handle_frame(id, &frame, aircraft, autopilot);
            }
        }
    }

    /// Records inputs that affect the vehicle, along with their sender, for the digest. Sequence numbers, checksums and
    /// client clocks are excluded.
    fn record_for_digest(&mut self, frame: &ReceivedFrame) {
        let clock_len = match frame.message_id {
            // Time requests: they don't affect the vehicle, and they contain wall time.
            TIMESYNC_DATA::ID | PING_DATA::ID => return,
            // The sender's time_boot_ms, at the start of the payload.
            SET_POSITION_TARGET_LOCAL_NED_DATA::ID | SET_POSITION_TARGET_GLOBAL_INT_DATA::ID | SET_ATTITUDE_TARGET_DATA::ID => {
                size_of::<u32>()
            }
            id if HANDLED.contains(&id) => 0,
            _ => return,
        };
        self.digest_input.extend(frame.message_id.to_le_bytes());
        self.digest_input.extend([frame.system_id, frame.component_id]);
        self.digest_input.extend(&frame.payload(255)[clock_len..]);
    }

    /// Handles a frame addressed to this system: by default as the autopilot component; the camera component has its
    /// own commands, settings and files.
    fn handle_frame(&mut self, id: LinkId, frame: &ReceivedFrame, aircraft: &SimulatedAircraft, autopilot: &mut Autopilot) {
        let (system, component) = router::target(frame);
        if system != 0 && system != self.links.system_id() {
            return;
        }
        if component == CAMERA
            && let Some(link) = self.links.get_mut(id)
        {
            link.use_camera();
        }
        self.record_for_digest(frame);
        if !matches!(component, 0 | AUTOPILOT | CAMERA) {
            return;
        }
        if let Some(command) = VehicleCommand::of(frame) {
            self.handle_command(id, &command, aircraft, autopilot);
            return;
        }
        let from = (frame.system_id, frame.component_id);
        let input = &payload_input(&self.vehicle, aircraft, autopilot);
        self.payload.receive(component, frame, &mut PayloadMessage { link: id, from, input, links: &mut self.links });
        if component != CAMERA {
            let (payload, links) = (&mut self.payload.equipment, &mut self.links);
            self.vehicle.receive(frame, &mut InboundMessage { link: id, from, aircraft, input, autopilot, payload, links });
        }
    }

    /// Executes a received command and acknowledges it.
    fn handle_command(&mut self, id: LinkId, command: &VehicleCommand, aircraft: &SimulatedAircraft, autopilot: &mut Autopilot) {
        let result = self.execute(id, command, aircraft, autopilot);
        let component = if command.component == CAMERA { CAMERA } else { AUTOPILOT };
        let number = command.number.to_le_bytes();
        let Some(link) = self.links.get_mut(id) else { return };
        // Encoded manually because the command number may be unknown to the dialect.
        let payload = [number[0], number[1], result as u8, 0, 0, 0, 0, 0, command.from.0, command.from.1];
        link.send_payload(component, COMMAND_ACK, &payload);
        let rows = std::mem::take(&mut link.after_acknowledgment);
        if rows.is_empty() {
            return;
        }
        let input = payload_input(&self.vehicle, aircraft, autopilot);
        let inputs = StreamInputs::new(&self.vehicle, &self.payload, aircraft, autopilot, &input).for_link(link.kind);
        for row in rows {
            if let Some(message) = STREAMS[row].build(&inputs) {
                link.send(STREAMS[row].component, &message);
            }
        }
    }

    /// Executes a received command. The camera component accepts only camera commands and message requests.
    fn execute(
        &mut self,
        link: LinkId,
        command: &VehicleCommand,
        aircraft: &SimulatedAircraft,
        autopilot: &mut Autopilot,
    ) -> MavResult {
        let Self { links, vehicle, payload, .. } = self;
        let mut request = MessageRequest { link, links, vehicle, payload, aircraft, autopilot };
        if let Some(result) = message_requests::handle(command, &mut request) {
            return result;
        }
        let input = &payload_input(&self.vehicle, aircraft, autopilot);
        let (payload, links) = (&mut self.payload.equipment, &mut self.links);
        let mut message = InboundMessage { link, from: command.from, aircraft, input, autopilot, payload, links };
        if let Some(result) = aux_functions::command(&mut self.vehicle, command, &mut message) {
            return result;
        }
        if command.component == CAMERA {
            let result = payload_commands::handle_camera(command, input, message.payload);
            return result.unwrap_or(MavResult::MAV_RESULT_UNSUPPORTED);
        }
        commands::execute(command, &mut self.vehicle, &mut message)
    }
}
