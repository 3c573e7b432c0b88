//! What a trainee hears, as samples: propellers by the rotors' speeds, tones for warnings. Pure; whoever plays it decides what time it is.

mod propellers;
mod warnings;

pub use warnings::spoken;

use propellers::Propellers;
use warnings::WarningTones;

/// Samples a second: twice and more what the highest harmonic has.
pub const RATE_HZ: u32 = 24_000;
/// Levels change no faster than within this, s (estimate: quicker than a motor, slow enough to make no click).
const SLEW_S: f64 = 0.02;
/// Share of the full level that each part may take, so that nothing is ever clipped.
const PROPELLERS: f64 = 0.5;
const WARNINGS: f64 = 0.45;

/// What is on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoundSettings {
    /// Propellers.
    pub propellers: bool,
    /// Tones for warnings.
    pub warnings: bool,
    /// Warnings in words.
    pub speech: bool,
    /// How loud, 0 to 1.
    pub volume: f64,
}

impl Default for SoundSettings {
    fn default() -> Self {
        Self { propellers: true, warnings: true, speech: false, volume: 0.7 }
    }
}

/// What there is to hear now.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SoundInputs {
    /// Speeds of the rotors, rad/s; empty: nobody has said.
    pub rotors_rad_s: Vec<f64>,
    /// From the inspector to the drone, m.
    pub distance_m: f64,
    /// Mask of cues, as the display shows them.
    pub cues: i32,
    /// All is silent: switched off, or time stands still.
    pub silent: bool,
}

/// A value that follows another one without a jump.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct SmoothedValue(f64);

impl SmoothedValue {
    /// One sample on.
    fn follow(&mut self, target: f64) -> f64 {
        self.0 += (target - self.0) / (SLEW_S * f64::from(RATE_HZ));
        self.0
    }
}

/// The sound of a flight.
#[derive(Debug, Clone, Default)]
pub struct FlightSound {
    settings: SoundSettings,
    inputs: SoundInputs,
    propellers: Propellers,
    warnings: WarningTones,
    volume: SmoothedValue,
}

impl FlightSound {
    /// Silent until something is heard.
    #[must_use]
    pub fn new(settings: SoundSettings) -> Self {
        Self { settings, ..Self::default() }
    }

    /// What there is to hear from now on.
    pub fn set(&mut self, heard: SoundInputs) {
        self.inputs = heard;
    }

    /// The next samples, each within -1 and 1.
    pub fn fill(&mut self, out: &mut [f32]) {
        let Self { settings, inputs: heard, propellers, warnings, volume } = self;
        for sample in out {
            let loud = volume.follow(if heard.silent { 0.0 } else { settings.volume.clamp(0.0, 1.0) });
            let rotors: &[f64] = if settings.propellers { &heard.rotors_rad_s } else { &[] };
            let cues = if settings.warnings { heard.cues } else { 0 };
            let mixed = PROPELLERS * propellers.next(rotors, heard.distance_m) + WARNINGS * warnings.next(cues);
            *sample = (loud * mixed) as f32;
        }
    }
}

#[cfg(test)]
mod tests;
