//! Sensors, estimator, battery, gimbal and camera, and the errors that ArduPilot simulates itself.

use super::super::sensor_errors::COMPASS_OFFSETS_MGAUSS;
use super::super::sensor_messages::FLOW_SCALER;
use super::table::Table;
use crate::backend::launch::LaunchSettings;
use spandrel_model::vehicle::Vehicle;

/// Type of a GNSS receiver and a range finder that send MAVLink messages.
const GPS_TYPE_MAVLINK: i64 = 14;
const RANGE_FINDER_MAVLINK: i64 = 10;
const FLOW_TYPE_MAVLINK: i64 = 5;
/// Type of a gimbal that uses MAVLink's gimbal device protocol (named after its first manufacturer).
const MOUNT_GIMBAL_DEVICE: i64 = 6;
/// Type of a camera that uses MAVLink's camera protocol, version 2.
const CAMERA_MAVLINK_V2: i64 = 6;
/// Age that a reading gets from the frame and the MAVLink link, ms.
const LINK_DELAY_MS: i64 = 5;
/// Largest allowed value of GPS1_DELAY_MS, ms.
const MAX_DELAY_MS: i64 = 250;
/// Rotations of a range finder: downward and upward.
const DOWN: i64 = 25;
const UP: i64 = 24;

/// Adds the parameters.
pub fn add(table: &mut Table, vehicle: &Vehicle, settings: &LaunchSettings) {
    add_position_sensors(table, vehicle);
    add_calibration(table);
    add_simulated_errors(table);
    add_battery(table, vehicle, settings);
    add_payload(table, vehicle);
}

fn add_position_sensors(table: &mut Table, vehicle: &Vehicle) {
    table.both(["GPS_TYPE", "GPS1_TYPE"], GPS_TYPE_MAVLINK);
    table.both(["GPS_TYPE2", "GPS2_TYPE"], 0);
    let delay_ms = (vehicle.sensors.gnss_delay_s * 1000.0).round() as i64;
    table.both(["GPS_DELAY_MS", "GPS1_DELAY_MS"], (delay_ms + LINK_DELAY_MS).min(MAX_DELAY_MS));
    table.integer("AHRS_EKF_TYPE", 3);
    table.integer("EK2_ENABLE", 0);
    table.integer("EK3_ENABLE", 1);
    let max_cm = (vehicle.sensors.range_max_m * 100.0).round() as i64;
    for (number, orientation) in [(1, DOWN), (2, UP)] {
        table.integer(&format!("RNGFND{number}_TYPE"), RANGE_FINDER_MAVLINK);
        table.integer(&format!("RNGFND{number}_ORIENT"), orientation);
        table.integer(&format!("RNGFND{number}_MIN_CM"), 10);
        table.integer(&format!("RNGFND{number}_MAX_CM"), max_cm);
        table.real(&format!("RNGFND{number}_MIN"), 0.1, (0.0, 100.0));
        table.real(&format!("RNGFND{number}_MAX"), vehicle.sensors.range_max_m, (0.0, 1000.0));
    }
    if vehicle.sensors.flow_velocity_m_s > 0.0 {
        table.integer("FLOW_TYPE", FLOW_TYPE_MAVLINK);
        table.integer("FLOW_FXSCALER", i64::from(FLOW_SCALER));
        table.integer("FLOW_FYSCALER", i64::from(FLOW_SCALER));
        // Velocity from optical flow in addition to the GNSS velocity: option 1 fuses the velocities of all source sets.
        table.integer("EK3_SRC2_POSXY", 0);
        table.integer("EK3_SRC2_VELXY", 5);
        table.integer("EK3_SRC2_POSZ", 1);
        table.integer("EK3_SRC2_VELZ", 0);
        table.integer("EK3_SRC2_YAW", 1);
        table.integer("EK3_SRC_OPTIONS", 1);
    }
}

/// Adds results of calibrations without which ArduPilot refuses to arm.
fn add_calibration(table: &mut Table) {
    for axis in ["X", "Y", "Z"] {
        table.real(&format!("INS_ACCOFFS_{axis}"), 0.001, (-3.5, 3.5));
        table.real(&format!("INS_ACCSCAL_{axis}"), 1.001, (0.8, 1.2));
        // The JSON interface presets a calibration of a second sensor. Without the sensor, it must be gone.
        table.integer(&format!("INS_ACC2OFFS_{axis}"), 0);
        table.integer(&format!("INS_ACC2SCAL_{axis}"), 1);
    }
    table.integer("INS_GYR_CAL", 0);
    for (axis, offset) in ["X", "Y", "Z"].into_iter().zip(COMPASS_OFFSETS_MGAUSS) {
        table.real(&format!("COMPASS_OFS_{axis}"), offset, (-400.0, 400.0));
        table.real(&format!("SIM_MAG1_OFS_{axis}"), offset, (-400.0, 400.0));
    }
    table.integer("COMPASS_USE2", 0);
    table.integer("COMPASS_USE3", 0);
}

/// Turns off the errors that ArduPilot would add to the sensors: they come from the aircraft's sensor models.
fn add_simulated_errors(table: &mut Table) {
    for name in ["SIM_BARO_RND", "SIM_DRIFT_SPEED", "SIM_MAG_RND", "SIM_WIND_SPD", "SIM_WIND_TURB"] {
        table.integer(name, 0);
    }
    table.integer("SIM_BARO_COUNT", 1);
    // The line of JSON has one inertial sensor. Each further one would be a copy, and the second one is too slow for the loop rate.
    table.integer("SIM_IMU_COUNT", 1);
}

fn add_battery(table: &mut Table, vehicle: &Vehicle, settings: &LaunchSettings) {
    let capacity_mah = vehicle.battery.capacity_ah * 1000.0;
    let (low_pct, critical_pct) = settings.battery_thresholds_pct;
    table.integer("BATT_MONITOR", 4);
    // Pins and scales of the simulated power module.
    table.integer("BATT_VOLT_PIN", 13);
    table.integer("BATT_CURR_PIN", 12);
    table.real("BATT_VOLT_MULT", 10.1, (0.0, 100.0));
    table.real("BATT_AMP_PERVLT", 17.0, (0.0, 100.0));
    table.integer("BATT_CAPACITY", capacity_mah.round() as i64);
    table.integer("BATT_LOW_MAH", (0.01 * low_pct * capacity_mah).round() as i64);
    table.integer("BATT_CRT_MAH", (0.01 * critical_pct * capacity_mah).round() as i64);
    // The charge decides: the voltage under load drops for moments.
    table.integer("BATT_LOW_VOLT", 0);
    table.integer("BATT_CRT_VOLT", 0);
    table.integer("BATT_FS_LOW_ACT", 2);
    table.integer("BATT_FS_CRT_ACT", 1);
}

fn add_payload(table: &mut Table, vehicle: &Vehicle) {
    let camera = &vehicle.camera;
    table.integer("MNT1_TYPE", MOUNT_GIMBAL_DEVICE);
    table.real("MNT1_PITCH_MIN", camera.gimbal_pitch_min_rad.to_degrees(), (-90.0, 90.0));
    table.real("MNT1_PITCH_MAX", camera.gimbal_pitch_max_rad.to_degrees(), (-90.0, 90.0));
    table.real("MNT1_YAW_MIN", 0.0, (-180.0, 180.0));
    table.real("MNT1_YAW_MAX", 0.0, (-180.0, 180.0));
    table.integer("CAM1_TYPE", CAMERA_MAVLINK_V2);
}
