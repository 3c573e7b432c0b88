//! Pauses and resumes the simulation at the parent process's request (`pause` and `resume` lines on standard input).

use super::stop::StopRequest;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Line that pauses the simulation.
pub const PAUSE_LINE: &str = "pause";
/// Line that resumes the simulation.
pub const RESUME_LINE: &str = "resume";

/// Pause flag, shared by all vehicles in a process.
#[derive(Debug, Clone, Default)]
pub struct PauseSwitch(Arc<AtomicBool>);

impl PauseSwitch {
    /// Handles `pause` and `resume` lines on standard input. When standard input closes, requests a stop.
    pub fn listen(stop: &StopRequest) -> Self {
        let (still, lines) = (Self::default(), stop.lines());
        let heeding = still.clone();
        std::thread::spawn(move || {
            for line in lines {
                match line.trim() {
                    PAUSE_LINE => heeding.0.store(true, Ordering::Relaxed),
                    RESUME_LINE => heeding.0.store(false, Ordering::Relaxed),
                    other => tracing::warn!("ignored '{other}' on standard input (allowed: {PAUSE_LINE}, {RESUME_LINE})"),
                }
            }
        });
        still
    }

    /// Returns true while the simulation is paused.
    pub fn is_paused(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
