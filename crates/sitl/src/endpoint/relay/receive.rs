//! Received datagrams: frames from the autopilot and from clients.

use super::RelayEndpoint;
use super::instructor_params::ParamAnswer;
use crate::endpoint::component_ids::AUTOPILOT;
use crate::endpoint::link::{LinkId, ReceivedDatagram};
use crate::endpoint::payload::PayloadMessage;
use crate::endpoint::simulated_aircraft::SimulatedAircraft;
use crate::endpoint::vehicle_command::VehicleCommand;
use mavlink::MessageData;
use spandrel_mavlink::codec::ReceivedFrame;
use spandrel_mavlink::dialect::{HEARTBEAT_DATA, MavMessage};
use spandrel_mavlink::router;
use spandrel_model::time::SimTime;

impl RelayEndpoint {
    /// Processes a datagram received on a link. `link_now` is the clock of the links, which also runs while simulation time is
    /// stopped.
    pub fn receive(&mut self, id: LinkId, datagram: ReceivedDatagram, aircraft: &SimulatedAircraft, link_now: SimTime) {
        if self.links.get(id).is_none() {
            return;
        }
        let from_autopilot = self.autopilot_link == Some(id);
        for frame in self.links.take_frames(datagram) {
            if from_autopilot {
                self.receive_from_autopilot(id, &frame, aircraft);
            } else {
                self.receive_from_client(id, &frame, aircraft, link_now);
            }
        }
    }

    /// Handles a frame from the autopilot: keeps its reports, answers for the equipment and forwards everything else.
    fn receive_from_autopilot(&mut self, id: LinkId, frame: &ReceivedFrame, aircraft: &SimulatedAircraft) {
        if frame.system_id != self.links.system_id() || self.links.is_own(frame.component_id) {
            return;
        }
        if frame.component_id == AUTOPILOT {
            self.report.read(frame);
            if frame.message_id == HEARTBEAT_DATA::ID {
                self.request_streams_once();
            }
        }
        let (system, component) = router::target(frame);
        let for_equipment = self.links.is_own(component);
        if system == 0 || system == self.links.system_id() {
            let done = self.handle_for_equipment(id, component, frame, aircraft);
            if done || for_equipment {
                return;
            }
        }
        self.forward_from_autopilot(id, frame);
    }

    /// Handles a frame from a client: answers for the equipment and the instructor, and forwards everything else.
    fn receive_from_client(&mut self, id: LinkId, frame: &ReceivedFrame, aircraft: &SimulatedAircraft, link_now: SimTime) {
        if self.links.is_lockstep_answer(id, frame) {
            self.links.join_lockstep(id);
            return;
        }
        let is_forged = frame.system_id == self.links.system_id() && frame.component_id == AUTOPILOT;
        if is_forged {
            return;
        }
        if frame.message_id == HEARTBEAT_DATA::ID {
            self.links.start_streams(id, link_now);
        }
        let (system, component) = router::target(frame);
        if system == 0 || system == self.links.system_id() {
            if !self.admits_sticks(id, frame, aircraft.clock.now) {
                return;
            }
            let answered = self.answer_parameter(id, component, frame)
                || self.handle_for_equipment(id, component, frame, aircraft)
                || self.links.is_own(component);
            if answered {
                return;
            }
            if self.forward_sticks(frame) {
                return;
            }
            self.take_gimbal_control(frame);
        }
        self.forward_from_client(id, frame, link_now);
    }

    /// Handles a command or a message for the equipment or the simulator. Returns whether it must not be forwarded.
    fn handle_for_equipment(&mut self, id: LinkId, component: u8, frame: &ReceivedFrame, aircraft: &SimulatedAircraft) -> bool {
        if let Some(command) = VehicleCommand::of(frame) {
            return self.handle_command(id, &command, aircraft);
        }
        let (from, input) = ((frame.system_id, frame.component_id), &self.input(aircraft));
        let mut message = PayloadMessage { link: id, from, input, links: &mut self.links };
        self.payload.receive_beside_autopilot(component, frame, &mut message);
        false
    }

    /// Answers a request for a parameter of the simulation. Returns false for all other frames.
    fn answer_parameter(&mut self, id: LinkId, component: u8, frame: &ReceivedFrame) -> bool {
        let answer = match &frame.message {
            Some(MavMessage::PARAM_SET(set)) if component <= AUTOPILOT => {
                self.instructor.set((frame.system_id, frame.component_id), set)
            }
            Some(MavMessage::PARAM_REQUEST_READ(read)) if component <= AUTOPILOT => self.instructor.read(read),
            _ => None,
        };
        match answer {
            Some(ParamAnswer::Reply(message)) => self.links.answer(AUTOPILOT, id, &message),
            Some(ParamAnswer::Changed(message)) => self.broadcast_to_clients(AUTOPILOT, &message),
            None => return false,
        }
        true
    }

    /// Reads stick input. Returns false if it must not reach the autopilot: manual control has failed, or another sender is in
    /// control.
    fn admits_sticks(&mut self, id: LinkId, frame: &ReceivedFrame, now: SimTime) -> bool {
        let from = (id, (frame.system_id, frame.component_id));
        let admitted = match &frame.message {
            Some(MavMessage::MANUAL_CONTROL(sticks)) => {
                self.accepts_sticks && self.manual.manual_control(from, sticks, now).is_some()
            }
            Some(MavMessage::RC_CHANNELS_OVERRIDE(channels)) if self.accepts_sticks => {
                // A release has no stick positions but must reach the autopilot.
                let was_in_control = self.manual.is_controlling_sender(from);
                self.manual.channels(from, channels, now).is_some() || was_in_control
            }
            Some(MavMessage::RC_CHANNELS_OVERRIDE(_)) => false,
            _ => true,
        };
        while let Some(text) = self.manual.poll_text() {
            self.texts.push(spandrel_mavlink::dialect::MavSeverity::MAV_SEVERITY_NOTICE, &text);
        }
        admitted
    }
}
