//! Outgoing messages of a tick: changes, streams, texts and lists, each to the links concerned.

use super::camera::CaptureRecord;
use super::link::PeerLink;
use super::snapshot::VehicleSnapshot;
use super::streams::{self, AUTOPILOT, CAMERA, STREAMS};
use super::{Endpoint, LinkId, LinkKind, commands, ftp, items, mission};
use crate::autopilot::{AutopilotEvent, Severity};
use spandrel_mavlink::codec::Encodable;
use spandrel_mavlink::dialect::{MISSION_ITEM_REACHED_DATA, MavMessage, MavResult, MavSeverity};

/// Repeats the autopilot's heartbeat after the camera's in the same datagram, for clients that keep only the last heartbeat and
/// don't use the camera.
fn repeat_autopilot(link: &mut PeerLink, view: &VehicleSnapshot) {
    if link.uses_camera() || link.kind == LinkKind::Payload {
        return;
    }
    let rows = streams::rows_of(HEARTBEAT).filter(|(_, row)| row.component == AUTOPILOT);
    for message in rows.filter_map(|(_, row)| row.build(view)) {
        link.send(AUTOPILOT, &message);
    }
}

/// Message ID of HEARTBEAT.
const HEARTBEAT: u32 = 0;

impl Endpoint {
    /// Sends everything that is due.
    pub fn publish(&mut self, view: &VehicleSnapshot, events: Vec<AutopilotEvent>, reached: Vec<usize>) {
        self.chosen = self.reported_mode(view);
        self.flight.update(std::mem::replace(&mut self.was_armed, view.status.armed), view.status, view.now);
        let shown = Some((self.params.changes(), self.plans.totals(), view.fence_enabled));
        let is_news = self.shown_by_params != shown;
        if is_news {
            self.note_fence_switch(view.fence_enabled);
        }
        self.take_picture(view);
        if self.speed_factor != self.reported_speed_factor {
            self.reported_speed_factor = self.speed_factor;
            self.push_text(MavSeverity::MAV_SEVERITY_INFO, &format!("Client timeouts are scaled by {}", self.speed_factor));
        }
        for event in events {
            let severity = match event.severity {
                Severity::Critical => MavSeverity::MAV_SEVERITY_CRITICAL,
                Severity::Warning => MavSeverity::MAV_SEVERITY_WARNING,
                Severity::Info => MavSeverity::MAV_SEVERITY_INFO,
            };
            let own = event.sensor.and_then(self.flavour.sensor_words);
            self.texts.push(own.unwrap_or((severity, event.text)));
        }
        for seq in reached {
            self.mission_payload(seq, view);
            let message = MavMessage::MISSION_ITEM_REACHED(MISSION_ITEM_REACHED_DATA { seq: seq as u16 + view.plans.lead });
            self.broadcast(AUTOPILOT, &message);
        }
        let view = &view.with_payload(&self.payload);
        self.publish_payload_changes(view);
        self.send_due_streams(view);
        self.truth(view);
        self.calibrate(view);
        self.report_events(view);
        self.say_texts(view);
        if is_news {
            self.params.note_plans(self.plans.totals());
            self.shown_by_params = shown;
        }
        self.send_params();
        self.send_shell();
        ftp::send(self);
        self.send_log_messages();
        self.send_pictures();
        if let Some((peer, message)) = self.plans.poll_retries(view.now) {
            self.send_to(peer, &message);
        }
    }

    /// Sends heartbeats and texts only, while simulation time is paused. The camera's heartbeat goes only to links that use the
    /// camera.
    pub fn send_heartbeats(&mut self, view: &VehicleSnapshot) {
        let view = &view.with_payload(&self.payload);
        for link in self.listeners() {
            let view = &view.for_link(link.kind);
            let camera = link.uses_camera();
            for (_, row) in streams::rows_of(HEARTBEAT).filter(|(_, row)| camera || row.component == AUTOPILOT) {
                if let Some(message) = row.build(view) {
                    link.send(row.component, &message);
                }
            }
        }
        self.say_texts(view);
    }

    /// Returns the flavour's number of the active mode. If the fence or a failsafe changed the mode, returns its default number:
    /// the mode for go-to commands must be selected again.
    fn reported_mode(&mut self, view: &VehicleSnapshot) -> u32 {
        let taken = view.status.fence.taken;
        let changed = std::mem::replace(&mut self.fence_took, taken) != taken;
        let forced = view.status.failsafe.is_some() && view.status.mode != view.status.intended;
        if changed || forced { self.flavour.default_mode(view.status.mode).number } else { view.mode_row().number }
    }

    fn take_picture(&mut self, view: &VehicleSnapshot) {
        let here = view.estimate.position_m.enu();
        if !self.payload.camera.due(view.now, here) {
            return;
        }
        let view = &view.with_payload(&self.payload);
        // The scoring evaluates the image content: send the field of view first.
        if view.vehicle.camera.zoom_max > 1.0 {
            self.broadcast(CAMERA, &streams::field_of_view(view));
        }
        let message = self.payload.camera.take(CaptureRecord::of(view), view.now, here);
        self.broadcast(CAMERA, &message);
        if self.payload.camera.full(view.now) {
            self.payload.changes.add_warning("Memory card full");
        }
    }

    /// Broadcasts changes of the payload.
    fn publish_payload_changes(&mut self, view: &VehicleSnapshot) {
        let (messages, warnings) = self.payload.changes.take();
        for (_, row) in messages.into_iter().flat_map(streams::rows_of) {
            for link in self.links.values_mut() {
                if let Some(message) = row.build(&view.for_link(link.kind)) {
                    link.send(row.component, &message);
                }
            }
        }
        for warning in warnings {
            self.push_text(MavSeverity::MAV_SEVERITY_WARNING, warning);
        }
    }

    /// Resends requested image records, one per tick on each link with capacity.
    fn send_pictures(&mut self) {
        for link in self.links.values_mut().filter(|link| !link.is_busy()) {
            if let Some(message) = link.pictures.next().and_then(|index| self.payload.camera.recorded_capture(index)) {
                link.send(CAMERA, &message);
            }
        }
    }

    /// Executes payload items of the mission when they are reached.
    fn mission_payload(&mut self, seq: usize, view: &VehicleSnapshot) {
        let Some(item) = items::aimed(self.plans.mission(), seq) else { return };
        let command = commands::VehicleCommand::from_item(&item, (self.system_id, AUTOPILOT));
        if let Some(result) = commands::payload::handle(&command, view, &mut self.payload)
            && result != MavResult::MAV_RESULT_ACCEPTED
        {
            let why = commands::payload::refusal_text(&command, view, &self.payload);
            let text = format!("Mission item {}: {why}", seq + usize::from(view.plans.lead));
            self.push_text(MavSeverity::MAV_SEVERITY_WARNING, &text);
        }
    }

    fn send_due_streams(&mut self, view: &VehicleSnapshot) {
        let mut rows = std::mem::take(&mut self.row_buffer);
        for link in self.listeners() {
            link.due(view.now, &mut rows);
            let view = &view.for_link(link.kind);
            for row in &rows {
                let stream = &STREAMS[*row];
                if let Some(message) = stream.build(view) {
                    link.stream(stream.component, &message);
                    if (stream.id, stream.component) == (HEARTBEAT, CAMERA) {
                        repeat_autopilot(link, view);
                    }
                }
            }
        }
        self.row_buffer = rows;
    }

    pub(super) fn broadcast(&mut self, component: u8, message: &impl Encodable) {
        for link in self.listeners() {
            link.send(component, message);
        }
    }

    /// Sends a message on the links on which the peer was seen.
    fn send_to(&mut self, peer: mission::PlanPeer, message: &MavMessage) {
        for (id, link) in &mut self.links {
            if self.router.note_sender(peer, *id) {
                link.send(AUTOPILOT, message);
            }
        }
    }

    fn send_log_messages(&mut self) {
        let links = &self.links;
        let ready = |link: &LinkId| links.get(link).is_none_or(|link| !link.is_busy());
        for (link, message) in self.logs.poll(ready) {
            self.answer(link, &message);
        }
    }
}
