//! Messages that the equipment and the scoring feed send in a tick.

use super::PayloadLink;
use super::input::PayloadInput;
use super::snapshot::PayloadSnapshot;
use super::streams::camera::{capture_record, field_of_view};
use crate::endpoint::component_ids::{CAMERA, TELEMETRY_RADIO};
use crate::endpoint::files;
use crate::endpoint::link::{LinkId, LinkKind, Links, PeerLink};
use crate::physics::RigidState;
use spandrel_mavlink::contract::named_values::NamedValue;
use spandrel_mavlink::contract::other_drones::{self, OtherDrone};
use spandrel_mavlink::contract::radio_status;
use spandrel_mavlink::dialect::{MavMessage, MavResult};
use spandrel_model::site::drones::{LiveDrone, live_drone_number};

/// Noise and interference at the receivers of the control link, dBm (estimate: 10 dB below the sensitivity).
const NOISE_DBM: f64 = -104.0;

impl PayloadLink {
    /// Captures the next scheduled image and announces it.
    pub(crate) fn take_picture(&mut self, input: &PayloadInput, links: &mut Links) {
        let (now, here) = (input.clock.now, input.position_m.enu());
        if !self.equipment.camera.due(now, here) {
            return;
        }
        let view = PayloadSnapshot::new(input, &self.equipment);
        // Scoring evaluates the image content, so the field of view must be sent first.
        if input.vehicle.camera.zoom_max > 1.0 {
            links.broadcast(CAMERA, &field_of_view(&view));
        }
        let message = self.equipment.camera.take(capture_record(&view), now, here);
        links.broadcast(CAMERA, &message);
        if self.equipment.camera.is_full(now) {
            self.equipment.changes.add_warning("Memory card full");
        }
    }

    /// Sends the named scoring values that are due.
    pub(crate) fn send_scoring(&mut self, input: &PayloadInput, links: &mut Links) {
        let due = self.scoring.take_due(input.scoring, self.speed_factor, input.clock.now);
        self.send_values(due, input, links);
    }

    /// Sends the state of the hazards that the job simulates if it is due: the radio link's to all clients, and all of them to
    /// clients that receive the scoring data.
    pub(crate) fn send_hazards(&mut self, input: &PayloadInput, links: &mut Links) {
        if input.clock.now < self.hazards_due.next_due() {
            return;
        }
        let Some(report) = input.hazards.report().filter(|_| self.hazards_due.fire(input.clock.now)) else { return };
        let message = report.message(input.clock.sim_time_us());
        let status = input.hazards.radio.map(|radio| radio_status::message(radio.signal_dbm, NOISE_DBM, radio.silent_intervals));
        for link in links.listeners().filter(|link| link.kind != LinkKind::Autopilot && !link.is_busy()) {
            if let Some(status) = &status {
                link.stream(TELEMETRY_RADIO, status);
            }
            if !link.is_limited() && link.receives_truth() {
                link.stream(self.components.scoring, &message);
            }
        }
    }

    /// Sends the positions of the other vehicles that share the site to clients that receive the scoring data, if it is due.
    pub(crate) fn send_other_drones(&mut self, input: &PayloadInput, links: &mut Links) {
        let live = input.site.live_drones();
        if live.is_empty() || !self.other_drones_due.fire(input.clock.now) {
            return;
        }
        let others: Vec<OtherDrone> = live.iter().filter_map(|drone| other_drone(drone, input.truth)).collect();
        let message = other_drones::message(&others, input.clock.sim_time_us());
        for link in links.listeners().filter(|link| link.kind != LinkKind::Autopilot && !link.is_busy()) {
            if !link.is_limited() && link.receives_truth() {
                link.stream(self.components.scoring, &message);
            }
        }
    }

    /// Sends the named values that report a freeze. Call while simulation time is stopped; does nothing unless the flight is
    /// frozen.
    pub(crate) fn send_frozen_values(&mut self, input: &PayloadInput, links: &mut Links) {
        if input.scoring.is_frozen {
            let values = self.scoring.frozen_values(input.scoring);
            self.send_values(values, input, links);
        }
    }

    fn send_values(&self, values: Vec<NamedValue>, input: &PayloadInput, links: &mut Links) {
        if values.is_empty() {
            return;
        }
        let time_ms = input.clock.sim_time_ms();
        let messages: Vec<(bool, MavMessage)> =
            values.into_iter().map(|value| (value.is_practice_value(), value.message(time_ms))).collect();
        let has_room = |link: &PeerLink| link.kind != LinkKind::Autopilot && !link.is_limited();
        for link in links.listeners().filter(|link| has_room(link)) {
            let is_scorer = link.receives_truth();
            for (_, message) in messages.iter().filter(|(is_for_all, _)| is_scorer || *is_for_all) {
                link.send(self.components.scoring, message);
            }
        }
    }

    /// Sends the camera file server's replies.
    pub(crate) fn send_files(&mut self, links: &mut Links) {
        files::send_replies(&mut self.files, CAMERA, links);
    }

    /// Resends image records `first` (-1: all) to `last` (0: only `first`, -1: to the newest). The first is sent
    /// immediately, the rest as link capacity permits.
    pub(crate) fn resend_images(&mut self, (first, last): (f64, f64), link: LinkId, links: &mut Links) -> MavResult {
        let count = self.equipment.camera.image_count();
        let (first, last) = match (first, last) {
            (-1.0, _) => (0.0, -1.0),
            (first, last) => (first, if last.is_finite() { last } else { 0.0 }),
        };
        if !(first >= 0.0 && first < count as f64) || last < -1.0 {
            return MavResult::MAV_RESULT_DENIED;
        }
        let first = first as usize;
        let end = match last {
            -1.0 => count,
            0.0 => first + 1,
            last => count.min(last as usize + 1),
        };
        let Some(message) = self.equipment.camera.recorded_capture(first) else { return MavResult::MAV_RESULT_DENIED };
        if end > first + 1 {
            self.image_requests.insert(link, first + 1..end);
        }
        links.answer(CAMERA, link, &message);
        MavResult::MAV_RESULT_ACCEPTED
    }

    /// Resends requested image records, one per tick on each link with capacity.
    pub(crate) fn send_requested_images(&mut self, links: &mut Links) {
        let camera = &self.equipment.camera;
        self.image_requests.retain(|id, images| {
            let Some(link) = links.get_mut(*id) else { return false };
            if !link.is_busy()
                && let Some(message) = images.next().and_then(|index| camera.recorded_capture(index))
            {
                link.send(CAMERA, &message);
            }
            images.start < images.end
        });
    }
}

/// Returns another vehicle as seen from this one.
fn other_drone(drone: &LiveDrone, own: &RigidState) -> Option<OtherDrone> {
    Some(OtherDrone {
        system_id: live_drone_number(drone.object)?.checked_add(1)?,
        armed: drone.armed,
        offset_m: drone.position_m.ned() - own.position_m,
        attitude: drone.attitude,
    })
}
