//! Setpoints from the navigator.

use super::velocity::{AttitudeThrustSetpoint, VelocitySetpoint};
use spandrel_model::frames::{Frd, Vec3};

/// A setpoint for the control loops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Setpoint {
    /// Idle motors on the ground.
    Idle,
    /// Velocity and heading.
    Velocity(VelocitySetpoint),
    /// Vertical velocity with fixed roll and pitch.
    Level {
        /// Vertical velocity and heading.
        motion: VelocitySetpoint,
        /// Roll and pitch, rad.
        tilt: (f64, f64),
    },
    /// Attitude and thrust.
    AttitudeThrust {
        /// Attitude and collective thrust.
        target: AttitudeThrustSetpoint,
        /// Intended descent rate for landing detection, m/s.
        descent_rate_m_s: f64,
    },
    /// Body rates and thrust.
    Rates {
        /// Body rates, rad/s.
        rates_rad_s: Vec3<Frd>,
        /// Collective thrust, N.
        thrust_n: f64,
        /// Intended descent rate for landing detection, m/s.
        descent_rate_m_s: f64,
    },
    /// Body rates and vertical velocity.
    RatesAndClimb {
        /// Body rates, rad/s.
        rates_rad_s: Vec3<Frd>,
        /// Vertical velocity.
        motion: VelocitySetpoint,
        /// Intended descent rate for landing detection, m/s.
        descent_rate_m_s: f64,
    },
}
