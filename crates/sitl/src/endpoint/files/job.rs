//! What the server asks of whoever holds the files, and what it is told. The server itself touches none.

use super::path::FilePath;
use spandrel_mavlink::ftp::FtpError;

/// Bytes of a file that one job sums up: less than a tenth of a millisecond of a processor (estimate, `crc32fast`), so that no tick waits
/// for a long file.
pub const CHECKSUM_SLICE: u32 = 131_072;
/// The longest file that is summed up, bytes: 8,192 slices, some 8 s of simulation time.
pub const CHECKSUM_MAX: u32 = 8_192 * CHECKSUM_SLICE;
/// A listing looks at every name in a directory; it counts as so many jobs.
const LISTING_COST: u32 = 8;

/// Work on files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileJob {
    /// Goes back with the outcome.
    pub ticket: u64,
    /// What to do.
    pub action: FileAction,
}

/// What to do with files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FileAction {
    /// Names and sizes in a directory, in one order every time.
    List(FilePath),
    /// The size of a file.
    Size(FilePath),
    /// Makes an empty file; one that is there is emptied.
    Create(FilePath),
    /// At most so many bytes from an offset; none at the end.
    Read(FilePath, u32, u32),
    /// Bytes to an offset.
    Write(FilePath, u32, Vec<u8>),
    /// Removes a file.
    Remove(FilePath),
    /// Makes a directory.
    MakeDirectory(FilePath),
    /// Removes an empty directory.
    RemoveDirectory(FilePath),
    /// Cuts or lengthens a file.
    Truncate(FilePath, u32),
    /// Renames the first to the second, which must not be there.
    Rename(FilePath, FilePath),
    /// [`spandrel_mavlink::ftp::checksum`] over at most [`CHECKSUM_SLICE`] bytes of a file.
    Checksum {
        /// The file.
        path: FilePath,
        /// Where the slice begins, bytes.
        from: u32,
        /// The sum over what lies before it.
        sum: u32,
    },
}

impl FileAction {
    /// What it takes out of the ticks' [`super::allowance::JobAllowance`].
    #[must_use]
    pub fn cost(&self) -> u32 {
        if matches!(self, Self::List(_)) { LISTING_COST } else { 1 }
    }
}

/// One thing in a directory.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum DirectoryEntry {
    /// A directory.
    Directory(String),
    /// A file and its size, bytes.
    File(String, u64),
}

/// What came of a job.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FileJobResult {
    /// Of [`FileAction::List`].
    Entries(Vec<DirectoryEntry>),
    /// Of [`FileAction::Size`], bytes.
    Size(u32),
    /// Of [`FileAction::Read`].
    Bytes(Vec<u8>),
    /// Of [`FileAction::Checksum`].
    Checksum {
        /// The sum up to the slice's end.
        sum: u32,
        /// Bytes of the slice; fewer than a whole one at the end of the file.
        bytes: u32,
    },
    /// Of everything else.
    Nothing,
}

/// Why a job was not done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileError {
    /// There is none.
    NotFound,
    /// One is there already.
    Exists,
    /// It may not be read or written.
    Protected,
    /// Anything else.
    Other,
}

impl FileError {
    /// As the wire says it.
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
