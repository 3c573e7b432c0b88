//! The pipe to `train`, which starts flights and ends them.

use crate::io::stop::StopRequest;
use spandrel_view::flow::pipe::{self, FromWindow, ToWindow};
use std::io::Write;
use std::sync::mpsc::Receiver;

/// The window's end of the pipe.
#[derive(Debug)]
pub struct TrainPipe {
    lines: Receiver<String>,
    complained: bool,
}

impl TrainPipe {
    /// Listens to standard input; its end closes the window.
    pub fn listen(stop: &StopRequest) -> Self {
        Self { lines: stop.lines(), complained: false }
    }

    /// The next thing that `train` says. A bad line is named once and left alone.
    pub fn poll(&mut self) -> Option<ToWindow> {
        while let Ok(line) = self.lines.try_recv() {
            match pipe::read(&line) {
                Ok(message) => return Some(message),
                Err(error) if !self.complained => {
                    self.complained = true;
                    tracing::warn!("{error}; such lines are left alone");
                }
                Err(_) => {}
            }
        }
        None
    }

    /// Says something to `train`. When it is gone, standard input ends as well, and that closes the window.
    pub fn send(&self, message: &FromWindow) {
        let mut out = std::io::stdout().lock();
        if let Err(error) = writeln!(out, "{}", pipe::line(message)).and_then(|()| out.flush()) {
            tracing::debug!("nobody listens: {error}");
        }
    }
}
