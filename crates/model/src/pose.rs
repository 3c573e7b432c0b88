//! Pose and motion of the aircraft. The type parameter is the frame of position and velocity.

use crate::frames::{Frd, Ned, Rotation, Vec3};

/// Position and attitude of the aircraft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose<F> {
    /// Position of the center of mass, m.
    pub position_m: Vec3<F>,
    /// Attitude: rotation from body to NED.
    pub ned_from_frd: Rotation<Frd, Ned>,
}

/// Position, velocity and attitude of the aircraft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion<F> {
    /// Position of the center of mass, m.
    pub position_m: Vec3<F>,
    /// Velocity over ground, m/s.
    pub velocity_m_s: Vec3<F>,
    /// Attitude: rotation from body to NED.
    pub ned_from_frd: Rotation<Frd, Ned>,
}

impl<F: Copy> Motion<F> {
    /// Returns the pose without the velocity.
    #[must_use]
    pub fn pose(&self) -> Pose<F> {
        Pose { position_m: self.position_m, ned_from_frd: self.ned_from_frd }
    }

    /// Interpolates position and velocity linearly, and the attitude along the shorter arc: `t` = 0 returns this motion, 1
    /// returns `other`.
    #[must_use]
    pub fn lerp(&self, other: &Self, t: f64) -> Self {
        Self { ned_from_frd: self.ned_from_frd.lerp(other.ned_from_frd, t), ..self.lerp_with_held_attitude(other, t) }
    }

    /// Interpolates position and velocity linearly and keeps the attitude of this motion.
    #[must_use]
    pub fn lerp_with_held_attitude(&self, other: &Self, t: f64) -> Self {
        Self {
            position_m: self.position_m.lerp(other.position_m, t),
            velocity_m_s: self.velocity_m_s.lerp(other.velocity_m_s, t),
            ned_from_frd: self.ned_from_frd,
        }
    }
}
