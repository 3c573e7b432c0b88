//! The pitch gimbal, controlled through the gimbal manager of the autopilot component. It stabilizes roll and pitch and
//! follows the heading; it has no roll or yaw axis and cannot retract.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::vehicle::Camera;

/// ID of the non-MAVLink gimbal device (docs/src/reference/wire.md, "Camera, gimbal and lamp").
pub const BUILTIN_GIMBAL_DEVICE_ID: u8 = 1;
/// Tolerance within which an angle beyond the limit is clamped instead of rejected, rad (about one degree, because
/// clients round).
const TOLERANCE_RAD: f64 = 0.02;

/// Gimbal target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GimbalTarget {
    /// A pitch angle, rad.
    Angle(f64),
    /// A pitch angle, rad, and the rate at which to approach it, rad/s.
    AngleAtRate(f64, f64),
    /// A pitch rate, rad/s.
    Rate(f64),
    /// A position to point at, m.
    Position(Vec3<Enu>),
    /// Level, facing forward.
    Neutral,
}

impl GimbalTarget {
    /// Returns the target for a message with these fields: an angle, an angle with a rate, or a rate alone.
    #[must_use]
    pub fn of(angle_rad: Option<f64>, rate_rad_s: Option<f64>) -> Option<Self> {
        match (angle_rad, rate_rad_s) {
            (Some(angle), Some(rate)) if rate != 0.0 => Some(Self::AngleAtRate(angle, rate.abs())),
            (Some(angle), _) => Some(Self::Angle(angle)),
            (None, Some(rate)) => Some(Self::Rate(rate)),
            (None, None) => None,
        }
    }
}

/// Gimbal state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GimbalState {
    /// Pitch relative to the horizon, rad; negative points down.
    pub pitch_rad: f64,
    /// Pitch rate, rad/s.
    pub rate_rad_s: f64,
    /// Component in primary control: system and component ID; 0 if none.
    pub control: (u8, u8),
    /// Secondary control: system and component ID.
    pub secondary: (u8, u8),
    /// Whether DO_MOUNT_CONTROL values are rates, as selected by DO_MOUNT_CONFIGURE.
    pub mount_values_are_rates: bool,
    /// Whether the gimbal is at its limit and the target is beyond it.
    pub is_at_limit: bool,
    aim: GimbalTarget,
}

impl GimbalState {
    /// Creates a level gimbal.
    #[must_use]
    pub fn new() -> Self {
        Self {
            pitch_rad: 0.0,
            rate_rad_s: 0.0,
            control: (0, 0),
            secondary: (0, 0),
            mount_values_are_rates: false,
            is_at_limit: false,
            aim: GimbalTarget::Angle(0.0),
        }
    }

    /// Returns true if this sender may move the gimbal. If no component is in control, any sender may.
    #[must_use]
    pub fn accepts_control_from(&self, from: (u8, u8)) -> bool {
        self.control == (0, 0) || self.control == from || self.secondary == from
    }

    /// Checks whether the gimbal is in its neutral position or moving there.
    #[must_use]
    pub fn is_neutral(&self) -> bool {
        self.aim == GimbalTarget::Neutral
    }

    /// Converts a stick deflection in [-1, 1] (positive: up) to an angle. Full deflection corresponds to the limit on
    /// that side.
    #[must_use]
    pub fn stick_to_angle(camera: &Camera, deflection: f64) -> GimbalTarget {
        let stop = if deflection < 0.0 { -camera.gimbal_pitch_min_rad } else { camera.gimbal_pitch_max_rad };
        GimbalTarget::Angle(deflection.clamp(-1.0, 1.0) * stop)
    }

    /// Sets a new target. Returns false if it is not finite or out of range.
    pub fn set(&mut self, aim: GimbalTarget, camera: &Camera) -> bool {
        let reached = (camera.gimbal_pitch_min_rad - TOLERANCE_RAD)..=(camera.gimbal_pitch_max_rad + TOLERANCE_RAD);
        let is_valid = match aim {
            GimbalTarget::Angle(angle) => reached.contains(&angle),
            GimbalTarget::AngleAtRate(angle, rate) => reached.contains(&angle) && rate.is_finite() && rate > 0.0,
            GimbalTarget::Rate(rate) => rate.is_finite(),
            GimbalTarget::Position(place) => place.is_finite(),
            GimbalTarget::Neutral => true,
        };
        if is_valid {
            self.aim = aim;
        }
        is_valid
    }

    /// Moves the gimbal for `dt_s` seconds.
    pub fn step(&mut self, camera: &Camera, position_m: Vec3<Enu>, dt_s: f64) {
        let fastest = if let GimbalTarget::AngleAtRate(_, rate) = self.aim {
            rate.min(camera.gimbal_rate_rad_s)
        } else {
            camera.gimbal_rate_rad_s
        };
        let limit = fastest * dt_s;
        let before = self.pitch_rad;
        let requested_rad = match self.aim {
            GimbalTarget::Angle(angle) | GimbalTarget::AngleAtRate(angle, _) => angle,
            GimbalTarget::Rate(rate) => before + rate * dt_s,
            GimbalTarget::Position(place) => {
                let line = place - position_m;
                math::atan2(line.up(), line.horizontal_norm())
            }
            GimbalTarget::Neutral => 0.0,
        };
        let target_rad = requested_rad.clamp(camera.gimbal_pitch_min_rad, camera.gimbal_pitch_max_rad);
        self.pitch_rad = before + (target_rad - before).clamp(-limit, limit);
        self.rate_rad_s = (self.pitch_rad - before) / dt_s;
        let tolerance_rad = if let GimbalTarget::Rate(_) = self.aim { 0.0 } else { TOLERANCE_RAD };
        self.is_at_limit = self.pitch_rad == target_rad && (requested_rad - target_rad).abs() > tolerance_rad;
    }
}

impl Default for GimbalState {
    fn default() -> Self {
        Self::new()
    }
}
