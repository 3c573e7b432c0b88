//! Sound of a flight as samples: propellers from the rotor speeds, warning tones, and spoken words. It has no side effects; the
//! caller provides the time base and the words' samples.

mod propellers;
mod resampled;
mod smoothing;
mod speech;
mod warnings;

pub use resampled::ResampledSound;
pub use smoothing::SAMPLE_RATE_HZ;
pub use speech::SpokenWords;
pub use warnings::{ActiveAlarms, spoken};

use crate::hud::{DisplayStyle, StatusAlarm};
use propellers::Propellers;
use smoothing::SmoothedValue;
use spandrel_mavlink::contract::cue::CueTexts;
use speech::Speech;
use std::sync::Arc;
use warnings::WarningTones;

/// Fraction of full scale available to each of the signals; prevents clipping.
const PROPELLER_LEVEL: f64 = 0.5;
const WARNING_LEVEL: f64 = 0.45;

/// Sound settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoundSettings {
    /// Whether propeller sound is on.
    pub propellers: bool,
    /// Whether warning tones are on.
    pub warnings: bool,
    /// Whether spoken warnings are on.
    pub speech: bool,
    /// Volume, 0 to 1.
    pub volume: f64,
}

impl Default for SoundSettings {
    fn default() -> Self {
        Self { propellers: true, warnings: true, speech: false, volume: 0.7 }
    }
}

/// Inputs for sound synthesis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SoundInputs {
    /// Rotor speeds, rad/s; empty if unknown.
    pub rotors_rad_s: Vec<f64>,
    /// Distance from the inspector to the drone, m.
    pub distance_m: f64,
    /// Active alarms, as in the HUD.
    pub alarms: ActiveAlarms,
    /// The monitor's texts for the active cues.
    pub cue_texts: CueTexts,
    /// Language and units in which the texts are displayed and spoken.
    pub style: DisplayStyle,
    /// Whether all sound is off, because it is muted or the flight is paused.
    pub silent: bool,
}

impl SoundInputs {
    /// Mutes a frozen flight. Without a link, the rotor speeds are unknown; the alarm of the lost link sounds, also in a freeze.
    #[must_use]
    pub fn with_freeze(self, is_frozen: bool) -> Self {
        let is_lost = self.alarms.status.contains(StatusAlarm::LinkLost);
        Self {
            rotors_rad_s: if is_lost { Vec::new() } else { self.rotors_rad_s },
            silent: self.silent || (is_frozen && !is_lost),
            ..self
        }
    }
}

/// Sound synthesizer for a flight.
#[derive(Debug, Clone, Default)]
pub struct FlightSound {
    settings: SoundSettings,
    inputs: SoundInputs,
    propellers: Propellers,
    warnings: WarningTones,
    speech: Speech,
    volume: SmoothedValue,
}

impl FlightSound {
    /// Creates the state of a silent flight.
    #[must_use]
    pub fn new(settings: SoundSettings) -> Self {
        Self { settings, ..Self::default() }
    }

    /// Changes the settings.
    pub fn set_settings(&mut self, settings: SoundSettings) {
        self.settings = settings;
    }

    /// Sets the current inputs.
    pub fn set(&mut self, heard: SoundInputs) {
        self.inputs = heard;
    }

    /// Begins to speak words, instead of the previous ones.
    pub fn say(&mut self, words: Arc<SpokenWords>) {
        self.speech.say(words);
    }

    /// Writes the next samples, each in [-1, 1].
    pub fn fill(&mut self, out: &mut [f32]) {
        let Self { settings, inputs: heard, propellers, warnings, speech, volume } = self;
        for sample in out {
            let loud = volume.follow(if heard.silent { 0.0 } else { settings.volume.clamp(0.0, 1.0) });
            let rotors: &[f64] = if settings.propellers { &heard.rotors_rad_s } else { &[] };
            let alarms = if settings.warnings { heard.alarms } else { ActiveAlarms::default() };
            let signals = PROPELLER_LEVEL * propellers.next(rotors, heard.distance_m) + WARNING_LEVEL * warnings.next(alarms);
            *sample = (loud * speech.mix(signals)) as f32;
        }
    }
}

#[cfg(test)]
mod tests;
