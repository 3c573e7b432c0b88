//! The undisturbed wind, and the air at a position compared with it.

use crate::frames::{Enu, Ned, Vec3};

/// Wind below which there are no wakes, m/s.
pub(super) const MIN_WIND_M_S: f64 = 0.2;

/// Air at a position, compared with the undisturbed wind.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LocalAir {
    /// Added velocity, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Standard deviation of the added turbulence in each direction, m/s.
    pub turbulence_m_s: f64,
    /// Length of its eddies, m; 0 without turbulence.
    pub eddy_m: f64,
}

/// A horizontal wind's direction, the direction to its left, and its speed in m/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stream {
    pub(super) along: Vec3<Enu>,
    pub(super) left: Vec3<Enu>,
    pub(super) speed_m_s: f64,
}

impl Stream {
    /// Returns `None` in still air.
    pub(super) fn of(wind_m_s: Vec3<Ned>) -> Option<Self> {
        let horizontal = Vec3::new(wind_m_s.east(), wind_m_s.north(), 0.0);
        let speed_m_s = horizontal.norm();
        let along = (speed_m_s >= MIN_WIND_M_S).then(|| horizontal / speed_m_s)?;
        Some(Self { along, left: Vec3::new(-along.north(), along.east(), 0.0), speed_m_s })
    }
}
