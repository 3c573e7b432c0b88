//! The photographs of a flight, drawn into its folder and its report while nobody waits for them.

use super::window::spare_threads;
use crate::io::stop::StopRequest;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// Between two looks at who draws.
const LOOK: Duration = Duration::from_millis(50);

/// Drawings that have not been finished.
#[derive(Default)]
pub struct PhotographJobs(Vec<Child>);

impl PhotographJobs {
    /// Begins with a session's. Where nothing can be drawn its report has places instead of pictures, as without a window.
    pub fn draw(&mut self, session: &Path) {
        let started = std::env::current_exe().and_then(|program| {
            let (threads, few) = spare_threads();
            let mut command = Command::new(program);
            command.args(["--log", "warn", "render"]).arg(session).args(["--snapshots", "--nice"]);
            command.env(threads, few).stdin(Stdio::null()).stdout(Stdio::null()).spawn()
        });
        match started {
            Ok(child) => self.0.push(child),
            Err(error) => tracing::warn!("the photographs of {} are not drawn: {error}", session.display()),
        }
    }

    /// Waits until all are drawn; who interrupts leaves the rest undrawn.
    pub fn finish(&mut self, stop: &StopRequest) {
        self.0.retain_mut(|child| matches!(child.try_wait(), Ok(None)));
        if !self.0.is_empty() && !stop.is_requested() {
            tracing::info!("the photographs are being drawn into the report; Ctrl-C leaves them");
        }
        while !self.0.is_empty() && !stop.is_requested() {
            std::thread::sleep(LOOK);
            self.0.retain_mut(|child| matches!(child.try_wait(), Ok(None)));
        }
        for mut child in self.0.drain(..) {
            // It may have ended just now.
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}
