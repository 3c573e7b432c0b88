//! Messages sent in a tick: changes, streams, texts and lists, each only on the links that need it.

use super::Endpoint;
use super::component_ids::{AUTOPILOT, CAMERA};
use super::inputs::{StreamInputs, payload_input};
use super::link::{LinkKind, PeerLink};
use super::payload::{Payload, PayloadInput, PayloadSnapshot};
use super::simulated_aircraft::SimulatedAircraft;
use super::streams::{self, STREAMS};
use super::vehicle_link::snapshot::VehicleSnapshot;
use crate::autopilot::{Autopilot, AutopilotEvent};
use spandrel_mavlink::dialect::MavSeverity;

/// Message ID of RC_CHANNELS, which reports the sticks.
const RC_CHANNELS: u32 = 65;
/// HEARTBEAT's message ID.
const HEARTBEAT: u32 = 0;

/// Repeats the autopilot's heartbeat after the camera's heartbeat in the same datagram, for clients that use only the
/// last heartbeat and don't use the camera.
fn repeat_autopilot(link: &mut PeerLink, inputs: &StreamInputs) {
    if link.uses_camera() || link.kind == LinkKind::Payload {
        return;
    }
    let rows = streams::rows_of(HEARTBEAT).filter(|(_, row)| row.component == AUTOPILOT);
    for message in rows.filter_map(|(_, row)| row.build(inputs)) {
        link.send(AUTOPILOT, &message);
    }
}

/// Returns the state from which messages are built. The equipment may have changed since the vehicle's snapshot.
fn stream_inputs<'a>(view: &VehicleSnapshot<'a>, input: &'a PayloadInput<'a>, equipment: &Payload) -> StreamInputs<'a> {
    StreamInputs { vehicle: view.with_payload(equipment), payload: PayloadSnapshot::new(input, equipment) }
}

impl Endpoint {
    /// Sends all messages scheduled for this tick.
    pub fn publish(
        &mut self,
        aircraft: &SimulatedAircraft,
        autopilot: &Autopilot,
        events: Vec<AutopilotEvent>,
        reached_items: Vec<usize>,
    ) {
        let view = self.vehicle.snapshot(aircraft, autopilot, &self.payload.equipment);
        let input = payload_input(&self.vehicle, aircraft, autopilot);
        self.vehicle.observe(&view, &mut self.links);
        self.payload.take_picture(&input, &mut self.links);
        self.vehicle.queue_event_texts(events);
        for seq in reached_items {
            self.vehicle.report_reached_item(seq, &input, &mut self.payload.equipment, &mut self.links);
        }
        self.hasten_sticks(&view);
        self.announce_changes(&view, &input);
        self.send_due_streams(&view, &input);
        self.payload.send_scoring(&input, &mut self.links);
        self.payload.send_hazards(&input, &mut self.links);
        self.payload.send_other_drones(&input, &mut self.links);
        self.vehicle.send_messages(&view, &mut self.links);
        self.payload.send_files(&mut self.links);
        self.vehicle.send_logs(&mut self.links);
        self.payload.send_requested_images(&mut self.links);
        self.vehicle.retry_plan_request(&view, &mut self.links);
    }

    /// Sends only heartbeats, texts and the values that report a freeze, while simulation time is stopped. The camera's heartbeat
    /// is sent only on links that use the camera.
    pub fn send_heartbeats(&mut self, aircraft: &SimulatedAircraft, autopilot: &Autopilot) {
        let input = payload_input(&self.vehicle, aircraft, autopilot);
        let inputs = StreamInputs::new(&self.vehicle, &self.payload, aircraft, autopilot, &input);
        for link in self.links.listeners() {
            let inputs = &inputs.for_link(link.kind);
            let camera = link.uses_camera();
            for (_, row) in streams::rows_of(HEARTBEAT).filter(|(_, row)| camera || row.component == AUTOPILOT) {
                if let Some(message) = row.build(inputs) {
                    link.send(row.component, &message);
                }
            }
        }
        self.vehicle.send_texts(&inputs.vehicle, &mut self.links);
        self.payload.send_frozen_values(&input, &mut self.links);
    }

    /// Reports changed sticks at once to clients that have requested them at the highest rate.
    fn hasten_sticks(&mut self, view: &VehicleSnapshot) {
        if std::mem::replace(&mut self.published_pulses_us, view.pulses_us) != view.pulses_us {
            for (_, link) in self.links.iter_mut() {
                link.streams.hasten(RC_CHANNELS, view.clock.now);
            }
        }
    }

    /// Broadcasts equipment and autopilot changes once.
    fn announce_changes(&mut self, view: &VehicleSnapshot, input: &PayloadInput) {
        let (mut messages, warnings) = self.payload.equipment.changes.take();
        messages.append(&mut self.vehicle.take_announcements());
        if messages.is_empty() && warnings.is_empty() {
            return;
        }
        let inputs = stream_inputs(view, input, &self.payload.equipment);
        for (_, row) in messages.into_iter().flat_map(streams::rows_of) {
            for (_, link) in self.links.iter_mut() {
                if let Some(message) = row.build(&inputs.for_link(link.kind)) {
                    link.send(row.component, &message);
                }
            }
        }
        for warning in warnings {
            self.vehicle.push_text(MavSeverity::MAV_SEVERITY_WARNING, &warning);
        }
    }

    fn send_due_streams(&mut self, view: &VehicleSnapshot, input: &PayloadInput) {
        let mut rows = std::mem::take(&mut self.row_buffer);
        for link in self.links.listeners() {
            link.due(view.clock.now, &mut rows);
            if rows.is_empty() {
                continue;
            }
            // Streams are due on a link only in every few ticks.
            let inputs = &stream_inputs(view, input, &self.payload.equipment).for_link(link.kind);
            for row in &rows {
                let stream = &STREAMS[*row];
                if let Some(message) = stream.build(inputs) {
                    link.stream(stream.component, &message);
                    if (stream.id, stream.component) == (HEARTBEAT, CAMERA) {
                        repeat_autopilot(link, inputs);
                    }
                }
            }
        }
        self.row_buffer = rows;
    }
}
