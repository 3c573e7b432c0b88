//! Messages that the simulator's components send in a tick.

use super::RelayEndpoint;
use super::streams::{EQUIPMENT_STREAMS, rows_of};
use crate::endpoint::component_ids::{AUTOPILOT, SIMULATOR};
use crate::endpoint::link::LinkKind;
use crate::endpoint::payload::PayloadSnapshot;
use crate::endpoint::simulated_aircraft::SimulatedAircraft;
use crate::endpoint::text_queue::chunks;
use spandrel_mavlink::dialect::{MavMessage, MavSeverity, STATUSTEXT_DATA};
use spandrel_model::time::SimTime;

impl RelayEndpoint {
    /// Sends all messages scheduled for this tick. `link_now` is the clock of the links, which also runs while simulation time is
    /// stopped; payload processes, which use simulation time, then receive nothing.
    pub fn publish(&mut self, aircraft: &SimulatedAircraft, link_now: SimTime, is_time_stopped: bool) {
        self.repeat_requests(link_now);
        let input = self.input(aircraft);
        self.payload.take_picture(&input, &mut self.links);
        self.announce_changes(&PayloadSnapshot::new(&input, &self.payload.equipment));
        self.send_due_streams(&PayloadSnapshot::new(&input, &self.payload.equipment), link_now, is_time_stopped);
        self.payload.send_scoring(&input, &mut self.links);
        self.payload.send_hazards(&input, &mut self.links);
        self.send_texts();
        self.payload.send_files(&mut self.links);
        self.payload.send_requested_images(&mut self.links);
    }

    /// Repeats the autopilot's latest heartbeat, sends texts and the values that report a freeze while simulation time is
    /// stopped, because the autopilot's own clock is stopped as well.
    pub fn send_heartbeats(&mut self, aircraft: &SimulatedAircraft) {
        if let Some(beat) = self.report.heartbeat.clone() {
            self.broadcast_to_clients(AUTOPILOT, &MavMessage::HEARTBEAT(beat));
        }
        self.send_texts();
        let input = self.input(aircraft);
        self.payload.send_frozen_values(&input, &mut self.links);
    }

    /// Broadcasts equipment changes once.
    fn announce_changes(&mut self, snapshot: &PayloadSnapshot) {
        let (messages, warnings) = self.payload.equipment.changes.take();
        for (_, row) in messages.into_iter().flat_map(|message| rows_of(message, 0)) {
            for link in self.links.listeners() {
                if let Some(message) = (row.build)(&snapshot.for_link(link.kind)) {
                    link.send(row.component, &message);
                }
            }
        }
        for warning in warnings {
            self.push_text(MavSeverity::MAV_SEVERITY_WARNING, &warning);
        }
    }

    fn send_due_streams(&mut self, snapshot: &PayloadSnapshot, link_now: SimTime, is_time_stopped: bool) {
        let mut rows = std::mem::take(&mut self.row_buffer);
        for link in self.links.listeners().filter(|link| !(is_time_stopped && link.kind == LinkKind::Payload)) {
            link.due(link_now, &mut rows);
            let snapshot = &snapshot.for_link(link.kind);
            for row in &rows {
                let stream = &EQUIPMENT_STREAMS[*row];
                if let Some(message) = (stream.build)(snapshot) {
                    link.stream(stream.component, &message);
                }
            }
        }
        self.row_buffer = rows;
    }

    /// Sends the simulator's own texts to all clients.
    pub(super) fn send_texts(&mut self) {
        for (severity, text) in self.texts.take() {
            let pieces = chunks(&text);
            let id = if pieces.len() == 1 { 0 } else { self.texts.next_id() };
            for link in self.links.listeners().filter(|link| link.kind != LinkKind::Autopilot) {
                for (k, piece) in pieces.iter().enumerate() {
                    let text = piece.as_str().into();
                    link.send(SIMULATOR, &MavMessage::STATUSTEXT(STATUSTEXT_DATA { severity, text, id, chunk_seq: k as u8 }));
                }
            }
        }
    }
}
