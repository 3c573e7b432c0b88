//! PX4's parameters for battery, sensors, gimbal and links.

use super::param_table::ParamTable;
use crate::backend::launch::LaunchSettings;
use crate::sensors::magnetometer::earth_field_gauss;
use spandrel_model::math;
use spandrel_model::vehicle::Vehicle;

/// PX4's default rate of the rate controller in multirotors, Hz. A higher sensor rate needs a higher one: PX4 answers only
/// readings that it passes on to the rate controller.
const RATE_CONTROL_HZ: f64 = 800.0;
/// PX4's default timeouts, s: ground station, sticks, offboard setpoints and onboard computer.
const STATION_TIMEOUT_S: f64 = 10.0;
const STICKS_TIMEOUT_S: f64 = 0.5;
const OFFBOARD_TIMEOUT_S: f64 = 1.0;
const COMPANION_TIMEOUT_S: f64 = 5.0;
/// Emergency threshold of the battery, as a share of the critical one (estimate).
const EMERGENCY_SHARE: f64 = 0.5;
/// PX4's code for the barometer as height reference.
const BAROMETER_HEIGHT: f64 = 0.0;
/// Barometer noise that PX4 assumes, as a multiple of the sensor's white noise: a margin for its drift (tuned in flights with PX4
/// 1.16: heights within 0.1 m, 1 sigma).
const BAROMETER_NOISE_FACTOR: f64 = 10.0;
/// PX4's bit for the velocity of a vision system.
const VISION_VELOCITY: f64 = 4.0;
/// Margin of the time to return that disables the failsafe for the remaining flight time, s.
const RETURN_TIME_MARGIN_S: f64 = -10_000.0;

/// Adds all parameters of this file.
pub(super) fn add(table: &mut ParamTable, vehicle: &Vehicle, settings: &LaunchSettings) {
    battery(table, vehicle, settings);
    inertial_sensors(table, settings);
    position_sensors(table, vehicle);
    compass(table, settings);
    range_and_flow(table, vehicle);
    gimbal(table, vehicle);
    links(table, settings);
    log(table);
}

/// PX4 takes the charge from BATTERY_STATUS of another component instead of its own battery model.
fn battery(table: &mut ParamTable, vehicle: &Vehicle, settings: &LaunchSettings) {
    let (low, critical) = settings.battery_thresholds_pct;
    table.integer("SIM_BAT_ENABLE", 0.0, (0.0, 1.0));
    table.integer("BAT1_N_CELLS", f64::from(vehicle.battery.cells), (0.0, 16.0));
    table.real("BAT1_CAPACITY", vehicle.battery.capacity_ah * 1000.0, (-1.0, 100_000.0));
    table.real("BAT_LOW_THR", low / 100.0, (0.12, 0.5));
    table.real("BAT_CRIT_THR", critical / 100.0, (0.05, 0.5));
    table.real("BAT_EMERGEN_THR", critical * EMERGENCY_SHARE / 100.0, (0.03, 0.5));
    remaining_time(table);
}

/// PX4 takes no remaining flight time from BATTERY_STATUS and treats the missing value as 0 s, so it would return to launch after
/// every takeoff. Action 0 (none) still stops the vehicle for some seconds. The margin, far below PX4's documented minimum of 0,
/// makes the time that a return needs negative, so the condition is never met. The failsafe for the charge remains.
fn remaining_time(table: &mut ParamTable) {
    table.integer("COM_FLTT_LOW_ACT", 1.0, (0.0, 3.0));
    table.integer("RTL_TIME_MARGIN", RETURN_TIME_MARGIN_S, (RETURN_TIME_MARGIN_S, 3600.0));
}

/// Three inertial sensors, each with an estimator of its own. The estimators must run at the sensor rate: PX4's logger takes part
/// in the lockstep once per estimator step, and with slower estimators, most readings would get no answer as soon as it starts.
fn inertial_sensors(table: &mut ParamTable, settings: &LaunchSettings) {
    table.integer("IMU_INTEG_RATE", settings.rate_hz, (100.0, 1000.0));
    table.integer("IMU_GYRO_RATEMAX", settings.rate_hz.max(RATE_CONTROL_HZ), (100.0, 2000.0));
    table.integer("EKF2_MULTI_IMU", 3.0, (0.0, 4.0));
    table.integer("SENS_IMU_MODE", 0.0, (0.0, 1.0));
}

/// The barometer is much steadier than the height of the receiver.
fn position_sensors(table: &mut ParamTable, vehicle: &Vehicle) {
    let sensors = &vehicle.sensors;
    table.real("EKF2_GPS_DELAY", sensors.gnss_delay_s * 1000.0, (0.0, 300.0));
    table.real("EKF2_GPS_P_NOISE", sensors.gnss_horizontal_noise_m, (0.01, 10.0));
    table.real("EKF2_GPS_V_NOISE", sensors.gnss_velocity_noise_m_s, (0.01, 5.0));
    table.integer("EKF2_HGT_REF", BAROMETER_HEIGHT, (0.0, 3.0));
    table.real("EKF2_BARO_NOISE", BAROMETER_NOISE_FACTOR * sensors.baro_noise_m, (0.01, 15.0));
}

/// The simulated field is a dipole, whose declination differs from PX4's table by some degrees.
fn compass(table: &mut ParamTable, settings: &LaunchSettings) {
    let field = earth_field_gauss(settings.home);
    table.integer("EKF2_DECL_TYPE", 0.0, (0.0, 3.0));
    table.real("EKF2_MAG_DECL", math::atan2(field.east(), field.north()).to_degrees(), (-180.0, 180.0));
}

/// The range finder measures from the center of mass, so on the ground it reads the height of the feet.
fn range_and_flow(table: &mut ParamTable, vehicle: &Vehicle) {
    let sensors = &vehicle.sensors;
    let standing_m = vehicle.hull.feet_m.iter().map(|foot| foot.down()).fold(0.0, f64::max);
    table.real("EKF2_MIN_RNG", standing_m, (0.01, 10.0));
    table.real("EKF2_RNG_NOISE", math::hypot(sensors.range_noise_m, sensors.range_bias_m), (0.01, 10.0));
    table.real("EKF2_RNG_DELAY", 0.0, (0.0, 300.0));
    let fitted = sensors.flow_velocity_m_s > 0.0;
    table.integer("EKF2_OF_CTRL", if fitted { 1.0 } else { 0.0 }, (0.0, 1.0));
    table.real("EKF2_OF_DELAY", 0.0, (0.0, 300.0));
    // Without a surface below, the flow velocity arrives as the velocity of a vision system.
    table.integer("EKF2_EV_CTRL", if fitted { VISION_VELOCITY } else { 0.0 }, (0.0, 15.0));
    table.real("EKF2_EVV_NOISE", sensors.flow_velocity_m_s, (0.01, 2.0));
    table.real("EKF2_EV_DELAY", 0.0, (0.0, 300.0));
    table.real("SENS_FLOW_MAXHGT", sensors.range_max_m, (1.0, 100.0));
}

/// PX4 is the manager of our gimbal, which is a MAVLink gimbal device.
fn gimbal(table: &mut ParamTable, vehicle: &Vehicle) {
    table.integer("MNT_MODE_IN", 4.0, (-1.0, 4.0));
    table.integer("MNT_MODE_OUT", 2.0, (0.0, 2.0));
    table.real("MNT_RATE_PITCH", vehicle.camera.gimbal_rate_rad_s.to_degrees(), (1.0, 90.0));
}

/// Sticks come as MANUAL_CONTROL from a ground station. PX4 measures timeouts in simulation time, clients in their own.
fn links(table: &mut ParamTable, settings: &LaunchSettings) {
    let factor = settings.client_speed_factor.max(1.0);
    table.integer("COM_RC_IN_MODE", 1.0, (0.0, 4.0));
    // Trainees may put down the controller in automatic flight, as with the built-in autopilot.
    table.integer("COM_RCL_EXCEPT", 7.0, (0.0, 7.0));
    table.integer("COM_DL_LOSS_T", (STATION_TIMEOUT_S * factor).ceil(), (5.0, 300.0));
    table.real("COM_RC_LOSS_T", STICKS_TIMEOUT_S * factor, (0.0, 35.0));
    table.real("COM_OF_LOSS_T", OFFBOARD_TIMEOUT_S * factor, (0.0, 60.0));
    table.real("COM_OBC_LOSS_T", COMPANION_TIMEOUT_S * factor, (0.0, 60.0));
    // A vehicle near a bridge must climb clear of it before it returns.
    table.integer("RTL_CONE_ANG", 0.0, (0.0, 90.0));
}

/// PX4's defaults for real aircraft. Those of its simulations record several times as much.
fn log(table: &mut ParamTable) {
    table.integer("SDLOG_MODE", 0.0, (-1.0, 4.0));
    table.integer("SDLOG_PROFILE", 1.0, (0.0, 2047.0));
}
