//! Propeller sound: the blade-pass frequency of each rotor and its harmonics.

use super::smoothing::{SAMPLE_RATE_HZ, SmoothedValue};
use spandrel_model::math;

/// Blades per propeller. TASBID's aircraft, a DJI Phantom 2, has two-bladed 9.4-inch propellers, like most aircraft of
/// its size.
pub const BLADES_PER_PROPELLER: f64 = 2.0;
/// Number of harmonics, and level of each harmonic relative to the previous one (estimate: 6 dB, as with small
/// propellers from the second harmonic on).
const HARMONIC_COUNT: u32 = 6;
const HARMONIC_DECAY: f64 = 0.5;
/// Maximum number of rotors that are modeled separately.
const MAX_ROTORS: usize = 8;
/// Rotor speed at full level, rad/s. The level increases with the square of the speed, like thrust (estimate: a small
/// quadrotor in a climb).
const FULL_LEVEL_SPEED_RAD_S: f64 = 1_100.0;
/// Maximum distance with a constant level, m. Beyond it, the level decreases with distance, as for a point source
/// outdoors. A drone at 120 m remains audible on typical speakers (estimate).
const FULL_LEVEL_DISTANCE_M: f64 = 15.0;

/// Minimum rotor speed that produces sound, rad/s.
const MIN_ROTOR_SPEED_RAD_S: f64 = 1e-3;

/// One oscillator per rotor.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Propellers {
    rotors: [RotorOscillator; MAX_ROTORS],
    level: SmoothedValue,
    count: SmoothedValue,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct RotorOscillator {
    speed: SmoothedValue,
    /// Phase of the blade-pass fundamental, 0 to 1.
    phase: f64,
}

impl Propellers {
    /// Returns the next sample, in [-1, 1], for the given rotor speeds (rad/s) and distance (m).
    pub fn next(&mut self, rotors_rad_s: &[f64], distance_m: f64) -> f64 {
        let far = self.level.follow((FULL_LEVEL_DISTANCE_M / distance_m.max(FULL_LEVEL_DISTANCE_M)).clamp(0.0, 1.0));
        // Normalizes by the number of rotors, but at least by four, so a single rotor sounds quieter.
        let count = self.count.follow(rotors_rad_s.len().min(MAX_ROTORS) as f64).max(4.0);
        let mut sum = 0.0;
        for (k, rotor) in self.rotors.iter_mut().enumerate() {
            sum += rotor.next(rotors_rad_s.get(k).copied().unwrap_or(0.0));
        }
        far * sum / count
    }
}

impl RotorOscillator {
    fn next(&mut self, rad_s: f64) -> f64 {
        let wanted = if rad_s.is_finite() { rad_s.clamp(0.0, 2.0 * FULL_LEVEL_SPEED_RAD_S) } else { 0.0 };
        let speed = self.speed.follow(wanted);
        if wanted == 0.0 && speed < MIN_ROTOR_SPEED_RAD_S {
            return 0.0;
        }
        self.phase = (self.phase + BLADES_PER_PROPELLER * speed / math::TAU / f64::from(SAMPLE_RATE_HZ)).rem_euclid(1.0);
        let level = (speed / FULL_LEVEL_SPEED_RAD_S).min(1.0);
        let (mut sum, mut share, mut whole) = (0.0, 1.0, 0.0);
        for k in 1..=HARMONIC_COUNT {
            sum += share * math::sin(math::TAU * self.phase * f64::from(k));
            whole += share;
            share *= HARMONIC_DECAY;
        }
        level * level * sum / whole
    }
}
