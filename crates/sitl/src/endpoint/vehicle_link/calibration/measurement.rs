//! Measures a sensor at rest.

use super::texts::CalibratedSensor;
use crate::sensors::Readings;
use spandrel_model::frames::{Frd, Vec3};
use spandrel_model::math::GRAVITY_M_S2;
use spandrel_model::time::SimTime;

/// Averaging time, s (PX4's gyro calibration takes about as long).
pub(super) const MEASUREMENT_S: f64 = 4.0;
/// Maximum rate difference between the two halves of the measurement at rest, rad/s (PX4: gyro calibration, 0.01
/// rad/s).
const MAX_RATE_CHANGE_RAD_S: f64 = 0.01;
/// Maximum specific force difference between the halves, m/s² (estimate: ten times the noise of the mean).
const MAX_FORCE_CHANGE_M_S2: f64 = 0.05;
/// Maximum deviation from 1 g at rest, m/s².
const MAX_GRAVITY_ERROR_M_S2: f64 = 1.0;
/// Maximum horizontal component of gravity for a level vehicle, m/s² (30 degrees; PX4: level calibration).
const MAX_LEVEL_ERROR_M_S2: f64 = 0.5 * GRAVITY_M_S2;

/// Sums over one half of the measurement.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct HalfSums {
    rates: Vec3<Frd>,
    force: Vec3<Frd>,
    samples: u32,
}

impl HalfSums {
    fn means(&self) -> (Vec3<Frd>, Vec3<Frd>) {
        let share = 1.0 / f64::from(self.samples.max(1));
        (self.rates * share, self.force * share)
    }
}

/// A calibration in progress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Calibration {
    pub(super) sensor: CalibratedSensor,
    pub(super) since: SimTime,
    halves: [HalfSums; 2],
    pub(super) steps: u32,
}

impl Calibration {
    /// Starts a measurement.
    pub(super) fn start(sensor: CalibratedSensor, since: SimTime) -> Self {
        Self { sensor, since, halves: [HalfSums::default(); 2], steps: 0 }
    }

    /// Adds the latest reading. Returns true once the measuring time has passed.
    pub(super) fn measure(&mut self, readings: &Readings, now: SimTime) -> bool {
        let age_s = (now - self.since).s();
        let half = &mut self.halves[usize::from(age_s > 0.5 * MEASUREMENT_S)];
        if let Some(imu) = readings.imu {
            half.rates += imu.rates_rad_s;
            half.force += imu.specific_force_m_s2;
            half.samples += 1;
        }
        age_s >= MEASUREMENT_S
    }

    /// Returns the gyroscope bias in rad/s, or the reason for the failure.
    pub(super) fn outcome(&self) -> Result<Vec3<Frd>, &'static str> {
        let [(rates_0, force_0), (rates_1, force_1)] = self.halves.map(|half| half.means());
        let force = (force_0 + force_1) * 0.5;
        if self.halves.iter().any(|half| half.samples == 0) {
            return Err("reading sensor");
        }
        let turned = (rates_1 - rates_0).array().iter().any(|rate| rate.abs() > MAX_RATE_CHANGE_RAD_S);
        if turned
            || (force_1 - force_0).norm() > MAX_FORCE_CHANGE_M_S2
            || (force.norm() - GRAVITY_M_S2).abs() > MAX_GRAVITY_ERROR_M_S2
        {
            return Err("vehicle moved");
        }
        if self.sensor == CalibratedSensor::Level && force.forward().abs().max(force.right().abs()) > MAX_LEVEL_ERROR_M_S2 {
            return Err("excess roll or pitch angle");
        }
        Ok((rates_0 + rates_1) * 0.5)
    }
}
