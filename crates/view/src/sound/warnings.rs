//! Warning tones, distinguished by pitch and rhythm. Only the tone of the most serious warning sounds.

use super::smoothing::SAMPLE_RATE_HZ;
use crate::hud::{DisplayStyle, StatusAlarm, StatusAlarms};
use spandrel_mavlink::contract::cue::{self, CueTexts};
use spandrel_model::math;
use spandrel_text::monitor_texts::Warning;
use spandrel_text::{Language, text};

/// Duration of a tone's attack and release, s: long enough to avoid clicks, short enough for a clear onset.
const FADE_DURATION_S: f64 = 0.008;

/// Alarms that are displayed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ActiveAlarms {
    /// Mask of active cues, as in the HUD.
    pub cues: i32,
    /// Alarms of the links and satellites.
    pub status: StatusAlarms,
}

impl ActiveAlarms {
    /// Returns the alarms that were not active before.
    fn since(self, before: Self) -> Self {
        Self { cues: cue::displayed(self.cues) & !cue::displayed(before.cues), status: self.status.without(before.status) }
    }

    fn contains(self, source: ToneSource) -> bool {
        match source {
            ToneSource::Cue(cue) => self.cues & cue != 0,
            ToneSource::Status(alarm) => self.status.contains(alarm),
        }
    }
}

/// Alarm that a tone belongs to.
#[derive(Debug, Clone, Copy, PartialEq)]
enum ToneSource {
    Cue(i32),
    Status(StatusAlarm),
}

/// Tone of an alarm: pitch (Hz), on-time (s), and period (s).
struct Tone {
    source: ToneSource,
    hz: f64,
    on_time_s: f64,
    period_s: f64,
}

const fn cue_tone(cue: i32, hz: f64, on_time_s: f64, period_s: f64) -> Tone {
    Tone { source: ToneSource::Cue(cue), hz, on_time_s, period_s }
}

const fn status_tone(alarm: StatusAlarm, hz: f64, on_time_s: f64, period_s: f64) -> Tone {
    Tone { source: ToneSource::Status(alarm), hz, on_time_s, period_s }
}

/// Tones in order of severity; without a link, all other alarms are of unknown age. Pitches and rhythms are estimates: a fourth or
/// more apart, with faster rhythms for more urgent warnings (modeled on the bursts in ISO 7731 and IEC 60601-1-8). Both cues
/// about the position have the same pitch, and so have all alarms about the links.
const TONES: [Tone; 10] = [
    status_tone(StatusAlarm::LinkLost, 1_575.0, 0.3, 0.5),
    cue_tone(cue::CRASH, 220.0, 0.35, 0.5),
    cue_tone(cue::TOO_CLOSE, 1_050.0, 0.09, 0.18),
    cue_tone(cue::SPEEDING, 700.0, 0.15, 0.6),
    status_tone(StatusAlarm::ControlWeak, 1_575.0, 0.1, 1.0),
    cue_tone(cue::STAND_OFF, 440.0, 0.1, 1.2),
    cue_tone(cue::OFF_PATH, 440.0, 0.25, 1.2),
    status_tone(StatusAlarm::GnssLost, 2_100.0, 0.1, 1.5),
    status_tone(StatusAlarm::VideoWeak, 1_575.0, 0.1, 2.0),
    cue_tone(cue::BATTERY_RED, 330.0, 0.4, 3.0),
];

/// Returns the spoken warning for the most serious alarm that has just become active: the text that is displayed, with its
/// units in words.
#[must_use]
pub fn spoken(before: ActiveAlarms, now: ActiveAlarms, texts: &CueTexts, style: DisplayStyle) -> Option<String> {
    let new = now.since(before);
    match TONES.iter().find(|tone| new.contains(tone.source))?.source {
        ToneSource::Cue(cue) => {
            let warning = Warning::of_text(texts.text(cue)?, style.language, |name| name)?;
            Some(units_in_words(&style.units.words(&warning.words), style.language))
        }
        ToneSource::Status(alarm) => Some(spoken_status(alarm, style.language)),
    }
}

fn spoken_status(alarm: StatusAlarm, language: Language) -> String {
    match alarm {
        StatusAlarm::LinkLost => text!(language, "flight-spoken-link-lost"),
        StatusAlarm::GnssLost => text!(language, "flight-spoken-gnss-lost"),
        StatusAlarm::ControlWeak => text!(language, "flight-spoken-control-weak"),
        StatusAlarm::VideoWeak => text!(language, "flight-spoken-video-weak"),
    }
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
    /// Returns the next sample, in [-1, 1], for the given active alarms.
    pub fn next(&mut self, alarms: ActiveAlarms) -> f64 {
        let step_s = 1.0 / f64::from(SAMPLE_RATE_HZ);
        let wanted = TONES.iter().position(|tone| alarms.contains(tone.source));
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
