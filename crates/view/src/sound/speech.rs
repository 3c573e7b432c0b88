//! Spoken words as one of the sources of the sound.

use super::smoothing::{SAMPLE_RATE_HZ, SmoothedValue};
use std::sync::Arc;

/// Level of the words. The other sources share the rest, about -9 dB of their own level, so that the words stand out (estimate).
pub(super) const SPEECH_LEVEL: f64 = 0.65;

/// Words that a speech synthesizer has spoken.
#[derive(Debug, Clone, PartialEq)]
pub struct SpokenWords {
    samples: Vec<f32>,
    rate_hz: u32,
}

impl SpokenWords {
    /// Creates words from samples, each in [-1, 1], and their rate.
    #[must_use]
    pub fn new(samples: Vec<f32>, rate_hz: u32) -> Self {
        Self { samples, rate_hz }
    }

    /// Returns the sample at a time, interpolated linearly; `None` after the end.
    fn at(&self, time_s: f64) -> Option<f64> {
        let position = time_s * f64::from(self.rate_hz);
        let before = *self.samples.get(position as usize)?;
        let after = self.samples.get(position as usize + 1).copied().unwrap_or_default();
        Some(f64::from(before) + position.fract() * f64::from(after - before))
    }
}

/// Speaks words, and makes room for them among the other sources.
#[derive(Debug, Clone, Default)]
pub(super) struct Speech {
    words: Option<Arc<SpokenWords>>,
    /// Samples since the words began.
    clock: u32,
    level: SmoothedValue,
}

impl Speech {
    /// Begins to speak, instead of the previous words.
    pub(super) fn say(&mut self, words: Arc<SpokenWords>) {
        (self.words, self.clock) = (Some(words), 0);
    }

    /// Mixes the words with the other sources, each at most 1 in magnitude, and so is the result. Drops the words at their end.
    pub(super) fn mix(&mut self, others: f64) -> f64 {
        let time_s = f64::from(self.clock) / f64::from(SAMPLE_RATE_HZ);
        let sample = self.words.as_ref().and_then(|words| words.at(time_s));
        match sample {
            Some(_) => self.clock += 1,
            None => self.words = None,
        }
        let level = self.level.follow(if sample.is_some() { SPEECH_LEVEL } else { 0.0 });
        (1.0 - level) * others + level * sample.unwrap_or_default()
    }
}
