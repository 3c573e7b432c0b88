//! The estimated state of the vehicle.

use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};

/// The current estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Position relative to the origin, m.
    pub position_m: Vec3<Ned>,
    /// Velocity, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Attitude.
    pub attitude: Rotation<Frd, Ned>,
    /// Angular rate with bias removed, rad/s.
    pub rates_rad_s: Vec3<Frd>,
    /// Horizontal position accuracy, m (1 sigma).
    pub horizontal_m: f64,
    /// Vertical position accuracy, m (1 sigma).
    pub vertical_m: f64,
    /// Position at which the estimator was initialized, relative to the origin, m. It is the origin of MAVLink's local frame.
    pub local_origin_m: Vec3<Ned>,
    /// Whether the origin of the local frame is set.
    pub local_origin_set: bool,
    /// Whether horizontal position and velocity are usable for control.
    pub position_valid: bool,
    /// Whether the attitude is aligned.
    pub attitude_valid: bool,
}
