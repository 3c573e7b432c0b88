//! Renders a flight's photographs and its video in the background, for its folder and its report.

use super::args::VideoMode;
use crate::io::stop::StopRequest;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// Interval at which the rendering processes are checked.
const CHECK_INTERVAL: Duration = Duration::from_millis(50);
/// Size and rate of the video: estimate, enough to see what the trainee saw.
const VIDEO_OPTIONS: [&str; 6] = ["--size", "960x540", "--fps", "10", "--quality", "low"];

/// Rendering processes, one at a time: each may use half of the processor cores, and rewrites its session's report at the end.
#[derive(Default)]
pub struct PictureJobs {
    running: Option<Child>,
    waiting: VecDeque<PictureJob>,
}

/// A rendering process that has not started.
struct PictureJob {
    session: PathBuf,
    options: Vec<&'static str>,
    what: &'static str,
}

impl PictureJobs {
    /// Renders a session's photographs. If that fails, the report shows placeholders, as it does without a window.
    pub fn draw_photographs(&mut self, session: &Path) {
        self.add(session, vec!["--snapshots"], "photographs");
    }

    /// Renders a session's video. If that fails, the report has none.
    pub fn draw_video(&mut self, session: &Path, mode: VideoMode) {
        let mut options = vec!["--video"];
        match mode {
            VideoMode::On => {}
            VideoMode::Auto => options.push("--only-with-gpu"),
            VideoMode::Off => return,
        }
        options.extend(VIDEO_OPTIONS);
        self.add(session, options, "video");
    }

    fn add(&mut self, session: &Path, options: Vec<&'static str>, what: &'static str) {
        self.waiting.push_back(PictureJob { session: session.to_path_buf(), options, what });
        self.advance();
    }

    /// Starts the next process if none runs. Call regularly.
    pub fn advance(&mut self) {
        if let Some(child) = &mut self.running
            && matches!(child.try_wait(), Ok(None))
        {
            return;
        }
        self.running = None;
        while let Some(job) = self.waiting.pop_front() {
            match job.start() {
                Ok(child) => {
                    self.running = Some(child);
                    return;
                }
                Err(error) => tracing::warn!("cannot render the {} of {}: {error}", job.what, job.session.display()),
            }
        }
    }

    /// Waits until all pictures are rendered; a stop request cancels the remaining ones.
    pub fn finish(&mut self, stop: &StopRequest) {
        self.advance();
        if self.running.is_some() && !stop.is_requested() {
            tracing::info!("rendering the pictures for the report; press Ctrl-C to skip");
        }
        while self.running.is_some() && !stop.is_requested() {
            std::thread::sleep(CHECK_INTERVAL);
            self.advance();
        }
        self.waiting.clear();
        if let Some(mut child) = self.running.take() {
            // The process may have just exited.
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

/// Returns the number of threads for Mesa's software renderer: half of the CPUs. A window that shows a flight beside it needs the
/// other half.
fn software_renderer_threads() -> usize {
    std::thread::available_parallelism().map_or(1, |all| (all.get() / 2).max(1))
}

impl PictureJob {
    fn start(&self) -> std::io::Result<Child> {
        let mut command = Command::new(std::env::current_exe()?);
        command.args(["--log", "warn", "render"]).arg(&self.session).args(&self.options).arg("--nice");
        command.env("LP_NUM_THREADS", software_renderer_threads().to_string()).stdin(Stdio::null()).stdout(Stdio::null()).spawn()
    }
}
