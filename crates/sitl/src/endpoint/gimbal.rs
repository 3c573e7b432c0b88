//! Pitch gimbal behind the gimbal manager of the autopilot component. It keeps the horizon in roll and pitch and follows the heading:
//! it has no axis for roll and yaw, and no place to retract to.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::vehicle::Camera;

/// Id of the non-MAVLink gimbal device (docs/src/reference/wire.md, "Camera, gimbal and lamp").
pub const DEVICE: u8 = 1;
/// An angle this far beyond the stop is taken as the stop, rad (a degree: clients round).
const SLACK_RAD: f64 = 0.02;

/// What the gimbal strives for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GimbalTarget {
    /// An angle, rad.
    Angle(f64),
    /// An angle, rad, and how fast to get there, rad/s.
    Slowly(f64, f64),
    /// A rate, rad/s.
    Rate(f64),
    /// A place, m.
    Place(Vec3<Enu>),
    /// Level and ahead.
    Neutral,
}

impl GimbalTarget {
    /// What a message with these fields asks for, NaN and zero rates being left out: an angle, at a rate, or a rate alone.
    #[must_use]
    pub fn of(angle_rad: Option<f64>, rate_rad_s: Option<f64>) -> Option<Self> {
        match (angle_rad, rate_rad_s) {
            (Some(angle), Some(rate)) if rate != 0.0 => Some(Self::Slowly(angle, rate.abs())),
            (Some(angle), _) => Some(Self::Angle(angle)),
            (None, Some(rate)) => Some(Self::Rate(rate)),
            (None, None) => None,
        }
    }
}

/// The gimbal's state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GimbalState {
    /// Pitch about the horizon, rad; negative looks down.
    pub pitch_rad: f64,
    /// Its rate, rad/s.
    pub rate_rad_s: f64,
    /// Who controls it: system and component, 0 for nobody.
    pub control: (u8, u8),
    /// Who may move it besides.
    pub secondary: (u8, u8),
    /// Angles of DO_MOUNT_CONTROL are rates: DO_MOUNT_CONFIGURE has said so.
    pub mount_rates: bool,
    /// It is wanted beyond its stop.
    pub at_stop: bool,
    aim: GimbalTarget,
}

impl GimbalState {
    /// Level.
    #[must_use]
    pub fn new() -> Self {
        Self {
            pitch_rad: 0.0,
            rate_rad_s: 0.0,
            control: (0, 0),
            secondary: (0, 0),
            mount_rates: false,
            at_stop: false,
            aim: GimbalTarget::Angle(0.0),
        }
    }

    /// Somebody in control keeps others out; with nobody in control anybody may move it.
    #[must_use]
    pub fn accepts_control_from(&self, from: (u8, u8)) -> bool {
        self.control == (0, 0) || self.control == from || self.secondary == from
    }

    /// It is in its neutral place, or on the way there.
    #[must_use]
    pub fn is_neutral(&self) -> bool {
        self.aim == GimbalTarget::Neutral
    }

    /// A stick's deflection in [-1, 1], up positive: the whole way to the stop on its side.
    #[must_use]
    pub fn deflected(camera: &Camera, deflection: f64) -> GimbalTarget {
        let stop = if deflection < 0.0 { -camera.gimbal_pitch_min_rad } else { camera.gimbal_pitch_max_rad };
        GimbalTarget::Angle(deflection.clamp(-1.0, 1.0) * stop)
    }

    /// A new aim; refused when it is not a number or an angle out of reach.
    pub fn set(&mut self, aim: GimbalTarget, camera: &Camera) -> bool {
        let reached = (camera.gimbal_pitch_min_rad - SLACK_RAD)..=(camera.gimbal_pitch_max_rad + SLACK_RAD);
        let legal = match aim {
            GimbalTarget::Angle(angle) => reached.contains(&angle),
            GimbalTarget::Slowly(angle, rate) => reached.contains(&angle) && rate.is_finite() && rate > 0.0,
            GimbalTarget::Rate(rate) => rate.is_finite(),
            GimbalTarget::Place(place) => place.is_finite(),
            GimbalTarget::Neutral => true,
        };
        if legal {
            self.aim = aim;
        }
        legal
    }

    /// Moves for `dt_s`.
    pub fn step(&mut self, camera: &Camera, position_m: Vec3<Enu>, dt_s: f64) {
        let fastest = if let GimbalTarget::Slowly(_, rate) = self.aim {
            rate.min(camera.gimbal_rate_rad_s)
        } else {
            camera.gimbal_rate_rad_s
        };
        let limit = fastest * dt_s;
        let before = self.pitch_rad;
        let wished = match self.aim {
            GimbalTarget::Angle(angle) | GimbalTarget::Slowly(angle, _) => angle,
            GimbalTarget::Rate(rate) => before + rate * dt_s,
            GimbalTarget::Place(place) => {
                let line = place - position_m;
                math::atan2(line.up(), line.horizontal_norm())
            }
            GimbalTarget::Neutral => 0.0,
        };
        let wanted = wished.clamp(camera.gimbal_pitch_min_rad, camera.gimbal_pitch_max_rad);
        self.pitch_rad = before + (wanted - before).clamp(-limit, limit);
        self.rate_rad_s = (self.pitch_rad - before) / dt_s;
        let beyond = if let GimbalTarget::Rate(_) = self.aim { 0.0 } else { SLACK_RAD };
        self.at_stop = self.pitch_rad == wanted && (wished - wanted).abs() > beyond;
    }
}

impl Default for GimbalState {
    fn default() -> Self {
        Self::new()
    }
}
