//! Questionnaire answers in a session folder, and wordings from files.

use super::files;
use crate::errors::AppError;
use spandrel_model::scenario::Scenario;
use spandrel_training::questionnaire::{ANSWERS, Answers, Languages, read_answers, read_wording};
use std::path::{Path, PathBuf};

/// Returns a session's saved answers, or `None` if there are none.
///
/// # Errors
/// Returns an error if the file cannot be read or is invalid.
pub fn read_saved_answers(session: &Path, scenario: &Scenario) -> Result<Option<Answers>, AppError> {
    let path = session.join(ANSWERS);
    if !path.is_file() {
        return Ok(None);
    }
    Ok(Some(read_answers(&path.display().to_string(), &files::read(&path)?, &task_ids(scenario))?))
}

/// Returns the task numbers used in the questions.
pub fn task_ids(scenario: &Scenario) -> Vec<u32> {
    scenario.tasks.iter().map(|task| task.id).collect()
}

/// Returns the custom wordings followed by the shipped ones.
///
/// # Errors
/// Returns an error if a file cannot be read or is invalid.
pub fn languages(own: &[PathBuf]) -> Result<Languages, AppError> {
    let read = |path: &PathBuf| Ok(read_wording(&path.display().to_string(), &files::read(path)?)?);
    Ok(Languages::with(own.iter().map(read).collect::<Result<Vec<_>, AppError>>()?)?)
}
