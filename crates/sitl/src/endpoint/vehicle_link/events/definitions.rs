//! The event definitions: health and arming checks, their components, and the metadata file.

use super::notices;
use serde_json::{Value as Json, json};

/// Component bits in `health_component_t` (PX4: enums.json).
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
const SYSTEM_COMPONENT: u8 = 20;
/// For each mode group: PX4's number, name and custom mode, and whether the group requires a position.
pub(super) const MODE_GROUPS: [(u8, &str, u32, bool); 12] = [
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
pub(super) const MISSION_GROUP: u8 = 3;
/// Arming checks: the autopilot's text, the event name, and the affected component.
const ARMING_CHECKS: [(&str, &str, u8); 13] = [
    ("Booting", "check_booting", SYSTEM_COMPONENT),
    ("Attitude not aligned", "check_attitude_not_aligned", 16),
    ("No GNSS fix", "check_no_gnss_fix", 3),
    ("Position not accurate enough", "check_position_inaccurate", 17),
    ("Not level", "check_not_level", 16),
    ("Compass missing", "check_compass_missing", 27),
    ("Barometer missing", "check_barometer_missing", 1),
    ("No battery readings", "check_battery_not_measured", 11),
    ("Battery too low", "check_battery_too_low", 11),
    ("Sticks not centered", "check_sticks_not_centered", 7),
    ("Outside the geofence", "check_outside_geofence", SYSTEM_COMPONENT),
    ("Obstacle above vehicle", "check_obstacle_above", SYSTEM_COMPONENT),
    (UNLISTED_CHECK, "check_other", SYSTEM_COMPONENT),
];
/// A check without a dedicated event; its status text has the details.
const UNLISTED_CHECK: &str = "Preflight check failed";
pub(super) const ARMING_SUMMARY: &str = "commander_arming_check_summary";
pub(super) const HEALTH_SUMMARY: &str = "commander_health_summary";

/// Computes an event's ID within the component (PX4: FNV-1a, 24 bits).
pub(super) fn sub_id(name: &str) -> u32 {
    let hash = name.bytes().fold(0x811c_9dc5_u32, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193));
    hash & 0x00ff_ffff
}

/// Returns the definition of the arming check with this text.
pub(super) fn check(reason: &str) -> &'static (&'static str, &'static str, u8) {
    ARMING_CHECKS.iter().find(|(words, ..)| *words == reason).unwrap_or(&ARMING_CHECKS[ARMING_CHECKS.len() - 1])
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
    let modes: serde_json::Map<String, Json> = MODE_GROUPS.iter().map(|(bit, name, ..)| entry(*bit, name, name)).collect();
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
    let mut checks: serde_json::Map<String, Json> = ARMING_CHECKS
        .iter()
        .map(|(words, name, _)| {
            let arguments = arguments(&[("modes", group), ("health_component_index", "uint8_t")]);
            (sub_id(name).to_string(), json!({ "name": name, "message": words, "arguments": arguments }))
        })
        .collect();
    checks.insert(sub_id(ARMING_SUMMARY).to_string(), arming_summary);
    let groups: serde_json::Map<String, Json> =
        MODE_GROUPS.iter().map(|(nav, _, mode, _)| (nav.to_string(), json!([mode]))).collect();
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
