//! Where the database and the session folders are.

use super::database::Database;
use super::erasure;
use crate::errors::AppError;
use std::path::{Path, PathBuf};

/// Locations of the database and the session folders.
#[derive(Debug, Clone)]
pub struct RecordsLocation {
    /// Folders that contain session folders.
    pub sessions: Vec<PathBuf>,
    /// Database: a file, or a PostgreSQL URL; `None` for `records.sqlite` in the first sessions folder.
    pub database: Option<String>,
}

impl RecordsLocation {
    /// Returns one sessions folder with the database in it.
    #[must_use]
    pub fn beside(sessions: &Path) -> Self {
        Self { sessions: vec![sessions.to_path_buf()], database: None }
    }

    /// Returns whether the database has been created. One that was chosen explicitly counts as created.
    #[must_use]
    pub fn exists(&self) -> bool {
        self.database.is_some() || self.default_database().is_file()
    }

    /// Opens the database if it has been created, and finishes interrupted erasures.
    ///
    /// # Errors
    /// Returns an error if it cannot be opened.
    pub fn open_existing(&self) -> Result<Option<Database>, AppError> {
        if self.exists() { self.open().map(Some) } else { Ok(None) }
    }

    fn default_database(&self) -> PathBuf {
        self.sessions.first().cloned().unwrap_or_else(|| PathBuf::from("sessions")).join("records.sqlite")
    }

    /// Opens the database and completes interrupted erasures.
    ///
    /// # Errors
    /// Returns an error if the database cannot be opened.
    pub fn open(&self) -> Result<Database, AppError> {
        let database = match &self.database {
            Some(target) => Database::open(target),
            None => Database::open(&self.default_database().display().to_string()),
        }?;
        if let Err(error) = erasure::finish_erasures(&database, &self.sessions) {
            tracing::warn!("cannot finish an interrupted erasure: {error}");
        }
        Ok(database)
    }
}
