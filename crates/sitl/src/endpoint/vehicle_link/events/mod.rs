//! PX4's events interface: events for arming checks and health, and the metadata file that describes them
//! (<https://mavlink.io/en/services/events.html>; libevents, health and arming checks).

mod definitions;
mod notices;
mod reports;

use super::VehicleLink;
use super::inbound::InboundMessage;
use super::snapshot::VehicleSnapshot;
use crate::endpoint::component_ids::AUTOPILOT;
use crate::endpoint::link::{LinkKind, Links, PeerLink};
pub use definitions::definitions;
use definitions::{ARMING_SUMMARY, HEALTH_SUMMARY, MODE_GROUPS, check};
pub(super) use notices::covers_whole_text;
pub use reports::EventReports;
use reports::{HISTORY_LENGTH, masks};
use spandrel_mavlink::dialect::{
    CURRENT_EVENT_SEQUENCE_DATA, MavEventCurrentSequenceFlags, MavEventErrorReason, MavMessage, REQUEST_EVENT_DATA,
    RESPONSE_EVENT_ERROR_DATA,
};
use spandrel_model::time::SimTime;

/// Maximum number of events sent per request (estimate: one full report; clients request the rest again).
const MAX_EVENTS_PER_REQUEST: u16 = 10;
/// Minimum interval between reports, and interval of the sequence number message.
const REPORT_INTERVAL: SimTime = SimTime::from_ms(500);
const SEQUENCE_INTERVAL: SimTime = SimTime::from_ms(2_000);
/// PX4's log levels: internal in the upper four bits, external in the lower.
const PROTOCOL: u8 = 0x88;
const ERROR_LEVELS: u8 = 0x33;

impl VehicleLink {
    /// Reports the arming checks when they change, and repeats the latest sequence number.
    pub(super) fn report_events(&mut self, view: &VehicleSnapshot, links: &mut Links) {
        if !self.flavor.events {
            return;
        }
        let (reasons, masks) = (&view.status.arming_blockers, masks(view));
        let changed = self.events.reported.as_ref().is_none_or(|(known, before)| (known, before) != (reasons, &masks));
        if self.events.requested || (changed && view.clock.now >= self.events.next_report) {
            self.events.requested = false;
            self.events.next_report = view.clock.now + REPORT_INTERVAL;
            let before = self.events.sequence;
            self.add_report(reasons, masks, view);
            self.events.reported = Some((reasons.clone(), masks));
            let fresh = self
                .events
                .history
                .iter()
                .filter(|event| event.sequence.wrapping_sub(before.wrapping_add(1)) < HISTORY_LENGTH as u16);
            let fresh: Vec<MavMessage> = fresh.cloned().map(MavMessage::EVENT).collect();
            for link in event_links(links) {
                fresh.iter().for_each(|event| link.stream(AUTOPILOT, event));
            }
        }
        if view.clock.now >= self.events.next_sequence {
            self.events.next_sequence = view.clock.now + SEQUENCE_INTERVAL;
            let flags = MavEventCurrentSequenceFlags::empty();
            let sequence = self.events.sequence;
            let message = MavMessage::CURRENT_EVENT_SEQUENCE(CURRENT_EVENT_SEQUENCE_DATA { sequence, flags });
            event_links(links).for_each(|link| link.stream(AUTOPILOT, &message));
        }
    }

    /// Adds the check summary, one event for each failed check, and the health summary, in the order that clients
    /// expect.
    fn add_report(&mut self, reasons: &[String], [errors, can_arm, can_run, present, failing]: [u32; 5], view: &VehicleSnapshot) {
        let now_ms = view.clock.boot_time_ms();
        let summary = |words: &[u32]| [&[0][..], &words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>()].concat();
        self.events.add(ARMING_SUMMARY, PROTOCOL, &summary(&[errors, 0, can_arm, can_run]), now_ms);
        let all: u32 = MODE_GROUPS.iter().fold(0, |mask, group| mask | 1 << group.0);
        for reason in reasons {
            let (_, name, component) = check(reason);
            let arguments = [&all.to_le_bytes()[..], &[*component]].concat();
            self.events.add(name, ERROR_LEVELS, &arguments, now_ms);
        }
        self.events.add(HEALTH_SUMMARY, PROTOCOL, &summary(&[present, failing, 0]), now_ms);
    }
}

impl VehicleLink {
    /// Sends the event that corresponds to a status text, if there is one.
    pub(super) fn send_notice(&mut self, text: &str, now_ms: u32, links: &mut Links) {
        let Some(notice) = notices::of(text).filter(|_| self.flavor.events) else { return };
        self.events.add(notice.name, notice.levels, &[], now_ms);
        let Some(event) = self.events.history.back().cloned().map(MavMessage::EVENT) else { return };
        event_links(links).for_each(|link| link.stream(AUTOPILOT, &event));
    }
}

/// Returns the links that receive events. Payload processes use telemetry instead.
fn event_links(links: &mut Links) -> impl Iterator<Item = &mut PeerLink> {
    links.iter_mut().map(|(_, link)| link).filter(|link| link.kind != LinkKind::Payload)
}

/// Resends events. If the first one is no longer available, reports the oldest one that is, and the client makes a new
/// request starting there.
pub(super) fn request(v: &mut VehicleLink, r: &REQUEST_EVENT_DATA, a: &mut InboundMessage) {
    if !v.flavor.events {
        return;
    }
    let count = r.last_sequence.wrapping_sub(r.first_sequence).min(MAX_EVENTS_PER_REQUEST - 1);
    for sequence in (0..=count).map(|k| r.first_sequence.wrapping_add(k)) {
        if let Some(event) = v.events.history.iter().find(|event| event.sequence == sequence) {
            let again = MavMessage::EVENT(event.clone());
            a.answer(&again);
            continue;
        }
        let error = MavMessage::RESPONSE_EVENT_ERROR(RESPONSE_EVENT_ERROR_DATA {
            sequence,
            sequence_oldest_available: v.events.history.front().map_or(v.events.sequence, |event| event.sequence),
            target_system: a.from.0,
            target_component: a.from.1,
            reason: MavEventErrorReason::MAV_EVENT_ERROR_REASON_UNAVAILABLE,
        });
        return a.answer(&error);
    }
}
