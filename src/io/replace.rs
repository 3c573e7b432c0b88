//! Replaces whole files atomically.

use super::append_file::WriteError;
use crate::errors::AppError;
use std::fs::File;
use std::io::Write;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

/// Writes a temporary file next to the target and renames it, so readers never see a partial file, even if the process
/// is killed.
///
/// # Errors
/// Returns an error if the disk cannot be written.
pub fn replace(path: &Path, bytes: &[u8]) -> Result<(), AppError> {
    Ok(write_and_rename(path, bytes, |_| Ok(()))?)
}

/// Like [`replace`], but also safe against a power failure.
///
/// # Errors
/// Returns an error if the disk cannot be written.
pub fn replace_durably(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    write_and_rename(path, bytes, File::sync_data)
}

fn write_and_rename(path: &Path, bytes: &[u8], settle: fn(&File) -> std::io::Result<()>) -> Result<(), WriteError> {
    // The temporary name is unique so that two writers of the same file do not rename each other's partial file.
    static TEMP_FILE_COUNTER: AtomicU64 = AtomicU64::new(0);
    let mut temp_path = path.to_path_buf().into_os_string();
    temp_path.push(format!(".{}-{}.new", std::process::id(), TEMP_FILE_COUNTER.fetch_add(1, Ordering::Relaxed)));
    let write = || {
        let mut file = File::create(&temp_path)?;
        file.write_all(bytes)?;
        settle(&file)?;
        drop(file);
        std::fs::rename(&temp_path, path)
    };
    write().map_err(|error| {
        // Later writes do not reuse this name, so the file would otherwise remain.
        let _ = std::fs::remove_file(&temp_path);
        WriteError { path: path.to_path_buf(), error }
    })
}
