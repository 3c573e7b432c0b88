//! Bandwidth budget of a slow link: tracks its capacity, scales the stream intervals, and decides when data waits or is
//! dropped.

use spandrel_model::time::SimTime;

/// Fraction of the link capacity available to streams; the rest is for responses, lists and files.
const STREAM_SHARE: f64 = 0.75;
/// Assumed stream frame size until one is measured, in bytes (estimate: mean of the shipped streams).
const ASSUMED_FRAME_BYTES: f64 = 50.0;
/// Maximum factor by which stream intervals are stretched.
const MAX_STRETCH: f64 = 200.0;
/// Maximum burst after an idle period, in seconds of link capacity, and its lower limit (one datagram), in bytes.
const MAX_BURST_S: f64 = 0.05;
const MIN_BURST_BYTES: f64 = 300.0;
/// Backlog above which lists and files wait, and streams and forwarded frames are skipped, in seconds of link capacity.
const SATURATED_BACKLOG_S: f64 = 0.25;
/// Backlog above which data is dropped, in seconds of link capacity.
const MAX_BACKLOG_S: f64 = 2.0;
/// Interval between adjustments of the stream intervals.
const ADJUST_INTERVAL: SimTime = SimTime::from_ms(1_000);

/// A link's capacity and current use.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkBudget {
    capacity_bytes_s: f64,
    tokens: f64,
    at: SimTime,
    last_adjusted: SimTime,
    streamed_bytes: f64,
    stretch: f64,
}

impl LinkBudget {
    /// Creates the budget for a link with a capacity of `capacity_bytes_s` bytes/s and streams that request `frames_s` frames/s.
    #[must_use]
    pub fn new(capacity_bytes_s: f64, frames_s: f64, now: SimTime) -> Self {
        let stretch = (frames_s * ASSUMED_FRAME_BYTES / (capacity_bytes_s * STREAM_SHARE)).clamp(1.0, MAX_STRETCH);
        Self { capacity_bytes_s, tokens: 0.0, at: now, last_adjusted: now, streamed_bytes: 0.0, stretch }
    }

    /// Refills the capacity up to `now`; once a second, adjusts the stream intervals to the measured usage.
    pub fn advance(&mut self, now: SimTime) {
        self.tokens = (self.tokens + self.capacity_bytes_s * (now - self.at).s())
            .min(MIN_BURST_BYTES.max(self.capacity_bytes_s * MAX_BURST_S));
        self.at = now;
        let window_s = (now - self.last_adjusted).s();
        if now - self.last_adjusted >= ADJUST_INTERVAL {
            let used = self.streamed_bytes / (window_s * self.capacity_bytes_s * STREAM_SHARE);
            // Move only halfway each time, so that a second with few slow streams does not make the intervals jump.
            self.stretch = (self.stretch * f64::midpoint(1.0, used)).clamp(1.0, MAX_STRETCH);
            self.streamed_bytes = 0.0;
            self.last_adjusted = now;
        }
    }

    /// Consumes a datagram's bytes if the link can send them now; returns false otherwise.
    pub fn take(&mut self, bytes: usize) -> bool {
        let free = self.tokens > 0.0;
        if free {
            self.tokens -= bytes as f64;
        }
        free
    }

    /// Counts bytes sent by streams.
    pub fn note_streamed(&mut self, bytes: usize) {
        self.streamed_bytes += bytes as f64;
    }

    /// Returns the factor by which stream intervals are stretched, at least 1.
    #[must_use]
    pub fn interval_factor(&self) -> f64 {
        self.stretch
    }

    /// Checks whether a backlog of `waiting` bytes is large enough to hold back more data.
    #[must_use]
    pub fn is_saturated(&self, waiting: usize) -> bool {
        waiting as f64 > self.capacity_bytes_s * SATURATED_BACKLOG_S
    }

    /// Returns the maximum backlog in bytes.
    #[must_use]
    pub fn max_backlog(&self) -> usize {
        (self.capacity_bytes_s * MAX_BACKLOG_S) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Capacity of a telemetry radio at 57,600 baud (8N1), bytes/s.
    const RADIO_BYTES_S: f64 = 5_760.0;
    /// Relative tolerance for the ten-second mean; datagrams are indivisible.
    const MEAN_RATE_TOLERANCE: f64 = 0.02;

    #[test]
    fn exact_output_matches_the_link_capacity() {
        let mut budget = LinkBudget::new(RADIO_BYTES_S, 0.0, SimTime::ZERO);
        let mut sent = 0;
        for ms in 1..=10_000 {
            budget.advance(SimTime::from_ms(ms));
            while budget.take(280) {
                sent += 280;
            }
        }
        assert!((f64::from(sent) / 10.0 / RADIO_BYTES_S - 1.0).abs() < MEAN_RATE_TOLERANCE, "{sent}");
    }

    #[test]
    fn exact_stream_rate_converges_to_its_share_from_both_sides() {
        for (frames_s, bytes) in [(400.0, 20), (100.0, 200)] {
            let mut budget = LinkBudget::new(RADIO_BYTES_S, frames_s, SimTime::ZERO);
            let mut asked = 0.0;
            for ms in 1..=60_000 {
                budget.advance(SimTime::from_ms(ms));
                asked += frames_s * bytes as f64 / 1_000.0 / budget.interval_factor();
                if asked >= bytes as f64 {
                    asked -= bytes as f64;
                    budget.note_streamed(bytes);
                }
            }
            let share = frames_s * bytes as f64 / budget.interval_factor() / RADIO_BYTES_S;
            assert!((share / STREAM_SHARE - 1.0).abs() < 0.1, "share {share}: only whole frames are counted each second");
        }
    }

    #[test]
    fn exact_fast_link_is_not_throttled() {
        assert_eq!(LinkBudget::new(1e6, 800.0, SimTime::ZERO).interval_factor(), 1.0);
    }
}
