//! Share of a serial link that hardware in the loop uses: the rate of the inertial readings, and the sensors that fit beside them.

use crate::sensors::flow::SAMPLE_RATE_HZ as FLOW_RATE_HZ;
use spandrel_model::vehicle::SensorSpec;

/// Highest rate of HIL_SENSOR, Hz: PX4's own simulators send at this rate.
pub const MAX_RATE_HZ: f64 = 250.0;
/// Lowest rate of HIL_SENSOR with which PX4 can fly, Hz: the lowest value of its parameter IMU_INTEG_RATE.
pub const MIN_RATE_HZ: f64 = 100.0;
/// Share of the link that the readings may use. The rest is for ordinary MAVLink messages to the flight controller.
pub const LINK_SHARE: f64 = 0.5;
/// Largest frames of each message, bytes: payload and 12 bytes of MAVLink 2 framing.
pub(super) const SENSOR_FRAME_BYTES: f64 = 77.0;
pub(super) const GPS_FRAME_BYTES: f64 = 51.0;
pub(super) const RANGE_FRAME_BYTES: f64 = 51.0;
pub(super) const FLOW_FRAME_BYTES: f64 = 56.0;
/// Range finders of an aircraft: down, up and eight horizontal ones.
const RANGE_FINDER_COUNT: f64 = 10.0;
/// Milliseconds per second. The control period is a whole number of milliseconds, the step of the physics.
const MS_PER_S: f64 = 1000.0;

/// Sensors that are sent in addition to the inertial sensor, magnetometer, barometer and GNSS receiver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ExtraSensors {
    /// None.
    None,
    /// The range finder below the aircraft and the flow sensor.
    Below,
    /// All range finders and the flow sensor.
    All,
}

/// Readings that fit into the link's share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HilPlan {
    /// Rate of HIL_SENSOR, Hz. Its period is a whole number of milliseconds.
    pub rate_hz: f64,
    /// Additional sensors.
    pub extra: ExtraSensors,
}

impl HilPlan {
    /// Plans the readings for a link of `capacity_bytes_s` bytes/s. `None` if the link is too slow to fly with.
    ///
    /// The rate is (share × capacity - bytes/s of all other sensors) / bytes of a HIL_SENSOR frame, at most [`MAX_RATE_HZ`]. Extra
    /// sensors are sent only if they do not reduce it.
    #[must_use]
    pub fn new(capacity_bytes_s: f64, sensors: &SensorSpec) -> Option<Self> {
        let richest =
            [ExtraSensors::All, ExtraSensors::Below].into_iter().map(|extra| Self::with(extra, capacity_bytes_s, sensors));
        let full_rate = richest.flatten().find(|plan| plan.rate_hz >= MAX_RATE_HZ);
        full_rate.or_else(|| Self::with(ExtraSensors::None, capacity_bytes_s, sensors))
    }

    /// Plans the readings with given extra sensors. `None` if the rate would be below [`MIN_RATE_HZ`].
    fn with(extra: ExtraSensors, capacity_bytes_s: f64, sensors: &SensorSpec) -> Option<Self> {
        let left_bytes_s = LINK_SHARE * capacity_bytes_s - other_bytes_s(extra, sensors);
        let period_ms = (MS_PER_S * SENSOR_FRAME_BYTES / left_bytes_s.max(1.0)).max(MS_PER_S / MAX_RATE_HZ).ceil();
        let rate_hz = MS_PER_S / period_ms;
        (rate_hz >= MIN_RATE_HZ).then_some(Self { rate_hz, extra })
    }

    /// Returns the largest number of bytes/s that these readings need.
    #[must_use]
    pub fn bytes_s(&self, sensors: &SensorSpec) -> f64 {
        self.rate_hz * SENSOR_FRAME_BYTES + other_bytes_s(self.extra, sensors)
    }

    /// Returns the lowest capacity that suffices for these sensors, bytes/s.
    #[must_use]
    pub fn min_capacity_bytes_s(sensors: &SensorSpec) -> f64 {
        Self { rate_hz: MIN_RATE_HZ, extra: ExtraSensors::None }.bytes_s(sensors) / LINK_SHARE
    }
}

/// Returns the bytes/s of all messages except HIL_SENSOR.
fn other_bytes_s(extra: ExtraSensors, sensors: &SensorSpec) -> f64 {
    let has_flow = sensors.flow_velocity_m_s > 0.0;
    let flow = if has_flow { FLOW_RATE_HZ * FLOW_FRAME_BYTES } else { 0.0 };
    let one_range = sensors.range_rate_hz * RANGE_FRAME_BYTES;
    let gps = sensors.gnss_rate_hz * GPS_FRAME_BYTES;
    match extra {
        ExtraSensors::None => gps,
        ExtraSensors::Below => gps + one_range + flow,
        ExtraSensors::All => gps + RANGE_FINDER_COUNT * one_range + flow,
    }
}
