//! Times several runs and keeps the fastest, which is least affected by other load on the machine.

use std::hint::black_box;
use std::time::Duration;

/// Returns the shortest wall time of `rounds` runs.
#[expect(clippy::disallowed_methods, reason = "benchmarks measure wall time")]
pub fn best<T>(rounds: usize, mut work: impl FnMut() -> T) -> Duration {
    let once = |_| {
        let start = std::time::Instant::now();
        black_box(work());
        start.elapsed()
    };
    (0..rounds).map(once).min().unwrap_or_default()
}
