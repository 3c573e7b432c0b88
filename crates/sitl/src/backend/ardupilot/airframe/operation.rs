//! Links, sticks, failsafes, scheduling and logging.

use super::table::Table;
use crate::backend::launch::LaunchSettings;

/// States per pass through ArduPilot's main loop. ArduPilot does not arm unless the gyroscope is at least 1.8 times as fast as the
/// loop.
const STATES_PER_LOOP: f64 = 2.0;
/// System ID that ground stations use by default.
const GROUND_STATION: i64 = 255;
/// ArduPilot's default timeouts of a lost ground station and of stick overrides, s.
const STATION_TIMEOUT_S: f64 = 5.0;
const OVERRIDE_TIMEOUT_S: f64 = 3.0;

/// Dead zone of the roll, pitch and yaw sticks, microseconds: ArduPilot's default. ArduPilot refuses to arm while a stick is
/// outside it, and no hand or gamepad rests at the exact center.
const DEAD_ZONE_US: i64 = 20;

/// Adds the parameters.
pub fn add(table: &mut Table, settings: &LaunchSettings) {
    add_links(table, settings);
    add_sticks(table);
    table.integer("SCHED_LOOP_RATE", (settings.rate_hz / STATES_PER_LOOP).round() as i64);
    table.integer("ARMING_CHECK", 1);
    table.integer("FENCE_ENABLE", 0);
    table.integer("AVOID_ENABLE", 1);
    table.integer("TERRAIN_ENABLE", 0);
    table.integer("LOG_BACKEND_TYPE", 1);
    table.integer("LOG_FILE_MB_FREE", 10);
}

fn add_links(table: &mut Table, settings: &LaunchSettings) {
    let system_id = i64::from(settings.instance) + 1;
    table.both(["SYSID_THISMAV", "MAV_SYSID"], system_id);
    // ArduPilot takes sticks only from this ground station. 4.7's range of IDs (MAV_GCS_SYSID_HI) is missing in its development
    // versions.
    table.both(["SYSID_MYGCS", "MAV_GCS_SYSID"], GROUND_STATION);
    table.integer("SERIAL0_PROTOCOL", 2);
    for port in 1..=7 {
        table.integer(&format!("SERIAL{port}_PROTOCOL"), -1);
    }
    let factor = settings.client_speed_factor.max(1.0);
    table.integer("FS_GCS_ENABLE", 1);
    table.real("FS_GCS_TIMEOUT", STATION_TIMEOUT_S * factor, (2.0, 120.0));
    table.real("RC_OVERRIDE_TIME", OVERRIDE_TIMEOUT_S * factor, (0.0, 120.0));
    // Keep flying if the ground station is lost while the pilot has control, as with the built-in
    // autopilot.
    table.integer("FS_OPTIONS", 21);
    // If the position estimate fails under a bridge, the trainee must remain in control: Altitude Hold instead of Land.
    table.integer("FS_EKF_ACTION", 2);
}

/// Adds the receiver, whose channels are centered while no ground station overrides them.
fn add_sticks(table: &mut Table) {
    for channel in 1..=8 {
        table.integer(&format!("RC{channel}_MIN"), 1000);
        table.integer(&format!("RC{channel}_TRIM"), 1500);
        table.integer(&format!("RC{channel}_MAX"), 2000);
        table.integer(&format!("RC{channel}_OPTION"), 0);
    }
    for channel in [1, 2, 4] {
        table.integer(&format!("RC{channel}_DZ"), DEAD_ZONE_US);
    }
    table.integer("RC3_DZ", 10);
    table.integer("THR_DZ", 30);
    table.integer("FLTMODE_CH", 0);
    table.integer("INITIAL_MODE", 5);
    table.integer("FS_THR_ENABLE", 0);
    // The throttle stick returns to its center, and landing disarms.
    table.integer("PILOT_THR_BHV", 5);
}
