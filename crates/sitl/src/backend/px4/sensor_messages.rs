//! HIL_SENSOR and HIL_STATE_QUATERNION: inertial sensors, magnetometer and barometer, and the true motion for PX4's log.

use crate::backend::interface::StepInput;
use crate::sensors::ImuReading;
use spandrel_mavlink::contract::truth::PublishedTruth;
use spandrel_mavlink::dialect::{HIL_SENSOR_DATA, HilSensorUpdatedFlags, MavMessage};
use spandrel_model::frames::Vec3;

/// Largest specific force that fits in PX4's 16-bit FIFO (16 g, scaled by g/2048), m/s².
pub(super) const MAX_FORCE_M_S2: f64 = 156.9;
/// Largest angular rate that fits in PX4's 16-bit FIFO (2,000 deg/s), rad/s.
pub(super) const MAX_RATE_RAD_S: f64 = 34.9;
/// Temperature of the standard atmosphere, which is also the one in this simulator's telemetry, °C.
const TEMPERATURE_DEG_C: f32 = 15.0;

/// PX4 accepts a group only if all its bits are set.
const ACCELEROMETER: HilSensorUpdatedFlags = HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_XACC
    .union(HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_YACC)
    .union(HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_ZACC);
const GYROSCOPE: HilSensorUpdatedFlags = HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_XGYRO
    .union(HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_YGYRO)
    .union(HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_ZGYRO);
const MAGNETOMETER: HilSensorUpdatedFlags = HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_XMAG
    .union(HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_YMAG)
    .union(HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_ZMAG);
const BAROMETER: HilSensorUpdatedFlags = HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_ABS_PRESSURE
    .union(HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_PRESSURE_ALT)
    .union(HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_TEMPERATURE);

/// Clips to the range of PX4's sensor. A value that is not a number makes the sensor absent.
fn clipped(values: [f64; 3], limit: f64) -> Option<[f32; 3]> {
    values.iter().all(|value| !value.is_nan()).then(|| values.map(|value| value.clamp(-limit, limit) as f32))
}

/// Builds the message of one inertial sensor.
pub(super) fn inertial(imu: &ImuReading, id: u8, time_us: u64) -> HIL_SENSOR_DATA {
    let mut out =
        HIL_SENSOR_DATA { time_usec: time_us, fields_updated: HilSensorUpdatedFlags::empty(), id, ..HIL_SENSOR_DATA::default() };
    if let Some([x, y, z]) = clipped(imu.specific_force_m_s2.array(), MAX_FORCE_M_S2) {
        (out.xacc, out.yacc, out.zacc) = (x, y, z);
        out.fields_updated |= ACCELEROMETER;
    }
    if let Some([x, y, z]) = clipped(imu.rates_rad_s.array(), MAX_RATE_RAD_S) {
        (out.xgyro, out.ygyro, out.zgyro) = (x, y, z);
        out.fields_updated |= GYROSCOPE;
    }
    out
}

/// Builds the message that advances PX4's clock: the first inertial sensor, and the magnetometer and barometer if they have a
/// new reading.
pub(super) fn primary(step: &StepInput<'_>, time_us: u64) -> MavMessage {
    let mut out = inertial(&step.imus[0], 0, time_us);
    if let Some(field) = step.fresh.mag_gauss.filter(|field| field.is_finite()) {
        [out.xmag, out.ymag, out.zmag] = field.array().map(|gauss| gauss as f32);
        out.fields_updated |= MAGNETOMETER;
    }
    if let Some(pascal) = step.fresh.pressure_pa.filter(|pascal| pascal.is_finite()) {
        out.abs_pressure = (pascal / 100.0) as f32;
        out.temperature = TEMPERATURE_DEG_C;
        out.fields_updated |= BAROMETER;
    }
    MavMessage::HIL_SENSOR(out)
}

/// Builds the message with the true motion. PX4 only logs it.
pub(super) fn truth(step: &StepInput<'_>, time_us: u64) -> MavMessage {
    let rigid = step.truth;
    let published = PublishedTruth {
        time_us,
        place: step.plane.geo_from_enu(rigid.position_m.enu()),
        velocity_m_s: rigid.velocity_m_s,
        ned_from_frd: rigid.attitude,
        rates_rad_s: rigid.rates_rad_s,
        specific_force_m_s2: step.imus[0].specific_force_m_s2,
        airspeed_m_s: Vec3::norm(rigid.velocity_m_s - step.wind_m_s),
    };
    MavMessage::HIL_STATE_QUATERNION(published.message())
}
