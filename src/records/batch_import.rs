//! Imports many session folders.

use super::database::Database;
use super::erasure_marks::ErasureMarks;
use super::import;
use crate::errors::AppError;
use crate::io::progress::ProgressLog;
use spandrel_training::record::SessionRecord;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Maximum number of records per database transaction, so that an interrupted import loses little work.
const RECORDS_PER_TRANSACTION: usize = 64;

/// Numbers of session folders by import result.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ImportCounts {
    /// New or changed folders.
    pub changed: usize,
    /// Folders that could not be read.
    pub left_out: usize,
    /// Folders of erased sessions.
    pub erased: usize,
}

impl ImportCounts {
    /// Returns the record of a folder, or `None` if the session was erased, is unchanged in `known`, or cannot be read.
    /// If it cannot be read, logs the error; `otherwise` describes the consequence.
    pub fn read(
        &mut self,
        folder: &Path,
        (known, erased): (&BTreeMap<String, String>, &ErasureMarks),
        otherwise: &str,
    ) -> Option<SessionRecord> {
        if import::is_erased(folder, erased) {
            self.erased += 1;
            return None;
        }
        import::read(folder, known).unwrap_or_else(|error| {
            self.left_out += 1;
            tracing::warn!("{otherwise}: {error}");
            None
        })
    }
}

/// Imports new and changed sessions. Logs and skips sessions that cannot be scored.
///
/// # Errors
/// Returns an error if the database fails.
pub fn import_into(database: &Database, folders: &[PathBuf]) -> Result<ImportCounts, AppError> {
    let (known, erased) = (database.fingerprints()?, database.erased()?);
    let mut taken = ImportCounts::default();
    let mut progress = ProgressLog::start("reading sessions");
    for (parcel, part) in folders.chunks(RECORDS_PER_TRANSACTION).enumerate() {
        let mut records = Vec::new();
        for (k, folder) in part.iter().enumerate() {
            progress.report(|| format!("session {} of {}", parcel * RECORDS_PER_TRANSACTION + k + 1, folders.len()));
            records.extend(taken.read(folder, (&known, &erased), "skipped"));
        }
        taken.changed += database.put(&records)?;
    }
    progress.finish();
    Ok(taken)
}
