//! Warning tones, distinguished by pitch and rhythm. Only the tone of the most serious warning sounds.

use super::smoothing::SAMPLE_RATE_HZ;
use spandrel_mavlink::contract::cue;
use spandrel_model::math;

/// Duration of a tone's attack and release, s: long enough to avoid clicks, short enough for a clear onset.
const FADE_DURATION_S: f64 = 0.008;

/// Tone of a cue: pitch (Hz), on-time (s), and period (s).
struct Tone {
    cue: i32,
    hz: f64,
    on_time_s: f64,
    period_s: f64,
    speech: &'static str,
}

/// Tones in order of severity. Pitches and rhythms are estimates: a fifth or more apart, with faster rhythms for more
/// urgent warnings (modeled on the bursts in ISO 7731 and IEC 60601-1-8).
const TONES: [Tone; 5] = [
    Tone { cue: cue::CRASH, hz: 220.0, on_time_s: 0.35, period_s: 0.5, speech: "Crash" },
    Tone { cue: cue::TOO_CLOSE, hz: 1_050.0, on_time_s: 0.09, period_s: 0.18, speech: "Too close" },
    Tone { cue: cue::SPEEDING, hz: 700.0, on_time_s: 0.15, period_s: 0.6, speech: "Too fast" },
    Tone { cue: cue::OFF_PATH, hz: 440.0, on_time_s: 0.25, period_s: 1.2, speech: "Off the path" },
    Tone { cue: cue::BATTERY_RED, hz: 330.0, on_time_s: 0.4, period_s: 3.0, speech: "Battery low" },
];

/// Returns the spoken warning for the most serious cue that has just become active.
#[must_use]
pub fn spoken(before: i32, now: i32) -> Option<&'static str> {
    TONES.iter().find(|tone| now & !before & tone.cue != 0).map(|tone| tone.speech)
}

/// Oscillator of the warning tones.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WarningTones {
    tone: Option<usize>,
    clock_s: f64,
    phase: f64,
    gate: f64,
}

impl WarningTones {
    /// Returns the next sample, in [-1, 1], for the given active cues.
    pub fn next(&mut self, cues: i32) -> f64 {
        let step_s = 1.0 / f64::from(SAMPLE_RATE_HZ);
        let wanted = TONES.iter().position(|tone| cues & tone.cue != 0);
        // A different tone starts after the current one has faded out.
        if wanted != self.tone && self.gate <= 0.0 {
            (self.tone, self.clock_s) = (wanted, 0.0);
        }
        let Some(tone) = self.tone.map(|k| &TONES[k]) else { return 0.0 };
        let sounds = wanted == self.tone && self.clock_s.rem_euclid(tone.period_s) < tone.on_time_s;
        let way = if sounds { 1.0 } else { -1.0 };
        self.gate = (self.gate + way * step_s / FADE_DURATION_S).clamp(0.0, 1.0);
        self.clock_s += step_s;
        self.phase = (self.phase + tone.hz * step_s).rem_euclid(1.0);
        // A raised cosine is smooth at both ends.
        let level = 0.5 - 0.5 * math::cos(math::PI * self.gate);
        level * math::sin(math::TAU * self.phase)
    }
}
