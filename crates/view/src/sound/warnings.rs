//! Warning tones, distinguished by pitch and rhythm. Only the tone of the most serious warning sounds.

use super::smoothing::SAMPLE_RATE_HZ;
use crate::hud::DisplayStyle;
use spandrel_mavlink::contract::cue::{self, CueTexts};
use spandrel_model::math;
use spandrel_text::monitor_texts::Warning;
use spandrel_text::{Language, text};

/// Duration of a tone's attack and release, s: long enough to avoid clicks, short enough for a clear onset.
const FADE_DURATION_S: f64 = 0.008;

/// Tone of a cue: pitch (Hz), on-time (s), and period (s).
struct Tone {
    cue: i32,
    hz: f64,
    on_time_s: f64,
    period_s: f64,
}

/// Tones in order of severity. Pitches and rhythms are estimates: a fifth or more apart, with faster rhythms for more
/// urgent warnings (modeled on the bursts in ISO 7731 and IEC 60601-1-8). Both cues about the position have the same pitch.
const TONES: [Tone; 6] = [
    Tone { cue: cue::CRASH, hz: 220.0, on_time_s: 0.35, period_s: 0.5 },
    Tone { cue: cue::TOO_CLOSE, hz: 1_050.0, on_time_s: 0.09, period_s: 0.18 },
    Tone { cue: cue::SPEEDING, hz: 700.0, on_time_s: 0.15, period_s: 0.6 },
    Tone { cue: cue::STAND_OFF, hz: 440.0, on_time_s: 0.1, period_s: 1.2 },
    Tone { cue: cue::OFF_PATH, hz: 440.0, on_time_s: 0.25, period_s: 1.2 },
    Tone { cue: cue::BATTERY_RED, hz: 330.0, on_time_s: 0.4, period_s: 3.0 },
];

/// Returns the spoken warning for the most serious cue that has just become active: the text that is displayed, with its
/// units in words.
#[must_use]
pub fn spoken(before: i32, now: i32, texts: &CueTexts, style: DisplayStyle) -> Option<String> {
    let new = cue::displayed(now) & !cue::displayed(before);
    let tone = TONES.iter().find(|tone| new & tone.cue != 0)?;
    let warning = Warning::of_text(texts.text(tone.cue)?, style.language, |name| name)?;
    Some(units_in_words(&style.units.words(&warning.words), style.language))
}

fn units_in_words(text: &str, language: Language) -> String {
    let spoken = |word: &str| {
        let (unit, mark) = word.strip_suffix([':', ',']).map_or((word, ""), |unit| (unit, &word[unit.len()..]));
        match unit_in_words(unit, language) {
            Some(words) => format!("{words}{mark}"),
            None => word.replace('%', &format!(" {}", text!(language, "flight-spoken-percent"))),
        }
    };
    text.split(' ').map(spoken).collect::<Vec<_>>().join(" ")
}

/// Returns how a unit is spoken; `None` for other words.
fn unit_in_words(unit: &str, language: Language) -> Option<String> {
    Some(match unit {
        "m" => text!(language, "flight-spoken-meters"),
        "ft" => text!(language, "flight-spoken-feet"),
        "mph" => text!(language, "flight-spoken-miles-per-hour"),
        "m/s" => text!(language, "flight-spoken-meters-per-second"),
        _ => return None,
    })
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
