//! Saves uploaded scenarios. A scenario that somebody else has changed is not replaced silently.

use super::lock::lock;
use super::picture_store;
use super::safe_names::is_safe_file_name;
use super::scenario_library::{read, upload_path, uploaded};
use super::state::ServerState;
use crate::errors::AppError;
use crate::io::files;
use crate::io::replace::replace;
use spandrel_monitor::folder::sha256_hex;
use spandrel_text::{Language, text};
use std::path::Path;
use std::sync::MutexGuard;

/// Maximum number of uploaded scenarios.
const MAX_UPLOADS: usize = 200;
/// Names that the server's own pages use.
const RESERVED_NAMES: [&str; 1] = ["new"];

/// Returns an identifier of a scenario's text, by which the editor notices changes by others.
pub fn version(text: &str) -> String {
    sha256_hex(text.as_bytes())
}

/// The stored file that a save may replace.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Expected<'a> {
    /// Any file or none.
    Anything,
    /// No file.
    Absent,
    /// The file with this version.
    Version(&'a str),
}

/// Reason why a scenario was not saved.
#[derive(Debug, Clone, PartialEq)]
pub enum SaveError {
    /// The stored file is not the expected one; contains a message in the user's language.
    Conflict(String),
    /// The name is not allowed, or there are too many scenarios; contains a message in the user's language.
    Refused(String),
    /// The scenario is invalid, or the file cannot be written.
    App(AppError),
}

impl From<AppError> for SaveError {
    fn from(error: AppError) -> Self {
        Self::App(error)
    }
}

/// Validates and saves an uploaded scenario, and returns its name. `shown` is the file name for messages, which are in this
/// language unless they are about the contents of the file.
///
/// # Errors
/// Returns an error if the scenario or its name is invalid, the stored file is not the expected one, or writing fails.
pub fn save(
    state: &ServerState,
    language: Language,
    (shown, text): (&str, &str),
    expected: Expected<'_>,
) -> Result<String, SaveError> {
    let writing = lock(&state.scenario_writing);
    save_locked((state, &writing), language, (shown, text), expected)
}

/// Like [`save`], while the caller holds the lock for writing scenarios. Pictures of the briefing that the text does not list are
/// removed, and those of the scenario from which it was copied are copied.
///
/// # Errors
/// As [`save`].
pub fn save_locked(
    (state, _writing): (&ServerState, &MutexGuard<'_, ()>),
    language: Language,
    (shown, text): (&str, &str),
    expected: Expected<'_>,
) -> Result<String, SaveError> {
    let name = read(&state.scenarios, shown, text)?.name;
    check_name(language, shown, &name).map_err(SaveError::Refused)?;
    let target = upload_path(&state.scenarios, &name);
    check_expected(language, &target, &name, expected)?;
    if !target.is_file() && uploaded(&state.scenarios).len() >= MAX_UPLOADS {
        return Err(SaveError::Refused(text!(language, "editor-too-many", most = MAX_UPLOADS)));
    }
    std::fs::create_dir_all(&state.scenarios)
        .map_err(|error| AppError::failed(format!("{}: cannot create the folder: {error}", state.scenarios.display())))?;
    let text = picture_store::adopt(&state.scenarios, &read(&state.scenarios, shown, text)?, text)?;
    replace(&target, text.as_bytes())?;
    picture_store::remove_unlisted(&state.scenarios, &name, &read(&state.scenarios, shown, &text)?.briefing_pictures);
    Ok(name)
}

/// Returns a message if the name is not allowed.
fn check_name(language: Language, shown: &str, name: &str) -> Result<(), String> {
    // The name becomes part of folder names; the scenario parser allows only [a-z0-9-].
    if !is_safe_file_name(name) || name.len() > 60 {
        return Err(text!(language, "editor-name-too-long", file = shown));
    }
    if files::scenario_names().contains(&name) {
        return Err(text!(language, "editor-name-shipped", file = shown, name = name));
    }
    if RESERVED_NAMES.contains(&name) {
        return Err(text!(language, "editor-name-reserved", file = shown, name = name));
    }
    Ok(())
}

fn check_expected(language: Language, target: &Path, name: &str, expected: Expected<'_>) -> Result<(), SaveError> {
    let stored = if target.is_file() { Some(files::read(target)?) } else { None };
    let conflict = match (expected, &stored) {
        (Expected::Anything, _) | (Expected::Absent, None) => None,
        (Expected::Absent, Some(_)) => Some(text!(language, "editor-conflict-exists", name = name)),
        (Expected::Version(_), None) => Some(text!(language, "editor-conflict-deleted", name = name)),
        (Expected::Version(opened), Some(text)) => {
            (version(text) != opened).then(|| text!(language, "editor-conflict-changed", name = name))
        }
    };
    conflict.map_or(Ok(()), |words| Err(SaveError::Conflict(words)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_only_the_expected_file_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let target = upload_path(folder.path(), "job");
        let check = |expected: Expected<'_>| check_expected(Language::English, &target, "job", expected);
        assert_eq!((check(Expected::Absent), check(Expected::Anything)), (Ok(()), Ok(())));
        assert!(matches!(check(Expected::Version("x")), Err(SaveError::Conflict(words)) if words.contains("deleted")));
        std::fs::write(&target, "a = 1\n").unwrap();
        assert_eq!((check(Expected::Version(&version("a = 1\n"))), check(Expected::Anything)), (Ok(()), Ok(())));
        assert!(
            matches!(check(Expected::Version(&version("a = 2\n"))), Err(SaveError::Conflict(words)) if words.contains("changed"))
        );
        assert!(matches!(check(Expected::Absent), Err(SaveError::Conflict(words)) if words.contains("already")));
    }

    #[test]
    fn exact_shipped_and_reserved_names_are_refused() {
        let refused = |name: &str| check_name(Language::English, "job.toml", name).unwrap_err();
        assert!(refused("practice").contains("shipped scenario"));
        assert!(refused("new").contains("page of this server"));
        assert!(refused("../x").contains("too long") && refused(&"x".repeat(61)).contains("too long"));
        assert_eq!(check_name(Language::English, "job.toml", "my-job"), Ok(()));
    }
}
