//! Time that stands still because the parent process says so: lines `pause` and `resume` on standard input.

use super::stop::StopRequest;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The line that stops time.
pub const PAUSE: &str = "pause";
/// The line that lets it run again.
pub const RESUME: &str = "resume";

/// Whether time stands still, shared by all vehicles of a process.
#[derive(Debug, Clone, Default)]
pub struct PauseSwitch(Arc<AtomicBool>);

impl PauseSwitch {
    /// Does from now on what standard input says; its end ends the process.
    pub fn listen(stop: &StopRequest) -> Self {
        let (still, lines) = (Self::default(), stop.lines());
        let heeding = still.clone();
        std::thread::spawn(move || {
            for line in lines {
                match line.trim() {
                    PAUSE => heeding.0.store(true, Ordering::Relaxed),
                    RESUME => heeding.0.store(false, Ordering::Relaxed),
                    other => tracing::warn!("'{other}' on standard input is left alone (allowed: {PAUSE}, {RESUME})"),
                }
            }
        });
        still
    }

    /// It stands still now.
    pub fn is_paused(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
