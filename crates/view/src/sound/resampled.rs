//! Converts the synthesizer's samples to the sample rate of an audio device.

use super::{FlightSound, SAMPLE_RATE_HZ};

/// Samples that are synthesized at once.
const CHUNK: usize = SAMPLE_RATE_HZ as usize / 200;

/// Sound of a flight at any sample rate. Interpolates linearly, which suffices because the highest frequency is far below half
/// the synthesizer's rate.
#[derive(Debug, Clone)]
pub struct ResampledSound {
    flight: FlightSound,
    chunk: [f32; CHUNK],
    /// Index of the next sample in the chunk.
    next: usize,
    /// Samples before and after the current position.
    pair: [f32; 2],
    /// Position between the two samples in units of `1 / rate_hz`, so that no rounding error adds up.
    position: u32,
    rate_hz: u32,
}

impl ResampledSound {
    /// Creates the state of a silent flight.
    #[must_use]
    pub fn new(rate_hz: u32) -> Self {
        let flight = FlightSound::default();
        Self { flight, chunk: [0.0; CHUNK], next: CHUNK, pair: [0.0; 2], position: 0, rate_hz: rate_hz.max(1) }
    }

    /// Returns the synthesizer.
    pub fn flight(&mut self) -> &mut FlightSound {
        &mut self.flight
    }

    /// Returns the next sample, in [-1, 1].
    pub fn next_sample(&mut self) -> f32 {
        while self.position >= self.rate_hz {
            self.position -= self.rate_hz;
            self.pair = [self.pair[1], self.synthesized()];
        }
        let share = f64::from(self.position) / f64::from(self.rate_hz);
        self.position += SAMPLE_RATE_HZ;
        let [before, after] = self.pair.map(f64::from);
        (before + share * (after - before)) as f32
    }

    fn synthesized(&mut self) -> f32 {
        if self.next >= CHUNK {
            self.flight.fill(&mut self.chunk);
            self.next = 0;
        }
        let sample = self.chunk.get(self.next).copied().unwrap_or_default();
        self.next += 1;
        sample
    }
}
