//! The window process and the pipe to it. The session continues if the window exits.

use super::args::{Args, camera_file};
use crate::io::addresses::PortChoice;
use crate::io::children::Child;
use crate::io::clock::Stopwatch;
use crate::io::stop::StopRequest;
use crate::io::user_language::user_language;
use spandrel_text::Language;
use spandrel_view::flow::pipe::{self, FromWindow, ToWindow};
use std::time::Duration;

/// Interval at which the window is checked.
const CHECK_INTERVAL: Duration = Duration::from_millis(20);
/// Time limit for the window to open on a busy machine.
const OPEN_TIMEOUT: Duration = Duration::from_secs(60);

/// The window process.
pub struct WindowProcess {
    child: Child,
    has_exited: bool,
    /// True once the window has reported that it is shown.
    pub ready: bool,
    /// True if the user closed the window; false if it crashed.
    pub closed: bool,
    /// Language of the texts that the window shows.
    pub language: Language,
    is_flying: bool,
    bad_line_reported: bool,
}

impl WindowProcess {
    /// Starts the window, unless it is disabled or there is no payload port to subscribe to.
    pub fn open(args: &Args, log: tracing::Level) -> Option<Self> {
        if args.no_view || !cfg!(feature = "view") {
            return None;
        }
        if args.ports.payload_port == Some(PortChoice::None) {
            tracing::warn!("no window: it requires the payload port, but --payload-port is none");
            return None;
        }
        let opened = Child::start("view", &window_args(args, log));
        let child = opened.inspect_err(|error| tracing::warn!("no window: {error}")).ok()?;
        Some(Self::from_child(child))
    }

    fn from_child(child: Child) -> Self {
        Self {
            child,
            has_exited: false,
            ready: false,
            closed: false,
            language: user_language(),
            is_flying: false,
            bad_line_reported: false,
        }
    }

    /// Waits until the window is shown. Returns false if it fails or a stop is requested.
    pub fn is_ready(&mut self, stop: &StopRequest) -> bool {
        let watch = Stopwatch::start();
        while self.is_open() && !stop.is_requested() {
            if self.receive() == Some(FromWindow::Ready) {
                return true;
            }
            if watch.elapsed() > OPEN_TIMEOUT {
                tracing::warn!("the window has not opened after {} s: continuing without waiting", OPEN_TIMEOUT.as_secs());
                return false;
            }
            std::thread::sleep(CHECK_INTERVAL);
        }
        false
    }

    /// Sends a message to the window.
    pub fn send(&mut self, message: &ToWindow) {
        match message {
            ToWindow::Flying(_) => self.is_flying = true,
            ToWindow::Ended(_) => self.is_flying = false,
            ToWindow::Offers(_)
            | ToWindow::Ordered(_)
            | ToWindow::Briefing
            | ToWindow::Paused { .. }
            | ToWindow::Refused { .. }
            | ToWindow::Loading { .. }
            | ToWindow::OpenPage { .. }
            | ToWindow::School(_)
            | ToWindow::Ghost(_) => {}
        }
        self.child.send_line(&pipe::line(message));
    }

    /// Returns the window's next message. Only the first invalid line is logged; later ones are ignored.
    pub fn receive(&mut self) -> Option<FromWindow> {
        while let Some(line) = self.child.try_read_line() {
            match pipe::read(&line) {
                Ok(message) => {
                    self.ready |= message == FromWindow::Ready;
                    if let FromWindow::Language { tag } = &message {
                        self.language = Language::from_tag(tag).unwrap_or(self.language);
                    }
                    return Some(message);
                }
                Err(error) if !self.bad_line_reported => {
                    self.bad_line_reported = true;
                    tracing::warn!("invalid message from the window: {error}; further invalid messages are ignored");
                }
                Err(_) => {}
            }
        }
        None
    }

    /// Returns true while the window runs; logs its exit once.
    pub fn is_open(&mut self) -> bool {
        let ended = self.child.exit_status();
        if let Some(status) = ended.filter(|_| !self.has_exited) {
            self.has_exited = true;
            self.closed = status.success();
            tracing::info!("{}", exit_message(self.closed, self.is_flying));
        }
        !self.has_exited
    }

    /// Ends the process after the user has closed the window.
    pub fn close(mut self) {
        self.has_exited = true;
        self.child.finish();
    }
}

/// Returns the command-line arguments for the window process.
fn window_args(args: &Args, log: tracing::Level) -> Vec<String> {
    let mut words = ["--led", "--log", &log.to_string().to_lowercase()].map(str::to_owned).to_vec();
    let given = [
        ("--keys", args.keys.as_ref().map(|file| file.display().to_string())),
        ("--quality", args.quality.clone()),
        ("--device", args.device.clone()),
        ("--profiles", args.profiles.as_ref().map(|folder| folder.display().to_string())),
        ("--stream", args.stream.map(|to| to.to_string())),
        ("--picture", Some(camera_file(args).display().to_string())),
    ];
    for (name, value) in given {
        words.extend(value.map(|value| [name.to_owned(), value]).into_iter().flatten());
    }
    if args.no_sound {
        words.push("--no-sound".to_owned());
    }
    words
}

fn exit_message(closed: bool, is_flying: bool) -> &'static str {
    match (closed, is_flying) {
        (true, false) => "the window was closed",
        (true, true) => "the window was closed: the session continues without it",
        (false, _) => "the window failed (see its message in the terminal): the session continues without it",
    }
}

#[cfg(test)]
impl WindowProcess {
    /// Starts a process that fails immediately: the test executable does not accept `--announce`.
    pub fn failing_process() -> Self {
        Self::from_child(Child::start("view", &[]).unwrap())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_options_are_passed_to_the_window_once() {
        let told = ["--stream", "127.0.0.1:5600", "--device", "Pad", "--no-sound", "--quality", "low"];
        let words = window_args(&super::super::args::parse_args(&told), tracing::Level::WARN);
        for pair in [["--stream", "127.0.0.1:5600"], ["--device", "Pad"], ["--quality", "low"], ["--log", "warn"]] {
            assert_eq!(words.windows(2).filter(|two| *two == pair).count(), 1, "{pair:?}: {words:?}");
        }
        let count = |word: &str| words.iter().filter(|w| *w == word).count();
        assert_eq!([count("--stream"), count("--no-sound"), count("--keys")], [1, 1, 0]);
    }

    #[test]
    fn exact_crashed_window_is_neither_ready_nor_closed() {
        let mut window = WindowProcess::failing_process();
        assert!(!window.is_ready(&StopRequest::default()) && !window.is_open());
        assert!(!window.ready && !window.closed);
        assert!(exit_message(window.closed, true).contains("see its message in the terminal"));
        assert!(!exit_message(true, false).contains("message"), "closing the window is not an error");
    }
}
