//! The window as a process of its own, and the pipe to it. The session depends on neither.

use super::args::{Args, camera};
use crate::io::addresses::PortChoice;
use crate::io::children::Child;
use crate::io::clock::Stopwatch;
use crate::io::stop::StopRequest;
use spandrel_view::flow::pipe::{self, FromWindow, ToWindow};
use std::time::Duration;

/// Between two looks at the window.
const LOOK: Duration = Duration::from_millis(20);
/// A window has this long to open on a busy machine.
const OPEN_LIMIT: Duration = Duration::from_secs(60);

/// The window's process.
pub struct WindowProcess {
    child: Child,
    over: bool,
    /// It has said that it stands on a display.
    pub ready: bool,
    /// It was closed, and did not break off.
    pub closed: bool,
    flies: bool,
    bad_line_reported: bool,
}

impl WindowProcess {
    /// Opens it, unless it is not wanted or there is nothing that it could listen to.
    pub fn open(args: &Args, log: tracing::Level) -> Option<Self> {
        if args.no_view || !cfg!(feature = "view") {
            return None;
        }
        if args.ports.payload_port == Some(PortChoice::None) {
            tracing::warn!("no window: it listens at the payload port, and --payload-port is none");
            return None;
        }
        let opened = Child::start_sibling("view", &window_args(args, log), &[spare_threads()]);
        let child = opened.inspect_err(|error| tracing::warn!("no window: {error}")).ok()?;
        Some(Self::of(child))
    }

    fn of(child: Child) -> Self {
        Self { child, over: false, ready: false, closed: false, flies: false, bad_line_reported: false }
    }

    /// Waits until it stands on a display; false when it does not, or somebody interrupts.
    pub fn is_ready(&mut self, stop: &StopRequest) -> bool {
        let watch = Stopwatch::start();
        while self.is_open() && !stop.is_requested() {
            if self.receive() == Some(FromWindow::Ready) {
                return true;
            }
            if watch.elapsed() > OPEN_LIMIT {
                tracing::warn!("the window has not opened after {} s: it is not waited for", OPEN_LIMIT.as_secs());
                return false;
            }
            std::thread::sleep(LOOK);
        }
        false
    }

    /// Says something to it.
    pub fn send(&mut self, message: &ToWindow) {
        match message {
            ToWindow::Flying(_) => self.flies = true,
            ToWindow::Ended(_) => self.flies = false,
            ToWindow::Offers(_) | ToWindow::Paused { .. } | ToWindow::Refused { .. } => {}
        }
        self.child.send_line(&pipe::line(message));
    }

    /// The next thing that it says. A bad line is named once and left alone.
    pub fn receive(&mut self) -> Option<FromWindow> {
        while let Some(line) = self.child.line() {
            match pipe::read(&line) {
                Ok(message) => {
                    self.ready |= message == FromWindow::Ready;
                    return Some(message);
                }
                Err(error) if !self.bad_line_reported => {
                    self.bad_line_reported = true;
                    tracing::warn!("from the window: {error}; such lines are left alone");
                }
                Err(_) => {}
            }
        }
        None
    }

    /// It has not ended; once it has, how is told once.
    pub fn is_open(&mut self) -> bool {
        let ended = self.child.ended();
        if let Some(status) = ended.filter(|_| !self.over) {
            self.over = true;
            self.closed = status.success();
            tracing::info!("{}", exit_message(self.closed, self.flies));
        }
        !self.over
    }

    /// It closes, as was asked for in it.
    pub fn close(mut self) {
        self.over = true;
        self.child.finish();
    }
}

/// The window's command line.
fn window_args(args: &Args, log: tracing::Level) -> Vec<String> {
    let mut words = ["--led", "--log", &log.to_string().to_lowercase(), "--quality", &args.quality].map(str::to_owned).to_vec();
    let given = [
        ("--keys", args.keys.as_ref().map(|file| file.display().to_string())),
        ("--device", args.device.clone()),
        ("--profiles", args.profiles.as_ref().map(|folder| folder.display().to_string())),
        ("--stream", args.stream.map(|to| to.to_string())),
        ("--picture", Some(camera(args).display().to_string())),
    ];
    for (name, value) in given {
        words.extend(value.map(|value| [name.to_owned(), value]).into_iter().flatten());
    }
    if args.no_sound {
        words.push("--no-sound".to_owned());
    }
    words
}

fn exit_message(closed: bool, flies: bool) -> &'static str {
    match (closed, flies) {
        (true, false) => "the window is closed",
        (true, true) => "the window is closed: the session goes on without",
        (false, _) => "there is no window (its message is in the terminal): the session goes on without",
    }
}

/// Mesa's software driver takes every processor unless it is told otherwise; half of them are the simulator's and the monitor's.
pub fn spare_threads() -> (&'static str, String) {
    let all = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    ("LP_NUM_THREADS", (all / 2).max(1).to_string())
}

#[cfg(test)]
impl WindowProcess {
    /// One that breaks off at once: the tests' own program knows no --announce.
    pub fn failing() -> Self {
        Self::of(Child::start("view", &[]).unwrap())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_window_events_reach_train_once() {
        let told = ["--stream", "127.0.0.1:5600", "--device", "Pad", "--no-sound", "--quality", "low"];
        let words = window_args(&super::super::args::parsed(&told), tracing::Level::WARN);
        for pair in [["--stream", "127.0.0.1:5600"], ["--device", "Pad"], ["--quality", "low"], ["--log", "warn"]] {
            assert_eq!(words.windows(2).filter(|two| *two == pair).count(), 1, "{pair:?}: {words:?}");
        }
        let count = |word: &str| words.iter().filter(|w| *w == word).count();
        assert_eq!([count("--stream"), count("--no-sound"), count("--keys")], [1, 1, 0]);
    }

    #[test]
    fn exact_a_window_that_breaks_off_is_neither_ready_nor_closed() {
        let mut window = WindowProcess::failing();
        assert!(!window.is_ready(&StopRequest::default()) && !window.is_open());
        assert!(!window.ready && !window.closed);
        assert!(exit_message(window.closed, true).contains("its message is in the terminal"));
        assert!(!exit_message(true, false).contains("message"), "who closes a window needs no reason");
    }
}
