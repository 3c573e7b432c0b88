//! Renders a flight's photographs in the background, for its folder and its report.

use crate::io::children::software_renderer_threads;
use crate::io::stop::StopRequest;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// Interval at which the rendering processes are checked.
const CHECK_INTERVAL: Duration = Duration::from_millis(50);

/// Rendering processes that have not finished.
#[derive(Default)]
pub struct PhotographJobs(Vec<Child>);

impl PhotographJobs {
    /// Starts rendering a session's photographs. If that fails, the report shows placeholders, as it does without a
    /// window.
    pub fn draw(&mut self, session: &Path) {
        let started = std::env::current_exe().and_then(|program| {
            let (threads, few) = software_renderer_threads();
            let mut command = Command::new(program);
            command.args(["--log", "warn", "render"]).arg(session).args(["--snapshots", "--nice"]);
            command.env(threads, few).stdin(Stdio::null()).stdout(Stdio::null()).spawn()
        });
        match started {
            Ok(child) => self.0.push(child),
            Err(error) => tracing::warn!("cannot render the photographs of {}: {error}", session.display()),
        }
    }

    /// Waits until all photographs are rendered; a stop request cancels the remaining ones.
    pub fn finish(&mut self, stop: &StopRequest) {
        self.0.retain_mut(|child| matches!(child.try_wait(), Ok(None)));
        if !self.0.is_empty() && !stop.is_requested() {
            tracing::info!("rendering the photographs for the report; press Ctrl-C to skip");
        }
        while !self.0.is_empty() && !stop.is_requested() {
            std::thread::sleep(CHECK_INTERVAL);
            self.0.retain_mut(|child| matches!(child.try_wait(), Ok(None)));
        }
        for mut child in self.0.drain(..) {
            // The process may have just exited.
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}
