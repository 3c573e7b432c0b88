//! Session folder on disk. Its logs are append-only and flushed regularly, so that a restarted monitor can resume the
//! session.

use super::append_file::{AppendFile, WriteError, complete_lines_len, sync_folder};
use super::clock;
use super::files::{self, ScenarioFile, VehicleFile};
use super::log_file::LogFile;
use super::replace::replace_durably;
use crate::errors::AppError;
use spandrel_mavlink::telemetry::tlog;
use spandrel_model::scenario::{self, PlacedDefect};
use spandrel_monitor::folder::{
    ADVICE, ASSESSMENT, EVENTS, REPORT, SCENARIO, SESSION, SessionInfo, TELEMETRY, VEHICLE, sha256_hex,
};
use spandrel_monitor::{SessionOutput, export};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Message if another monitor has locked the telemetry log.
const RECORDING_CONFLICT: &str =
    "another monitor is recording this session: stop that monitor, or omit --session to start a new session";

/// An open session folder.
#[derive(Debug)]
pub struct SessionFolder {
    path: PathBuf,
    telemetry: AppendFile,
    events: AppendFile,
    scenario_toml: String,
    vehicle_toml: String,
    started_utc: String,
    monitor_starts: u32,
}

/// Contents of a session folder, read from disk.
#[derive(Debug)]
pub struct StoredSession {
    /// Scenario with the seed and the placed defects.
    pub scenario: ScenarioFile,
    /// Aircraft flown in the session.
    pub vehicle: VehicleFile,
    /// Telemetry log.
    pub log: LogFile,
    /// Trainee ID.
    pub trainee: String,
    /// Purpose of the flight, if one was chosen.
    pub purpose: Option<String>,
    /// Wall time at which the trainee acknowledged the briefing's site check, µs since the Unix epoch, if a briefing was shown.
    pub site_check_unix_us: Option<u64>,
    /// Wall time at simulation time zero, µs since the Unix epoch.
    pub started_unix_us: u64,
    /// Number of monitor starts for this session.
    pub monitor_starts: u32,
    /// Version of the program that recorded the session; empty if unknown.
    pub spandrel_version: String,
}

impl SessionFolder {
    /// Creates `SESSIONS/<utc>-<trainee>-<scenario>-<short id>/`.
    ///
    /// # Errors
    /// Returns an error if the folder cannot be created or written.
    pub fn create(
        sessions: &Path,
        trainee: &str,
        started_unix_us: u64,
        scenario: &ScenarioFile,
        vehicle: &VehicleFile,
    ) -> Result<Self, AppError> {
        let (readable, compact) = clock::utc(started_unix_us);
        std::fs::create_dir_all(sessions).map_err(|error| io_error(sessions, &error))?;
        let stem = format!("{compact}-{trainee}-{}", scenario.scenario.name);
        let path = new_folder(sessions, &stem, started_unix_us)?;
        for (name, bytes) in &scenario.referenced_files {
            let file = path.join(name);
            if let Some(folder) = file.parent() {
                std::fs::create_dir_all(folder).map_err(|error| io_error(folder, &error))?;
            }
            replace_durably(&file, bytes)?;
        }
        replace_durably(&path.join(SCENARIO), scenario.text.as_bytes())?;
        replace_durably(&path.join(VEHICLE), vehicle.text.as_bytes())?;
        Self::open(path, scenario.text.clone(), vehicle.text.clone(), readable, 1)
    }

    /// Opens the folder of a session whose monitor was killed, and truncates telemetry and events to complete records
    /// and lines.
    ///
    /// # Errors
    /// Returns an error if this is not a session folder, another monitor is recording to it, or it cannot be written.
    pub fn resume(path: &Path, stored: &StoredSession) -> Result<Self, AppError> {
        let (readable, _) = clock::utc(stored.started_unix_us);
        let (scenario, vehicle) = (stored.scenario.text.clone(), stored.vehicle.text.clone());
        let mut folder = Self::open(path.to_path_buf(), scenario, vehicle, readable, stored.monitor_starts + 1)?;
        // Another monitor may have finished between reading and locking.
        if folder.telemetry.len() != stored.log.len() {
            return Err(AppError::failed(format!("{}: the session changed while it was being read; try again", path.display())));
        }
        folder.telemetry.truncate(stored.log.complete_len()?)?;
        let events_path = path.join(EVENTS);
        let events = std::fs::read(&events_path).map_err(|error| io_error(&events_path, &error))?;
        folder.events.truncate(complete_lines_len(&events) as u64)?;
        Ok(folder)
    }

    fn open(
        path: PathBuf,
        scenario_toml: String,
        vehicle_toml: String,
        started_utc: String,
        monitor_starts: u32,
    ) -> Result<Self, AppError> {
        let telemetry = AppendFile::open(path.join(TELEMETRY), tlog::complete_len)?;
        telemetry.lock(RECORDING_CONFLICT)?;
        let events = AppendFile::open(path.join(EVENTS), complete_lines_len)?;
        Ok(Self { path, telemetry, events, scenario_toml, vehicle_toml, started_utc, monitor_starts })
    }

    /// Returns the folder's path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Adds a record; the next [`Self::flush`] writes it.
    pub fn record(&mut self, record: SessionOutput) {
        match record {
            SessionOutput::Telemetry(bytes) => self.telemetry.push(&bytes),
            SessionOutput::Event(line) => self.events.push(line.as_bytes()),
        }
    }

    /// Writes pending records.
    ///
    /// # Errors
    /// Returns an error if the disk cannot be written. The files then contain only complete records, and the next call
    /// retries.
    pub fn flush(&mut self) -> Result<(), WriteError> {
        let telemetry = self.telemetry.flush();
        self.events.flush().and(telemetry)
    }

    /// Returns the number of bytes not written yet.
    pub fn pending(&self) -> usize {
        self.telemetry.pending() + self.events.pending()
    }

    /// Returns the number of records dropped because the disk was unwritable for too long.
    pub fn dropped(&self) -> u64 {
        self.telemetry.dropped() + self.events.dropped()
    }

    /// Waits until the session has been written to the physical disk.
    ///
    /// # Errors
    /// Returns an error if the disk cannot be written.
    pub fn sync(&self) -> Result<(), WriteError> {
        self.telemetry.sync()?;
        self.events.sync()?;
        sync_folder(&self.path, &[SCENARIO, VEHICLE, SESSION, ASSESSMENT, ADVICE, REPORT])?;
        self.path.parent().map_or(Ok(()), |sessions| sync_folder(sessions, &[]))
    }

    /// Saves the seed and the placed defects in `scenario.toml`.
    ///
    /// # Errors
    /// Returns an error if the disk cannot be written; the next call retries.
    pub fn resolve(&mut self, seed: u64, placed: &[PlacedDefect]) -> Result<(), WriteError> {
        let resolved = scenario::resolve(&self.scenario_toml, seed, placed);
        replace_durably(&self.path.join(SCENARIO), resolved.as_bytes())?;
        self.scenario_toml = resolved;
        Ok(())
    }

    /// Writes `session.json`.
    ///
    /// # Errors
    /// Returns an error if the disk cannot be written.
    pub fn write_session_json(&self, info: impl FnOnce(&[u8], &[u8], String, u32) -> SessionInfo) -> Result<(), WriteError> {
        let (scenario, vehicle) = (self.scenario_toml.as_bytes(), self.vehicle_toml.as_bytes());
        let info = info(scenario, vehicle, self.started_utc.clone(), self.monitor_starts);
        replace_durably(&self.path.join(SESSION), export::json_text(&info).as_bytes())
    }

    /// Writes `assessment.json`.
    ///
    /// # Errors
    /// Returns an error if the disk cannot be written.
    pub fn write_assessment(&self, json: &str) -> Result<(), WriteError> {
        replace_durably(&self.path.join(ASSESSMENT), json.as_bytes())
    }
}

impl StoredSession {
    /// Reads only the scenario from a session folder.
    ///
    /// # Errors
    /// Returns an error if this is not a session folder, or the file is invalid.
    pub fn read_scenario(path: &Path) -> Result<ScenarioFile, AppError> {
        if !is_session(path) {
            return Err(not_a_session_folder(path));
        }
        files::scenario(&path.join(SCENARIO).display().to_string())
    }

    /// Reads a session folder. The telemetry log and the two TOML files are required; without `session.json`, the
    /// trainee is taken from the folder name.
    ///
    /// # Errors
    /// Returns an error if one of these files is missing or invalid.
    pub fn read(path: &Path) -> Result<Self, AppError> {
        if !is_session(path) {
            return Err(not_a_session_folder(path));
        }
        let session = read_session_json(&path.join(SESSION))?;
        let text = |key: &str| session.get(key).and_then(serde_json::Value::as_str).map(str::to_owned);
        let number = |key: &str| session.get(key).and_then(serde_json::Value::as_u64);
        let log = LogFile::open(&path.join(TELEMETRY))?;
        let started_unix_us = match number("started_unix_us") {
            Some(told) => Some(told),
            None => log.session_start_us()?,
        };
        let scenario = files::scenario(&path.join(SCENARIO).display().to_string())?;
        let vehicle_path = path.join(VEHICLE);
        Ok(Self {
            vehicle: match text("vehicle") {
                Some(id) => files::vehicle_with_id(&vehicle_path, &id)?,
                None => files::vehicle(&vehicle_path.display().to_string())?,
            },
            trainee: text("trainee").or_else(|| trainee_from_folder_name(path, &scenario.scenario.name)).unwrap_or_default(),
            purpose: text("purpose"),
            site_check_unix_us: number("site_check_unix_us"),
            started_unix_us: started_unix_us.unwrap_or_default(),
            spandrel_version: text("spandrel_version").unwrap_or_default(),
            monitor_starts: u32::try_from(number("monitor_starts").unwrap_or_default()).unwrap_or(u32::MAX - 1),
            scenario,
            log,
        })
    }
}

/// Returns a session's trainee, and the wall time at its simulation time zero in µs since the Unix epoch. Faster than
/// reading the whole session.
///
/// # Errors
/// Returns an error if this is not a session folder, or a file is invalid.
pub fn trainee_and_start(path: &Path) -> Result<(String, u64), AppError> {
    let session = read_session_json(&path.join(SESSION))?;
    match (session["trainee"].as_str(), session["started_unix_us"].as_u64()) {
        (Some(trainee), Some(started_unix_us)) => Ok((trainee.to_owned(), started_unix_us)),
        (_, _) => StoredSession::read(path).map(|stored| (stored.trainee, stored.started_unix_us)),
    }
}

/// Returns a session's purpose, if one was chosen and `session.json` is readable. Faster than reading the whole
/// session.
pub fn purpose(path: &Path) -> Option<String> {
    read_session_json(&path.join(SESSION)).ok()?["purpose"].as_str().map(str::to_owned)
}

/// A session that is being recorded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OngoingSession {
    /// Trainee ID.
    pub trainee: String,
    /// Scenario CRC.
    pub crc: u32,
    /// Session seed.
    pub seed: u64,
}

/// Returns the session if it has not ended and its telemetry has grown within this period; `None` otherwise.
pub fn ongoing_session(path: &Path, within: Duration) -> Option<OngoingSession> {
    let grown = path.join(TELEMETRY).metadata().and_then(|about| about.modified()).ok()?;
    // If the clock has been set back, the file counts as recent.
    if path.join(ASSESSMENT).exists() || grown.elapsed().unwrap_or_default() > within {
        return None;
    }
    let session = read_session_json(&path.join(SESSION)).ok()?;
    let crc = u32::from_str_radix(session["scenario_crc"].as_str()?, 16).ok()?;
    Some(OngoingSession { trainee: session["trainee"].as_str()?.to_owned(), crc, seed: session["seed"].as_u64()? })
}

/// Returns true if the folder contains a session's telemetry.
pub fn is_session(path: &Path) -> bool {
    path.join(TELEMETRY).is_file()
}

fn not_a_session_folder(path: &Path) -> AppError {
    AppError::invalid(format!("{}: not a session folder (it has no {TELEMETRY})", path.display()))
}

/// Returns the contents of `session.json`, or null if there is no such file.
fn read_session_json(path: &Path) -> Result<serde_json::Value, AppError> {
    if !path.is_file() {
        return Ok(serde_json::Value::Null);
    }
    serde_json::from_str(&files::read(path)?)
        .map_err(|error| AppError::invalid(format!("{}: line {}: {error}", path.display(), error.line())))
}

/// Returns the trainee part of the folder name `<utc>-<trainee>-<scenario>-<short id>`.
fn trainee_from_folder_name(path: &Path, scenario: &str) -> Option<String> {
    let name = path.file_name()?.to_str()?;
    let (_, rest) = name.split_once('-')?;
    let (rest, _) = rest.rsplit_once('-')?;
    Some(rest.strip_suffix(scenario)?.strip_suffix('-')?.to_owned())
}

/// Creates a new folder. Its name is unique even if two sessions start in the same second.
fn new_folder(sessions: &Path, stem: &str, started_unix_us: u64) -> Result<PathBuf, AppError> {
    for attempt in 0..1000u32 {
        let key = format!("{started_unix_us} {} {attempt}", std::process::id());
        let path = sessions.join(format!("{stem}-{}", &sha256_hex(key.as_bytes())[..6]));
        match std::fs::create_dir(&path) {
            Ok(()) => return Ok(path),
            Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(io_error(&path, &error)),
        }
    }
    Err(AppError::failed(format!("{}: no free folder name for {stem}", sessions.display())))
}

fn io_error(path: &Path, error: &std::io::Error) -> AppError {
    AppError::failed(format!("{}: cannot write: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_sessions_with_the_same_start_time_get_separate_folders() {
        let sessions = tempfile::tempdir().unwrap();
        let make = || new_folder(sessions.path(), "20231114T221320Z-anna-two-bridges", 5).unwrap();
        let (a, b) = (make(), make());
        assert_ne!(a, b);
        assert!(a.is_dir() && b.is_dir());
    }

    #[test]
    fn exact_purpose_is_read_from_session_json() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(purpose(folder.path()), None, "nothing describes it");
        for (text, told) in
            [("{}", None), ("no JSON", None), (r#"{"purpose": null}"#, None), (r#"{"purpose": "practice"}"#, Some("practice"))]
        {
            std::fs::write(folder.path().join(SESSION), text).unwrap();
            assert_eq!(purpose(folder.path()).as_deref(), told, "{text}");
        }
    }

    #[test]
    fn exact_other_folders_are_rejected() {
        let folder = tempfile::tempdir().unwrap();
        let Err(error) = StoredSession::read(folder.path()) else { panic!("read it") };
        assert!(error.to_string().contains("not a session folder"));
    }
}
