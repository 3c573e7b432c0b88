//! Logs on standard error; standard output is reserved for results.

use std::io::{IsTerminal, stderr};
use tracing::Level;
use tracing_subscriber::EnvFilter;

/// Starts logging at this level. The libraries below speak up from warnings on; those of windows and graphics drivers tell the loader's and
/// the display's troubles one by one, which the one message of the view sums up: they speak when somebody looks for a fault.
pub fn start(level: Level) {
    let graphics = if level > Level::INFO { "" } else { ",winit=error,wgpu_hal=off" };
    let filter = EnvFilter::new(format!("warn{graphics},spandrel={level}").to_lowercase());
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
