//! Alignment at rest: roll and pitch from gravity, heading from the magnetic field, gyroscope bias from the mean rate.

use crate::sensors::ImuReading;
use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};
use spandrel_model::math;

/// Averaging time for the alignment, s.
pub const ALIGNMENT_TIME_S: f64 = 0.5;
/// Maximum angular rate at rest, rad/s.
const MAX_REST_RATE_RAD_S: f64 = 0.15;
/// Maximum deviation of the specific force from 1 g at rest, m/s².
const REST_FORCE_TOLERANCE_M_S2: f64 = 1.5;
/// Mean rates beyond this many standard deviations of the gyroscope bias count as motion.
const MAX_BIAS_SIGMAS: f64 = 5.0;
/// Residual rocking of a vehicle at rest, as a fraction of the gyroscope bias (1 sigma, estimate). It limits how
/// accurately the mean rate determines the bias; the filter estimates the rest of the bias in flight.
pub const ROCKING_BIAS_FRACTION: f64 = 0.1;

/// Gyroscope characteristics from the data sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GyroSpec {
    /// Bias after calibration, rad/s (1 sigma).
    pub bias_rad_s: f64,
    /// White noise of one sample, rad/s (1 sigma).
    pub white_noise_rad_s: f64,
}

impl GyroSpec {
    /// Returns true if a mean rate at rest is plausible as the bias of this gyroscope.
    fn is_plausible_bias(&self, mean_rad_s: Vec3<Frd>, samples: f64) -> bool {
        let sigma = math::hypot(self.bias_rad_s, self.white_noise_rad_s / samples.sqrt());
        mean_rad_s.array().iter().all(|rate| rate.abs() <= MAX_BIAS_SIGMAS * sigma)
    }
}

/// Sums of the samples collected for alignment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alignment {
    gyro: GyroSpec,
    force: Vec3<Frd>,
    rates: Vec3<Frd>,
    mag: Vec3<Frd>,
    samples: u32,
    mag_samples: u32,
    time_s: f64,
}

/// Result of the alignment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlignmentResult {
    /// Attitude.
    pub attitude: Rotation<Frd, Ned>,
    /// Gyroscope bias, rad/s.
    pub gyro_bias_rad_s: Vec3<Frd>,
    /// Variance of the gyroscope bias, (rad/s)².
    pub gyro_variance: f64,
    /// Number of averaged inertial samples.
    pub samples: f64,
    /// Number of averaged magnetometer samples.
    pub mag_samples: f64,
}

impl Alignment {
    /// Creates an alignment without samples.
    #[must_use]
    pub fn new(gyro: GyroSpec) -> Self {
        let zero = Vec3::zero();
        Self { gyro, force: zero, rates: zero, mag: Vec3::zero(), samples: 0, mag_samples: 0, time_s: 0.0 }
    }

    /// Adds an inertial sample. Motion, or a mean rate too large for a bias, restarts the alignment.
    pub fn imu(&mut self, reading: &ImuReading, dt_s: f64) {
        let moving = reading.rates_rad_s.norm() > MAX_REST_RATE_RAD_S
            || (reading.specific_force_m_s2.norm() - math::GRAVITY_M_S2).abs() > REST_FORCE_TOLERANCE_M_S2;
        let turning = self.time_s >= ALIGNMENT_TIME_S && !self.gyro.is_plausible_bias(self.mean_rate(), f64::from(self.samples));
        if moving || turning {
            *self = Self::new(self.gyro);
            return;
        }
        self.force += reading.specific_force_m_s2;
        self.rates += reading.rates_rad_s;
        self.samples += 1;
        self.time_s += dt_s;
    }

    fn mean_rate(&self) -> Vec3<Frd> {
        self.rates / f64::from(self.samples.max(1))
    }

    /// Adds a magnetometer sample.
    pub fn mag(&mut self, gauss: Vec3<Frd>) {
        self.mag += gauss;
        self.mag_samples += 1;
    }

    fn gyro_variance(&self, samples: f64) -> f64 {
        let least = ROCKING_BIAS_FRACTION * self.gyro.bias_rad_s;
        self.gyro.white_noise_rad_s * self.gyro.white_noise_rad_s / samples + least * least
    }

    /// Returns the result once enough samples have been averaged. `field` is the Earth's magnetic field at the site.
    #[must_use]
    pub fn result(&self, field: Vec3<Ned>) -> Option<AlignmentResult> {
        if self.time_s < ALIGNMENT_TIME_S || self.mag_samples == 0 {
            return None;
        }
        let samples = f64::from(self.samples);
        if !self.gyro.is_plausible_bias(self.mean_rate(), samples) {
            return None;
        }
        let force = self.force / samples;
        let roll = math::atan2(-force.right(), -force.down());
        let pitch = math::atan2(force.forward(), math::hypot(force.right(), force.down()));
        let level = Rotation::from_euler(roll, pitch, 0.0) * self.mag;
        let yaw = math::wrap_pi(math::atan2(field.east(), field.north()) - math::atan2(level.east(), level.north()));
        Some(AlignmentResult {
            attitude: Rotation::from_euler(roll, pitch, yaw),
            gyro_bias_rad_s: self.mean_rate(),
            gyro_variance: self.gyro_variance(samples),
            samples,
            mag_samples: f64::from(self.mag_samples),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GYRO: GyroSpec = GyroSpec { bias_rad_s: 0.02, white_noise_rad_s: 0.002 };

    #[test]
    fn regress_rocking_vehicle_does_not_align_and_bias_stays_uncertain() {
        let gyro = GyroSpec { bias_rad_s: 0.003, white_noise_rad_s: 0.002 };
        let mut alignment = Alignment::new(gyro);
        let field = Vec3::new(0.2, 0.02, 0.4);
        let mut feed = |rate: f64, samples: u32| {
            for _ in 0..samples {
                let force = Vec3::new(0.0, 0.0, -math::GRAVITY_M_S2);
                alignment.imu(&ImuReading { specific_force_m_s2: force, rates_rad_s: Vec3::new(rate, 0.0, 0.0) }, 0.0025);
                alignment.mag(Vec3::new(0.2, 0.02, 0.4));
            }
            alignment.result(field)
        };
        // 20 times the bias sigma, as observed when the caged aircraft rocked on its cage.
        assert_eq!(feed(0.06, 800), None);
        let aligned = feed(0.002, 400).expect("at rest");
        assert!(aligned.gyro_variance >= 9e-8, "{}", aligned.gyro_variance);
    }

    #[test]
    fn exact_alignment_recovers_tilted_attitude() {
        let truth = Rotation::from_euler(0.2, -0.1, 2.0);
        let field = Vec3::new(0.2, 0.02, 0.4);
        let mut alignment = Alignment::new(GYRO);
        let reading = ImuReading {
            specific_force_m_s2: truth.inverse() * Vec3::new(0.0, 0.0, -math::GRAVITY_M_S2),
            rates_rad_s: Vec3::new(0.01, -0.02, 0.03),
        };
        for _ in 0..201 {
            alignment.imu(&reading, 0.0025);
            alignment.mag(truth.inverse() * field);
        }
        let aligned = alignment.result(field);
        let error = aligned.map(|a| (a.attitude.inverse().then(truth)).raw().angle());
        // Rounding error of trigonometric functions.
        assert!(error.is_some_and(|e| e < 1e-7), "{error:?}");
        assert!(aligned.is_some_and(|a| (a.gyro_bias_rad_s - Vec3::new(0.01, -0.02, 0.03)).norm() < 1e-12));
    }
}
