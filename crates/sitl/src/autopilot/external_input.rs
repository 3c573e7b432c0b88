//! Inputs from pilots and companion computers: sticks and external setpoints.

use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};

/// Stick inputs, each from -1 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sticks {
    /// Forward (+), backward (-).
    pub forward: f64,
    /// Right (+), left (-).
    pub right: f64,
    /// Up (+), down (-).
    pub up: f64,
    /// Clockwise (+), counterclockwise (-).
    pub yaw: f64,
}

/// An external setpoint. It does not control axes set to `None`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OffboardSetpoint {
    /// Position, m, NED.
    pub position_m: [Option<f64>; 3],
    /// Velocity, m/s (north, east, down).
    pub velocity_m_s: [Option<f64>; 3],
    /// Acceleration, m/s² (north, east, down): used directly if the axis has no position or velocity, and fed forward
    /// otherwise.
    pub acceleration_m_s2: [Option<f64>; 3],
    /// Heading, rad.
    pub yaw_rad: Option<f64>,
    /// Heading rate, rad/s.
    pub yaw_rate_rad_s: Option<f64>,
    /// Attitude and thrust (0 to 1) instead of position or velocity.
    pub attitude: Option<(Rotation<Frd, Ned>, f64)>,
    /// Body rates, rad/s, and thrust (0 to 1) instead of everything else.
    pub rates: Option<(Vec3<Frd>, f64)>,
    /// Climb rate that replaces the thrust of an attitude or body rate setpoint, m/s up.
    pub climb_m_s: Option<f64>,
}
