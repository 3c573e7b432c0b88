//! Optical flow: horizontal velocity relative to any lit surface within range of the range finders, in any direction
//! (the cameras cover all sides, as on current inspection aircraft). It returns no measurement over distant water or in
//! the dark.

use super::readings::FlowReading;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::time::{Schedule, SimTime};
use spandrel_model::vehicle;

/// Minimum light for feature tracking, lx (manufacturers of vision positioning systems specify more than 15 lx).
pub const MIN_ILLUMINANCE_LUX: f64 = 15.0;
/// Scale error, constant over a session, as a fraction of velocity (estimate).
const SCALE_ERROR: f64 = 0.01;
/// Sample rate, Hz (estimate: typical for on-board flow sensors).
pub(crate) const SAMPLE_RATE_HZ: f64 = 20.0;

/// State of the flow sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct OpticalFlow {
    stream: RandomStream,
    due: Schedule,
    noise_m_s: f64,
    reach_m: f64,
    scale: f64,
}

impl OpticalFlow {
    /// Creates the sensor. If the aircraft has no flow sensor, it never returns a sample.
    #[must_use]
    pub fn new(sensors: &vehicle::SensorSpec, seed: u64) -> Self {
        let mut stream = RandomStream::new(seed, "flow");
        let fitted = sensors.flow_velocity_m_s > 0.0;
        Self {
            due: Schedule::new(SimTime::ZERO, if fitted { SAMPLE_RATE_HZ } else { 0.0 }),
            noise_m_s: sensors.flow_velocity_m_s,
            reach_m: sensors.range_max_m,
            scale: 1.0 + SCALE_ERROR * stream.normal(),
            stream,
        }
    }

    /// Returns true if a sample is due. Call once per tick.
    pub fn due(&mut self, now: SimTime) -> bool {
        self.due.fire(now)
    }

    /// Returns the reading for a surface at the distance `nearest_m` with the illuminance `lux`, or `None` if tracking
    /// is impossible. `velocity_m_s` is relative to the surface.
    pub fn read(&mut self, velocity_m_s: Vec3<Ned>, yaw_rad: f64, nearest_m: f64, lux: f64) -> Option<FlowReading> {
        let (a, b) = (self.stream.normal(), self.stream.normal());
        if lux < MIN_ILLUMINANCE_LUX || nearest_m >= self.reach_m {
            return None;
        }
        let (s, c) = math::sin_cos(yaw_rad);
        let v = velocity_m_s;
        Some(FlowReading {
            forward_m_s: (c * v.north() + s * v.east()) * self.scale + a * self.noise_m_s,
            right_m_s: (c * v.east() - s * v.north()) * self.scale + b * self.noise_m_s,
            quality: (lux / (4.0 * MIN_ILLUMINANCE_LUX)).min(1.0) * (1.0 - 0.5 * nearest_m / self.reach_m),
        })
    }
}
