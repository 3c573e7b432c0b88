//! A file that only grows, by whole records: what the disk refuses stays in memory and is written once it can be.

use crate::errors::AppError;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Bytes kept in memory while the disk refuses them: some 20 minutes of a session's telemetry (50 kB/s, estimate).
const PENDING_MOST: usize = 64 * 1024 * 1024;

/// The disk did not take a write.
#[derive(Debug, thiserror::Error)]
#[error("{}: cannot be written: {error}", path.display())]
pub struct WriteRefused {
    /// The file.
    pub path: PathBuf,
    /// The reason.
    pub error: std::io::Error,
}

impl WriteRefused {
    /// Returns true when space is missing, and not the disk itself at fault.
    pub fn is_full(&self) -> bool {
        matches!(self.error.kind(), ErrorKind::StorageFull | ErrorKind::QuotaExceeded)
    }
}

impl From<WriteRefused> for AppError {
    fn from(refused: WriteRefused) -> Self {
        Self::failed(refused.to_string())
    }
}

/// The file.
#[derive(Debug)]
pub struct AppendFile {
    file: File,
    path: PathBuf,
    /// Length on disk, whole records only.
    len: u64,
    /// The file may hold a part of a record beyond `len`.
    torn: bool,
    pending: Vec<u8>,
    dropped: u64,
    whole: fn(&[u8]) -> usize,
}

impl AppendFile {
    /// Opens or creates the file. `whole` returns the length of the whole records at the start of some bytes.
    ///
    /// # Errors
    /// If it cannot be opened.
    pub fn open(path: PathBuf, whole: fn(&[u8]) -> usize) -> Result<Self, WriteRefused> {
        let open = || {
            let file = OpenOptions::new().create(true).append(true).open(&path)?;
            let len = file.metadata()?.len();
            Ok((file, len))
        };
        match open() {
            Ok((file, len)) => Ok(Self { file, path, len, torn: false, pending: Vec::new(), dropped: 0, whole }),
            Err(error) => Err(WriteRefused { path, error }),
        }
    }

    /// Locks the file against another process that would append to it, until it is closed.
    ///
    /// # Errors
    /// When another process holds the lock. A file system without locks is no error.
    pub fn lock(&self) -> Result<(), AppError> {
        match self.file.try_lock() {
            Ok(()) => Ok(()),
            Err(TryLockError::WouldBlock) => Err(AppError::wrong(format!(
                "{}: another monitor records this session: end that one, or leave --session out to start a new session",
                self.path.display()
            ))),
            Err(TryLockError::Error(error)) => {
                tracing::warn!("{}: cannot be locked: {error}", self.path.display());
                Ok(())
            }
        }
    }

    /// Length on disk, bytes.
    pub fn len(&self) -> u64 {
        self.len
    }

    /// Cuts the file to this length.
    ///
    /// # Errors
    /// If the disk cannot be written.
    pub fn cut(&mut self, len: u64) -> Result<(), WriteRefused> {
        self.file.set_len(len).map_err(|error| self.refused(error))?;
        self.len = len;
        self.torn = false;
        Ok(())
    }

    /// Takes whole records; they reach the disk with the next [`Self::flush`]. Beyond a limit they are dropped and counted.
    pub fn push(&mut self, records: &[u8]) {
        if self.pending.len() > PENDING_MOST {
            self.dropped += 1;
        } else {
            self.pending.extend_from_slice(records);
        }
    }

    /// Pushes that were dropped.
    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    /// Bytes that the disk has not taken.
    pub fn pending(&self) -> usize {
        self.pending.len()
    }

    /// Writes what is pending. After an error the file holds whole records, and the rest stays pending.
    ///
    /// # Errors
    /// If the disk cannot be written.
    pub fn flush(&mut self) -> Result<(), WriteRefused> {
        if self.torn {
            self.cut(self.len)?;
        }
        let (written, result) = write_available(&mut self.file, &self.pending);
        let kept = if result.is_ok() { written } else { (self.whole)(&self.pending[..written]) };
        self.len += kept as u64;
        self.pending.drain(..kept);
        if self.pending.is_empty() {
            // A disk that was full for long leaves no large buffer behind.
            self.pending.shrink_to(PENDING_MOST / 64);
        }
        let Err(error) = result else { return Ok(()) };
        self.torn = written > kept;
        if self.torn {
            // A failure here is no other one: the next flush tries again.
            let _ = self.cut(self.len);
        }
        Err(self.refused(error))
    }

    /// Waits until what was written is on the disk itself.
    ///
    /// # Errors
    /// If the disk cannot be written.
    pub fn sync(&self) -> Result<(), WriteRefused> {
        self.file.sync_all().map_err(|error| self.refused(error))
    }

    fn refused(&self, error: std::io::Error) -> WriteRefused {
        WriteRefused { path: self.path.clone(), error }
    }
}

/// Writes until the end or an error, and returns how many bytes were taken.
fn write_available(file: &mut impl Write, bytes: &[u8]) -> (usize, std::io::Result<()>) {
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

/// Syncs files that were written and closed, and the folder that names them.
///
/// # Errors
/// When the disk refuses; files that do not exist are skipped.
pub fn sync_folder(folder: &Path, names: &[&str]) -> Result<(), WriteRefused> {
    let sync = |path: PathBuf| match File::open(&path).and_then(|file| file.sync_all()) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(WriteRefused { path, error }),
        Ok(()) | Err(_) => Ok(()),
    };
    names.iter().try_for_each(|name| sync(folder.join(name)))?;
    // Only Unix opens folders as files.
    if cfg!(unix) { sync(folder.to_path_buf()) } else { Ok(()) }
}

/// Length of the whole lines at the start of some bytes.
pub fn whole_lines(bytes: &[u8]) -> usize {
    bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1)
}
