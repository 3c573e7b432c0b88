//! Circles around a point, and requests for them.

use spandrel_model::frames::{Ned, Vec3};

/// Heading on a circle, with the values of MAVLink's ORBIT_YAW_BEHAVIOUR.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OrbitYaw {
    /// Toward the center (0).
    #[default]
    Center,
    /// Heading at the start (1), or uncontrolled (2).
    Keep,
    /// Tangent to the circle (3).
    Tangent,
    /// Controlled by the yaw stick (4).
    Stick,
}

impl OrbitYaw {
    /// Returns the behavior for a command value, or `None` if it is unknown.
    #[must_use]
    pub fn from_number(n: i64) -> Option<Self> {
        [Self::Center, Self::Keep, Self::Keep, Self::Tangent, Self::Stick].get(usize::try_from(n).ok()?).copied()
    }
}

/// An active circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orbit {
    /// Center and height of the circle, m.
    pub center_m: Vec3<Ned>,
    /// Radius, m.
    pub radius_m: f64,
    /// Tangential speed, m/s; positive is clockwise as seen from above.
    pub speed_m_s: f64,
    /// Heading behavior.
    pub yaw: OrbitYaw,
    /// Remaining arc, rad; infinite for an endless circle.
    pub remaining_arc_rad: f64,
    /// Learned inward speed that keeps the vehicle on the circle, m/s.
    pub inward_speed_m_s: f64,
}

/// A requested circle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OrbitRequest {
    /// Center, north and east, m; `None` uses the current position.
    pub center_m: Option<(f64, f64)>,
    /// Height above the origin, m.
    pub up_m: Option<f64>,
    /// Radius, m; negative for counterclockwise.
    pub radius_m: Option<f64>,
    /// Speed, m/s.
    pub speed_m_s: Option<f64>,
    /// Heading behavior. `None` keeps the behavior of the active circle or, without one, points toward the center.
    pub yaw: Option<OrbitYaw>,
    /// Arc to fly, rad; 0 for an endless circle.
    pub arc_rad: f64,
}
