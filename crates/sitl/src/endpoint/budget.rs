//! What a slow link carries: bytes a second, what that leaves to the streams, and what has to wait or is dropped.

use spandrel_model::time::SimTime;

/// Part of the link that streams may fill; the rest is for answers, lists and files.
const STREAMS_SHARE: f64 = 0.75;
/// A stream frame before any was seen, bytes (estimate: the shipped streams' mean).
const FRAME_BYTES: f64 = 50.0;
/// Streams are slowed by this at most.
const SLOWEST: f64 = 200.0;
/// What may leave at once after a silence, s of the link's capacity, and at least one datagram, bytes.
const BURST_S: f64 = 0.05;
const BURST_BYTES: f64 = 300.0;
/// More waiting than this, s of the link's capacity: lists and files wait, streams and forwarded frames are left out.
const BUSY_S: f64 = 0.25;
/// More waiting than this is dropped, s of the link's capacity.
const FULL_S: f64 = 2.0;
/// The streams' share is looked at this often.
const LOOK: SimTime = SimTime::from_ms(1_000);

/// A link's capacity and its use.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkBudget {
    bytes_s: f64,
    tokens: f64,
    at: SimTime,
    last_adjusted: SimTime,
    streamed: f64,
    stretch: f64,
}

impl LinkBudget {
    /// A link of so many bytes a second, whose streams would send `frames_s` frames a second.
    #[must_use]
    pub fn new(bytes_s: f64, frames_s: f64, now: SimTime) -> Self {
        let stretch = (frames_s * FRAME_BYTES / (bytes_s * STREAMS_SHARE)).clamp(1.0, SLOWEST);
        Self { bytes_s, tokens: 0.0, at: now, last_adjusted: now, streamed: 0.0, stretch }
    }

    /// Time passes: capacity grows again; once a second the streams' pace follows what they took.
    pub fn advance(&mut self, now: SimTime) {
        self.tokens = (self.tokens + self.bytes_s * (now - self.at).s()).min(BURST_BYTES.max(self.bytes_s * BURST_S));
        self.at = now;
        let window_s = (now - self.last_adjusted).s();
        if now - self.last_adjusted >= LOOK {
            let used = self.streamed / (window_s * self.bytes_s * STREAMS_SHARE);
            // Half of the way each time: a second with few slow streams in it must not throw the pace about.
            self.stretch = (self.stretch * f64::midpoint(1.0, used)).clamp(1.0, SLOWEST);
            self.streamed = 0.0;
            self.last_adjusted = now;
        }
    }

    /// Takes a datagram's bytes if the link can carry them now.
    pub fn take(&mut self, bytes: usize) -> bool {
        let free = self.tokens > 0.0;
        if free {
            self.tokens -= bytes as f64;
        }
        free
    }

    /// Streams sent so many bytes.
    pub fn note_streamed(&mut self, bytes: usize) {
        self.streamed += bytes as f64;
    }

    /// How many times slower than asked the streams run.
    #[must_use]
    pub fn interval_factor(&self) -> f64 {
        self.stretch
    }

    /// So many waiting bytes are enough for now.
    #[must_use]
    pub fn is_saturated(&self, waiting: usize) -> bool {
        waiting as f64 > self.bytes_s * BUSY_S
    }

    /// No more than this may wait, bytes.
    #[must_use]
    pub fn most_waiting(&self) -> usize {
        (self.bytes_s * FULL_S) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A telemetry radio at 57,600 baud, 8N1, bytes a second.
    const RADIO: f64 = 5_760.0;
    /// Of the mean over ten seconds; datagrams are not divisible.
    const TOLERANCE: f64 = 0.02;

    #[test]
    fn exact_what_leaves_is_what_the_link_carries() {
        let mut budget = LinkBudget::new(RADIO, 0.0, SimTime::ZERO);
        let mut sent = 0;
        for ms in 1..=10_000 {
            budget.advance(SimTime::from_ms(ms));
            while budget.take(280) {
                sent += 280;
            }
        }
        assert!((f64::from(sent) / 10.0 / RADIO - 1.0).abs() < TOLERANCE, "{sent}");
    }

    #[test]
    fn exact_streams_settle_at_their_share_of_the_link_from_either_side() {
        for (frames_s, bytes) in [(400.0, 20), (100.0, 200)] {
            let mut budget = LinkBudget::new(RADIO, frames_s, SimTime::ZERO);
            let mut asked = 0.0;
            for ms in 1..=60_000 {
                budget.advance(SimTime::from_ms(ms));
                asked += frames_s * bytes as f64 / 1_000.0 / budget.interval_factor();
                if asked >= bytes as f64 {
                    asked -= bytes as f64;
                    budget.note_streamed(bytes);
                }
            }
            let share = frames_s * bytes as f64 / budget.interval_factor() / RADIO;
            assert!((share / STREAMS_SHARE - 1.0).abs() < 0.1, "{share}: whole frames in one second's count");
        }
    }

    #[test]
    fn exact_a_fast_link_is_not_slowed() {
        assert_eq!(LinkBudget::new(1e6, 800.0, SimTime::ZERO).interval_factor(), 1.0);
    }
}
