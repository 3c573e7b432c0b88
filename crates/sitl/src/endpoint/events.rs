//! PX4's events interface: events for arming checks and health, and the metadata file that describes them
//! (<https://mavlink.io/en/services/events.html>; libevents, health and arming checks).

use super::inbound::InboundMessage;
use super::link::PeerLink;
use super::notices;
use super::snapshot::VehicleSnapshot;
use super::streams::AUTOPILOT;
use super::{Endpoint, LinkKind};
use serde_json::{Value as Json, json};
use spandrel_mavlink::dialect::{
    CURRENT_EVENT_SEQUENCE_DATA, EVENT_DATA, MavEventCurrentSequenceFlags, MavEventErrorReason, MavMessage, REQUEST_EVENT_DATA,
    RESPONSE_EVENT_ERROR_DATA,
};
use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Number of events kept for retransmission (estimate: several reports).
const KEPT: usize = 64;
/// Maximum number of events for each request (estimate: a whole report; clients request the remainder again).
const AT_ONCE: u16 = 10;
/// Minimum interval between reports, and interval of the sequence number message.
const REPORT_EVERY: SimTime = SimTime::from_ms(500);
const SEQUENCE_EVERY: SimTime = SimTime::from_ms(2_000);
/// PX4's log levels: internal in the upper four bits, external in the lower.
const PROTOCOL: u8 = 0x88;
const ERROR: u8 = 0x33;

/// Bits of `health_component_t` (PX4: enums.json).
const COMPONENTS: [(u8, &str, &str); 10] = [
    (0, "none", "None"),
    (1, "absolute_pressure", "Absolute pressure"),
    (3, "gps", "GPS"),
    (7, "remote_control", "Remote Control (RC or Joystick)"),
    (11, "battery", "Battery"),
    (16, "attitude_estimate", "Attitude estimate"),
    (17, "local_position_estimate", "Local position estimate"),
    (20, "system", "System"),
    (27, "magnetometer", "Magnetometer"),
    (29, "gyro", "Gyroscope"),
];
const SYSTEM: u8 = 20;
/// PX4's number, name and custom mode of each mode group, and whether it requires a position.
const GROUPS: [(u8, &str, u32, bool); 12] = [
    (1, "altctl", 2 << 16, false),
    (2, "posctl", 3 << 16, true),
    (3, "mission", 4 << 16 | 4 << 24, true),
    (4, "loiter", 4 << 16 | 3 << 24, true),
    (5, "rtl", 4 << 16 | 5 << 24, true),
    (10, "acro", 5 << 16, false),
    (14, "offboard", 6 << 16, false),
    (15, "stab", 7 << 16, false),
    (17, "takeoff", 4 << 16 | 2 << 24, true),
    (18, "land", 4 << 16 | 6 << 24, false),
    (19, "follow_target", 4 << 16 | 8 << 24, true),
    (21, "orbit", 3 << 16 | 1 << 24, true),
];
const MISSION_GROUP: u8 = 3;
/// Arming checks: the autopilot's text, the event name, the affected component.
const CHECKS: [(&str, &str, u8); 13] = [
    ("Booting", "check_booting", SYSTEM),
    ("Attitude not aligned", "check_attitude_not_aligned", 16),
    ("No GNSS fix", "check_no_gnss_fix", 3),
    ("Position not accurate enough", "check_position_inaccurate", 17),
    ("Not level", "check_not_level", 16),
    ("Compass missing", "check_compass_missing", 27),
    ("Barometer missing", "check_barometer_missing", 1),
    ("No battery measurement", "check_battery_not_measured", 11),
    ("Battery too low", "check_battery_too_low", 11),
    ("Sticks not centered", "check_sticks_not_centered", 7),
    ("Outside the geofence", "check_outside_geofence", SYSTEM),
    ("Obstacle above vehicle", "check_obstacle_above", SYSTEM),
    (OTHER, "check_other", SYSTEM),
];
/// A check without an event of its own; the details are in its status text.
const OTHER: &str = "Preflight check failed";
const ARMING_SUMMARY: &str = "commander_arming_check_summary";
const HEALTH_SUMMARY: &str = "commander_health_summary";

/// Computes an event's ID within the component (PX4: FNV-1a, 24 bits).
fn sub_id(name: &str) -> u32 {
    let hash = name.bytes().fold(0x811c_9dc5_u32, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193));
    hash & 0x00ff_ffff
}

/// Events sent, and the contents of the last report.
#[derive(Debug, Clone, Default)]
pub struct EventReports {
    sequence: u16,
    history: VecDeque<EVENT_DATA>,
    reported: Option<(Vec<String>, [u32; 5])>,
    next_report: SimTime,
    next_sequence: SimTime,
    /// Report even if nothing changed.
    pub asked: bool,
}

impl EventReports {
    fn add(&mut self, name: &str, log_levels: u8, payload: &[u8], now_ms: u32) {
        let mut arguments = [0; 40];
        arguments.iter_mut().zip(payload).for_each(|(slot, byte)| *slot = *byte);
        self.sequence = self.sequence.wrapping_add(1);
        let (id, sequence) = (sub_id(name) | 1 << 24, self.sequence);
        let event = EVENT_DATA {
            id,
            event_time_boot_ms: now_ms,
            sequence,
            destination_component: 0,
            destination_system: 0,
            log_levels,
            arguments,
        };
        if self.history.len() == KEPT {
            self.history.pop_front();
        }
        self.history.push_back(event);
    }
}

/// Returns the bit masks: failed checks, modes that allow arming, modes that can run, components present, components failing.
fn masks(view: &VehicleSnapshot) -> [u32; 5] {
    let s = view.status;
    let errors = s.arming_reasons.iter().fold(0, |mask, reason| mask | 1 << check(reason).2);
    let flyable = |(nav, _, _, needs_position): &(u8, &str, u32, bool)| {
        (view.estimate.position_valid || !needs_position) && (*nav != MISSION_GROUP || view.plans.mission_items > 0)
    };
    let can_run = GROUPS.iter().filter(|group| flyable(group)).fold(0, |mask, group| mask | 1 << group.0);
    let can_arm = if s.arming_reasons.is_empty() { can_run } else { 0 };
    let present = [1, 3, 11, 27, 29].iter().fold(0, |mask, bit| mask | 1_u32 << bit);
    let failing = u32::from(!s.health.barometer) << 1 | u32::from(!s.health.compass) << 27;
    [errors, can_arm, can_run, present, failing]
}

fn check(reason: &str) -> &'static (&'static str, &'static str, u8) {
    CHECKS.iter().find(|(words, ..)| *words == reason).unwrap_or(&CHECKS[CHECKS.len() - 1])
}

impl Endpoint {
    /// Reports the arming checks when they change, and repeats the latest sequence number.
    pub(super) fn report_events(&mut self, view: &VehicleSnapshot) {
        if !self.flavour.events {
            return;
        }
        let (reasons, masks) = (view.status.arming_reasons.clone(), masks(view));
        let changed = self.events.reported.as_ref().is_none_or(|(told, before)| (told, before) != (&reasons, &masks));
        if self.events.asked || (changed && view.now >= self.events.next_report) {
            self.events.asked = false;
            self.events.next_report = view.now + REPORT_EVERY;
            let before = self.events.sequence;
            self.add_report(&reasons, masks, view);
            self.events.reported = Some((reasons, masks));
            let fresh =
                self.events.history.iter().filter(|event| event.sequence.wrapping_sub(before.wrapping_add(1)) < KEPT as u16);
            let fresh: Vec<MavMessage> = fresh.cloned().map(MavMessage::EVENT).collect();
            for link in self.links.values_mut().filter(|link| is_listening(link)) {
                fresh.iter().for_each(|event| link.stream(AUTOPILOT, event));
            }
        }
        if view.now >= self.events.next_sequence {
            self.events.next_sequence = view.now + SEQUENCE_EVERY;
            let flags = MavEventCurrentSequenceFlags::empty();
            let sequence = self.events.sequence;
            let message = MavMessage::CURRENT_EVENT_SEQUENCE(CURRENT_EVENT_SEQUENCE_DATA { sequence, flags });
            self.links.values_mut().filter(|link| is_listening(link)).for_each(|link| link.stream(AUTOPILOT, &message));
        }
    }

    /// Adds the check summary, one event for each failed check, and the health summary, in the order that clients expect.
    fn add_report(&mut self, reasons: &[String], [errors, can_arm, can_run, present, failing]: [u32; 5], view: &VehicleSnapshot) {
        let now_ms = view.boot_ms();
        let summary = |words: &[u32]| [&[0][..], &words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>()].concat();
        self.events.add(ARMING_SUMMARY, PROTOCOL, &summary(&[errors, 0, can_arm, can_run]), now_ms);
        let all: u32 = GROUPS.iter().fold(0, |mask, group| mask | 1 << group.0);
        for reason in reasons {
            let (_, name, component) = check(reason);
            let arguments = [&all.to_le_bytes()[..], &[*component]].concat();
            self.events.add(name, ERROR, &arguments, now_ms);
        }
        self.events.add(HEALTH_SUMMARY, PROTOCOL, &summary(&[present, failing, 0]), now_ms);
    }
}

impl Endpoint {
    /// Sends the event that corresponds to a status text, if there is one.
    pub(super) fn send_notice(&mut self, text: &str, now_ms: u32) {
        let Some(notice) = notices::of(text).filter(|_| self.flavour.events) else { return };
        self.events.add(notice.name, notice.levels, &[], now_ms);
        let Some(event) = self.events.history.back().cloned().map(MavMessage::EVENT) else { return };
        self.links.values_mut().filter(|link| is_listening(link)).for_each(|link| link.stream(AUTOPILOT, &event));
    }
}

/// Payload processes read telemetry, not events.
fn is_listening(link: &PeerLink) -> bool {
    link.kind != LinkKind::Payload
}

/// Resends events. If the first one is no longer kept, reports the oldest available, and the client requests again from there.
pub(super) fn request(e: &mut Endpoint, r: &REQUEST_EVENT_DATA, a: &mut InboundMessage) {
    if !e.flavour.events {
        return;
    }
    let count = r.last_sequence.wrapping_sub(r.first_sequence).min(AT_ONCE - 1);
    for sequence in (0..=count).map(|k| r.first_sequence.wrapping_add(k)) {
        if let Some(event) = e.events.history.iter().find(|event| event.sequence == sequence) {
            let again = MavMessage::EVENT(event.clone());
            e.answer(a.link, &again);
            continue;
        }
        let error = MavMessage::RESPONSE_EVENT_ERROR(RESPONSE_EVENT_ERROR_DATA {
            sequence,
            sequence_oldest_available: e.events.history.front().map_or(e.events.sequence, |event| event.sequence),
            target_system: a.from.0,
            target_component: a.from.1,
            reason: MavEventErrorReason::MAV_EVENT_ERROR_REASON_UNAVAILABLE,
        });
        return e.answer(a.link, &error);
    }
}

/// Returns the event definitions (component metadata, type events).
#[must_use]
pub fn definitions() -> Json {
    let bitfield = |description: &str, entries: Json| json!({ "type": "uint32_t", "description": description, "is_bitfield": true, "entries": entries });
    let entry = |bit: u8, name: &str, description: &str| {
        ((1_u32 << bit).to_string(), json!({ "name": name, "description": description }))
    };
    let components: serde_json::Map<String, Json> =
        COMPONENTS.iter().map(|(bit, name, words)| entry(*bit, name, words)).collect();
    let modes: serde_json::Map<String, Json> = GROUPS.iter().map(|(bit, name, ..)| entry(*bit, name, name)).collect();
    let arguments =
        |all: &[(&str, &str)]| -> Vec<Json> { all.iter().map(|(name, kind)| json!({ "name": name, "type": kind })).collect() };
    let (health, group) = ("health_component_t", "navigation_mode_group_t");
    let arming_summary = json!({
        "name": ARMING_SUMMARY,
        "type": "summary",
        "message": "Arming check summary event",
        "arguments": arguments(&[("chunk_idx", "uint8_t"), ("error", health), ("warning", health), ("can_arm", group), ("can_run", group)]),
    });
    let health_summary = json!({
        "name": HEALTH_SUMMARY,
        "type": "summary",
        "message": "Health report summary event",
        "arguments": arguments(&[("chunk_idx", "uint8_t"), ("is_present", health), ("error", health), ("warning", health)]),
    });
    let mut checks: serde_json::Map<String, Json> = CHECKS
        .iter()
        .map(|(words, name, _)| {
            let arguments = arguments(&[("modes", group), ("health_component_index", "uint8_t")]);
            (sub_id(name).to_string(), json!({ "name": name, "message": words, "arguments": arguments }))
        })
        .collect();
    checks.insert(sub_id(ARMING_SUMMARY).to_string(), arming_summary);
    let groups: serde_json::Map<String, Json> = GROUPS.iter().map(|(nav, _, mode, _)| (nav.to_string(), json!([mode]))).collect();
    json!({
        "version": 2,
        "components": { "1": {
            "namespace": "px4",
            "enums": {
                "health_component_t": bitfield("Bitfield for subsystems & components", components.into()),
                "navigation_mode_group_t": bitfield("Flight modes that share the same arming checks", modes.into()),
            },
            "event_groups": {
                "arming_check": { "events": checks },
                "default": notices::definitions(sub_id),
                "health": { "events": { sub_id(HEALTH_SUMMARY).to_string(): health_summary } },
            },
            "navigation_mode_groups": { "groups": groups },
            "supported_protocols": ["health_and_arming_check"],
        } },
    })
}
