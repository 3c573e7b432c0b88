//! Barometer: height above the origin with white noise and a slow random-walk offset, and the corresponding pressure.

use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::time::{Schedule, SimTime};
use spandrel_model::vehicle;

/// Offset at power-on, after zeroing at the known height of the origin, m (estimate).
pub const START_OFFSET_M: f64 = 0.1;

/// State of the barometer.
#[derive(Debug, Clone, PartialEq)]
pub struct Barometer {
    stream: RandomStream,
    due: Schedule,
    noise_m: f64,
    walk_m: f64,
    offset_m: f64,
    origin_altitude_m: f64,
}

impl Barometer {
    /// Creates the sensor. `origin_altitude_m` is the altitude of the local origin above mean sea level.
    #[must_use]
    pub fn new(sensors: &vehicle::SensorSpec, origin_altitude_m: f64, seed: u64) -> Self {
        let mut stream = RandomStream::new(seed, "baro");
        Self {
            due: Schedule::new(SimTime::ZERO, sensors.baro_rate_hz),
            noise_m: sensors.baro_noise_m,
            walk_m: sensors.baro_drift_m_sqrt_s / sensors.baro_rate_hz.sqrt(),
            offset_m: START_OFFSET_M * stream.normal(),
            origin_altitude_m,
            stream,
        }
    }

    /// Returns the height above the origin (m) and the static pressure (Pa) if a sample is due.
    pub fn read(&mut self, up_m: f64, now: SimTime) -> Option<(f64, f64)> {
        if !self.due.fire(now) {
            return None;
        }
        self.offset_m += self.walk_m * self.stream.normal();
        let measured = up_m + self.offset_m + self.noise_m * self.stream.normal();
        Some((measured, pressure_pa(self.origin_altitude_m + measured)))
    }

    /// Returns the current offset in meters, for estimator tests.
    #[must_use]
    pub fn offset_m(&self) -> f64 {
        self.offset_m
    }
}

/// Returns the static pressure, in Pa, at an altitude in the standard troposphere (ISO 2533).
#[must_use]
pub fn pressure_pa(altitude_m: f64) -> f64 {
    101_325.0 * math::pow((1.0 - 2.255_77e-5 * altitude_m).max(0.01), 5.255_88)
}

#[cfg(test)]
mod tests {
    #[test]
    fn val_pressure_at_1000_m_matches_standard_atmosphere() {
        // ISO 2533 lists 89,874.6 Pa at 1,000 m; tolerance 5 Pa.
        assert!((super::pressure_pa(1000.0) - 89_874.6).abs() < 5.0);
    }
}
