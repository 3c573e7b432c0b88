//! Looks up people, and exports and erases all of a trainee's data.

use super::database::Database;
use super::erasure_marks::folder_name;
use super::location::RecordsLocation;
use super::{erasure, import};
use crate::errors::AppError;
use crate::io::session_folder::trainee_and_start;
use crate::io::{marks, school_record};
use serde::Serialize;
use spandrel_training::assignment::Assignment;
use spandrel_training::marks::TimelineMark;
use spandrel_training::record::SessionRecord;
use spandrel_training::rubric::SignOffEvent;
use spandrel_training::school::SchoolRecord;
use spandrel_training::trainee::Trainee;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Microseconds in a second.
const US_PER_S: u64 = 1_000_000;

/// All of one trainee's data.
#[derive(Debug, Serialize)]
pub struct TraineeData {
    trainee: Trainee,
    classes: Vec<String>,
    assignments: Vec<Assignment>,
    sign_offs: Vec<SignOffEvent>,
    sessions: Vec<SessionRecord>,
    folders: Vec<String>,
    /// The instructors' marks, by session folder.
    marks: BTreeMap<String, Vec<TimelineMark>>,
    /// Progress in the defect school, for each sessions folder that has any.
    school: Vec<SchoolRecord>,
}

impl TraineeData {
    /// Returns the same data with folder names instead of full paths, so that web responses do not reveal the server's
    /// directory layout.
    #[must_use]
    pub fn with_folder_names(mut self) -> Self {
        for folder in &mut self.folders {
            let name = Path::new(folder).file_name().map(|name| name.to_string_lossy().into_owned());
            *folder = name.unwrap_or_default();
        }
        self
    }
}

/// Returns all of a trainee's data: details, classes, assignments, sign-offs, sessions and answers from the database, and folder
/// names. Returns `None` if there is no data.
///
/// # Errors
/// Returns an error if the database or a folder cannot be read.
pub fn trainee_data(
    database: &Database,
    records_location: &RecordsLocation,
    trainee: &str,
) -> Result<Option<TraineeData>, AppError> {
    let sessions = database.records(Some(trainee))?;
    let folders = folders_of_trainee(records_location, trainee)?;
    let known = find(database, trainee)?;
    let stored = records_location.sessions.iter().map(|folder| school_record::find(folder, trainee));
    let school: Vec<SchoolRecord> = stored.filter_map(Result::transpose).collect::<Result<_, _>>()?;
    if known.is_none() && sessions.is_empty() && folders.is_empty() && school.is_empty() {
        return Ok(None);
    }
    let named = |folder: &PathBuf| Ok((folder_name(folder), marks::marks(folder)?));
    let marks = folders.iter().map(named).collect::<Result<BTreeMap<_, _>, AppError>>()?;
    let folders = folders.iter().map(|path| path.display().to_string()).collect();
    Ok(Some(TraineeData {
        trainee: known.unwrap_or_else(|| Trainee::new(trainee)),
        classes: database.classes_of(trainee)?,
        assignments: database.assignments_of_trainee(trainee)?,
        sign_offs: database.sign_offs(trainee)?,
        sessions,
        folders,
        marks,
        school,
    }))
}

/// Erases a trainee. Returns true if any data existed, and the number of sessions in the database.
///
/// # Errors
/// Returns an error if a folder or the database cannot be changed.
pub fn erase_trainee(database: &Database, records_location: &RecordsLocation, trainee: &str) -> Result<(bool, u64), AppError> {
    let folders = folders_of_trainee(records_location, trainee)?;
    let (known, sessions) = database.erase(trainee, &folders)?;
    erasure::remove_folders(database, &folders)?;
    remove_name_from_marks(records_location, trainee)?;
    Ok((known || !folders.is_empty(), sessions))
}

/// Removes an erased instructor's name from the marks in other trainees' sessions. The marks remain.
fn remove_name_from_marks(records_location: &RecordsLocation, name: &str) -> Result<(), AppError> {
    let here: Vec<PathBuf> = records_location.sessions.iter().filter(|folder| folder.is_dir()).cloned().collect();
    for folder in import::session_folders(&here)? {
        let mut found = marks::valid_marks(&folder);
        if found.iter().any(|mark| mark.by == name) {
            found.iter_mut().filter(|mark| mark.by == name).for_each(|mark| mark.by.clear());
            marks::save_marks(&folder, found)?;
        }
    }
    Ok(())
}

/// Returns a person, or `None` if nobody has this name.
///
/// # Errors
/// Returns an error if the database fails.
pub fn find(database: &Database, trainee: &str) -> Result<Option<Trainee>, AppError> {
    Ok(database.account(trainee)?.map(|account| account.person))
}

/// Returns a trainee's session folders, and the folder with the trainee's progress in the defect school.
///
/// # Errors
/// Returns an error if the sessions folder cannot be read.
pub fn folders_of_trainee(records_location: &RecordsLocation, trainee: &str) -> Result<Vec<PathBuf>, AppError> {
    let mut folders = matching_folders(&records_location.sessions, |owner, _| owner == trainee)?;
    let school = records_location.sessions.iter().map(|sessions| school_record::folder(sessions, trainee));
    folders.extend(school.filter(|folder| folder.is_dir()));
    Ok(folders)
}

/// Returns the session folders whose trainee and start time (µs since the Unix epoch) satisfy the predicate. Logs
/// unreadable folders, because they might match.
///
/// # Errors
/// Returns an error if the sessions folder cannot be read.
fn matching_folders(sessions: &[PathBuf], is: impl Fn(&str, u64) -> bool) -> Result<Vec<PathBuf>, AppError> {
    let here: Vec<PathBuf> = sessions.iter().filter(|folder| folder.is_dir()).cloned().collect();
    let mut found = Vec::new();
    for path in import::session_folders(&here)? {
        match trainee_and_start(&path) {
            Ok((trainee, started_unix_us)) if is(&trainee, started_unix_us) => found.push(path),
            Ok(_) => {}
            Err(error) => tracing::warn!("cannot tell which trainee a session folder belongs to: {error}"),
        }
    }
    Ok(found)
}

/// Erases all sessions and session folders that started before this time (µs since the Unix epoch). Returns the number
/// of sessions and the number of folders.
///
/// # Errors
/// Returns an error if a folder or the database cannot be changed.
pub fn erase_older_than(
    database: &Database,
    records_location: &RecordsLocation,
    limit_us: u64,
) -> Result<(u64, usize), AppError> {
    let folders = folders_older_than(records_location, limit_us)?;
    let ids: Vec<String> = database.older_than(limit_us)?.into_iter().map(|(id, _)| id).collect();
    let deleted = database.delete_sessions(&ids, &folders)?;
    erasure::remove_folders(database, &folders)?;
    Ok((deleted, folders.len()))
}

/// Returns the session folders that started before this time (µs since the Unix epoch), and the folders of the defect school
/// without a later answer.
///
/// # Errors
/// Returns an error if the sessions folder cannot be read.
pub fn folders_older_than(records_location: &RecordsLocation, limit_us: u64) -> Result<Vec<PathBuf>, AppError> {
    let mut folders = matching_folders(&records_location.sessions, |_, started_unix_us| started_unix_us < limit_us)?;
    let limit_s = limit_us / US_PER_S;
    folders.extend(records_location.sessions.iter().flat_map(|sessions| school_record::folders_older_than(sessions, limit_s)));
    Ok(folders)
}
