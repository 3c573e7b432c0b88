//! Text files with which instructors replace shipped data, such as the rules of the training plans.

use super::response::WebError;
use super::state::ServerState;
use crate::errors::AppError;
use crate::io::files;
use crate::io::replace::replace;
use std::path::{Path, PathBuf};

/// A file that replaces shipped data while it exists. It is in a folder of its own, because the scenario folder lists its
/// files as scenarios.
#[derive(Debug, Clone, Copy)]
pub struct OwnFile {
    /// Folder inside the scenario folder.
    pub folder: &'static str,
    /// File name.
    pub name: &'static str,
}

impl OwnFile {
    /// Returns the file's path.
    pub fn path(self, state: &ServerState) -> PathBuf {
        self.path_in(&state.scenarios)
    }

    /// Returns the file's path in a folder of scenarios.
    pub fn path_in(self, scenarios: &Path) -> PathBuf {
        scenarios.join(self.folder).join(self.name)
    }

    /// Returns true if the file exists.
    pub fn exists(self, state: &ServerState) -> bool {
        self.path(state).is_file()
    }

    /// Returns the text; `None` if the shipped data is used.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read.
    pub fn text(self, state: &ServerState) -> Result<Option<String>, AppError> {
        if self.exists(state) { files::read(&self.path(state)).map(Some) } else { Ok(None) }
    }

    /// Saves the text.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub fn save(self, state: &ServerState, text: &str) -> Result<(), WebError> {
        let target = self.path(state);
        if let Some(folder) = target.parent() {
            std::fs::create_dir_all(folder)
                .map_err(|error| WebError::Failed(format!("{}: cannot create the folder: {error}", folder.display())))?;
        }
        Ok(replace(&target, text.as_bytes())?)
    }

    /// Deletes the file, if it exists.
    ///
    /// # Errors
    /// Returns an error if the file cannot be deleted.
    pub fn delete(self, state: &ServerState) -> Result<(), WebError> {
        let path = self.path(state);
        if !path.is_file() {
            return Ok(());
        }
        std::fs::remove_file(&path).map_err(|error| WebError::Failed(format!("{}: cannot remove: {error}", path.display())))
    }
}
