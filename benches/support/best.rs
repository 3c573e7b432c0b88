//! The best of several runs: what a shared machine's other work disturbs least.

use std::hint::black_box;
use std::time::Duration;

/// Least wall time of so many runs.
#[expect(clippy::disallowed_methods, reason = "a bench measures wall time")]
pub fn best<T>(rounds: usize, mut work: impl FnMut() -> T) -> Duration {
    let once = |_| {
        let start = std::time::Instant::now();
        black_box(work());
        start.elapsed()
    };
    (0..rounds).map(once).min().unwrap_or_default()
}
