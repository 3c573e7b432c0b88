//! Details of trainees, and the export and erasure of all data of a trainee.

use super::{Database, RecordsLocation, erasure, import};
use crate::args::TraineeId;
use crate::errors::AppError;
use crate::files;
use crate::session_folder::session_owner;
use serde::Serialize;
use spandrel_monitor::export::json_text;
use spandrel_training::record::SessionRecord;
use spandrel_training::trainee::{AGE_BANDS, EXPERIENCE, Role, Trainee};
use std::path::{Path, PathBuf};

/// Details to set for a person.
#[derive(Debug, clap::Args)]
pub struct PersonArgs {
    /// Pseudonym
    #[arg(value_name = "ID")]
    id: TraineeId,
    /// Role, which sets the person's permissions
    #[arg(long, value_name = "ROLE", value_parser = Role::ALL.map(Role::word))]
    role: Option<String>,
    /// Age, years
    #[arg(long, value_name = "BAND", value_parser = AGE_BANDS.to_vec())]
    age_band: Option<String>,
    /// Experience with drones
    #[arg(long, value_name = "HOW", value_parser = EXPERIENCE.to_vec())]
    drone_experience: Option<String>,
    /// Experience with games
    #[arg(long, value_name = "HOW", value_parser = EXPERIENCE.to_vec())]
    gaming_experience: Option<String>,
}

/// All stored data of one trainee.
#[derive(Debug, Serialize)]
pub struct TraineeData {
    trainee: Trainee,
    sessions: Vec<SessionRecord>,
    folders: Vec<String>,
}

impl TraineeData {
    /// Returns the same data with folder names instead of full paths, so that web responses do not reveal the server's file
    /// system.
    #[must_use]
    pub fn without_places(mut self) -> Self {
        for folder in &mut self.folders {
            let name = Path::new(folder).file_name().map(|name| name.to_string_lossy().into_owned());
            *folder = name.unwrap_or_default();
        }
        self
    }
}

/// Sets the given details of a person, then prints them.
///
/// # Errors
/// If the database fails, or the person does not exist and no details were given.
pub fn set(database: &Database, args: &PersonArgs) -> Result<(), AppError> {
    let name = args.id.as_str();
    let details = [&args.age_band, &args.drone_experience, &args.gaming_experience].map(|value| value.as_deref());
    if args.role.is_some() || details.iter().any(Option::is_some) {
        database.set_given(name, args.role.as_deref().and_then(Role::from_word), details)?;
    }
    let person = find(database, name)?;
    let person = person.ok_or_else(|| AppError::wrong(format!("{}: unknown person '{name}'", database.name())))?;
    files::write("-", json_text(&person).as_bytes())
}

/// Returns all stored data of a trainee: details, sessions and answers from the database, and folder names. `None` if there is no
/// data.
///
/// # Errors
/// If the database or a folder cannot be read.
pub fn kept(database: &Database, place: &RecordsLocation, trainee: &str) -> Result<Option<TraineeData>, AppError> {
    let sessions = database.records(Some(trainee))?;
    let folders = folders_of(place, trainee)?;
    let known = find(database, trainee)?;
    if known.is_none() && sessions.is_empty() && folders.is_empty() {
        return Ok(None);
    }
    let folders = folders.iter().map(|path| path.display().to_string()).collect();
    Ok(Some(TraineeData { trainee: known.unwrap_or_else(|| Trainee::new(trainee)), sessions, folders }))
}

/// Writes all stored data of a trainee.
///
/// # Errors
/// If there is no data, or the database or the output fails.
pub fn export(place: &RecordsLocation, trainee: &str, out: &str) -> Result<(), AppError> {
    let database = place.open()?;
    let kept = kept(&database, place, trainee)?;
    let kept = kept.ok_or_else(|| AppError::wrong(format!("{}: no data about '{trainee}'", database.name())))?;
    files::write(out, json_text(&kept).as_bytes())
}

/// Erases a trainee, or lists what would be erased.
///
/// # Errors
/// If a folder or the database cannot be changed.
pub fn erase(place: &RecordsLocation, trainee: &str, yes: bool) -> Result<(), AppError> {
    let database = place.open()?;
    let folders = folders_of(place, trainee)?;
    if !yes {
        let sessions = database.records(Some(trainee))?.len();
        let known = if find(&database, trainee)?.is_some() { "in the database" } else { "not in the database" };
        println!(
            "'{trainee}' is {known}: {sessions} sessions in {} and {} folders; --yes erases them",
            database.name(),
            folders.len()
        );
        return Ok(());
    }
    let (known, sessions) = erase_person(&database, place, trainee)?;
    if !known {
        return Err(AppError::wrong(format!("{}: no data about '{trainee}'", database.name())));
    }
    println!("erased '{trainee}': {sessions} sessions in {}, {} folders", database.name(), folders.len());
    Ok(())
}

/// Erases a trainee. Returns whether any data existed, and the number of sessions in the database.
///
/// # Errors
/// If a folder or the database cannot be changed.
pub fn erase_person(database: &Database, place: &RecordsLocation, trainee: &str) -> Result<(bool, u64), AppError> {
    let folders = folders_of(place, trainee)?;
    let (known, sessions) = database.erase(trainee, &folders)?;
    erasure::remove_folders(database, &folders)?;
    Ok((known || !folders.is_empty(), sessions))
}

fn find(database: &Database, trainee: &str) -> Result<Option<Trainee>, AppError> {
    Ok(database.account(trainee)?.map(|account| account.person))
}

fn folders_of(place: &RecordsLocation, trainee: &str) -> Result<Vec<PathBuf>, AppError> {
    folders_where(&place.sessions, |owner, _| owner == trainee)
}

/// Returns the session folders whose trainee and start (µs since the Unix epoch) satisfy the predicate. Logs unreadable folders,
/// because they may match.
///
/// # Errors
/// If the folder of sessions cannot be read.
fn folders_where(sessions: &[PathBuf], is: impl Fn(&str, u64) -> bool) -> Result<Vec<PathBuf>, AppError> {
    let here: Vec<PathBuf> = sessions.iter().filter(|folder| folder.is_dir()).cloned().collect();
    let mut found = Vec::new();
    for path in import::session_folders(&here)? {
        match session_owner(&path) {
            Ok((trainee, started_unix_us)) if is(&trainee, started_unix_us) => found.push(path),
            Ok(_) => {}
            Err(error) => tracing::warn!("cannot determine the trainee of a session folder: {error}"),
        }
    }
    Ok(found)
}

/// Erases all sessions and session folders that started before this time, µs since the Unix epoch. Returns the numbers of
/// sessions and folders.
///
/// # Errors
/// If a folder or the database cannot be changed.
pub fn erase_older(database: &Database, place: &RecordsLocation, limit_us: u64) -> Result<(u64, usize), AppError> {
    let folders = folders_older(place, limit_us)?;
    let ids: Vec<String> = database.older_than(limit_us)?.into_iter().map(|(id, _)| id).collect();
    let deleted = database.delete_sessions(&ids, &folders)?;
    erasure::remove_folders(database, &folders)?;
    Ok((deleted, folders.len()))
}

/// Returns the session folders that started before this time, µs since the Unix epoch.
///
/// # Errors
/// If the folder of sessions cannot be read.
pub fn folders_older(place: &RecordsLocation, limit_us: u64) -> Result<Vec<PathBuf>, AppError> {
    folders_where(&place.sessions, |_, started_unix_us| started_unix_us < limit_us)
}
