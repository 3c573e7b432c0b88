//! When to stop: on SIGINT or SIGTERM, or when the process that holds the leash ends. Runs look at the flag and finish cleanly.

use super::errors::AppError;
use std::io::Read;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A request to finish, shared by all threads of the process.
#[derive(Debug, Clone, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
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
                on_end.ask();
            });
        }
        Ok(stop)
    }

    /// True once somebody has asked.
    pub fn asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Asks everybody who looks to end.
    pub fn ask(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    async fn signals(self) {
        // The first asks, the second insists.
        if one_signal().await.is_ok() {
            self.ask();
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
