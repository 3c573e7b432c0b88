//! Alignment at rest: roll and pitch from gravity, heading from the magnetic field, gyroscope bias from stillness.

use crate::base::frames::{Frd, Ned, Rotation, Vec3};
use crate::base::math;
use crate::sitl::sensors::ImuReading;

/// Samples are averaged for this long, s.
pub const ALIGN_S: f64 = 0.5;
/// Faster turning than this is not rest, rad/s.
const STILL_RATE_RAD_S: f64 = 0.15;
/// A specific force this far from 1 g is not rest, m/s².
const STILL_FORCE_M_S2: f64 = 1.5;

/// Sums while aligning.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Alignment {
    force: Vec3<Frd>,
    rates: Vec3<Frd>,
    mag: Vec3<Frd>,
    samples: u32,
    mag_samples: u32,
    time_s: f64,
}

/// The outcome.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aligned {
    /// Attitude.
    pub attitude: Rotation<Frd, Ned>,
    /// Gyroscope bias, rad/s.
    pub gyro_bias_rad_s: Vec3<Frd>,
    /// How many inertial samples were averaged.
    pub samples: f64,
    /// How many magnetic samples were averaged.
    pub mag_samples: f64,
}

impl Alignment {
    /// Takes in an inertial sample; movement starts it over.
    pub fn imu(&mut self, reading: &ImuReading, dt_s: f64) {
        let moving = reading.rates_rad_s.norm() > STILL_RATE_RAD_S
            || (reading.specific_force_m_s2.norm() - math::GRAVITY_M_S2).abs() > STILL_FORCE_M_S2;
        if moving {
            *self = Self::default();
            return;
        }
        self.force += reading.specific_force_m_s2;
        self.rates += reading.rates_rad_s;
        self.samples += 1;
        self.time_s += dt_s;
    }

    /// Takes in a magnetic sample.
    pub fn mag(&mut self, gauss: Vec3<Frd>) {
        self.mag += gauss;
        self.mag_samples += 1;
    }

    /// The attitude, once enough was averaged. `field` is the earth's field at the site.
    #[must_use]
    pub fn done(&self, field: Vec3<Ned>) -> Option<Aligned> {
        if self.time_s < ALIGN_S || self.mag_samples == 0 {
            return None;
        }
        let samples = f64::from(self.samples);
        let force = self.force / samples;
        let roll = math::atan2(-force.right(), -force.down());
        let pitch = math::atan2(force.forward(), math::hypot(force.right(), force.down()));
        let level = Rotation::from_euler(roll, pitch, 0.0) * self.mag;
        let yaw = math::wrap_pi(math::atan2(field.east(), field.north()) - math::atan2(level.east(), level.north()));
        Some(Aligned {
            attitude: Rotation::from_euler(roll, pitch, yaw),
            gyro_bias_rad_s: self.rates / samples,
            samples,
            mag_samples: f64::from(self.mag_samples),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_alignment_finds_the_attitude_of_a_tilted_body() {
        let truth = Rotation::from_euler(0.2, -0.1, 2.0);
        let field = Vec3::new(0.2, 0.02, 0.4);
        let mut alignment = Alignment::default();
        let reading = ImuReading {
            specific_force_m_s2: truth.inverse() * Vec3::new(0.0, 0.0, -math::GRAVITY_M_S2),
            rates_rad_s: Vec3::new(0.01, -0.02, 0.03),
        };
        for _ in 0..201 {
            alignment.imu(&reading, 0.0025);
            alignment.mag(truth.inverse() * field);
        }
        let aligned = alignment.done(field);
        let error = aligned.map(|a| (a.attitude.inverse().then(truth)).raw().angle());
        // Rounding of trigonometry.
        assert!(error.is_some_and(|e| e < 1e-7), "{error:?}");
        assert!(aligned.is_some_and(|a| (a.gyro_bias_rad_s - Vec3::new(0.01, -0.02, 0.03)).norm() < 1e-12));
    }
}
