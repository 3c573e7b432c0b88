//! Shows progress on standard error: a spinner on a terminal, otherwise a log line every 15 s.

use super::clock::Stopwatch;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, stderr};
use std::time::Duration;

/// Interval between log lines when standard error is not a terminal.
const LOG_INTERVAL: Duration = Duration::from_secs(15);

/// Progress display for a long operation.
#[derive(Debug)]
pub struct ProgressLog {
    bar: Option<ProgressBar>,
    stopwatch: Stopwatch,
    lines: u32,
}

impl ProgressLog {
    /// Starts the display with a first message.
    pub fn start(what: &str) -> Self {
        let bar = stderr().is_terminal().then(|| {
            let bar = ProgressBar::new_spinner();
            if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}") {
                bar.set_style(style);
            }
            bar.enable_steady_tick(Duration::from_millis(120));
            bar.set_message(what.to_owned());
            bar
        });
        Self { bar, stopwatch: Stopwatch::start(), lines: 0 }
    }

    /// Updates the message; may be called as often as needed.
    pub fn report(&mut self, message: impl FnOnce() -> String) {
        match &self.bar {
            Some(bar) => bar.set_message(message()),
            None if self.stopwatch.elapsed() >= LOG_INTERVAL * (self.lines + 1) => {
                self.lines += 1;
                tracing::info!("{}", message());
            }
            None => {}
        }
    }

    /// Removes the spinner from the terminal.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
