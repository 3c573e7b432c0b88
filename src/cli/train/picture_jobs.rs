//! Renders a flight's photographs and its video in the background, for its folder and its report.

use super::args::VideoMode;
use crate::io::children::software_renderer_threads;
use crate::io::stop::StopRequest;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// Interval at which the rendering processes are checked.
const CHECK_INTERVAL: Duration = Duration::from_millis(50);
/// Size and rate of the video: enough to see what the trainee saw, at a hundredth of the work of a photograph per picture.
const VIDEO_OPTIONS: [&str; 6] = ["--size", "960x540", "--fps", "10", "--quality", "low"];

/// Rendering processes that have not finished.
#[derive(Default)]
pub struct PictureJobs(Vec<Child>);

impl PictureJobs {
    /// Starts rendering a session's photographs. If that fails, the report shows placeholders, as it does without a
    /// window.
    pub fn draw_photographs(&mut self, session: &Path) {
        self.start(session, &["--snapshots"], "photographs");
    }

    /// Starts rendering a session's video. If that fails, the report has none.
    pub fn draw_video(&mut self, session: &Path, mode: VideoMode) {
        let mut options = vec!["--video"];
        match mode {
            VideoMode::On => {}
            VideoMode::Auto => options.push("--only-with-gpu"),
            VideoMode::Off => return,
        }
        options.extend(VIDEO_OPTIONS);
        self.start(session, &options, "video");
    }

    fn start(&mut self, session: &Path, options: &[&str], what: &str) {
        let started = std::env::current_exe().and_then(|program| {
            let (threads, few) = software_renderer_threads();
            let mut command = Command::new(program);
            command.args(["--log", "warn", "render"]).arg(session).args(options).arg("--nice");
            command.env(threads, few).stdin(Stdio::null()).stdout(Stdio::null()).spawn()
        });
        match started {
            Ok(child) => self.0.push(child),
            Err(error) => tracing::warn!("cannot render the {what} of {}: {error}", session.display()),
        }
    }

    /// Waits until all pictures are rendered; a stop request cancels the remaining ones.
    pub fn finish(&mut self, stop: &StopRequest) {
        self.0.retain_mut(|child| matches!(child.try_wait(), Ok(None)));
        if !self.0.is_empty() && !stop.is_requested() {
            tracing::info!("rendering the pictures for the report; press Ctrl-C to skip");
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
