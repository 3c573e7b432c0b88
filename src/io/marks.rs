//! The instructor's marks in a session folder.

use super::files;
use super::replace::replace_durably;
use crate::errors::AppError;
use spandrel_training::marks::{MARKS, TimelineMark, marks_json, read_marks};
use std::path::Path;

/// Returns a session's marks by moment; empty if there are none.
///
/// # Errors
/// Returns an error if the file cannot be read or is invalid.
pub fn marks(session: &Path) -> Result<Vec<TimelineMark>, AppError> {
    let path = session.join(MARKS);
    if !path.is_file() {
        return Ok(Vec::new());
    }
    read_marks(&files::read(&path)?).map_err(|wrong| AppError::failed(format!("{}: {wrong}", path.display())))
}

/// Returns a session's marks by moment. If the file is invalid, logs the error and returns no marks, so that the session can
/// still be shown.
pub fn valid_marks(session: &Path) -> Vec<TimelineMark> {
    marks(session).unwrap_or_else(|error| {
        tracing::warn!("the session is shown without marks: {error}");
        Vec::new()
    })
}

/// Replaces a session's marks.
///
/// # Errors
/// Returns an error if the file cannot be written.
pub fn save_marks(session: &Path, marks: Vec<TimelineMark>) -> Result<(), AppError> {
    let text = marks_json(marks).map_err(|error| AppError::failed(error.to_string()))?;
    Ok(replace_durably(&session.join(MARKS), text.as_bytes())?)
}
