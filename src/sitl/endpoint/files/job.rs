//! What the server asks of whoever holds the files, and what it is told. The server itself touches none.

use super::path::FilePath;
use crate::mav::ftp::Refusal;

/// Work on files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Job {
    /// Goes back with the outcome.
    pub ticket: u64,
    /// What to do.
    pub action: Action,
}

/// What to do with files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Action {
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
    /// [`crate::mav::ftp::checksum`] over a whole file.
    Checksum(FilePath),
}

/// One thing in a directory.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Entry {
    /// A directory.
    Directory(String),
    /// A file and its size, bytes.
    File(String, u64),
}

/// What came of a job.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Done {
    /// Of [`Action::List`].
    Entries(Vec<Entry>),
    /// Of [`Action::Size`], bytes.
    Size(u32),
    /// Of [`Action::Read`].
    Bytes(Vec<u8>),
    /// Of [`Action::Checksum`].
    Checksum(u32),
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
    pub fn refusal(self) -> Refusal {
        match self {
            Self::NotFound => Refusal::FileNotFound,
            Self::Exists => Refusal::FileExists,
            Self::Protected => Refusal::FileProtected,
            Self::Other => Refusal::Fail,
        }
    }
}
