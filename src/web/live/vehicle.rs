//! A vehicle on the live page.

use super::instructor_command::InstructorCommand;
use super::telemetry_listener::{ListenerPaths, LiveListener, SharedFlightInfo};
use crate::errors::AppError;
use spandrel_text::Translated;
use spandrel_training::web::live_state::LiveFlightState;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Sender, channel};
use tokio::sync::watch;

/// Settings for a vehicle on the live page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WatchedVehicle {
    /// Address of its payload port.
    pub vehicle: SocketAddr,
    /// File to which a window saves the camera's view.
    pub picture: Option<PathBuf>,
}

/// A vehicle on the live page and its listener thread.
#[derive(Debug)]
pub struct LiveVehicle {
    pub vehicle: SocketAddr,
    pub picture: Option<PathBuf>,
    /// Current values as JSON.
    pub moments: watch::Receiver<Translated<String>>,
    pub known: SharedFlightInfo,
    pub commands: Sender<InstructorCommand>,
}

impl LiveVehicle {
    /// Starts the listener thread.
    ///
    /// # Errors
    /// Returns an error if the socket cannot be opened.
    pub fn start(watched: &WatchedVehicle, sessions: &[PathBuf], scenarios: &Path) -> Result<Self, AppError> {
        let WatchedVehicle { vehicle, picture } = watched.clone();
        let state = LiveFlightState::new();
        let (sender, moments) = watch::channel(Translated::new(|language| state.to_json(false, language).to_string()));
        let (commands, received) = channel();
        let known = SharedFlightInfo::default();
        let places = ListenerPaths { sessions: sessions.to_vec(), scenarios: scenarios.to_path_buf(), picture: picture.clone() };
        let mut ear = LiveListener::open(vehicle, known.clone(), places)?;
        std::thread::spawn(move || ear.listen(&sender, &received));
        Ok(Self { vehicle, picture, moments, known, commands })
    }
}
