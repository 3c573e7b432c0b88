//! Server state shared by all requests.

use super::auth::{AllowedOrigins, Authenticator};
use super::figures::FigureCache;
use super::live::{LiveVehicle, WatchedVehicle};
use super::safe_names::is_safe_file_name;
use super::scenario_library::UPLOAD_FOLDER;
use super::session_importer::SessionImporter;
use super::station_jobs::StationJobs;
use super::temp_files;
use crate::errors::AppError;
use crate::io::answers;
use crate::io::map_tiles::LatestMap;
use crate::io::station_key::StationKey;
use crate::records::{Database, RecordsLocation};
use spandrel_training::questionnaire::Languages;
use spandrel_training::stations::StationBoard;
use std::path::PathBuf;
use std::sync::Mutex;

/// Server settings.
#[derive(Debug, Clone)]
pub struct ServerSetup {
    /// Location of the database and the session folders.
    pub records_location: RecordsLocation,
    /// Folder for uploaded scenarios; `None` for the default.
    pub scenarios: Option<PathBuf>,
    /// File of a job that is neither shipped nor uploaded; its site has map tiles, too.
    pub own_job: Option<PathBuf>,
    /// Vehicles on the live page.
    pub watched: Vec<WatchedVehicle>,
    /// Files with custom questionnaire wordings.
    pub wordings: Vec<PathBuf>,
    /// Key of the training stations; without one, no station can check in.
    pub station_key: Option<StationKey>,
}

/// Server state shared by all requests.
#[derive(Debug)]
pub struct ServerState {
    /// Database of sessions, trainees and answers.
    pub database: Database,
    /// Cache of cohort figures.
    pub figures: FigureCache,
    /// Location of the database and the session folders.
    pub records_location: RecordsLocation,
    /// Folder for uploaded scenarios.
    pub scenarios: PathBuf,
    /// File of a job that is neither shipped nor uploaded.
    pub own_job: Option<PathBuf>,
    /// Training stations that have checked in.
    pub stations: Mutex<StationBoard>,
    /// Jobs that can be ordered at the stations.
    pub station_jobs: StationJobs,
    /// Key of the training stations.
    pub station_key: Option<StationKey>,
    /// Manages logins, browser sessions and cookies.
    pub auth: Authenticator,
    /// Questionnaire languages.
    pub languages: Languages,
    /// Vehicles on the live page.
    pub live: Vec<LiveVehicle>,
    /// Imports new sessions into the database.
    pub importer: SessionImporter,
    /// Locked while an answer file is read, modified and written.
    pub answers: Mutex<()>,
    /// Locked while a file with marks is read, modified and written.
    pub marks: Mutex<()>,
    /// Locked while an uploaded scenario is compared with the stored file and written.
    pub scenario_writing: Mutex<()>,
    /// Map tiles of the job that was requested last.
    pub map_tiles: Mutex<Option<LatestMap>>,
    /// Locked while a map tile is drawn.
    pub tile_drawing: Mutex<()>,
    /// Locked while a recording is scored, because scoring is slow.
    pub scoring: Mutex<()>,
}

impl ServerState {
    /// Opens the database and the links to the vehicles, and removes stale temporary files.
    ///
    /// # Errors
    /// Returns an error if a wording is invalid, or the database or a link to a vehicle cannot be opened.
    pub fn open(setup: ServerSetup, secure: bool, reach: AllowedOrigins) -> Result<Self, AppError> {
        let ServerSetup { records_location, scenarios, own_job, watched, wordings, station_key } = setup;
        let languages = answers::languages(&wordings)?;
        let first = records_location.sessions.first().cloned().unwrap_or_else(|| PathBuf::from("sessions"));
        std::fs::create_dir_all(&first)
            .map_err(|error| AppError::failed(format!("{}: cannot create the folder: {error}", first.display())))?;
        temp_files::remove_partial_imports(&first)?;
        let scenarios = scenarios.unwrap_or_else(|| first.join(UPLOAD_FOLDER));
        temp_files::remove_stale(&records_location.sessions, &scenarios);
        let (database, figures) = (records_location.open()?, FigureCache::open(&records_location)?);
        let guard = Authenticator::new(!database.names_with_password()?.is_empty(), secure, reach);
        let start = |watched: &WatchedVehicle| LiveVehicle::start(watched, &records_location.sessions, &scenarios);
        let live = watched.iter().map(start).collect::<Result<Vec<_>, _>>()?;
        let taking_in = SessionImporter::start(&records_location)?;
        let (answers, marks, scoring) = (Mutex::new(()), Mutex::new(()), Mutex::new(()));
        Ok(Self {
            database,
            figures,
            records_location,
            scenarios,
            own_job,
            stations: Mutex::default(),
            station_jobs: StationJobs::default(),
            station_key,
            auth: guard,
            languages,
            live,
            importer: taking_in,
            answers,
            marks,
            scenario_writing: Mutex::default(),
            map_tiles: Mutex::default(),
            tile_drawing: Mutex::default(),
            scoring,
        })
    }

    /// Returns the folder for unfinished uploads and imports.
    pub fn spool(&self) -> PathBuf {
        self.default_folder().join(temp_files::IMPORT_FOLDER)
    }

    /// Returns the folder for new sessions.
    pub fn default_folder(&self) -> PathBuf {
        self.records_location.sessions.first().cloned().unwrap_or_else(|| PathBuf::from("sessions"))
    }

    /// Returns a session's folder, or `None` if it is not on this machine or the ID is not a plain name.
    pub fn folder(&self, id: &str) -> Option<PathBuf> {
        if !is_safe_file_name(id) {
            return None;
        }
        self.records_location
            .sessions
            .iter()
            .map(|folder| folder.join(id))
            .find(|path| crate::io::session_folder::is_session(path))
    }
}
