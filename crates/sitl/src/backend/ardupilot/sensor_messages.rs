//! MAVLink messages for the sensors that ArduPilot takes from MAVLink: GNSS receiver (GPS1_TYPE 14), range finders (RNGFNDn_TYPE
//! 10) and optical flow (FLOW_TYPE 5).

use crate::backend::interface::StepInput;
use crate::sensors::{FlowReading, GnssReading};
use spandrel_mavlink::dialect::{
    DISTANCE_SENSOR_DATA, GPS_INPUT_DATA, GpsFixType, GpsInputIgnoreFlags, MavDistanceSensor, MavMessage, MavSensorOrientation,
    OPTICAL_FLOW_DATA,
};
use spandrel_mavlink::units::{cm_u16, deg_e7};
use spandrel_model::frames::{Frd, Rotation, Vec3};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;

/// Start of GPS time, s since 1970-01-01 UTC (1980-01-06).
const GPS_EPOCH_UNIX_S: i64 = 315_964_800;
/// GPS time minus UTC, s (leap seconds since 2017).
const LEAP_SECONDS: i64 = 18;
const WEEK_MS: i64 = 7 * 24 * 3600 * 1000;
/// Largest dilution of precision that fits ArduPilot's hundredths.
const MAX_DOP: f64 = 99.9;
/// Largest accuracy that a receiver reports, m.
const MAX_ACCURACY_M: f64 = 999.0;
/// Minimum measurable distance, cm.
const MIN_RANGE_CM: u16 = 10;
/// ArduPilot multiplies the flow by its interval and by `1 + FLOW_FXSCALER/1000`. With this scaler, the factor is 0.01, which gives
/// the integer in the message a resolution of 0.5 mrad/s.
pub const FLOW_SCALER: i32 = -990;
const FLOW_FACTOR: f64 = 0.01;
/// Time after ArduPilot's start at which optical flow begins. With optical flow alone, ArduPilot would be ready to arm before its
/// estimator uses GNSS (about 45 s after the start), and would lose its position above the range of the flow sensor.
pub const FLOW_START: SimTime = SimTime::from_ms(50_000);
/// Interval of the flow sensor, s.
const FLOW_INTERVAL_S: f64 = 0.05;

/// Properties of the sensors that are not part of the readings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorInfo {
    gnss_horizontal_noise_m: f64,
    gnss_velocity_noise_m_s: f64,
    range_max_m: f64,
}

impl SensorInfo {
    /// Takes the properties from the aircraft.
    pub fn new(vehicle: &Vehicle) -> Self {
        let sensors = &vehicle.sensors;
        Self {
            gnss_horizontal_noise_m: sensors.gnss_horizontal_noise_m,
            gnss_velocity_noise_m_s: sensors.gnss_velocity_noise_m_s,
            range_max_m: sensors.range_max_m,
        }
    }
}

/// Returns a message for each reading that is new in this step, `elapsed` after ArduPilot started.
pub fn encode(step: &StepInput<'_>, info: &SensorInfo, elapsed: SimTime) -> Vec<MavMessage> {
    let fresh = step.fresh;
    let gnss = fresh.gnss.map(|reading| gps_input(step, &reading, info));
    let down = fresh.range_down_m.map(|range_m| distance(step, 0, range_m, info));
    let up = fresh.range_up_m.map(|range_m| distance(step, 1, range_m, info));
    let flow = fresh.flow.filter(|_| elapsed >= FLOW_START).and_then(|reading| optical_flow(step, &reading));
    [gnss, down, up, flow].into_iter().flatten().collect()
}

fn gps_input(step: &StepInput<'_>, reading: &GnssReading, info: &SensorInfo) -> MavMessage {
    let unix_ms = step.start_unix_s * 1000 + step.now.ms();
    let gps_ms = unix_ms + (LEAP_SECONDS - GPS_EPOCH_UNIX_S) * 1000;
    let place = step.plane.geo_from_enu(reading.position_m.enu());
    let [north, east, down] = reading.velocity_m_s.array();
    let degradation = (reading.eph_m / info.gnss_horizontal_noise_m.max(0.01)).max(1.0);
    MavMessage::GPS_INPUT(GPS_INPUT_DATA {
        time_usec: (unix_ms * 1000).unsigned_abs(),
        time_week: gps_ms.div_euclid(WEEK_MS) as u16,
        time_week_ms: gps_ms.rem_euclid(WEEK_MS) as u32,
        lat: deg_e7(place.latitude_deg),
        lon: deg_e7(place.longitude_deg),
        alt: place.altitude_m as f32,
        hdop: limited(reading.hdop, MAX_DOP),
        vdop: limited(reading.vdop, MAX_DOP),
        vn: north as f32,
        ve: east as f32,
        vd: down as f32,
        speed_accuracy: limited(info.gnss_velocity_noise_m_s * degradation, MAX_ACCURACY_M),
        horiz_accuracy: limited(reading.eph_m, MAX_ACCURACY_M),
        vert_accuracy: limited(reading.epv_m, MAX_ACCURACY_M),
        ignore_flags: GpsInputIgnoreFlags::empty(),
        gps_id: 0,
        fix_type: fix_type(reading.fix),
        satellites_visible: reading.satellites,
        // 0 means that the receiver does not measure the heading.
        yaw: 0,
    })
}

/// Returns MAVLink's fix type. Its 0 means that there is no receiver.
fn fix_type(fix: u8) -> GpsFixType {
    match fix {
        0 | 1 => GpsFixType::GPS_FIX_TYPE_NO_FIX,
        2 => GpsFixType::GPS_FIX_TYPE_2D_FIX,
        _ => GpsFixType::GPS_FIX_TYPE_3D_FIX,
    }
}

/// Limits a value; NaN becomes the limit.
fn limited(value: f64, limit: f64) -> f32 {
    value.min(limit) as f32
}

/// Builds the message of the downward (0) or upward (1) range finder. Reports slightly more than the maximum range if nothing is in
/// range.
fn distance(step: &StepInput<'_>, id: u8, range_m: f64, info: &SensorInfo) -> MavMessage {
    let reach = cm_u16(info.range_max_m);
    MavMessage::DISTANCE_SENSOR(DISTANCE_SENSOR_DATA {
        time_boot_ms: step.now.ms() as u32,
        min_distance: MIN_RANGE_CM,
        max_distance: reach,
        current_distance: if range_m.is_finite() { cm_u16(range_m) } else { reach + 1 },
        mavtype: MavDistanceSensor::MAV_DISTANCE_SENSOR_LASER,
        id,
        orientation: if id == 0 {
            MavSensorOrientation::MAV_SENSOR_ROTATION_PITCH_270
        } else {
            MavSensorOrientation::MAV_SENSOR_ROTATION_PITCH_90
        },
        covariance: u8::MAX,
        ..Default::default()
    })
}

/// Builds the message of a downward camera, if the ground is in range: ArduPilot computes the velocity from the angular rate of the
/// image and its height above the ground.
fn optical_flow(step: &StepInput<'_>, reading: &FlowReading) -> Option<MavMessage> {
    let range_m = step.latest.range_down_m.filter(|range_m| range_m.is_finite() && *range_m > 0.1)?;
    let [flow_x, flow_y] = flow_rates(step, reading, range_m).map(|rate| (rate / FLOW_FACTOR / FLOW_INTERVAL_S).round() as i16);
    Some(MavMessage::OPTICAL_FLOW(OPTICAL_FLOW_DATA {
        time_usec: step.now.us().unsigned_abs(),
        flow_x,
        flow_y,
        quality: (reading.quality * 255.0).round() as u8,
        ground_distance: range_m as f32,
        ..Default::default()
    }))
}

/// Returns the angular rates of the image about the forward and right axes, rad/s. A rotation of the camera about an axis gives the
/// same rate; moving right adds a negative rate about the forward axis, moving forward a positive one about the right axis.
fn flow_rates(step: &StepInput<'_>, reading: &FlowReading, range_m: f64) -> [f64; 2] {
    let (roll, pitch, _) = step.truth.attitude.euler();
    let tilt = Rotation::from_euler(roll, pitch, 0.0);
    let level = Vec3::new(reading.forward_m_s, reading.right_m_s, step.truth.velocity_m_s.down());
    let velocity: Vec3<Frd> = tilt.inverse() * level;
    let rates = step.imus[0].rates_rad_s;
    [rates.forward() - velocity.right() / range_m, rates.right() + velocity.forward() / range_m]
}
