//! State shared by all requests.

use super::auth::{AllowedOrigins, Authenticator};
use super::figures::FigureCache;
use super::live::{LiveVehicle, WatchedVehicle};
use super::safe_names::is_plain;
use super::session_importer::SessionImporter;
use super::temp_files;
use crate::errors::AppError;
use crate::io::answers;
use crate::records::{Database, RecordsLocation};
use spandrel_training::questionnaire::Languages;
use std::path::PathBuf;
use std::sync::Mutex;

/// What a server is made from.
#[derive(Debug, Clone)]
pub struct ServerSetup {
    /// Records and sessions.
    pub place: RecordsLocation,
    /// Folder of uploaded scenarios; `None` for the usual one.
    pub scenarios: Option<PathBuf>,
    /// Vehicles that are watched.
    pub watched: Vec<WatchedVehicle>,
    /// Wordings of the questionnaire beside the shipped ones.
    pub wordings: Vec<PathBuf>,
}

/// State shared by all requests.
#[derive(Debug)]
pub struct ServerState {
    /// Records.
    pub database: Database,
    /// Figures of cohorts.
    pub figures: FigureCache,
    /// Where they and the sessions are.
    pub place: RecordsLocation,
    /// Folder of uploaded scenarios.
    pub scenarios: PathBuf,
    /// Who is who.
    pub auth: Authenticator,
    /// Languages of the questionnaire.
    pub languages: Languages,
    /// The flights that are watched.
    pub live: Vec<LiveVehicle>,
    /// Takes new sessions in.
    pub importer: SessionImporter,
    /// Held while a file of answers is read, changed and written.
    pub answers: Mutex<()>,
    /// Held while a recording is scored: one at a time costs enough.
    pub scoring: Mutex<()>,
}

impl ServerState {
    /// Opens everything.
    ///
    /// # Errors
    /// When a wording is wrong, or the database or a link to a vehicle cannot be opened.
    pub fn open(setup: ServerSetup, secure: bool, reach: AllowedOrigins) -> Result<Self, AppError> {
        let ServerSetup { place, scenarios, watched, wordings } = setup;
        let languages = answers::languages(&wordings)?;
        let first = place.sessions.first().cloned().unwrap_or_else(|| PathBuf::from("sessions"));
        std::fs::create_dir_all(&first)
            .map_err(|error| AppError::failed(format!("{}: cannot be made: {error}", first.display())))?;
        temp_files::remove_partial_imports(&first)?;
        let scenarios = scenarios.unwrap_or_else(|| first.join("scenarios"));
        temp_files::remove_stale(&place.sessions, &scenarios);
        let (database, figures) = (place.open()?, FigureCache::open(&place)?);
        let guard = Authenticator::new(!database.with_password()?.is_empty(), secure, reach);
        let start = |watched: &WatchedVehicle| LiveVehicle::start(watched, &place.sessions, &scenarios);
        let live = watched.iter().map(start).collect::<Result<Vec<_>, _>>()?;
        let taking_in = SessionImporter::start(&place)?;
        let (answers, scoring) = (Mutex::new(()), Mutex::new(()));
        Ok(Self { database, figures, place, scenarios, auth: guard, languages, live, importer: taking_in, answers, scoring })
    }

    /// Where uploads lie while they arrive and sessions while they are made.
    pub fn spool(&self) -> PathBuf {
        self.default_folder().join(temp_files::ASIDE)
    }

    /// The folder of sessions that new ones go into.
    pub fn default_folder(&self) -> PathBuf {
        self.place.sessions.first().cloned().unwrap_or_else(|| PathBuf::from("sessions"))
    }

    /// The folder of a session; `None` when it is not on this machine, or the id is no plain name.
    pub fn folder(&self, id: &str) -> Option<PathBuf> {
        if !is_plain(id) {
            return None;
        }
        self.place.sessions.iter().map(|folder| folder.join(id)).find(|path| crate::io::session_folder::is_session(path))
    }
}
