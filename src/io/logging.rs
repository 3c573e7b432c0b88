//! Sets up logging on standard error; standard output is reserved for results.

use std::io::{IsTerminal, stderr};
use tracing::Level;
use tracing_subscriber::EnvFilter;

/// Starts logging at this level. Dependencies log only warnings and errors. Messages from the window and graphics
/// libraries appear only at the debug and trace levels, because the view already reports driver problems in a single
/// message.
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
    // In tests, a second call keeps the first call's settings.
    drop(done);
}
