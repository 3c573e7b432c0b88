//! Builders for messages with sensor measurements.

use super::super::snapshot::VehicleSnapshot;
use spandrel_mavlink::dialect::{
    DISTANCE_SENSOR_DATA, GPS_RAW_INT_DATA, GpsFixType, HIGHRES_IMU_DATA, HighresImuUpdatedFlags, MavDistanceSensor, MavFrame,
    MavMessage, MavSensorOrientation, OBSTACLE_DISTANCE_DATA, RAW_IMU_DATA, SCALED_IMU_DATA, SCALED_PRESSURE_DATA,
};
use spandrel_mavlink::units::{cm_u16, deg_e7, heading_cdeg, milli_g, mm};

pub(crate) fn gps_raw(v: &VehicleSnapshot) -> Option<MavMessage> {
    let gnss = v.readings.gnss.as_ref()?;
    let geo = v.plane.geo_from_enu(gnss.position_m.enu());
    let velocity = gnss.velocity_m_s;
    let course = spandrel_model::math::atan2(velocity.east(), velocity.north());
    let fix = gnss.fix >= 3;
    Some(MavMessage::GPS_RAW_INT(GPS_RAW_INT_DATA {
        time_usec: v.clock.boot_time_us(),
        lat: if fix { deg_e7(geo.latitude_deg) } else { 0 },
        lon: if fix { deg_e7(geo.longitude_deg) } else { 0 },
        alt: if fix { mm(geo.altitude_m) } else { 0 },
        eph: (gnss.hdop * 100.0).round() as u16,
        epv: (gnss.vdop * 100.0).round() as u16,
        vel: cm_u16(velocity.horizontal_norm()),
        cog: heading_cdeg(course),
        fix_type: if fix { GpsFixType::GPS_FIX_TYPE_3D_FIX } else { GpsFixType::GPS_FIX_TYPE_NO_FIX },
        satellites_visible: gnss.satellites,
        h_acc: mm(gnss.eph_m).unsigned_abs(),
        v_acc: mm(gnss.epv_m).unsigned_abs(),
        // The simulator treats mean sea level as the ellipsoid (base::geodesy).
        alt_ellipsoid: if fix { mm(geo.altitude_m) } else { 0 },
        ..Default::default()
    }))
}

pub(crate) fn pressure(v: &VehicleSnapshot) -> Option<MavMessage> {
    Some(MavMessage::SCALED_PRESSURE(SCALED_PRESSURE_DATA {
        time_boot_ms: v.clock.boot_time_ms(),
        press_abs: (v.readings.pressure_pa? / 100.0) as f32,
        temperature: 1500,
        ..Default::default()
    }))
}

pub(crate) fn highres_imu(v: &VehicleSnapshot) -> Option<MavMessage> {
    let imu = v.readings.imu.as_ref()?;
    let [xacc, yacc, zacc] = imu.specific_force_m_s2.array().map(|c| c as f32);
    let [xgyro, ygyro, zgyro] = imu.rates_rad_s.array().map(|c| c as f32);
    let [xmag, ymag, zmag] = v.readings.mag_gauss.map_or([0.0; 3], |m| m.array().map(|c| c as f32));
    Some(MavMessage::HIGHRES_IMU(HIGHRES_IMU_DATA {
        time_usec: v.clock.boot_time_us(),
        xacc,
        yacc,
        zacc,
        xgyro,
        ygyro,
        zgyro,
        xmag,
        ymag,
        zmag,
        abs_pressure: v.readings.pressure_pa.map_or(0.0, |p| (p / 100.0) as f32),
        temperature: 15.0,
        fields_updated: HighresImuUpdatedFlags::all(),
        ..Default::default()
    }))
}

/// Returns the specific force in milli-g, the angular rates in mrad/s, and the magnetic field in mgauss. RAW_IMU does
/// not define units; these are ArduPilot's.
fn milli(v: &VehicleSnapshot) -> Option<[[i16; 3]; 3]> {
    let imu = v.readings.imu.as_ref()?;
    let milli = |value: f64| (1000.0 * value).round() as i16;
    let field = v.readings.mag_gauss.map_or([0; 3], |gauss| gauss.array().map(milli));
    Some([imu.specific_force_m_s2.array().map(milli_g), imu.rates_rad_s.array().map(milli), field])
}

pub(crate) fn scaled_imu(v: &VehicleSnapshot) -> Option<MavMessage> {
    let [[xacc, yacc, zacc], [xgyro, ygyro, zgyro], [xmag, ymag, zmag]] = milli(v)?;
    Some(MavMessage::SCALED_IMU(SCALED_IMU_DATA {
        time_boot_ms: v.clock.boot_time_ms(),
        xacc,
        yacc,
        zacc,
        xgyro,
        ygyro,
        zgyro,
        xmag,
        ymag,
        zmag,
        ..Default::default()
    }))
}

pub(crate) fn raw_imu(v: &VehicleSnapshot) -> Option<MavMessage> {
    let [[xacc, yacc, zacc], [xgyro, ygyro, zgyro], [xmag, ymag, zmag]] = milli(v)?;
    Some(MavMessage::RAW_IMU(RAW_IMU_DATA {
        time_usec: v.clock.boot_time_us(),
        xacc,
        yacc,
        zacc,
        xgyro,
        ygyro,
        zgyro,
        xmag,
        ymag,
        zmag,
        ..Default::default()
    }))
}

/// Sector width of OBSTACLE_DISTANCE, deg: 72 sectors, because QGroundControl's overlay reads all elements of the
/// array.
const SECTOR_WIDTH_DEG: u8 = 5;

/// Returns the index of the range finder closest to a sector, clockwise from the nose.
fn nearest_range_finder(sector: usize, finders: usize) -> usize {
    let between_deg = 360 / finders.max(1);
    (sector * usize::from(SECTOR_WIDTH_DEG) + between_deg / 2) / between_deg % finders.max(1)
}

/// Sectors clockwise from the nose, each with the reading of the closest horizontal range finder.
pub(crate) fn obstacles(v: &VehicleSnapshot) -> Option<MavMessage> {
    let around = v.readings.range_around_m?;
    let reach = cm_u16(v.vehicle.sensors.range_max_m);
    let mut distances = [u16::MAX; 72];
    for (sector, slot) in distances.iter_mut().enumerate() {
        let range = around[nearest_range_finder(sector, around.len())];
        *slot = if range.is_finite() { cm_u16(range).min(reach) } else { reach + 1 };
    }
    Some(MavMessage::OBSTACLE_DISTANCE(OBSTACLE_DISTANCE_DATA {
        time_usec: v.clock.boot_time_us(),
        distances,
        min_distance: 10,
        max_distance: reach,
        sensor_type: MavDistanceSensor::MAV_DISTANCE_SENSOR_LASER,
        increment: SECTOR_WIDTH_DEG,
        increment_f: f32::from(SECTOR_WIDTH_DEG),
        angle_offset: 0.0,
        frame: MavFrame::MAV_FRAME_BODY_FRD,
    }))
}

pub(crate) fn range_down(v: &VehicleSnapshot) -> Option<MavMessage> {
    Some(range(v, 0, v.readings.range_down_m?, MavSensorOrientation::MAV_SENSOR_ROTATION_PITCH_270))
}

/// Builds the message with the distance to the soffit.
pub(crate) fn range_up(v: &VehicleSnapshot) -> Option<MavMessage> {
    Some(range(v, 1, v.readings.range_up_m?, MavSensorOrientation::MAV_SENSOR_ROTATION_PITCH_90))
}

/// Orientations of the horizontal range finders, clockwise from the nose. MAVLink's documentation swaps left and right;
/// PX4, ArduPilot and QGroundControl all interpret 90 degrees as right.
const HORIZONTAL_ORIENTATIONS: [MavSensorOrientation; 8] = [
    MavSensorOrientation::MAV_SENSOR_ROTATION_NONE,
    MavSensorOrientation::MAV_SENSOR_ROTATION_YAW_45,
    MavSensorOrientation::MAV_SENSOR_ROTATION_YAW_90,
    MavSensorOrientation::MAV_SENSOR_ROTATION_YAW_135,
    MavSensorOrientation::MAV_SENSOR_ROTATION_YAW_180,
    MavSensorOrientation::MAV_SENSOR_ROTATION_YAW_225,
    MavSensorOrientation::MAV_SENSOR_ROTATION_YAW_270,
    MavSensorOrientation::MAV_SENSOR_ROTATION_YAW_315,
];
/// ID of the first horizontal range finder; 0 is down, 1 is up.
const FIRST_HORIZONTAL_FINDER_ID: u8 = 2;

/// Builds the message for the horizontal range finder at the nose.
pub(crate) fn range_ahead(v: &VehicleSnapshot) -> Option<MavMessage> {
    range_beside(v, 0)
}

/// Builds the message for one of the eight horizontal range finders.
pub(crate) fn range_beside(v: &VehicleSnapshot, k: usize) -> Option<MavMessage> {
    Some(range(v, FIRST_HORIZONTAL_FINDER_ID + k as u8, *v.readings.range_around_m?.get(k)?, *HORIZONTAL_ORIENTATIONS.get(k)?))
}

/// Reports slightly more than the maximum range if nothing is within range.
fn range(v: &VehicleSnapshot, id: u8, distance_m: f64, orientation: MavSensorOrientation) -> MavMessage {
    let reach = cm_u16(v.vehicle.sensors.range_max_m);
    MavMessage::DISTANCE_SENSOR(DISTANCE_SENSOR_DATA {
        time_boot_ms: v.clock.boot_time_ms(),
        min_distance: 10,
        max_distance: reach,
        current_distance: if distance_m.is_finite() { cm_u16(distance_m) } else { reach + 1 },
        mavtype: MavDistanceSensor::MAV_DISTANCE_SENSOR_LASER,
        id,
        orientation,
        covariance: variance_cm2(v.vehicle.sensors.range_noise_m),
        ..Default::default()
    })
}

/// Returns the variance for a standard deviation in cm², limited to 255, which means "unknown".
fn variance_cm2(noise_m: f64) -> u8 {
    (noise_m * 100.0 * noise_m * 100.0).round().min(f64::from(u8::MAX)) as u8
}
