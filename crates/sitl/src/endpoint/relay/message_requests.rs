//! Requests for messages of the equipment and their rates.
#![allow(deprecated, reason = "clients still send superseded MAVLink commands")]

use super::RelayEndpoint;
use super::streams::{EQUIPMENT_STREAMS, rows_of};
use crate::endpoint::component_ids::AUTOPILOT;
use crate::endpoint::link::LinkId;
use crate::endpoint::message_requests::superseded_request;
use crate::endpoint::payload::PayloadSnapshot;
use crate::endpoint::simulated_aircraft::SimulatedAircraft;
use crate::endpoint::vehicle_command::VehicleCommand;
use mavlink::MessageData;
use spandrel_mavlink::dialect::{
    BATTERY_STATUS_DATA, CAMERA_IMAGE_CAPTURED_DATA, HEARTBEAT_DATA, MESSAGE_INTERVAL_DATA, MavCmd, MavMessage, MavResult,
    RC_CHANNELS_DATA, WIND_COV_DATA,
};

const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const DENIED: MavResult = MavResult::MAV_RESULT_DENIED;
/// Messages that the autopilot also sends. Requests for them go to the autopilot unless they name another component.
const SENT_BY_BOTH: [u32; 4] = [HEARTBEAT_DATA::ID, RC_CHANNELS_DATA::ID, BATTERY_STATUS_DATA::ID, WIND_COV_DATA::ID];

impl RelayEndpoint {
    /// Handles a request for a message of the equipment; `None` if the request is not for the equipment.
    pub(super) fn handle_message_request(
        &mut self,
        id: LinkId,
        c: &VehicleCommand,
        aircraft: &SimulatedAircraft,
    ) -> Option<MavResult> {
        use MavCmd as M;
        let requested = |k: usize| c.finite_param(k).filter(|v| (0.0..16_777_216.0).contains(v)).map(|v| v as u32);
        if let Some(message) = superseded_request(c.number).filter(|message| self.sends(*message, c.component)) {
            let index = if message == CAMERA_IMAGE_CAPTURED_DATA::ID { c.p[0] } else { 0.0 };
            return Some(self.send_requested(message, (index, 0.0), id, c.component, aircraft));
        }
        let message = requested(0).filter(|message| self.sends(*message, c.component))?;
        match c.number {
            n if n == M::MAV_CMD_REQUEST_MESSAGE as u16 => {
                Some(self.send_requested(message, (c.p[1], c.p[2]), id, c.component, aircraft))
            }
            n if n == M::MAV_CMD_SET_MESSAGE_INTERVAL as u16 => {
                Some(self.set_interval(message, c.p[1], id, c.component, aircraft))
            }
            n if n == M::MAV_CMD_GET_MESSAGE_INTERVAL as u16 => Some(self.get_interval(message, id, c.component)),
            _ => None,
        }
    }

    /// Returns whether a request for a message that names this component is for the equipment.
    fn sends(&self, message: u32, component: u8) -> bool {
        let known = message == CAMERA_IMAGE_CAPTURED_DATA::ID || rows_of(message, component).next().is_some();
        known && (component > AUTOPILOT || !SENT_BY_BOTH.contains(&message))
    }

    /// Sends a message. `index` and `last` are parameters 2 and 3 of the request, whose meaning depends on the message.
    fn send_requested(
        &mut self,
        message: u32,
        (index, last): (f64, f64),
        id: LinkId,
        component: u8,
        aircraft: &SimulatedAircraft,
    ) -> MavResult {
        if message == CAMERA_IMAGE_CAPTURED_DATA::ID {
            return self.payload.resend_images((index, last), id, &mut self.links);
        }
        let input = self.input(aircraft);
        let Some(link) = self.links.get_mut(id) else { return DENIED };
        let snapshot = PayloadSnapshot::new(&input, &self.payload.equipment).for_link(link.kind);
        let mut is_available = false;
        for (_, row) in rows_of(message, component) {
            if let Some(message) = (row.build)(&snapshot) {
                link.send(row.component, &message);
                is_available = true;
            }
        }
        if is_available { ACCEPTED } else { DENIED }
    }

    fn set_interval(&mut self, message: u32, us: f64, id: LinkId, component: u8, aircraft: &SimulatedAircraft) -> MavResult {
        let Some(link) = self.links.get_mut(id) else { return DENIED };
        let now = aircraft.clock.now;
        let done = rows_of(message, component).all(|(row, _)| link.streams.set_interval(row, us, now));
        if done { ACCEPTED } else { DENIED }
    }

    fn get_interval(&mut self, message: u32, id: LinkId, component: u8) -> MavResult {
        let row = rows_of(message, component).next();
        let interval_us = row.zip(self.links.get(id)).map_or(0, |((row, _), link)| link.streams.interval_us(row));
        let sender = row.map_or(AUTOPILOT, |(row, _)| EQUIPMENT_STREAMS[row].component);
        let answer = MESSAGE_INTERVAL_DATA { interval_us, message_id: message as u16 };
        self.links.answer(sender, id, &MavMessage::MESSAGE_INTERVAL(answer));
        if row.is_some() { ACCEPTED } else { MavResult::MAV_RESULT_FAILED }
    }
}
