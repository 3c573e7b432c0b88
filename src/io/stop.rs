//! When to stop: on SIGINT or SIGTERM, or when the process that holds the leash ends. Runs look at the flag and finish cleanly.

use crate::errors::AppError;
use std::io::{BufRead, Read};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};

/// A request to finish, shared by all threads of the process.
#[derive(Debug, Clone, Default)]
pub struct StopRequest(Arc<AtomicBool>);

impl StopRequest {
    /// Listens for SIGINT and SIGTERM, and with `leash` for the end of standard input: a parent that dies in whatever way closes it,
    /// so no child outlives its parent.
    ///
    /// # Errors
    /// When the system refuses the listener.
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

    /// Lines of standard input, from a parent process; their end asks to finish, as a leash does.
    pub fn lines(&self) -> Receiver<String> {
        let (sender, lines) = channel();
        let on_end = self.clone();
        std::thread::spawn(move || {
            let mut stdin = std::io::stdin().lock();
            let mut line = Vec::new();
            // Bytes that are no text are a bad line, not the end of the parent.
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

    /// True once somebody has asked.
    pub fn is_requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Asks everybody who looks to end.
    pub fn request(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    async fn signals(self) {
        // The first asks, the second insists.
        if one_signal().await.is_ok() {
            self.request();
            if one_signal().await.is_ok() {
                std::process::exit(1);
            }
        }
    }
}

#[cfg(unix)]
async fn one_signal() -> std::io::Result<()> {
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
async fn one_signal() -> std::io::Result<()> {
    tokio::signal::ctrl_c().await
}
