//! The only place that reads clocks.

use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// A stopwatch on the monotonic clock.
#[derive(Debug, Clone, Copy)]
pub struct Stopwatch(Instant);

impl Stopwatch {
    /// Starts now.
    #[expect(clippy::disallowed_methods, reason = "the shell's one reading of the monotonic clock")]
    pub fn start() -> Self {
        Self(Instant::now())
    }

    /// Wall time since the start.
    pub fn elapsed(self) -> Duration {
        self.0.elapsed()
    }
}

/// Wall time, µs since the Unix epoch.
#[expect(clippy::disallowed_methods, reason = "the shell's one reading of the wall clock")]
pub fn unix_us() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    u64::try_from(since.as_micros()).unwrap_or(u64::MAX)
}

/// UTC for people and file names: (RFC 3339 with seconds, compact `YYYYMMDDThhmmssZ`).
pub fn utc(unix_us: u64) -> (String, String) {
    let time = i64::try_from(unix_us).ok().and_then(|us| jiff::Timestamp::from_microsecond(us).ok()).unwrap_or_default();
    (time.strftime("%Y-%m-%dT%H:%M:%SZ").to_string(), time.strftime("%Y%m%dT%H%M%SZ").to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_utc_of_a_known_instant() {
        let (readable, compact) = utc(1_700_000_000_000_000);
        assert_eq!(readable, "2023-11-14T22:13:20Z");
        assert_eq!(compact, "20231114T221320Z");
    }
}
