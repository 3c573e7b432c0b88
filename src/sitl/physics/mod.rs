//! Rigid body, rotors, surface effects, drag, battery, contact: state is plain data, models are functions.

use crate::base::frames::{Frd, Ned, Rotation, Vec3};

/// Most rotors an aircraft may have.
pub const MAX_ROTORS: usize = 8;

/// The moving state of the aircraft: the truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidState {
    /// Centre of mass, m, local north-east-down.
    pub position_m: Vec3<Ned>,
    /// Velocity over ground, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Attitude.
    pub attitude: Rotation<Frd, Ned>,
    /// Angular velocity of the body against the ground, rad/s.
    pub rates_rad_s: Vec3<Frd>,
    /// Rotor speeds, rad/s.
    pub rotor_rad_s: [f64; MAX_ROTORS],
}

/// What the flight controller drives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Actuators {
    /// Motor commands, 0..1 of the speed range (idle to max), in rotor order; ignored when not armed.
    pub motors: [f64; MAX_ROTORS],
    /// Motors turn.
    pub armed: bool,
}
