//! Table of logged topics, one row each. Topics use PX4's names where possible, so that PX4's tools show their standard
//! plots.

use super::row::LogRow;
use crate::autopilot::{FlightMode, LandedState};
use crate::endpoint::snapshot::VehicleSnapshot;
use spandrel_model::geodesy::Geo;

/// A logged topic.
#[derive(Debug, Clone, Copy)]
pub struct UlogTopic {
    /// Topic name: PX4's name, or a custom one with the `spandrel_` prefix.
    pub name: &'static str,
    /// Field definitions after the timestamp.
    pub fields: &'static str,
    /// Rate in simulation time, Hz.
    pub rate_hz: f64,
    /// Function that appends the fields to a row. Returns `None` if there is no data to log.
    pub fill: fn(&VehicleSnapshot, &mut LogRow) -> Option<()>,
}

const fn topic(
    name: &'static str,
    rate_hz: f64,
    fields: &'static str,
    fill: fn(&VehicleSnapshot, &mut LogRow) -> Option<()>,
) -> UlogTopic {
    UlogTopic { name, fields, rate_hz, fill }
}

/// All logged topics.
pub const TOPICS: &[UlogTopic] = &[
    topic("sensor_combined", 250.0, "float[3] gyro_rad;float[3] accelerometer_m_s2;", sensor_combined),
    topic("vehicle_angular_velocity", 250.0, "float[3] xyz;", angular_velocity),
    topic("vehicle_attitude", 100.0, "float[4] q;", attitude),
    topic("vehicle_attitude_setpoint", 50.0, "float[4] q_d;float[3] thrust_body;", attitude_setpoint),
    topic(
        "vehicle_local_position",
        50.0,
        "float x;float y;float z;float vx;float vy;float vz;float heading;double ref_lat;double ref_lon;float ref_alt;float eph;\
         float epv;bool xy_valid;bool z_valid;bool v_xy_valid;bool v_z_valid;",
        local_position,
    ),
    topic("vehicle_local_position_setpoint", 20.0, "float x;float y;float z;", position_setpoint),
    topic("vehicle_global_position", 10.0, "double lat;double lon;float alt;float eph;float epv;", global_position),
    topic(
        "vehicle_gps_position",
        5.0,
        "double latitude_deg;double longitude_deg;double altitude_msl_m;float eph;float epv;float hdop;float vdop;float vel_n_m_s;\
         float vel_e_m_s;float vel_d_m_s;uint8_t fix_type;uint8_t satellites_used;",
        gnss,
    ),
    topic("vehicle_air_data", 20.0, "float baro_alt_meter;float baro_pressure_pa;", air_data),
    topic("vehicle_magnetometer", 20.0, "float[3] magnetometer_ga;", magnetometer),
    topic("distance_sensor", 20.0, "float current_distance;uint8_t orientation;", range_down),
    topic("manual_control_setpoint", 50.0, "bool valid;float roll;float pitch;float yaw;float throttle;", sticks),
    topic("actuator_motors", 100.0, "float[12] control;", motors),
    topic("actuator_outputs", 20.0, "uint32_t noutputs;float[16] output;", outputs),
    topic("battery_status", 5.0, "bool connected;float voltage_v;float current_a;float remaining;", battery),
    topic("vehicle_status", 5.0, "uint8_t arming_state;uint8_t nav_state;bool failsafe;uint8_t vehicle_type;", status),
    topic("vehicle_land_detected", 5.0, "bool landed;bool maybe_landed;bool ground_contact;", land_detected),
    topic("home_position", 1.0, "double lat;double lon;float alt;float x;float y;float z;", home),
    topic("wind", 5.0, "float windspeed_north;float windspeed_east;", wind),
    topic("vehicle_attitude_groundtruth", 50.0, "float[4] q;", true_attitude),
    topic("vehicle_angular_velocity_groundtruth", 50.0, "float[3] xyz;", true_rates),
    topic("vehicle_local_position_groundtruth", 50.0, "float x;float y;float z;float vx;float vy;float vz;", true_position),
    topic("vehicle_global_position_groundtruth", 10.0, "double lat;double lon;float alt;", true_global),
    topic(
        "spandrel_scoring",
        30.0,
        "float clearance_m;float lux;int32_t contact;int32_t hits;int32_t respawns;float gimbal_pitch_rad;bool lamp_on;",
        scoring,
    ),
];

fn sensor_combined(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    let imu = v.readings.imu.as_ref()?;
    row.vec(imu.rates_rad_s).vec(imu.specific_force_m_s2);
    Some(())
}

fn angular_velocity(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    row.vec(v.estimate.rates_rad_s);
    Some(())
}

fn attitude(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    row.quaternion(v.estimate.attitude);
    v.estimate.attitude_valid.then_some(())
}

fn attitude_setpoint(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    row.quaternion(v.status.attitude_target).floats(&[0.0, 0.0, -v.status.thrust]);
    v.status.armed.then_some(())
}

fn local_position(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    // Without a fix, there is no reference position, and PX4 logs NaN.
    let nowhere = Geo { latitude_deg: f64::NAN, longitude_deg: f64::NAN, altitude_m: f64::NAN };
    let (e, origin) = (v.estimate, v.local_origin().unwrap_or(nowhere));
    row.vec(v.local_from_site(e.position_m)).vec(e.velocity_m_s).f32(e.attitude.yaw_rad());
    row.f64(origin.latitude_deg).f64(origin.longitude_deg).f32(origin.altitude_m).f32(e.horizontal_m).f32(e.vertical_m);
    for valid in [e.position_valid, e.attitude_valid, e.position_valid, e.attitude_valid] {
        row.bool(valid);
    }
    Some(())
}

fn position_setpoint(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    row.vec(v.local_from_site(v.status.target_m?));
    Some(())
}

fn global_position(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    let geo = v.geo();
    row.f64(geo.latitude_deg).f64(geo.longitude_deg).f32(geo.altitude_m).f32(v.estimate.horizontal_m).f32(v.estimate.vertical_m);
    v.estimate.position_valid.then_some(())
}

fn gnss(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    let gnss = v.readings.gnss.as_ref()?;
    let geo = v.plane.geo_from_enu(gnss.position_m.enu());
    row.f64(geo.latitude_deg)
        .f64(geo.longitude_deg)
        .f64(geo.altitude_m)
        .f32(gnss.eph_m)
        .f32(gnss.epv_m)
        .f32(gnss.hdop)
        .f32(gnss.vdop);
    row.vec(gnss.velocity_m_s).u8(gnss.fix).u8(gnss.satellites);
    Some(())
}

fn air_data(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    row.f32(v.readings.baro_up_m? + v.plane.origin().altitude_m).f32(v.readings.pressure_pa?);
    Some(())
}

fn magnetometer(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    row.vec(v.readings.mag_gauss?);
    Some(())
}

fn range_down(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    /// ROTATION_DOWNWARD_FACING of PX4's `distance_sensor`.
    const DOWNWARD_FACING: u8 = 25;
    let range = v.readings.range_down_m.filter(|range| range.is_finite())?;
    row.f32(range).u8(DOWNWARD_FACING);
    Some(())
}

fn sticks(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    let sticks = v.sticks?;
    row.bool(true).f32(sticks.right).f32(sticks.forward).f32(sticks.yaw).f32(sticks.up);
    Some(())
}

fn motors(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    row.floats(&zero_padded::<12>(v.actuators.motors.iter().map(|motor| if v.actuators.armed { *motor } else { 0.0 })));
    Some(())
}

/// Appends the motor outputs as pulse widths, us: 1000 at idle, 2000 at full speed, 900 while disarmed.
fn outputs(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    let pulses = v.actuators.motors.iter().map(|motor| if v.actuators.armed { 1000.0 + 1000.0 * motor } else { 900.0 });
    row.i32(v.vehicle.rotors.len() as i32).floats(&zero_padded::<16>(pulses.take(v.vehicle.rotors.len())));
    Some(())
}

fn zero_padded<const N: usize>(values: impl Iterator<Item = f64>) -> [f64; N] {
    let mut out = [0.0; N];
    for (slot, value) in out.iter_mut().zip(values) {
        *slot = value;
    }
    out
}

fn battery(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    let battery = v.readings.battery.as_ref()?;
    row.bool(true).f32(battery.voltage_v).f32(battery.current_a).f32(battery.remaining_pct / 100.0);
    Some(())
}

fn status(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    /// PX4's arming states and its code for rotary-wing vehicles.
    const DISARMED: u8 = 1;
    const ARMED: u8 = 2;
    const ROTARY_WING: u8 = 1;
    row.u8(if v.status.armed { ARMED } else { DISARMED }).u8(nav_state(v.status.mode)).bool(v.status.failsafe.is_some());
    row.u8(ROTARY_WING);
    Some(())
}

/// Returns PX4's code for a mode (`nav_state` of `vehicle_status`).
fn nav_state(mode: FlightMode) -> u8 {
    match mode {
        FlightMode::Altitude => 1,
        FlightMode::Position => 2,
        FlightMode::Mission => 3,
        FlightMode::Hold => 4,
        FlightMode::Return => 5,
        FlightMode::Offboard => 14,
        FlightMode::Orbit => 21,
        FlightMode::Stabilized => 15,
        FlightMode::Takeoff => 17,
        FlightMode::Land => 18,
        FlightMode::Acro => 10,
        FlightMode::SmartReturn => 5,
        FlightMode::Follow => 19,
    }
}

fn land_detected(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    let landed = v.status.landed == LandedState::OnGround;
    row.bool(landed).bool(landed).bool(landed);
    Some(())
}

fn home(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    let home = v.status.home_m?;
    let geo = v.plane.geo_from_enu(home.enu());
    row.f64(geo.latitude_deg).f64(geo.longitude_deg).f32(geo.altitude_m).vec(v.local_from_site(home));
    Some(())
}

fn wind(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    row.f32(v.wind_m_s.north()).f32(v.wind_m_s.east());
    Some(())
}

fn true_attitude(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    row.quaternion(v.truth.attitude);
    Some(())
}

fn true_rates(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    row.vec(v.truth.rates_rad_s);
    Some(())
}

fn true_position(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    row.vec(v.local_from_site(v.truth.position_m)).vec(v.truth.velocity_m_s);
    Some(())
}

fn true_global(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    let geo = v.true_geo();
    row.f64(geo.latitude_deg).f64(geo.longitude_deg).f32(geo.altitude_m);
    Some(())
}

fn scoring(v: &VehicleSnapshot, row: &mut LogRow) -> Option<()> {
    row.f32(v.scoring.clearance_m).f32(v.scoring.lux).i32(v.scoring.contact.code()).i32(v.scoring.hits).i32(v.scoring.respawns);
    row.f32(v.gimbal.pitch_rad).bool(v.lamp.on);
    Some(())
}
