//! Reads the system clocks. No other file reads them.

pub use spandrel_model::calendar::utc;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// Stopwatch on the monotonic clock.
#[derive(Debug, Clone, Copy)]
pub struct Stopwatch(Instant);

impl Stopwatch {
    /// Starts a stopwatch at zero.
    #[expect(clippy::disallowed_methods, reason = "the only read of the monotonic clock")]
    pub fn start() -> Self {
        Self(Instant::now())
    }

    /// Returns the wall time since the start.
    pub fn elapsed(self) -> Duration {
        self.0.elapsed()
    }
}

/// Returns the wall time in µs since the Unix epoch.
#[expect(clippy::disallowed_methods, reason = "the only read of the wall clock")]
pub fn unix_us() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    u64::try_from(since.as_micros()).unwrap_or(u64::MAX)
}
