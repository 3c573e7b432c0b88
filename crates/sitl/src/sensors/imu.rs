//! Accelerometer and gyroscope: the mean over each sampling interval, plus white noise and a slowly varying bias.

use super::readings::ImuReading;
use spandrel_model::frames::{Frd, Vec3};
use spandrel_model::random::RandomStream;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle;

/// Bias random walk per √s as a fraction of the initial bias (estimate: consumer inertial sensors drift by a few
/// percent of their bias per minute).
const BIAS_WALK_FRACTION: f64 = 0.005;

/// Number of samples between updates of the bias random walk.
const BIAS_WALK_SAMPLES: u32 = 40;

/// State of the inertial sensors.
#[derive(Debug, Clone, PartialEq)]
pub struct Imu {
    stream: RandomStream,
    accel_sigma: f64,
    gyro_sigma: f64,
    accel_walk: f64,
    gyro_walk: f64,
    accel_bias: Vec3<Frd>,
    gyro_bias: Vec3<Frd>,
    samples_until_walk: u32,
    force_sum: Vec3<Frd>,
    rate_sum: Vec3<Frd>,
    time_s: f64,
}

impl Imu {
    /// Creates the sensors with random initial biases.
    #[must_use]
    pub fn new(sensors: &vehicle::SensorSpec, seed: u64) -> Self {
        let mut stream = RandomStream::new(seed, "imu");
        let period_s = 1.0 / sensors.imu_rate_hz;
        let walk = BIAS_WALK_FRACTION * (period_s * f64::from(BIAS_WALK_SAMPLES)).sqrt();
        let (accel, gyro) = two_normal_vectors(&mut stream);
        Self {
            accel_sigma: sensors.accel_noise_density / period_s.sqrt(),
            gyro_sigma: sensors.gyro_noise_density / period_s.sqrt(),
            accel_walk: sensors.accel_bias_m_s2 * walk,
            gyro_walk: sensors.gyro_bias_rad_s * walk,
            accel_bias: accel * sensors.accel_bias_m_s2,
            gyro_bias: gyro * sensors.gyro_bias_rad_s,
            samples_until_walk: BIAS_WALK_SAMPLES,
            stream,
            force_sum: Vec3::zero(),
            rate_sum: Vec3::zero(),
            time_s: 0.0,
        }
    }

    /// Integrates one physics step, so that the next sample includes impacts that occur between samples.
    pub fn integrate(&mut self, specific_force_m_s2: Vec3<Frd>, rates_rad_s: Vec3<Frd>, dt: SimTime) {
        let dt_s = dt.s();
        self.force_sum += specific_force_m_s2 * dt_s;
        self.rate_sum += rates_rad_s * dt_s;
        self.time_s += dt_s;
    }

    /// Returns the reading at the end of a sampling interval, or `None` if nothing was integrated since the last
    /// reading.
    pub fn read(&mut self) -> Option<ImuReading> {
        if self.time_s <= 0.0 {
            return None;
        }
        if self.samples_until_walk == 0 {
            self.samples_until_walk = BIAS_WALK_SAMPLES;
            let (accel, gyro) = two_normal_vectors(&mut self.stream);
            self.accel_bias += accel * self.accel_walk;
            self.gyro_bias += gyro * self.gyro_walk;
        }
        self.samples_until_walk -= 1;
        let (accel, gyro) = two_normal_vectors(&mut self.stream);
        let force = self.force_sum / self.time_s + self.accel_bias + accel * self.accel_sigma;
        let rates = self.rate_sum / self.time_s + self.gyro_bias + gyro * self.gyro_sigma;
        self.force_sum = Vec3::zero();
        self.rate_sum = Vec3::zero();
        self.time_s = 0.0;
        Some(ImuReading { specific_force_m_s2: force, rates_rad_s: rates })
    }

    /// Returns the true biases of accelerometer (m/s²) and gyroscope (rad/s), for estimator tests.
    #[must_use]
    pub fn biases(&self) -> (Vec3<Frd>, Vec3<Frd>) {
        (self.accel_bias, self.gyro_bias)
    }
}

/// Returns six independent standard normal values as two vectors.
fn two_normal_vectors(stream: &mut RandomStream) -> (Vec3<Frd>, Vec3<Frd>) {
    let ((a, b), (c, d), (e, f)) = (stream.normal_pair(), stream.normal_pair(), stream.normal_pair());
    (Vec3::new(a, b, c), Vec3::new(d, e, f))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_impact_between_samples_is_measured_completely() {
        let sensors = vehicle::SensorSpec { imu_rate_hz: 400.0, ..crate::sensors::tests::error_free_sensors() };
        let mut imu = Imu::new(&sensors, 1);
        let step = SimTime::from_us(500);
        for i in 0..5 {
            let push = if i == 2 { 2000.0 } else { 0.0 };
            imu.integrate(Vec3::new(push, 0.0, -9.806_65), Vec3::zero(), step);
        }
        let gained = imu.read().map(|r| r.specific_force_m_s2.forward() * 0.0025);
        // 2000 m/s² over 0.5 ms is 1 m/s; the tolerance covers rounding only.
        assert!(gained.is_some_and(|v| (v - 1.0).abs() < 1e-12), "{gained:?}");
    }
}
