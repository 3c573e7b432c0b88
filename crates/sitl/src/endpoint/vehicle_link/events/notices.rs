//! Texts that are also sent as events, as PX4 does: a client with the event definitions can show them in its own
//! language.

use serde_json::{Value as Json, json};

/// PX4's log levels: internal in the upper four bits, external in the lower.
const CRITICAL: u8 = 0x22;
const WARNING: u8 = 0x44;
const INFO: u8 = 0x66;

/// An event without arguments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Notice {
    /// Prefix of the text.
    pub text_prefix: &'static str,
    /// Name of the event.
    pub name: &'static str,
    /// Internal and external log levels.
    pub levels: u8,
}

const fn notice(text_prefix: &'static str, name: &'static str, levels: u8) -> Notice {
    Notice { text_prefix, name, levels }
}

/// All texts that are also sent as events.
pub const NOTICES: [Notice; 34] = [
    notice("Arming denied", "commander_arming_denied", CRITICAL),
    notice("Disarming denied: not landed", "commander_disarming_denied_not_landed", CRITICAL),
    notice("No mission to fly", "mode_denied_no_mission", CRITICAL),
    notice("Mission has no takeoff item", "mode_denied_no_takeoff_item", CRITICAL),
    notice("Mission has no landing item", "mode_denied_no_landing_item", CRITICAL),
    notice("First waypoint too far from home", "mode_denied_first_waypoint_far", CRITICAL),
    notice("Offboard rejected: no external setpoints", "mode_denied_no_setpoints", CRITICAL),
    notice("No position estimate", "mode_denied_no_position", CRITICAL),
    notice("No home position", "mode_denied_no_home", CRITICAL),
    notice("No path recorded since takeoff", "mode_denied_no_path", CRITICAL),
    notice("No orbit defined", "mode_denied_no_orbit", CRITICAL),
    notice("No such mode", "mode_denied_unknown", CRITICAL),
    notice("Low battery", "battery_warning_low", WARNING),
    notice("Critical battery", "battery_warning_critical", CRITICAL),
    notice("Failsafe: low battery", "failsafe_battery_low", WARNING),
    notice("Failsafe: critical battery", "failsafe_battery_critical", CRITICAL),
    notice("Failsafe: battery emergency", "failsafe_battery_emergency", CRITICAL),
    notice("Failsafe: motor failure", "failsafe_motor_failure", CRITICAL),
    notice("Failsafe: manual control lost", "failsafe_manual_control_lost", CRITICAL),
    notice("Failsafe: ground station lost", "failsafe_ground_station_lost", CRITICAL),
    notice("Failsafe: external setpoints lost", "failsafe_setpoints_lost", CRITICAL),
    notice("Failsafe: position lost, holding altitude only", "failsafe_position_lost_altitude", CRITICAL),
    notice("Failsafe: position lost, landing", "failsafe_position_lost_landing", CRITICAL),
    notice("Failsafe cleared", "failsafe_cleared", INFO),
    notice("Geofence breached", "failsafe_geofence_breached", CRITICAL),
    notice("Back inside geofence", "failsafe_geofence_within", INFO),
    notice("Attitude control lost: motor/propeller failure?", "failure_detector_attitude_lost", CRITICAL),
    notice("Crash detected", "failure_detector_crash", CRITICAL),
    notice("GNSS position jumped", "estimator_position_reset", CRITICAL),
    notice("GNSS stuck: not used", "sensor_gnss_stuck", CRITICAL),
    notice("GNSS inconsistent: not used", "sensor_gnss_inconsistent", CRITICAL),
    notice("Takeoff detected", "commander_takeoff_detected", INFO),
    notice("Landing detected", "commander_landing_detected", INFO),
    notice("Mission finished", "mission_finished", INFO),
];

/// Returns the event that corresponds to a text.
#[must_use]
pub fn of(text: &str) -> Option<&'static Notice> {
    NOTICES.iter().find(|notice| text.starts_with(notice.text_prefix))
}

/// Checks whether the event conveys the whole text. If so, a ground station that shows events does not have to show the
/// text as well. PX4 marks such texts with a trailing tab, and QGroundControl hides them.
#[must_use]
pub fn covers_whole_text(text: &str) -> bool {
    of(text).is_some_and(|notice| notice.text_prefix == text)
}

/// Returns the event definitions.
#[must_use]
pub fn definitions(id: impl Fn(&str) -> u32) -> Json {
    let events = NOTICES.iter().map(|n| (id(n.name).to_string(), json!({ "name": n.name, "message": n.text_prefix })));
    json!({ "events": events.collect::<serde_json::Map<String, Json>>() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_every_text_maps_to_one_event() {
        for (k, notice) in NOTICES.iter().enumerate() {
            let others = NOTICES.iter().enumerate().filter(|(other, _)| *other != k);
            assert!(
                others.clone().all(|(_, other)| !notice.text_prefix.starts_with(other.text_prefix)),
                "{}",
                notice.text_prefix
            );
            assert!(others.clone().all(|(_, other)| notice.name != other.name), "{}", notice.name);
        }
        assert_eq!(of("Mission finished").map(|n| n.name), Some("mission_finished"));
        assert!(covers_whole_text("Mission finished") && !covers_whole_text("Low battery: 29%") && of("Armed").is_none());
    }
}
