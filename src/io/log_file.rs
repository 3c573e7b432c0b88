//! A session's telemetry log on disk. It is read in chunks so that long logs do not use more memory.

use crate::errors::AppError;
use sha2::{Digest, Sha256};
use spandrel_mavlink::telemetry::log_stream::{RecordSplitter, TelemetryLog};
use spandrel_mavlink::telemetry::tlog::{self, TlogRecord};
use std::fs::File;
use std::io::Read;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Chunk size, bytes.
const CHUNK_BYTES: usize = 256 * 1024;
/// Number of bytes at the start of the file that always include the whole first record.
const HEAD_BYTES: u64 = 64 * 1024;

/// A telemetry log. Reads stop at the file's length at the time of opening, because the session may still be recording.
#[derive(Debug, Clone)]
pub struct LogFile {
    path: PathBuf,
    len: u64,
}

impl LogFile {
    /// Opens the log and stores its current length.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read.
    pub fn open(path: &Path) -> Result<Self, AppError> {
        let len = File::open(path).and_then(|file| file.metadata()).map_err(|error| unreadable(path, &error))?.len();
        Ok(Self { path: path.to_path_buf(), len })
    }

    /// Returns the length in bytes.
    pub fn len(&self) -> u64 {
        self.len
    }

    /// Returns the path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the length up to the end of the last complete record, in bytes.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read.
    pub fn complete_len(&self) -> Result<u64, AppError> {
        self.read_records(&mut |_| ControlFlow::Continue(())).map_err(|error| unreadable(&self.path, &error))
    }

    /// Returns the Unix time in µs at simulation time zero; `None` for an empty log.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read.
    pub fn session_start_us(&self) -> Result<Option<u64>, AppError> {
        Ok(tlog::session_start_us(&self.head()?))
    }

    /// Returns the log's SHA-256 hash as hexadecimal digits.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read.
    pub fn sha256(&self) -> Result<String, AppError> {
        let mut hash = Sha256::new();
        let mut update = |piece: &[u8]| {
            hash.update(piece);
            ControlFlow::Continue(())
        };
        self.for_each_chunk(&mut update).map_err(|error| unreadable(&self.path, &error))?;
        Ok(hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect())
    }

    /// Returns the whole log.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read.
    #[cfg(feature = "view")]
    pub fn bytes(&self) -> Result<Vec<u8>, AppError> {
        self.read(self.len)
    }

    fn read(&self, most: u64) -> Result<Vec<u8>, AppError> {
        let mut bytes = Vec::new();
        let read = File::open(&self.path).and_then(|file| file.take(most.min(self.len)).read_to_end(&mut bytes));
        read.map(|_| bytes).map_err(|error| unreadable(&self.path, &error))
    }

    /// Calls `take` with each complete record, in file order, until `take` returns `Break` or the log ends. Returns the
    /// length up to the end of the last complete record read, in bytes.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read.
    pub fn read_records(&self, take: &mut dyn FnMut(TlogRecord<'_>) -> ControlFlow<()>) -> std::io::Result<u64> {
        let mut splitter = RecordSplitter::default();
        let mut broken = false;
        self.for_each_chunk(&mut |piece| {
            let flow = splitter.feed(piece, take);
            broken = flow.is_break();
            flow
        })?;
        // Only the end of the file shows that the last record is complete.
        if !broken {
            let _ = splitter.end(take);
        }
        Ok(splitter.complete_bytes())
    }

    /// Returns the start of the log, at most [`HEAD_BYTES`] bytes.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read.
    pub fn head(&self) -> Result<Vec<u8>, AppError> {
        self.read(HEAD_BYTES)
    }

    fn for_each_chunk(&self, take: &mut dyn FnMut(&[u8]) -> ControlFlow<()>) -> std::io::Result<()> {
        let mut file = File::open(&self.path)?.take(self.len);
        let mut piece = vec![0; CHUNK_BYTES];
        loop {
            let length = match file.read(&mut piece) {
                Err(error) if error.kind() == std::io::ErrorKind::Interrupted => continue,
                other => other?,
            };
            if length == 0 || take(&piece[..length]).is_break() {
                return Ok(());
            }
        }
    }
}

impl TelemetryLog for LogFile {
    fn for_each_record(&self, take: &mut dyn FnMut(TlogRecord<'_>) -> ControlFlow<()>) -> std::io::Result<()> {
        self.read_records(take).map(|_| ())
    }
}

fn unreadable(path: &Path, error: &std::io::Error) -> AppError {
    AppError::invalid(format!("{}: cannot read: {error}", path.display()))
}
