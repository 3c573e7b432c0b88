//! Velocity loop: converts velocity and acceleration setpoints to an attitude and a collective thrust.

use super::gains::Gains;
use crate::autopilot::estimator::estimate::Estimate;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};
use spandrel_model::math::{self, GRAVITY_M_S2};
use spandrel_model::vehicle::MAX_TRANSLATIONAL_LIFT;

/// Setpoint of the velocity loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VelocitySetpoint {
    /// Velocity, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Acceleration feedforward, m/s².
    pub acceleration_m_s2: Vec3<Ned>,
    /// Heading, rad.
    pub yaw_rad: f64,
}

/// Attitude and collective thrust setpoint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AttitudeThrustSetpoint {
    /// Attitude.
    pub attitude: Rotation<Frd, Ned>,
    /// Collective thrust, N.
    pub thrust_n: f64,
}

/// Integral state of the loop, m/s².
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct VelocityLoop {
    integral: Vec3<Ned>,
}

impl VelocityLoop {
    /// Resets the integral.
    pub fn reset(&mut self) {
        self.integral = Vec3::zero();
    }

    /// Resets the horizontal integral only.
    pub fn reset_horizontal(&mut self) {
        self.integral = Vec3::new(0.0, 0.0, self.integral.down());
    }

    /// Controls all three axes.
    pub fn fly(
        &mut self,
        gains: &Gains,
        mass_kg: f64,
        now: &Estimate,
        motion: &VelocitySetpoint,
        dt_s: f64,
    ) -> AttitudeThrustSetpoint {
        // The attitude response lags, so the velocity is compared with the plan as it was one lag earlier.
        let late = motion.acceleration_m_s2 * gains.attitude_lag_s;
        let planned = motion.velocity_m_s - Vec3::new(late.north(), late.east(), 0.0);
        let error = planned - now.velocity_m_s;
        let acceleration = motion.acceleration_m_s2
            + drag(gains, motion.velocity_m_s)
            + Vec3::new(gains.velocity * error.north(), gains.velocity * error.east(), gains.climb * error.down())
            + self.integral;
        let (force, horizontal_free, vertical_free) = limit_acceleration(gains, mass_kg, acceleration);
        if horizontal_free {
            self.integral += Vec3::new(error.north(), error.east(), 0.0) * (gains.velocity_integral * dt_s);
        }
        self.climb(gains, error.down(), vertical_free, dt_s);
        self.clamp_integral(gains);
        attitude_thrust(mass_kg, now, force, motion, gains)
    }

    /// Controls height only; the pilot controls roll and pitch (rad).
    pub fn fly_level(
        &mut self,
        gains: &Gains,
        mass_kg: f64,
        now: &Estimate,
        motion: &VelocitySetpoint,
        tilt: (f64, f64),
        dt_s: f64,
    ) -> AttitudeThrustSetpoint {
        let error = motion.velocity_m_s.down() - now.velocity_m_s.down();
        let acceleration = motion.acceleration_m_s2.down() + gains.climb * error + self.integral.down();
        let (force, _, free) = limit_acceleration(gains, mass_kg, Vec3::new(0.0, 0.0, acceleration));
        self.climb(gains, error, free, dt_s);
        self.clamp_integral(gains);
        AttitudeThrustSetpoint {
            attitude: Rotation::from_euler(tilt.0, tilt.1, motion.yaw_rad),
            thrust_n: thrust(mass_kg, now, force, motion, gains),
        }
    }

    fn climb(&mut self, gains: &Gains, error: f64, free: bool, dt_s: f64) {
        // At a thrust limit, the integral can only decrease in magnitude.
        if free || error * self.integral.down() < 0.0 {
            self.integral += Vec3::new(0.0, 0.0, gains.climb_integral * error * dt_s);
        }
    }

    fn clamp_integral(&mut self, gains: &Gains) {
        let flat = Vec3::<Ned>::new(self.integral.north(), self.integral.east(), 0.0).limited(gains.acceleration_m_s2);
        let down = self.integral.down().clamp(-0.8 * GRAVITY_M_S2, 0.8 * GRAVITY_M_S2);
        self.integral = Vec3::new(flat.north(), flat.east(), down);
    }
}

/// Acceleration that compensates for drag in still air, m/s². The integral handles wind.
fn drag(gains: &Gains, velocity_m_s: Vec3<Ned>) -> Vec3<Ned> {
    let k = gains.drag.0 + gains.drag.1 * velocity_m_s.horizontal_norm();
    Vec3::new(velocity_m_s.north() * k, velocity_m_s.east() * k, 0.0)
}

/// Returns the specific force for a desired acceleration within the tilt and thrust limits, with priority for the
/// vertical part, and whether the horizontal and the vertical part are within these limits.
fn limit_acceleration(gains: &Gains, mass_kg: f64, wanted_m_s2: Vec3<Ned>) -> (Vec3<Ned>, bool, bool) {
    let (low, high) = (gains.thrust_min_n / mass_kg, gains.thrust_max_n / mass_kg);
    let lift = GRAVITY_M_S2 - wanted_m_s2.down();
    let up = lift.clamp(low, high);
    let tilt = up * gains.tilt_tangent;
    let spare = (high * high - up * up).max(0.0).sqrt();
    let flat = Vec3::<Ned>::new(wanted_m_s2.north(), wanted_m_s2.east(), 0.0);
    let held = flat.limited(tilt.min(spare));
    (Vec3::new(held.north(), held.east(), -up), held == flat, up == lift)
}

fn attitude_thrust(
    mass_kg: f64,
    now: &Estimate,
    force: Vec3<Ned>,
    motion: &VelocitySetpoint,
    gains: &Gains,
) -> AttitudeThrustSetpoint {
    let down = (-force).unit();
    let (s, c) = math::sin_cos(motion.yaw_rad);
    let right = down.cross(Vec3::new(c, s, 0.0)).unit();
    let forward = right.cross(down);
    let matrix = Matrix3::from_columns(&[forward.raw(), right.raw(), down.raw()]);
    // FRAME: the columns are the body's axes in NED.
    let attitude = Rotation::assume(UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix)));
    AttitudeThrustSetpoint { attitude, thrust_n: thrust(mass_kg, now, force, motion, gains) }
}

/// Collective thrust with the correct vertical component at the current tilt.
fn thrust(mass_kg: f64, now: &Estimate, force: Vec3<Ned>, motion: &VelocitySetpoint, gains: &Gains) -> f64 {
    let upright = (now.attitude * Vec3::<Frd>::new(0.0, 0.0, 1.0)).down();
    if upright <= 0.0 {
        // The thrust would point down, so use the minimum needed for control.
        return gains.thrust_min_n;
    }
    let level_n = mass_kg * -force.down() / upright.max(0.5);
    (level_n + mass_kg * inflow(gains, now, motion)).clamp(gains.thrust_min_n, gains.thrust_max_n)
}

/// Thrust per unit of mass that compensates for the change of the rotors' thrust by the motion through still air, m/s². The integral
/// handles wind. Vertically, the setpoint counts instead of the estimate, so that the rotors still damp vertical motion.
fn inflow(gains: &Gains, now: &Estimate, motion: &VelocitySetpoint) -> f64 {
    let over_ground = now.velocity_m_s;
    let flown = Vec3::<Ned>::new(over_ground.north(), over_ground.east(), motion.velocity_m_s.down());
    let flow = now.attitude.inverse() * flown;
    let edgewise_squared = flow.forward() * flow.forward() + flow.right() * flow.right();
    let lift = (gains.translational_lift_1_m * edgewise_squared).min(MAX_TRANSLATIONAL_LIFT * GRAVITY_M_S2);
    gains.heave_damping_1_s * -flow.down() - lift
}
