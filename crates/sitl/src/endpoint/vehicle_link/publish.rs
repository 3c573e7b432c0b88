//! Messages that the autopilot sends in a tick.

use super::VehicleLink;
use super::mission::items;
use super::snapshot::VehicleSnapshot;
use crate::autopilot::{Autopilot, AutopilotEvent, Severity};
use crate::endpoint::component_ids::AUTOPILOT;
use crate::endpoint::files;
use crate::endpoint::link::Links;
use crate::endpoint::payload::commands as payload;
use crate::endpoint::payload::{Payload, PayloadInput};
use crate::endpoint::vehicle_command::VehicleCommand;
use spandrel_mavlink::dialect::{MISSION_ITEM_REACHED_DATA, MavMessage, MavMissionType, MavResult, MavSeverity};
use spandrel_model::geodesy::LocalPlane;

impl VehicleLink {
    /// Updates the displayed mode, the flight times and the state-dependent parameters from the autopilot's state.
    pub(crate) fn observe(&mut self, view: &VehicleSnapshot, links: &mut Links) {
        self.requested_mode = self.reported_mode(view);
        self.flight.update(std::mem::replace(&mut self.was_armed, view.status.armed), view.status, view.clock.now);
        let shown = Some((self.params.changes(), self.plans.totals(), view.fence_enabled));
        if self.shown_by_params != shown {
            self.sync_fence_parameter(view.fence_enabled, links);
            self.params.update_plan_counts(self.plans.totals());
            self.shown_by_params = shown;
        }
    }

    /// Returns the flavor's number for the active mode. If the fence or a failsafe changed the mode, returns its
    /// default number: the mode for go-to commands must be selected again.
    fn reported_mode(&mut self, view: &VehicleSnapshot) -> u32 {
        let actions = view.status.fence.taken;
        let changed = std::mem::replace(&mut self.fence_actions, actions) != actions;
        let forced = view.status.failsafe.is_some() && view.status.mode != view.status.intended;
        if changed || forced { self.flavor.default_mode(view.status.mode).number } else { view.mode_row().number }
    }

    /// Queues the autopilot's event texts.
    pub(crate) fn queue_event_texts(&mut self, events: Vec<AutopilotEvent>) {
        if self.speed_factor != self.reported_speed_factor {
            self.reported_speed_factor = self.speed_factor;
            self.inform(&format!("Client timeouts are scaled by {}", self.speed_factor));
        }
        for event in events {
            let severity = match event.severity {
                Severity::Critical => MavSeverity::MAV_SEVERITY_CRITICAL,
                Severity::Warning => MavSeverity::MAV_SEVERITY_WARNING,
                Severity::Info => MavSeverity::MAV_SEVERITY_INFO,
            };
            let (severity, text) = event.sensor.and_then(self.flavor.sensor_text).unwrap_or((severity, event.text));
            self.texts.push_always(severity, text);
        }
    }

    /// Reports that a mission item was reached, and executes it if it is an equipment command.
    pub(crate) fn report_reached_item(&mut self, seq: usize, input: &PayloadInput, payload: &mut Payload, links: &mut Links) {
        let lead = self.plans.summary().lead;
        self.execute_equipment_item(seq, lead, input, payload);
        links.broadcast(AUTOPILOT, &MavMessage::MISSION_ITEM_REACHED(MISSION_ITEM_REACHED_DATA { seq: seq as u16 + lead }));
    }

    fn execute_equipment_item(&mut self, seq: usize, lead: u16, input: &PayloadInput, payload: &mut Payload) {
        let Some(item) = items::resolve_next_waypoint(self.plans.mission(), seq) else { return };
        let command = VehicleCommand::from_item(&item, (self.system_id, AUTOPILOT));
        if let Some(result) = payload::handle(&command, input, payload)
            && result != MavResult::MAV_RESULT_ACCEPTED
        {
            let why = payload::refusal_text(&command, input, payload);
            let text = format!("Mission item {}: {why}", seq + usize::from(lead));
            self.push_text(MavSeverity::MAV_SEVERITY_WARNING, &text);
        }
    }

    /// Sends calibration progress, events and texts, and then parts of lists, shell output and files on links with
    /// capacity.
    pub(crate) fn send_messages(&mut self, view: &VehicleSnapshot, links: &mut Links) {
        self.step_calibration(view);
        self.report_events(view, links);
        self.send_texts(view, links);
        self.send_params(links);
        self.send_shell(links);
        files::send_replies(&mut self.files, AUTOPILOT, links);
    }

    /// Sends the next parts of the log downloads on links with capacity.
    pub(crate) fn send_logs(&mut self, links: &mut Links) {
        if self.logs.is_idle() {
            return;
        }
        for (link, message) in self.logs.poll(|link| links.has_capacity(*link)) {
            links.answer(AUTOPILOT, link, &message);
        }
    }

    /// Repeats an unanswered request for a mission item.
    pub(crate) fn retry_plan_request(&mut self, view: &VehicleSnapshot, links: &mut Links) {
        if let Some((peer, message)) = self.plans.poll_retries(view.clock.now) {
            links.send_to(AUTOPILOT, peer, &message);
        }
    }

    /// Applies parameters and plans to a restarted autopilot.
    pub(crate) fn boot(&mut self, plane: &LocalPlane, autopilot: &mut Autopilot, payload: &mut Payload) {
        (self.mode_switch, self.switches) = (None, [None; super::manual::AUX_CHANNEL_COUNT]);
        if self.params.clears_mission_at_boot() {
            self.plans.clear_mission();
        }
        self.apply_parameters(autopilot, payload);
        self.update_autopilot_plan(MavMissionType::MAV_MISSION_TYPE_ALL, plane, autopilot);
    }

    /// Applies the flavor's parameter defaults to a new autopilot.
    pub(crate) fn prepare(&mut self, autopilot: &mut Autopilot, payload: &mut Payload) {
        if !self.flavor.params.defaults.is_empty() {
            self.apply_parameters(autopilot, payload);
        }
    }
}
