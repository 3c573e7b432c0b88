//! Logs on standard error; standard output belongs to results.

use std::io::{IsTerminal, stderr};
use tracing::Level;
use tracing_subscriber::EnvFilter;

/// Starts logging at this level. The libraries below speak up from warnings on.
pub fn start(level: Level) {
    let filter = EnvFilter::new(format!("warn,spandrel={level}").to_lowercase());
    let done = tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(stderr)
        .with_ansi(stderr().is_terminal())
        .with_target(false)
        .without_time()
        .try_init();
    // A second start (tests) keeps the first one's settings.
    drop(done);
}
