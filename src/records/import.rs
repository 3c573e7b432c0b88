//! Creates records from session folders.

use super::erasure_marks::ErasureMarks;
use crate::errors::AppError;
use crate::io::answers;
use crate::io::log_file::LogFile;
use crate::io::scoring;
use crate::io::session_folder::{StoredSession, is_session, trainee_and_start};
use spandrel_monitor::folder::{SCENARIO, TELEMETRY, VEHICLE};
use spandrel_monitor::sidecar::build_site;
use spandrel_training::questionnaire::ANSWERS;
use spandrel_training::record::{RecordSource, SessionRecord, SourceHashes, record};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Returns the session folders directly inside these folders, sorted by name (and therefore by time).
///
/// # Errors
/// Returns an error if a folder cannot be read.
pub fn session_folders(sessions: &[PathBuf]) -> Result<Vec<PathBuf>, AppError> {
    let mut found = Vec::new();
    for folder in sessions {
        let entries = std::fs::read_dir(folder)
            .map_err(|error| AppError::invalid(format!("{}: cannot read: {error}", folder.display())))?;
        found.extend(entries.flatten().map(|entry| entry.path()).filter(|path| is_session(path) && !is_hidden(path)));
    }
    found.sort_by(|a, b| a.file_name().cmp(&b.file_name()));
    Ok(found)
}

/// Returns true for folders that are being erased or created. Their names start with a dot.
fn is_hidden(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b"."))
}

/// Returns the ID of a session: the name of its folder.
///
/// # Errors
/// Returns an error if the folder name is not valid UTF-8.
pub fn id(session: &Path) -> Result<String, AppError> {
    let path = session.canonicalize().map_err(|error| AppError::invalid(format!("{}: {error}", session.display())))?;
    let name = path.file_name().and_then(|name| name.to_str());
    name.map(str::to_owned).ok_or_else(|| AppError::invalid(format!("{}: the folder name is not valid UTF-8", session.display())))
}

/// Creates a session folder's record. Returns `None` if `known` contains the session unchanged.
///
/// # Errors
/// Returns an error if the folder is invalid or contains nothing to score.
pub fn read(session: &Path, known: &BTreeMap<String, String>) -> Result<Option<SessionRecord>, AppError> {
    let id = id(session)?;
    let hashes = hashes(session)?;
    if known.get(&id).is_some_and(|fingerprint| *fingerprint == hashes.fingerprint()) {
        return Ok(None);
    }
    let stored = StoredSession::read(session)?;
    let scenario = &stored.scenario.scenario;
    let assessed_session = scoring::grade(&stored.log, scenario, &stored.vehicle.vehicle)
        .map_err(|error| AppError::failed(format!("{}: {error}", session.display())))?;
    // If the monitor was killed early, it did not save the defect positions; the seed reproduces them.
    let survey = scenario.defects.placed.is_none().then(|| build_site(scenario, assessed_session.seed));
    let placed = scenario.defects.placed.as_deref().or_else(|| survey.as_ref().map(|survey| survey.defects()));
    let answers = answers::read_saved_answers(session, scenario)?;
    Ok(Some(record(&RecordSource {
        id: &id,
        trainee: &stored.trainee,
        purpose: stored.purpose.as_deref(),
        started_unix_us: stored.started_unix_us,
        spandrel_version: &stored.spandrel_version,
        scenario,
        vehicle: &stored.vehicle.vehicle.id,
        hashes: &hashes,
        assessed_session: &assessed_session,
        placed: placed.unwrap_or_default(),
        answers: answers.as_ref(),
    })))
}

/// Returns true if a folder's session was erased, or if its trainee was erased after it started. Returns false for
/// unreadable folders, because [`read`] reports them.
pub fn is_erased(session: &Path, erased: &ErasureMarks) -> bool {
    let (Ok(id), Ok((trainee, started_unix_us))) = (id(session), trainee_and_start(session)) else { return false };
    erased.contains(&id, &trainee, started_unix_us)
}

fn hashes(session: &Path) -> Result<SourceHashes, AppError> {
    let bytes = |name: &str| {
        let path = session.join(name);
        std::fs::read(&path).map_err(|error| AppError::invalid(format!("{}: cannot read: {error}", path.display())))
    };
    let telemetry = LogFile::open(&session.join(TELEMETRY))?.sha256()?;
    let answers = if session.join(ANSWERS).is_file() { bytes(ANSWERS)? } else { Vec::new() };
    Ok(SourceHashes { telemetry, ..SourceHashes::of(&bytes(SCENARIO)?, &bytes(VEHICLE)?, &[], &answers) })
}
