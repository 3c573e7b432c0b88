//! Builders for additional messages that ArduCopter streams.

use super::super::snapshot::VehicleSnapshot;
use spandrel_mavlink::ardupilotmega::{AHRS, DialectMessage, EKF_STATUS_REPORT, MEMINFO, SIMSTATE, WIND};
use spandrel_mavlink::dialect::{MavMessage, MavPowerStatus, POWER_STATUS_DATA, SIM_STATE_DATA};
use spandrel_mavlink::units::deg_e7;
use spandrel_model::frames::Vec3;
use spandrel_model::math;

/// Flag bits from EKF_STATUS_FLAGS (ardupilotmega.xml).
const ATTITUDE: u16 = 1;
const VERTICAL: u16 = 4 | 32;
const HORIZONTAL: u16 = 2 | 8 | 16 | 256 | 512;
const CONSTANT_POSITION: u16 = 128;
const UNINITIALIZED: u16 = 1_024;
/// Accuracy that corresponds to a reported variance of 1, m (1 sigma): the accuracy required for arming. ArduPilot
/// rejects estimates with a higher variance.
const REJECTION_ACCURACY_M: f64 = 5.0;
/// Values that ArduPilot's own SITL reports for its board: a simulated board has no memory or power supply.
const FREE_MEMORY_BYTES: f64 = 524_288.0;
const BOARD_VOLTAGE_MV: u16 = 5_000;

pub(crate) fn estimator(v: &VehicleSnapshot) -> Option<DialectMessage> {
    let e = v.estimate;
    let flags = match (e.attitude_valid, e.position_valid) {
        (false, _) => UNINITIALIZED,
        (true, false) => ATTITUDE | VERTICAL | CONSTANT_POSITION,
        (true, true) => ATTITUDE | VERTICAL | HORIZONTAL,
    };
    let share = |sigma_m: f64| ((sigma_m / REJECTION_ACCURACY_M) * (sigma_m / REJECTION_ACCURACY_M)).min(1.0);
    let compass = if v.status.health.compass { 0.0 } else { 1.0 };
    let [flat, height] = [e.horizontal_m, e.vertical_m].map(share);
    Some(EKF_STATUS_REPORT.message(&[
        f64::from(flags),
        if e.position_valid { flat } else { 1.0 },
        flat,
        height,
        compass,
        0.0,
        0.0,
    ]))
}

/// Sends the gyroscope drift: the correction that the estimator adds to the readings. The estimator does not track its
/// attitude error, so those fields are 0.
pub(crate) fn ahrs(v: &VehicleSnapshot) -> Option<DialectMessage> {
    let drift = v.readings.imu.map_or(Vec3::zero(), |imu| v.estimate.rates_rad_s - imu.rates_rad_s);
    let [x, y, z] = drift.array();
    Some(AHRS.message(&[x, y, z]))
}

pub(crate) fn memory(_: &VehicleSnapshot) -> Option<DialectMessage> {
    Some(MEMINFO.message(&[0.0, f64::from(u16::MAX), FREE_MEMORY_BYTES]))
}

pub(crate) fn simulation(v: &VehicleSnapshot) -> Option<DialectMessage> {
    let (roll, pitch, yaw) = v.truth.attitude.euler();
    let ([xa, ya, za], [xr, yr, zr]) = (v.specific_force_m_s2.array(), v.truth.rates_rad_s.array());
    let geo = v.true_geo();
    let [lat, lng] = [geo.latitude_deg, geo.longitude_deg].map(|degrees| f64::from(deg_e7(degrees)));
    Some(SIMSTATE.message(&[roll, pitch, yaw, xa, ya, za, xr, yr, zr, lat, lng]))
}

pub(crate) fn sim_state(v: &VehicleSnapshot) -> Option<MavMessage> {
    let real = |value: f64| value as f32;
    let (roll, pitch, yaw) = v.truth.attitude.euler();
    let [q1, q2, q3, q4] = v.truth.attitude.wxyz().map(real);
    let ([xacc, yacc, zacc], [xgyro, ygyro, zgyro]) =
        (v.specific_force_m_s2.array().map(real), v.truth.rates_rad_s.array().map(real));
    let ([vn, ve, vd], geo) = (v.truth.velocity_m_s.array().map(real), v.true_geo());
    Some(MavMessage::SIM_STATE(SIM_STATE_DATA {
        q1,
        q2,
        q3,
        q4,
        roll: real(roll),
        pitch: real(pitch),
        yaw: real(yaw),
        xacc,
        yacc,
        zacc,
        xgyro,
        ygyro,
        zgyro,
        lat: real(geo.latitude_deg),
        lon: real(geo.longitude_deg),
        alt: real(geo.altitude_m),
        std_dev_horz: 0.0,
        std_dev_vert: 0.0,
        vn,
        ve,
        vd,
        lat_int: deg_e7(geo.latitude_deg),
        lon_int: deg_e7(geo.longitude_deg),
    }))
}

pub(crate) fn wind(v: &VehicleSnapshot) -> Option<DialectMessage> {
    let w = v.wind_m_s;
    let from = math::atan2(-w.east(), -w.north()).to_degrees();
    Some(WIND.message(&[from, w.horizontal_norm(), w.down()]))
}

pub(crate) fn power(_: &VehicleSnapshot) -> Option<MavMessage> {
    Some(MavMessage::POWER_STATUS(POWER_STATUS_DATA { Vcc: BOARD_VOLTAGE_MV, Vservo: 0, flags: MavPowerStatus::empty() }))
}
