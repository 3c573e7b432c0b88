//! The cascade: velocity to acceleration, acceleration to attitude and thrust, attitude to rates, rates to torque. Gains follow from the
//! aircraft's own numbers: each loop is a fixed factor slower than the one inside it, and the innermost follows the motors' lag.

use super::mixer::Mixer;
use super::{Estimate, Frd, Ned, Rotation, Vec3};
use crate::base::math::{self, GRAVITY_M_S2};
use crate::sitl::physics::Actuators;
use crate::vehicle::Vehicle;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

/// Attitude and thrust to be held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AttitudeTarget {
    /// Wanted attitude.
    pub attitude: Rotation<Frd, Ned>,
    /// Wanted rate of turn about the vertical, rad/s.
    pub yaw_rate_rad_s: f64,
    /// Wanted thrust, N.
    pub thrust_n: f64,
}

/// Gains and integrators.
#[derive(Debug, Clone, PartialEq)]
pub struct Control {
    mass_kg: f64,
    inertia: [f64; 3],
    rate_limit: f64,
    tilt_limit: f64,
    rate_gain: f64,
    attitude_gain: f64,
    velocity_gain: f64,
    /// Position gain, 1/s.
    pub position_gain: f64,
    mixer: Mixer,
    rate_integral: Vec3<Frd>,
    velocity_integral: Vec3<Ned>,
    /// Collective of the last step as a share of the most, for reports.
    pub thrust_share: f64,
}

/// Yaw is steered this much slower than roll and pitch: its authority is small.
const YAW_SHARE: f64 = 0.35;
/// Largest acceleration that the velocity integrator may hold, m/s².
const VELOCITY_INTEGRAL_M_S2: f64 = 5.0;
/// Largest torque that the rate integrator may hold, as angular acceleration, rad/s².
const RATE_INTEGRAL_RAD_S2: f64 = 8.0;

impl Control {
    /// Gains for an aircraft.
    #[must_use]
    pub fn new(vehicle: &Vehicle) -> Self {
        let rate_gain = 1.0 / (2.5 * vehicle.rotor.time_constant_s);
        let attitude_gain = (rate_gain / 3.0).min(8.0);
        let velocity_gain = (attitude_gain / 2.8).min(2.5);
        Self {
            mass_kg: vehicle.mass_kg,
            inertia: vehicle.inertia_kg_m2,
            rate_limit: vehicle.limits.rate_rad_s,
            tilt_limit: vehicle.limits.tilt_rad,
            rate_gain,
            attitude_gain,
            velocity_gain,
            position_gain: (velocity_gain / 1.7).min(1.1),
            mixer: Mixer::new(vehicle),
            rate_integral: Vec3::zero(),
            velocity_integral: Vec3::zero(),
            thrust_share: 0.0,
        }
    }

    /// Forgets what the integrators have learnt.
    pub fn reset(&mut self) {
        self.rate_integral = Vec3::zero();
        self.velocity_integral = Vec3::zero();
        self.thrust_share = 0.0;
    }

    /// Thrust that carries the weight, N.
    #[must_use]
    pub fn hover_n(&self) -> f64 {
        self.mass_kg * GRAVITY_M_S2
    }

    /// Horizontal acceleration that the tilt limit allows, m/s².
    #[must_use]
    pub fn lateral_limit_m_s2(&self) -> f64 {
        GRAVITY_M_S2 * math::tan(self.tilt_limit)
    }

    /// Attitude and thrust for a wanted velocity (with acceleration known ahead) and heading.
    pub fn velocity(
        &mut self,
        e: &Estimate,
        wanted_m_s: Vec3<Ned>,
        ahead_m_s2: Vec3<Ned>,
        yaw_rad: f64,
        yaw_rate: f64,
        dt_s: f64,
    ) -> AttitudeTarget {
        let error = wanted_m_s - e.velocity_m_s;
        let wish = error * self.velocity_gain + self.velocity_integral + ahead_m_s2;
        let level = Vec3::<Ned>::new(wish.north(), wish.east(), 0.0);
        let limited = level.limited(self.lateral_limit_m_s2());
        let top = 0.9 * self.mixer.top_n() / self.mass_kg;
        let down = wish.down().clamp(GRAVITY_M_S2 - top, 0.7 * GRAVITY_M_S2);
        // An integrator that pushes against a limit learns nothing.
        let free = if limited == level { 1.0 } else { 0.0 };
        let learn = Vec3::<Ned>::new(error.north() * free, error.east() * free, error.down()) * (0.4 * self.velocity_gain * dt_s);
        self.velocity_integral = (self.velocity_integral + learn).limited(VELOCITY_INTEGRAL_M_S2);
        self.thrust_along(e, Vec3::new(limited.north(), limited.east(), down), yaw_rad, yaw_rate)
    }

    /// Attitude and thrust that give an acceleration while facing a heading.
    fn thrust_along(&self, e: &Estimate, acceleration_m_s2: Vec3<Ned>, yaw_rad: f64, yaw_rate: f64) -> AttitudeTarget {
        let force = acceleration_m_s2 - Vec3::new(0.0, 0.0, GRAVITY_M_S2);
        let attitude = facing(-force, yaw_rad);
        // Only the part along the body's present axis is asked for, so that a late attitude does not lift.
        let axis = e.attitude * Vec3::<Frd>::new(0.0, 0.0, -1.0);
        let thrust_n = (force.dot(axis) * self.mass_kg).max(0.0);
        AttitudeTarget { attitude, yaw_rate_rad_s: yaw_rate, thrust_n }
    }

    /// Attitude for roll and pitch angles and a heading, with a thrust.
    #[must_use]
    pub fn tilted(&self, roll_rad: f64, pitch_rad: f64, yaw_rad: f64, yaw_rate: f64, thrust_n: f64) -> AttitudeTarget {
        AttitudeTarget { attitude: Rotation::from_euler(roll_rad, pitch_rad, yaw_rad), yaw_rate_rad_s: yaw_rate, thrust_n }
    }

    /// Motor commands that turn the body to the target.
    pub fn attitude(&mut self, e: &Estimate, target: &AttitudeTarget, dt_s: f64) -> Actuators {
        let mut error = (e.attitude.raw().inverse() * target.attitude.raw()).into_inner();
        if error.w < 0.0 {
            error = -error;
        }
        let turn = error.imag() * 2.0;
        let down_axis = (e.attitude.inverse() * Vec3::<Ned>::new(0.0, 0.0, 1.0)).raw();
        let gains = Vector3::new(1.0, 1.0, YAW_SHARE) * self.attitude_gain;
        let wanted = turn.component_mul(&gains) + down_axis * target.yaw_rate_rad_s;
        // FRAME: the error quaternion and the vertical axis are both in body axes.
        let wanted = Vec3::<Frd>::assume(wanted).limited(self.rate_limit);
        let torque = self.rates(e, wanted, dt_s);
        self.thrust_share = target.thrust_n / self.mixer.top_n();
        self.mixer.mix(target.thrust_n, torque)
    }

    fn rates(&mut self, e: &Estimate, wanted: Vec3<Frd>, dt_s: f64) -> [f64; 3] {
        let error = wanted - e.rates_rad_s;
        self.rate_integral = (self.rate_integral + error * (self.rate_gain * dt_s * 1.5)).limited(RATE_INTEGRAL_RAD_S2);
        let spin = (error * self.rate_gain + self.rate_integral).array();
        let w = e.rates_rad_s;
        let momentum = Vec3::<Frd>::new(self.inertia[0] * w.forward(), self.inertia[1] * w.right(), self.inertia[2] * w.down());
        let gyroscopic = w.cross(momentum).array();
        let share = [1.0, 1.0, 2.0 * YAW_SHARE];
        [0, 1, 2].map(|k| self.inertia[k] * spin[k] * share[k] + gyroscopic[k])
    }
}

/// Attitude whose down axis points along `down` and whose nose faces `yaw_rad` as far as the tilt allows.
fn facing(down: Vec3<Ned>, yaw_rad: f64) -> Rotation<Frd, Ned> {
    let z = down.unit().raw();
    let (s, c) = math::sin_cos(yaw_rad);
    let y = z.cross(&Vector3::new(c, s, 0.0));
    let norm = y.norm();
    if norm < 1e-6 {
        return Rotation::from_euler(0.0, 0.0, yaw_rad);
    }
    let y = y / norm;
    let x = y.cross(&z);
    let matrix = Matrix3::from_columns(&[x, y, z]);
    // FRAME: the columns are the body's axes written in NED.
    Rotation::assume(UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix)))
}
