//! Live flights. Each vehicle has a thread that subscribes to its payload port, streams its values to the pages and sends the instructor's commands.

mod command_queue;
mod flight_owner;
mod instructor_actions;
mod own_flight;
mod picture;
mod stream;
mod telemetry_listener;

pub use instructor_actions::run_action;
pub use own_flight::{camera as own_camera, current as own_now, page as own_page};
pub use picture::show as camera;
pub use stream::stream;

use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::state::{ServerState, lock};
use crate::errors::AppError;
use command_queue::InstructorCommand;
use spandrel_training::web::live as pages;
use spandrel_training::web::live_state::LiveFlightState;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Sender, channel};
use telemetry_listener::{ListenerPaths, LiveListener, SharedKnowledge};
use tokio::sync::watch;

/// A vehicle to show on the live page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WatchedVehicle {
    /// Address of its payload port.
    pub vehicle: SocketAddr,
    /// File to which a window saves the camera's view.
    pub picture: Option<PathBuf>,
}

/// A vehicle on the live page, with its listener thread.
#[derive(Debug)]
pub struct LiveVehicle {
    vehicle: SocketAddr,
    picture: Option<PathBuf>,
    moments: watch::Receiver<String>,
    known: SharedKnowledge,
    orders: Sender<InstructorCommand>,
}

impl LiveVehicle {
    /// Starts the listener thread.
    ///
    /// # Errors
    /// If the socket cannot be opened.
    pub fn start(watched: &WatchedVehicle, sessions: &[PathBuf], scenarios: &Path) -> Result<Self, AppError> {
        let WatchedVehicle { vehicle, picture } = watched.clone();
        let (sender, moments) = watch::channel(LiveFlightState::new().to_json(false).to_string());
        let (orders, received) = channel();
        let known = SharedKnowledge::default();
        let places = ListenerPaths { sessions: sessions.to_vec(), scenarios: scenarios.to_path_buf(), picture: picture.clone() };
        let mut ear = LiveListener::open(vehicle, known.clone(), places)?;
        std::thread::spawn(move || ear.listen(&sender, &received));
        Ok(Self { vehicle, picture, moments, known, orders })
    }
}

/// Returns the vehicle with this number, from 1, and the number; without a number, the first one.
///
/// # Errors
/// If no vehicle is configured, or the number is too large.
pub fn chosen<'a>(state: &'a ServerState, word: Option<&str>) -> Result<(usize, &'a LiveVehicle), WebError> {
    if state.live.is_empty() {
        return Err(WebError::BadRequest("no vehicle is configured (--vehicle)".into()));
    }
    let number = word.map_or(Some(1), |word| word.parse().ok());
    let found = number.and_then(|number: usize| Some((number, state.live.get(number.checked_sub(1)?)?)));
    found.ok_or_else(|| WebError::BadRequest(format!("vehicle: invalid number (allowed: 1 to {})", state.live.len())))
}

/// Shows the instructor's live page.
pub fn page(state: &ServerState, asked: &WebRequest) -> HandlerResult {
    if state.live.is_empty() {
        return Ok(WebResponse::page(pages::live(&asked.visitor, None, &pages::VehicleChoice::default())));
    }
    let (number, live) = chosen(state, asked.query_value("vehicle"))?;
    let drawn = lock(&live.known.drawn).clone();
    let vehicles = state.live.iter().map(|live| live.vehicle.to_string()).collect();
    Ok(WebResponse::page(pages::live(&asked.visitor, drawn.as_ref(), &pages::VehicleChoice { vehicles, number })))
}
