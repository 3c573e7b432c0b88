//! Pipe to the `train` process, which starts and ends flights.

use crate::io::stop::StopRequest;
use spandrel_view::flow::pipe::{self, FromWindow, ToWindow};
use std::io::Write;
use std::sync::mpsc::Receiver;

/// The window's end of the pipe.
#[derive(Debug)]
pub struct TrainPipe {
    lines: Receiver<String>,
    error_reported: bool,
}

impl TrainPipe {
    /// Reads messages from standard input. When standard input closes, the window closes, too.
    pub fn listen(stop: &StopRequest) -> Self {
        Self { lines: stop.lines(), error_reported: false }
    }

    /// Returns the next message from `train`. Only the first invalid line is logged; later ones are ignored.
    pub fn poll(&mut self) -> Option<ToWindow> {
        while let Ok(line) = self.lines.try_recv() {
            match pipe::read(&line) {
                Ok(message) => return Some(message),
                Err(error) if !self.error_reported => {
                    self.error_reported = true;
                    tracing::warn!("{error}; further invalid lines are ignored");
                }
                Err(_) => {}
            }
        }
        None
    }

    /// Sends a message to `train`. If `train` has exited, standard input also closes, which closes the window.
    pub fn send(&self, message: &FromWindow) {
        let mut out = std::io::stdout().lock();
        if let Err(error) = writeln!(out, "{}", pipe::line(message)).and_then(|()| out.flush()) {
            tracing::debug!("cannot write to standard output: {error}");
        }
    }
}
