//! DISTANCE_SENSOR: range finders below, above and around the aircraft.

use crate::sensors::Readings;
use spandrel_mavlink::dialect::{DISTANCE_SENSOR_DATA, MavDistanceSensor, MavMessage, MavSensorOrientation};
use spandrel_mavlink::units::cm_u16;
use spandrel_model::math;
use spandrel_model::vehicle::SensorSpec;

/// Sector of one horizontal range finder, rad.
const SECTOR_RAD: f64 = math::PI / 4.0;
/// ID of the first horizontal range finder; 0 is down, 1 is up.
const FIRST_HORIZONTAL_ID: u8 = 2;
/// Minimum range, cm. The aircraft's feet are closer to the ground than the minimum of most range finders.
const MIN_RANGE_CM: u16 = 1;

/// Properties that all range finders share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RangeFinders {
    reach_cm: u16,
    variance_cm2: u8,
}

impl RangeFinders {
    /// Takes the properties from the aircraft's sensors.
    pub(super) fn new(sensors: &SensorSpec) -> Self {
        let noise_cm = sensors.range_noise_m * 100.0;
        Self { reach_cm: cm_u16(sensors.range_max_m), variance_cm2: (noise_cm * noise_cm).round().min(f64::from(u8::MAX)) as u8 }
    }

    /// Builds the messages for all fresh ranges, the downward one first: PX4 uses the first that looks down.
    pub(super) fn messages(&self, fresh: &Readings, time_ms: u32) -> Vec<MavMessage> {
        let down =
            fresh.range_down_m.map(|range_m| self.reading(range_m, 0, MavSensorOrientation::MAV_SENSOR_ROTATION_PITCH_270));
        let up = fresh.range_up_m.map(|range_m| self.reading(range_m, 1, MavSensorOrientation::MAV_SENSOR_ROTATION_PITCH_90));
        let around = fresh.range_around_m.iter().flatten().enumerate();
        let around = around.map(|(sector, range_m)| self.horizontal(*range_m, sector));
        let all = down.into_iter().chain(up).chain(around);
        all.map(|data| MavMessage::DISTANCE_SENSOR(DISTANCE_SENSOR_DATA { time_boot_ms: time_ms, ..data })).collect()
    }

    /// Nothing in range is reported as slightly more than the maximum range: PX4's estimator ignores it, and its collision
    /// prevention treats the sector as free. A signal quality of 0 means "unknown".
    fn reading(&self, range_m: f64, id: u8, orientation: MavSensorOrientation) -> DISTANCE_SENSOR_DATA {
        let beyond_cm = self.reach_cm.saturating_add(1);
        DISTANCE_SENSOR_DATA {
            min_distance: MIN_RANGE_CM,
            max_distance: self.reach_cm,
            current_distance: if range_m.is_finite() { cm_u16(range_m).min(beyond_cm) } else { beyond_cm },
            mavtype: MavDistanceSensor::MAV_DISTANCE_SENSOR_LASER,
            id,
            orientation,
            covariance: self.variance_cm2,
            ..DISTANCE_SENSOR_DATA::default()
        }
    }

    /// PX4 knows four horizontal orientations by name; the diagonal ones need a quaternion.
    fn horizontal(&self, range_m: f64, sector: usize) -> DISTANCE_SENSOR_DATA {
        let orientation = match sector {
            0 => MavSensorOrientation::MAV_SENSOR_ROTATION_NONE,
            2 => MavSensorOrientation::MAV_SENSOR_ROTATION_YAW_90,
            4 => MavSensorOrientation::MAV_SENSOR_ROTATION_PITCH_180,
            6 => MavSensorOrientation::MAV_SENSOR_ROTATION_YAW_270,
            _ => MavSensorOrientation::MAV_SENSOR_ROTATION_CUSTOM,
        };
        let (sine, cosine) = math::sin_cos(0.5 * SECTOR_RAD * sector as f64);
        DISTANCE_SENSOR_DATA {
            horizontal_fov: SECTOR_RAD as f32,
            quaternion: [cosine as f32, 0.0, 0.0, sine as f32],
            ..self.reading(range_m, FIRST_HORIZONTAL_ID + sector as u8, orientation)
        }
    }
}
