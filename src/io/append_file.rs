//! Append-only files of complete records. Data that cannot be written yet stays in memory.

use crate::errors::AppError;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Maximum amount of data to keep in memory while the disk cannot be written, bytes: about 20 minutes of telemetry at
/// 50 kB/s (estimate).
const MAX_PENDING_BYTES: usize = 64 * 1024 * 1024;

/// A write error.
#[derive(Debug, thiserror::Error)]
#[error("{}: cannot write: {error}", path.display())]
pub struct WriteError {
    /// File path.
    pub path: PathBuf,
    /// The operating system's error.
    pub error: std::io::Error,
}

impl WriteError {
    /// Returns true if the disk is full, false for any other disk error.
    pub fn is_disk_full(&self) -> bool {
        matches!(self.error.kind(), ErrorKind::StorageFull | ErrorKind::QuotaExceeded)
    }
}

impl From<WriteError> for AppError {
    fn from(write_error: WriteError) -> Self {
        Self::failed(write_error.to_string())
    }
}

/// An append-only file with pending data.
#[derive(Debug)]
pub struct AppendFile {
    file: File,
    path: PathBuf,
    /// Length of the complete records on disk, bytes.
    len: u64,
    /// True if the file may contain a partial record beyond `len`.
    has_partial_record: bool,
    pending: Vec<u8>,
    dropped: u64,
    complete_len: fn(&[u8]) -> usize,
}

impl AppendFile {
    /// Opens or creates the file. `complete_len` returns the length of the complete records at the start of a buffer.
    ///
    /// # Errors
    /// Returns an error if the file cannot be opened.
    pub fn open(path: PathBuf, complete_len: fn(&[u8]) -> usize) -> Result<Self, WriteError> {
        let open = || {
            let file = OpenOptions::new().create(true).append(true).open(&path)?;
            let len = file.metadata()?.len();
            Ok((file, len))
        };
        match open() {
            Ok((file, len)) => {
                Ok(Self { file, path, len, has_partial_record: false, pending: Vec::new(), dropped: 0, complete_len })
            }
            Err(error) => Err(WriteError { path, error }),
        }
    }

    /// Locks the file against other processes until it is closed. `conflict` describes the conflict and how to solve it.
    ///
    /// # Errors
    /// Returns an error if another process has locked it. A file system without locks is not an error.
    pub fn lock(&self, conflict: &str) -> Result<(), AppError> {
        match self.file.try_lock() {
            Ok(()) => Ok(()),
            Err(TryLockError::WouldBlock) => Err(AppError::invalid(format!("{}: {conflict}", self.path.display()))),
            Err(TryLockError::Error(error)) => {
                tracing::warn!("{}: cannot lock: {error}", self.path.display());
                Ok(())
            }
        }
    }

    /// Returns the length on disk in bytes.
    pub fn len(&self) -> u64 {
        self.len
    }

    /// Truncates the file.
    ///
    /// # Errors
    /// Returns an error if the disk cannot be written.
    pub fn truncate(&mut self, len: u64) -> Result<(), WriteError> {
        self.file.set_len(len).map_err(|error| self.write_error(error))?;
        self.len = len;
        self.has_partial_record = false;
        Ok(())
    }

    /// Adds complete records; the next [`Self::flush`] writes them. Records that exceed the memory limit are dropped
    /// and counted.
    pub fn push(&mut self, records: &[u8]) {
        if self.pending.len() > MAX_PENDING_BYTES {
            self.dropped += 1;
        } else {
            self.pending.extend_from_slice(records);
        }
    }

    /// Returns the number of [`Self::push`] calls whose records were dropped.
    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    /// Returns the size of the pending data in bytes.
    pub fn pending(&self) -> usize {
        self.pending.len()
    }

    /// Writes the pending data. After an error, the file contains only complete records, and the rest remains pending.
    ///
    /// # Errors
    /// Returns an error if the disk cannot be written.
    pub fn flush(&mut self) -> Result<(), WriteError> {
        if self.has_partial_record {
            self.truncate(self.len)?;
        }
        let (written, result) = write_until_error(&mut self.file, &self.pending);
        let kept = if result.is_ok() { written } else { (self.complete_len)(&self.pending[..written]) };
        self.len += kept as u64;
        self.pending.drain(..kept);
        if self.pending.is_empty() {
            // After a long disk failure, free the memory of the large buffer.
            self.pending.shrink_to(MAX_PENDING_BYTES / 64);
        }
        let Err(error) = result else { return Ok(()) };
        self.has_partial_record = written > kept;
        if self.has_partial_record {
            // If this also fails, the next flush tries again.
            let _ = self.truncate(self.len);
        }
        Err(self.write_error(error))
    }

    /// Waits until all written data is on the physical disk.
    ///
    /// # Errors
    /// Returns an error if the disk cannot be written.
    pub fn sync(&self) -> Result<(), WriteError> {
        self.file.sync_all().map_err(|error| self.write_error(error))
    }

    fn write_error(&self, error: std::io::Error) -> WriteError {
        WriteError { path: self.path.clone(), error }
    }
}

/// Writes until all data is written or an error occurs. Returns the number of bytes written.
fn write_until_error(file: &mut impl Write, bytes: &[u8]) -> (usize, std::io::Result<()>) {
    let mut written = 0;
    while written < bytes.len() {
        match file.write(&bytes[written..]) {
            Ok(0) => return (written, Err(ErrorKind::WriteZero.into())),
            Ok(count) => written += count,
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return (written, Err(error)),
        }
    }
    (written, Ok(()))
}

/// Syncs closed files and their folder to disk.
///
/// # Errors
/// Returns an error if the disk cannot be written. Missing files are skipped.
pub fn sync_folder(folder: &Path, names: &[&str]) -> Result<(), WriteError> {
    let sync = |path: PathBuf| match File::open(&path).and_then(|file| file.sync_all()) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(WriteError { path, error }),
        Ok(()) | Err(_) => Ok(()),
    };
    names.iter().try_for_each(|name| sync(folder.join(name)))?;
    // Folders can be opened as files only on Unix.
    if cfg!(unix) { sync(folder.to_path_buf()) } else { Ok(()) }
}

/// Returns the length of the complete lines at the start of a buffer.
pub fn complete_lines_len(bytes: &[u8]) -> usize {
    bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1)
}
