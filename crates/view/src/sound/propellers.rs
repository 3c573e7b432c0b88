//! Propellers: for each rotor the frequency at which its blades pass, and harmonics of it.

use super::{RATE_HZ, SmoothedValue};
use spandrel_model::math;

/// Blades of a propeller (the aircraft of the paper, a DJI Phantom 2, has two-bladed ones of 9.4 inches; so have most of its size).
pub const BLADES: f64 = 2.0;
/// Harmonics, each with this share of the level of the one before (estimate: 6 dB; small propellers' tones fall so from the second on).
const HARMONICS: u32 = 6;
const FALL: f64 = 0.5;
/// Rotors that can be told apart.
const MOST: usize = 8;
/// The level is full at this speed, rad/s; it grows with its square, as thrust does (estimate: a small quadrotor's climb).
const FULL_RAD_S: f64 = 1_100.0;
/// Within this distance, m, the level is full; beyond it falls with the distance, as of a point source in the open. Chosen so that a drone at
/// 120 m is still heard over a usual loudspeaker (estimate).
const NEAR_M: f64 = 15.0;

/// Slower than this, rad/s, nothing is heard.
const STANDS_RAD_S: f64 = 1e-3;

/// Rotors as oscillators.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Propellers {
    rotors: [RotorOscillator; MOST],
    level: SmoothedValue,
    count: SmoothedValue,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct RotorOscillator {
    speed: SmoothedValue,
    /// Turns of the blades' fundamental, 0 to 1.
    phase: f64,
}

impl Propellers {
    /// The next sample, within -1 and 1, for rotors that turn so fast (rad/s) at this distance (m).
    pub fn next(&mut self, rotors_rad_s: &[f64], distance_m: f64) -> f64 {
        let far = self.level.follow((NEAR_M / distance_m.max(NEAR_M)).clamp(0.0, 1.0));
        // All rotors together are as loud as one is; no fewer than a quadrotor's, so that one alone is fainter.
        let count = self.count.follow(rotors_rad_s.len().min(MOST) as f64).max(4.0);
        let mut sum = 0.0;
        for (k, rotor) in self.rotors.iter_mut().enumerate() {
            sum += rotor.next(rotors_rad_s.get(k).copied().unwrap_or(0.0));
        }
        far * sum / count
    }
}

impl RotorOscillator {
    fn next(&mut self, rad_s: f64) -> f64 {
        let wanted = if rad_s.is_finite() { rad_s.clamp(0.0, 2.0 * FULL_RAD_S) } else { 0.0 };
        let speed = self.speed.follow(wanted);
        if wanted == 0.0 && speed < STANDS_RAD_S {
            return 0.0;
        }
        self.phase = (self.phase + BLADES * speed / math::TAU / f64::from(RATE_HZ)).rem_euclid(1.0);
        let level = (speed / FULL_RAD_S).min(1.0);
        let (mut sum, mut share, mut whole) = (0.0, 1.0, 0.0);
        for k in 1..=HARMONICS {
            sum += share * math::sin(math::TAU * self.phase * f64::from(k));
            whole += share;
            share *= FALL;
        }
        level * level * sum / whole
    }
}
