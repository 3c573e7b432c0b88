//! Stop requests, triggered by SIGINT, SIGTERM or the exit of the parent process. Long-running loops check the flag and
//! shut down cleanly.

use crate::errors::AppError;
use std::io::{BufRead, Read};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};

/// A request to stop, shared by all threads of the process.
#[derive(Debug, Clone, Default)]
pub struct StopRequest(Arc<AtomicBool>);

impl StopRequest {
    /// Listens for SIGINT and SIGTERM and, if `leash` is true, for the end of standard input, which closes when the
    /// parent exits for any reason. This way, no child outlives its parent.
    ///
    /// # Errors
    /// Returns an error if the signal handler cannot be installed.
    pub fn install(leash: bool) -> Result<Self, AppError> {
        let stop = Self::default();
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_io()
            .build()
            .map_err(|error| AppError::failed(format!("cannot listen for signals: {error}")))?;
        let on_signal = stop.clone();
        std::thread::spawn(move || runtime.block_on(on_signal.signals()));
        if leash {
            let on_end = stop.clone();
            std::thread::spawn(move || {
                let mut sink = [0u8; 64];
                let mut stdin = std::io::stdin();
                while matches!(stdin.read(&mut sink), Ok(1..)) {}
                on_end.request();
            });
        }
        Ok(stop)
    }

    /// Returns the lines that the parent process writes to standard input. When standard input closes, requests a stop.
    pub fn lines(&self) -> Receiver<String> {
        let (sender, lines) = channel();
        let on_end = self.clone();
        std::thread::spawn(move || {
            let mut stdin = std::io::stdin().lock();
            let mut line = Vec::new();
            // Bytes that are not UTF-8 invalidate the line, but do not end the input.
            while matches!(stdin.read_until(b'\n', &mut line), Ok(1..)) {
                let text = String::from_utf8_lossy(&line).trim_end().to_owned();
                line.clear();
                if sender.send(text).is_err() {
                    break;
                }
            }
            on_end.request();
        });
        lines
    }

    /// Returns true after a stop request.
    pub fn is_requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Asks all threads to stop.
    pub fn request(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    async fn signals(self) {
        // The first signal requests a stop; the second signal exits immediately.
        if next_signal().await.is_ok() {
            self.request();
            if next_signal().await.is_ok() {
                std::process::exit(1);
            }
        }
    }
}

#[cfg(unix)]
async fn next_signal() -> std::io::Result<()> {
    use tokio::signal::unix::{SignalKind, signal};
    let mut interrupt = signal(SignalKind::interrupt())?;
    let mut terminate = signal(SignalKind::terminate())?;
    tokio::select! {
        _ = interrupt.recv() => (),
        _ = terminate.recv() => (),
    }
    Ok(())
}

#[cfg(not(unix))]
async fn next_signal() -> std::io::Result<()> {
    tokio::signal::ctrl_c().await
}
