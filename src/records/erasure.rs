//! Removes session folders in a crash-safe way. The transaction that erases the records also marks their folders. Each
//! folder is then renamed, so that no program reads it anymore, and deleted. The next start completes interrupted
//! removals.

use super::database::Database;
use super::erasure_marks::{self, ErasedKind, folder_name};
use crate::errors::AppError;
use sqlx::Row;
use std::collections::BTreeSet;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Name prefix of folders that are being deleted.
const ERASING_PREFIX: &str = ".erasing-";

impl Database {
    /// Returns the name hashes of the folders that are marked for removal.
    fn marked_folder_hashes(&self) -> Result<BTreeSet<String>, AppError> {
        self.run(async {
            let query = sqlx::query("SELECT sha256 FROM erased WHERE what = $1").bind(ErasedKind::Folder.word().to_owned());
            query.fetch_all(&self.pool).await?.iter().map(|row| row.try_get(0)).collect()
        })
    }

    /// Removes a deleted folder's mark.
    fn remove_mark(&self, name: &str) -> Result<(), AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            erasure_marks::unmark(&mut change, ErasedKind::Folder, name).await?;
            change.commit().await
        })
    }
}

/// Removes folders that the database has marked (`Database::erase`, `Database::delete_sessions`).
///
/// # Errors
/// Returns an error if the disk or the database fails; the next start tries again.
pub(super) fn remove_folders(database: &Database, folders: &[PathBuf]) -> Result<(), AppError> {
    for folder in folders {
        let name = folder_name(folder);
        let aside = folder.with_file_name(format!("{ERASING_PREFIX}{name}"));
        delete(&aside)?;
        match std::fs::rename(folder, &aside) {
            // Another process is finishing the same erasure.
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            moved => moved.map_err(|error| io_error(folder, &error))?,
        }
        sync_parent(folder)?;
        delete(&aside)?;
        database.remove_mark(&name)?;
    }
    Ok(())
}

/// Finishes interrupted erasures.
///
/// # Errors
/// Returns an error if the disk or the database fails.
pub(super) fn finish_erasures(database: &Database, sessions: &[PathBuf]) -> Result<(), AppError> {
    let marked = database.marked_folder_hashes()?;
    for entry in sessions.iter().filter_map(|folder| std::fs::read_dir(folder).ok()).flatten().flatten() {
        let path = entry.path();
        let name = folder_name(&path);
        if let Some(original) = name.strip_prefix(ERASING_PREFIX) {
            delete(&path)?;
            database.remove_mark(original)?;
        } else if marked.contains(&erasure_marks::hash(&name)) {
            remove_folders(database, &[path])?;
        }
    }
    Ok(())
}

fn delete(folder: &Path) -> Result<(), AppError> {
    match std::fs::remove_dir_all(folder) {
        Err(error) if error.kind() != ErrorKind::NotFound || folder.exists() => Err(io_error(folder, &error)),
        _ => Ok(()),
    }
}

/// Syncs the parent folder, so that the new name is on disk before the contents are deleted.
fn sync_parent(folder: &Path) -> Result<(), AppError> {
    let Some(parent) = folder.parent().filter(|parent| !parent.as_os_str().is_empty()) else { return Ok(()) };
    std::fs::File::open(parent).and_then(|parent| parent.sync_all()).map_err(|error| io_error(parent, &error))
}

fn io_error(path: &Path, error: &std::io::Error) -> AppError {
    AppError::failed(format!("{}: cannot erase: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn session(sessions: &Path, name: &str) -> PathBuf {
        let folder = sessions.join(name);
        std::fs::create_dir_all(folder.join("snapshots")).unwrap();
        for file in ["telemetry.tlog", "answers.json", "session.json", "snapshots/1.jpg"] {
            std::fs::write(folder.join(file), "private").unwrap();
        }
        folder
    }

    fn remaining_folders(sessions: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            std::fs::read_dir(sessions).unwrap().flatten().map(|entry| folder_name(&entry.path())).collect();
        names.retain(|name| !name.starts_with("records"));
        names.sort();
        names
    }

    #[test]
    fn regress_interrupted_erasures_are_finished_at_the_next_start() {
        let temp_dir = tempfile::tempdir().unwrap();
        let here = [temp_dir.path().to_path_buf()];
        let database = Database::open(&temp_dir.path().join("records.sqlite").display().to_string()).unwrap();
        session(temp_dir.path(), "b-ben");
        // The erasure is interrupted after the transaction, after the rename, and during the deletion.
        let [marked, renamed, half] = ["a-anna", "c-anna", "d-anna"].map(|name| session(temp_dir.path(), name));
        database.erase("anna", &[marked, renamed.clone(), half.clone()]).unwrap();
        for folder in [&renamed, &half] {
            std::fs::rename(folder, folder.with_file_name(format!("{ERASING_PREFIX}{}", folder_name(folder)))).unwrap();
        }
        std::fs::remove_file(temp_dir.path().join(format!("{ERASING_PREFIX}d-anna")).join("telemetry.tlog")).unwrap();
        finish_erasures(&database, &here).unwrap();
        assert_eq!(remaining_folders(temp_dir.path()), ["b-ben"]);
        assert_eq!(database.marked_folder_hashes(), Ok(BTreeSet::new()));
        // A folder that someone copies back later is not deleted automatically.
        session(temp_dir.path(), "a-anna");
        finish_erasures(&database, &here).unwrap();
        assert_eq!(remaining_folders(temp_dir.path()), ["a-anna", "b-ben"]);
    }
}
