//! Attitude and rate loops. They correct the thrust direction first and the heading second. An integral in the rate
//! loop compensates for unmodeled effects.

use super::gains::Gains;
use super::mixer::AllocationStatus;
use crate::autopilot::estimator::estimate::Estimate;
use nalgebra::{UnitQuaternion, Vector3};
use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};
use spandrel_model::math;

/// Limit of the rate-error integral, as an angular acceleration in rad/s².
const INTEGRAL_MAX_RAD_S2: f64 = 20.0;
/// Factor by which yaw rate feedforward may exceed the attitude loop's rate limit.
const YAW_RATE_LIMIT_FACTOR: f64 = 1.2;
/// Commanded yaw rate above which the vehicle turns, rad/s (estimate).
const TURNING_YAW_RATE_RAD_S: f64 = 0.1;
/// Tilt error above which heading control is suspended, rad.
const HEADING_CONTROL_MAX_TILT_RAD: f64 = 0.9;

/// State of the attitude and rate loops.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AttitudeLoop {
    integral: Vec3<Frd>,
}

impl AttitudeLoop {
    /// Resets the integral.
    pub fn reset(&mut self) {
        self.integral = Vec3::zero();
    }

    /// Computes the torque for an attitude setpoint with a yaw rate feedforward about the vertical axis (rad/s).
    pub fn torque(
        &mut self,
        gains: &Gains,
        now: &Estimate,
        desired: Rotation<Frd, Ned>,
        yaw_rate: f64,
        allocated: AllocationStatus,
        dt_s: f64,
    ) -> Vec3<Frd> {
        let rates = desired_rates(gains, now.attitude, desired, yaw_rate);
        self.track_rates(gains, now, (rates, yaw_rate), allocated, dt_s)
    }

    /// Computes the torque for body rate setpoints.
    pub fn rate_torque(
        &mut self,
        gains: &Gains,
        now: &Estimate,
        rates: Vec3<Frd>,
        allocated: AllocationStatus,
        dt_s: f64,
    ) -> Vec3<Frd> {
        self.track_rates(gains, now, (rates, rates.down()), allocated, dt_s)
    }

    /// Computes the torque for body rate setpoints, and for the yaw rate that is commanded without corrections of the heading.
    fn track_rates(
        &mut self,
        gains: &Gains,
        now: &Estimate,
        (rates, commanded_yaw_rate): (Vec3<Frd>, f64),
        allocated: AllocationStatus,
        dt_s: f64,
    ) -> Vec3<Frd> {
        let error = rates - now.rates_rad_s;
        // Prevents integral windup at the motor limits.
        if allocated.tilt > 0.99 {
            self.integral += Vec3::new(error.forward(), error.right(), 0.0) * (gains.rate_integral * dt_s);
        }
        // The moment of a turn is known. An integral that held what remains of it would turn the nose on, or back, after its end.
        if allocated.yaw > 0.99 && commanded_yaw_rate.abs() < TURNING_YAW_RATE_RAD_S {
            self.integral += Vec3::new(0.0, 0.0, error.down()) * (0.5 * gains.yaw_rate * dt_s);
        }
        self.integral = self.integral.limited(INTEGRAL_MAX_RAD_S2);
        let acceleration =
            Vec3::<Frd>::new(gains.rate * error.forward(), gains.rate * error.right(), gains.yaw_rate * error.down());
        let turn = (acceleration + self.integral).raw();
        let j = Vector3::from(gains.inertia_kg_m2);
        let w = now.rates_rad_s.raw();
        // FRAME: the moments of inertia are about the body axes.
        let torque = Vec3::<Frd>::assume(j.component_mul(&turn) + w.cross(&j.component_mul(&w)));
        torque + Vec3::new(0.0, 0.0, gains.yaw_damping_n_m_s * now.rates_rad_s.down())
    }
}

/// Limits body rate setpoints to the aircraft's maximum rates.
#[must_use]
pub fn limit_rates(gains: &Gains, rates: Vec3<Frd>) -> Vec3<Frd> {
    let tilt = Vec3::<Frd>::new(rates.forward(), rates.right(), 0.0).limited(gains.rate_max_rad_s);
    Vec3::new(tilt.forward(), tilt.right(), rates.down().clamp(-gains.yaw_rate_max_rad_s, gains.yaw_rate_max_rad_s))
}

/// Body rates that correct the thrust direction first and the heading second.
fn desired_rates(gains: &Gains, attitude: Rotation<Frd, Ned>, desired: Rotation<Frd, Ned>, yaw_rate: f64) -> Vec3<Frd> {
    let into_body = attitude.inverse();
    let z = Vec3::<Frd>::new(0.0, 0.0, 1.0);
    let aim = into_body * (desired * z);
    let axis = z.cross(aim);
    let sine = axis.norm();
    let angle = math::atan2(sine, aim.down());
    // If the vehicle is upside down, any axis works; roll is the fastest.
    let axis = if sine > 1e-6 { axis / sine } else { Vec3::new(1.0, 0.0, 0.0) };
    let tilt = (axis * (gains.attitude * angle)).limited(gains.rate_max_rad_s);
    let up = into_body * Vec3::<Ned>::new(0.0, 0.0, 1.0);
    let heading = if angle < HEADING_CONTROL_MAX_TILT_RAD { heading_error(attitude, desired, axis, angle) } else { 0.0 };
    let yaw = (gains.yaw * heading).clamp(-gains.yaw_rate_max_rad_s, gains.yaw_rate_max_rad_s);
    let fed = up * yaw_rate;
    let limit = gains.yaw_rate_max_rad_s * YAW_RATE_LIMIT_FACTOR;
    Vec3::new(tilt.forward() + fed.forward(), tilt.right() + fed.right(), (yaw + fed.down()).clamp(-limit, limit))
}

/// Remaining rotation about the body's down axis once the thrust direction is correct, rad.
fn heading_error(attitude: Rotation<Frd, Ned>, desired: Rotation<Frd, Ned>, axis: Vec3<Frd>, angle: f64) -> f64 {
    let tilted = attitude.rotated_by(axis * angle);
    let rest: UnitQuaternion<f64> = tilted.inverse().raw() * desired.raw();
    math::wrap_pi(2.0 * math::atan2(rest.k, rest.w))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::testing::vehicle_with;
    use crate::sensors::tests::error_free_sensors;

    #[test]
    fn exact_heading_error_commands_only_yaw() {
        let gains = Gains::new(&vehicle_with(error_free_sensors()));
        let rates = desired_rates(&gains, Rotation::identity(), Rotation::from_euler(0.0, 0.0, 0.1), 0.0);
        assert!((rates - Vec3::new(0.0, 0.0, 0.1 * gains.yaw)).norm() < 1e-12, "{rates:?}");
    }

    #[test]
    fn prop_integral_removes_the_error_of_a_constant_moment() {
        // Tick, s, simulated time in ticks, moment about the down axis, N m, and heading error that remains, rad (a tenth of a degree).
        const DT_S: f64 = 0.0025;
        const TICKS: u32 = 8_000;
        const MOMENT_N_M: f64 = 0.03;
        const MAX_ERROR_RAD: f64 = 0.002;
        let gains = Gains::new(&vehicle_with(error_free_sensors()));
        let sensors = error_free_sensors();
        let origin = spandrel_model::geodesy::Geo { latitude_deg: 46.5, longitude_deg: 8.0, altitude_m: 0.0 };
        let mut now = crate::autopilot::estimator::Estimator::new(&sensors, origin).estimate();
        let mut attitude_loop = AttitudeLoop::default();
        let (mut yaw_rad, mut rate_rad_s): (f64, f64) = (0.0, 0.0);
        let allocated = AllocationStatus::FULLY_ALLOCATED;
        for _ in 0..TICKS {
            now.attitude = Rotation::from_euler(0.0, 0.0, yaw_rad);
            now.rates_rad_s = Vec3::new(0.0, 0.0, rate_rad_s);
            let torque = attitude_loop.torque(&gains, &now, Rotation::identity(), 0.0, allocated, DT_S).down();
            let damping = gains.yaw_damping_n_m_s * rate_rad_s;
            rate_rad_s += (torque + MOMENT_N_M - damping) / gains.inertia_kg_m2[2] * DT_S;
            yaw_rad += rate_rad_s * DT_S;
        }
        assert!(yaw_rad.abs() < MAX_ERROR_RAD, "{yaw_rad} rad");
    }

    #[test]
    fn exact_roll_error_commands_only_roll() {
        let gains = Gains::new(&vehicle_with(error_free_sensors()));
        let rates = desired_rates(&gains, Rotation::identity(), Rotation::from_euler(0.1, 0.0, 0.0), 0.0);
        assert!((rates - Vec3::new(0.1 * gains.attitude, 0.0, 0.0)).norm() < 1e-12, "{rates:?}");
    }

    #[test]
    fn prop_inverted_vehicle_rolls_back_at_full_rate() {
        let gains = Gains::new(&vehicle_with(error_free_sensors()));
        let rates = desired_rates(&gains, Rotation::from_euler(math::PI, 0.0, 0.0), Rotation::identity(), 0.0);
        assert!((rates.norm() - gains.rate_max_rad_s).abs() < 1e-9, "{rates:?}");
    }
}
