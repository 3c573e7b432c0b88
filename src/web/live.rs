//! The flights that are watched: for each a thread that is one more subscriber of the vehicle's payload port, the stream of what it sees,
//! and what an instructor asks of the vehicle.

mod act;
mod ear;
mod orders;
mod own;
mod picture;
mod stream;
mod whose;

pub use act::act;
pub use own::{camera as own_camera, now as own_now, page as own_page};
pub use picture::show as camera;
pub use stream::stream;

use super::answer::{Answer, Answered, Refusal};
use super::asked::Asked;
use super::state::{State, lock};
use crate::errors::AppError;
use ear::{Ear, Known, Places};
use orders::Order;
use spandrel_training::web::live as pages;
use spandrel_training::web::watch::Watch;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Sender, channel};
use tokio::sync::watch;

/// A vehicle to watch.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Watched {
    /// Its payload port.
    pub vehicle: SocketAddr,
    /// Where a window keeps the camera's view of it.
    pub picture: Option<PathBuf>,
}

/// A flight that is watched.
#[derive(Debug)]
pub struct Live {
    vehicle: SocketAddr,
    picture: Option<PathBuf>,
    moments: watch::Receiver<String>,
    known: Known,
    orders: Sender<Order>,
}

impl Live {
    /// Starts to listen.
    ///
    /// # Errors
    /// When no socket can be opened.
    pub fn start(watched: &Watched, sessions: &[PathBuf], scenarios: &Path) -> Result<Self, AppError> {
        let Watched { vehicle, picture } = watched.clone();
        let (sender, moments) = watch::channel(Watch::new().moment(false).to_string());
        let (orders, received) = channel();
        let known = Known::default();
        let places = Places { sessions: sessions.to_vec(), scenarios: scenarios.to_path_buf(), picture: picture.clone() };
        let mut ear = Ear::open(vehicle, known.clone(), places)?;
        std::thread::spawn(move || ear.listen(&sender, &received));
        Ok(Self { vehicle, picture, moments, known, orders })
    }
}

/// The flight with this number, from 1, and its number; without a word the first one.
///
/// # Errors
/// When no vehicle is watched, or not so many.
pub fn chosen<'a>(state: &'a State, word: Option<&str>) -> Result<(usize, &'a Live), Refusal> {
    if state.live.is_empty() {
        return Err(Refusal::Wrong("no vehicle is watched (--vehicle)".into()));
    }
    let number = word.map_or(Some(1), |word| word.parse().ok());
    let found = number.and_then(|number: usize| Some((number, state.live.get(number.checked_sub(1)?)?)));
    found.ok_or_else(|| Refusal::Wrong(format!("vehicle: no such number (allowed: 1 to {})", state.live.len())))
}

/// The page.
pub fn page(state: &State, asked: &Asked) -> Answered {
    if state.live.is_empty() {
        return Ok(Answer::page(pages::live(&asked.visitor, None, &pages::Choice::default())));
    }
    let (number, live) = chosen(state, asked.word("vehicle"))?;
    let drawn = lock(&live.known.drawn).clone();
    let vehicles = state.live.iter().map(|live| live.vehicle.to_string()).collect();
    Ok(Answer::page(pages::live(&asked.visitor, drawn.as_ref(), &pages::Choice { vehicles, number })))
}
