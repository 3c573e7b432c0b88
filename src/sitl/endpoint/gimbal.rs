//! Pitch gimbal behind the gimbal manager of the autopilot component.

use crate::base::frames::{Enu, Vec3};
use crate::base::math;
use crate::vehicle::Camera;

/// Id of the non-MAVLink gimbal device (mavlink.md 1.8).
pub const DEVICE: u8 = 1;

/// What the gimbal strives for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Aim {
    /// An angle, rad.
    Angle(f64),
    /// A rate, rad/s.
    Rate(f64),
    /// A place, m.
    Place(Vec3<Enu>),
}

/// The gimbal's state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gimbal {
    /// Pitch about the horizon, rad; negative looks down.
    pub pitch_rad: f64,
    /// Its rate, rad/s.
    pub rate_rad_s: f64,
    /// Who controls it: system and component, 0 for nobody.
    pub control: (u8, u8),
    /// Who may move it besides.
    pub secondary: (u8, u8),
    aim: Aim,
}

impl Gimbal {
    /// Level.
    #[must_use]
    pub fn new() -> Self {
        Self { pitch_rad: 0.0, rate_rad_s: 0.0, control: (0, 0), secondary: (0, 0), aim: Aim::Angle(0.0) }
    }

    /// Somebody in control keeps others out; with nobody in control anybody may move it.
    #[must_use]
    pub fn obeys(&self, from: (u8, u8)) -> bool {
        self.control == (0, 0) || self.control == from || self.secondary == from
    }

    /// A stick's deflection in [-1, 1], up positive: the whole way to the stop on its side.
    #[must_use]
    pub fn deflected(camera: &Camera, deflection: f64) -> Aim {
        let stop = if deflection < 0.0 { -camera.gimbal_pitch_min_rad } else { camera.gimbal_pitch_max_rad };
        Aim::Angle(deflection.clamp(-1.0, 1.0) * stop)
    }

    /// A new aim; refused when it is not a number or an angle out of reach.
    pub fn set(&mut self, aim: Aim, camera: &Camera) -> bool {
        // A degree beyond the stop is taken as the stop (clients round).
        let slack = 0.02;
        let legal = match aim {
            Aim::Angle(a) => a >= camera.gimbal_pitch_min_rad - slack && a <= camera.gimbal_pitch_max_rad + slack,
            Aim::Rate(r) => r.is_finite(),
            Aim::Place(p) => p.is_finite(),
        };
        if legal {
            self.aim = aim;
        }
        legal
    }

    /// Moves for `dt_s`.
    pub fn step(&mut self, camera: &Camera, position_m: Vec3<Enu>, dt_s: f64) {
        let limit = camera.gimbal_rate_rad_s * dt_s;
        let before = self.pitch_rad;
        let wanted = match self.aim {
            Aim::Angle(angle) => angle,
            Aim::Rate(rate) => before + rate * dt_s,
            Aim::Place(place) => {
                let line = place - position_m;
                math::atan2(line.up(), line.horizontal_norm())
            }
        };
        let wanted = wanted.clamp(camera.gimbal_pitch_min_rad, camera.gimbal_pitch_max_rad);
        self.pitch_rad = before + (wanted - before).clamp(-limit, limit);
        self.rate_rad_s = (self.pitch_rad - before) / dt_s;
    }
}

impl Default for Gimbal {
    fn default() -> Self {
        Self::new()
    }
}
