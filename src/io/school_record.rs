//! The trainees' progress in the defect school: one folder per trainee beside the session folders, so that it is erased like them.

use super::files;
use super::replace::replace;
use crate::errors::AppError;
use spandrel_training::school::SchoolRecord;
use std::path::{Path, PathBuf};

/// Start of the folders' names, which the trainee's ID completes. Such a folder is no session, because it has no telemetry.
const FOLDER_PREFIX: &str = "school-";
/// File in the folder.
const FILE: &str = "progress.json";

/// Returns the folder with a trainee's progress.
pub fn folder(sessions: &Path, trainee: &str) -> PathBuf {
    sessions.join(format!("{FOLDER_PREFIX}{trainee}"))
}

/// Returns a trainee's record, if there is one.
///
/// # Errors
/// Returns an error if the file cannot be read or is invalid.
pub fn find(sessions: &Path, trainee: &str) -> Result<Option<SchoolRecord>, AppError> {
    read(&folder(sessions, trainee))
}

/// Creates a trainee's folder, if it does not exist.
///
/// # Errors
/// Returns an error if the disk cannot be written.
#[cfg_attr(not(feature = "view"), allow(dead_code, reason = "only the window asks questions"))]
pub fn create(sessions: &Path, trainee: &str) -> Result<(), AppError> {
    let folder = folder(sessions, trainee);
    std::fs::create_dir_all(&folder).map_err(|error| AppError::failed(format!("{}: {error}", folder.display())))
}

/// Saves a trainee's record in its folder.
///
/// # Errors
/// Returns an error if the trainee has been erased since [`create`], or if the disk cannot be written.
#[cfg_attr(not(feature = "view"), allow(dead_code, reason = "only the window asks questions"))]
pub fn save(sessions: &Path, trainee: &str, record: &SchoolRecord) -> Result<(), AppError> {
    let folder = folder(sessions, trainee);
    if !folder.is_dir() {
        return Err(AppError::failed(format!("the data of '{trainee}' was erased during this round: begin another round")));
    }
    replace(&folder.join(FILE), record.text().as_bytes())
}

/// Returns the folders whose last answer is older than this time, s since the Unix epoch. Leaves out unreadable ones, and logs
/// them.
pub fn folders_older_than(sessions: &Path, limit_unix_s: u64) -> Vec<PathBuf> {
    let is_old = |folder: &PathBuf| match read(folder) {
        Ok(record) => record.is_some_and(|record| record.last_unix_s() < limit_unix_s),
        Err(error) => {
            tracing::warn!("cannot tell how old a school record is: {error}");
            false
        }
    };
    let is_school =
        |path: &PathBuf| path.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(FOLDER_PREFIX.as_bytes()));
    let entries = std::fs::read_dir(sessions).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).filter(is_school).filter(is_old).collect()
}

fn read(folder: &Path) -> Result<Option<SchoolRecord>, AppError> {
    let path = folder.join(FILE);
    if !path.is_file() {
        return Ok(None);
    }
    let record = SchoolRecord::read(&files::read(&path)?);
    record.map(Some).map_err(|error| AppError::invalid(format!("{}: {error}", path.display())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_training::school::{Card, Distance, Subject};

    const CARD: Card = Card { distance: Distance::Near, subject: Subject::Sound };

    #[test]
    fn exact_records_are_stored_per_trainee() {
        let temp_dir = tempfile::tempdir().unwrap();
        let sessions = temp_dir.path().join("sessions");
        assert_eq!(find(&sessions, "anna"), Ok(None));
        let mut record = SchoolRecord::default();
        record.answer(CARD, true, 1000);
        for (trainee, record) in [("anna", &record), ("bert", &SchoolRecord::default())] {
            assert!(save(&sessions, trainee, record).is_err(), "erased data must not return");
            create(&sessions, trainee).unwrap();
            save(&sessions, trainee, record).unwrap();
        }
        assert_eq!(find(&sessions, "anna"), Ok(Some(record)));
        assert_eq!(folders_older_than(&sessions, 1000), [folder(&sessions, "bert")], "bert has never answered");
        assert_eq!(folders_older_than(&temp_dir.path().join("none"), 1000), Vec::<PathBuf>::new());
    }

    #[test]
    fn exact_invalid_record_is_named() {
        let temp_dir = tempfile::tempdir().unwrap();
        let anna = folder(temp_dir.path(), "anna");
        std::fs::create_dir(&anna).unwrap();
        std::fs::write(anna.join(FILE), r#"{"format": 7, "rounds": 0, "last_unix_s": 0, "cards": {}}"#).unwrap();
        let error = find(temp_dir.path(), "anna").unwrap_err().to_string();
        assert!(error.contains("progress.json: format 7: unknown (allowed: 1)"), "{error}");
        assert_eq!(folders_older_than(temp_dir.path(), 1000), Vec::<PathBuf>::new());
    }
}
