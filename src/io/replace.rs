//! Replaces a file as a whole.

use super::append_file::WriteRefused;
use crate::errors::AppError;
use std::fs::File;
use std::io::Write;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

/// Writes beside and renames, so that a reader or a kill never sees half a file.
///
/// # Errors
/// If the disk cannot be written.
pub fn replace(path: &Path, bytes: &[u8]) -> Result<(), AppError> {
    Ok(replaced(path, bytes, |_| Ok(()))?)
}

/// As [`replace`], and not even a power failure leaves half a file.
///
/// # Errors
/// If the disk cannot be written.
pub fn replace_durably(path: &Path, bytes: &[u8]) -> Result<(), WriteRefused> {
    replaced(path, bytes, File::sync_data)
}

fn replaced(path: &Path, bytes: &[u8], settle: fn(&File) -> std::io::Result<()>) -> Result<(), WriteRefused> {
    // A name of its own: two who write the same file at once must not rename each other's half.
    static WRITTEN: AtomicU64 = AtomicU64::new(0);
    let mut beside = path.to_path_buf().into_os_string();
    beside.push(format!(".{}-{}.new", std::process::id(), WRITTEN.fetch_add(1, Ordering::Relaxed)));
    let write = || {
        let mut file = File::create(&beside)?;
        file.write_all(bytes)?;
        settle(&file)?;
        drop(file);
        std::fs::rename(&beside, path)
    };
    write().map_err(|error| {
        // Nobody else would ever write over it.
        let _ = std::fs::remove_file(&beside);
        WriteRefused { path: path.to_path_buf(), error }
    })
}
