//! File jobs and their results. The server never accesses files itself; its host runs the jobs.

use super::path::FilePath;
use spandrel_mavlink::ftp::FtpError;

/// Number of file bytes that one checksum job covers. A job takes less than 0.1 ms of CPU time (estimate, `crc32fast`),
/// so even a long file does not delay a tick.
pub const CHECKSUM_SLICE: u32 = 131_072;
/// Maximum size of a file to checksum, in bytes: 8,192 slices, or about 8 s of simulation time.
pub const MAX_CHECKSUM_BYTES: u32 = 8_192 * CHECKSUM_SLICE;
/// Cost of a directory listing, in jobs; a listing reads every name in the directory.
const LISTING_COST: u32 = 8;

/// A file operation for the host to run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileJob {
    /// Identifies the job; returned with its result.
    pub ticket: u64,
    /// The file operation to run.
    pub action: FileAction,
}

/// A file operation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FileAction {
    /// Lists the names and sizes in a directory in deterministic order.
    List(FilePath),
    /// Returns a file's size.
    Size(FilePath),
    /// Creates an empty file, or truncates an existing one.
    Create(FilePath),
    /// Reads up to a maximum number of bytes from an offset; returns no bytes at the end of the file.
    Read(FilePath, u32, u32),
    /// Writes bytes at an offset.
    Write(FilePath, u32, Vec<u8>),
    /// Removes a file.
    Remove(FilePath),
    /// Creates a directory.
    MakeDirectory(FilePath),
    /// Removes an empty directory.
    RemoveDirectory(FilePath),
    /// Truncates or extends a file.
    Truncate(FilePath, u32),
    /// Renames the first path to the second, which must not exist.
    Rename(FilePath, FilePath),
    /// Computes [`spandrel_mavlink::ftp::checksum`] over at most [`CHECKSUM_SLICE`] bytes of a file.
    Checksum {
        /// Path of the file.
        path: FilePath,
        /// Offset of the slice in the file, in bytes.
        from: u32,
        /// Checksum of all preceding bytes.
        sum: u32,
    },
}

impl FileAction {
    /// Returns the cost to deduct from [`super::job_allowance::JobAllowance`].
    #[must_use]
    pub fn cost(&self) -> u32 {
        if matches!(self, Self::List(_)) { LISTING_COST } else { 1 }
    }
}

/// An entry in a directory listing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum DirectoryEntry {
    /// A directory.
    Directory(String),
    /// A file and its size in bytes.
    File(String, u64),
}

/// A job's result.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FileJobResult {
    /// Result of [`FileAction::List`].
    Entries(Vec<DirectoryEntry>),
    /// Result of [`FileAction::Size`], in bytes.
    Size(u32),
    /// Result of [`FileAction::Read`].
    Bytes(Vec<u8>),
    /// Result of [`FileAction::Checksum`].
    Checksum {
        /// Checksum up to the end of the slice.
        sum: u32,
        /// Number of bytes in the slice; less than a full slice at the end of the file.
        bytes: u32,
    },
    /// Success of any other action.
    Nothing,
}

/// The reason a job failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileError {
    /// The path does not exist.
    NotFound,
    /// The path already exists.
    Exists,
    /// Permission to read or write the file is denied.
    Protected,
    /// Any other failure.
    Other,
}

impl FileError {
    /// Returns the corresponding MAVLink FTP error.
    #[must_use]
    pub fn refusal(self) -> FtpError {
        match self {
            Self::NotFound => FtpError::FileNotFound,
            Self::Exists => FtpError::FileExists,
            Self::Protected => FtpError::FileProtected,
            Self::Other => FtpError::Fail,
        }
    }
}
