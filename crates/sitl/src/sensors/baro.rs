//! Barometer: height above the origin with white noise, a slow random-walk offset and the suction of the airflow, and the
//! corresponding pressure.

use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::time::{Schedule, SimTime};
use spandrel_model::vehicle;

/// Offset at power-on, after zeroing at the known height of the origin, m (estimate).
const START_OFFSET_M: f64 = 0.1;

/// State of the barometer.
#[derive(Debug, Clone, PartialEq)]
pub struct Barometer {
    stream: RandomStream,
    due: Schedule,
    noise_m: f64,
    walk_m: f64,
    airflow: f64,
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
            airflow: sensors.baro_airflow,
            offset_m: START_OFFSET_M * stream.normal(),
            origin_altitude_m,
            stream,
        }
    }

    /// Returns the height above the origin (m) and the static pressure (Pa) if a sample is due. `air_velocity_m_s` is the velocity
    /// relative to the air.
    pub fn read(&mut self, up_m: f64, air_velocity_m_s: Vec3<Ned>, now: SimTime) -> Option<(f64, f64)> {
        if !self.due.fire(now) {
            return None;
        }
        self.offset_m += self.walk_m * self.stream.normal();
        let measured = up_m + self.offset_m + self.noise_m * self.stream.normal();
        // A pressure error of k ρ v² / 2 is a height error of k v² / 2 g.
        let measured = if self.airflow == 0.0 {
            measured
        } else {
            let airspeed_m_s = air_velocity_m_s.horizontal_norm();
            measured + self.airflow * airspeed_m_s * airspeed_m_s / (2.0 * math::GRAVITY_M_S2)
        };
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
    101_325.0 * math::pow(vehicle::standard_temperature_ratio(altitude_m), 5.255_88)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_airflow_raises_the_measured_height_by_the_velocity_head() {
        let sensors = vehicle::SensorSpec { baro_airflow: 0.3, ..crate::sensors::tests::error_free_sensors() };
        let height_m = |airspeed_m_s| {
            Barometer::new(&sensors, 430.0, 1).read(20.0, Vec3::new(0.0, airspeed_m_s, 0.0), SimTime::ZERO).unwrap().0
        };
        // 0.3 · (10 m/s)² / (2 · 9.80665 m/s²)
        assert!((height_m(10.0) - height_m(0.0) - 1.529_574).abs() < 1e-6);
    }

    #[test]
    fn val_pressure_at_1000_m_matches_standard_atmosphere() {
        // ISO 2533 lists 89,874.6 Pa at 1,000 m; tolerance 5 Pa.
        assert!((super::pressure_pa(1000.0) - 89_874.6).abs() < 5.0);
    }
}
