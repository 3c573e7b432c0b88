//! Uploaded files. Small files stay in memory; large files are written to disk as they arrive, so slow clients occupy
//! neither memory nor a queue slot. Clients that are too slow are disconnected.

use super::response::WebError;
use crate::errors::AppError;
use spandrel_text::{Language, text};
use std::borrow::Cow;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// Maximum size of a file kept in memory, bytes.
const MAX_BYTES_IN_MEMORY: usize = 512 * 1024;
/// Time after which the minimum upload rate applies.
const MIN_RATE_GRACE_PERIOD: Duration = Duration::from_secs(30);
/// Minimum upload rate after that time, bytes/s. Estimate: one-sixteenth of a 1 Mbit/s line.
const MIN_UPLOAD_BYTES_S: u64 = 8 * 1024;

/// A completely uploaded file.
#[derive(Debug)]
pub enum SpooledUpload {
    /// Contents of a small file.
    Memory(Vec<u8>),
    /// A large file on disk, deleted when this is dropped.
    Disk(SpoolFile),
}

/// A file that is deleted when this is dropped.
#[derive(Debug)]
pub struct SpoolFile(PathBuf);

impl Drop for SpoolFile {
    fn drop(&mut self) {
        if let Err(error) = std::fs::remove_file(&self.0) {
            tracing::warn!("{}: cannot remove: {error}", self.0.display());
        }
    }
}

impl SpooledUpload {
    /// Returns the file's contents.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read.
    pub fn bytes(&self) -> Result<Cow<'_, [u8]>, AppError> {
        match self {
            Self::Memory(bytes) => Ok(Cow::Borrowed(bytes)),
            Self::Disk(file) => std::fs::read(&file.0).map(Cow::Owned).map_err(|error| unreadable(&file.0, &error)),
        }
    }
}

/// An upload in progress.
#[derive(Debug)]
pub struct UploadSpool<'a> {
    folder: &'a Path,
    max_bytes: usize,
    language: Language,
    size: usize,
    head: Vec<u8>,
    disk: Option<(File, SpoolFile)>,
}

impl<'a> UploadSpool<'a> {
    /// Creates an empty upload with a limit of `most` bytes. Large uploads are written to this folder. The language is that of
    /// messages.
    pub fn new(folder: &'a Path, most: usize, language: Language) -> Self {
        Self { folder, max_bytes: most, language, size: 0, head: Vec::new(), disk: None }
    }

    /// Returns the maximum size in bytes.
    pub fn max_bytes(&self) -> usize {
        self.max_bytes
    }

    /// Appends a chunk that arrived `elapsed` after the start of the upload.
    ///
    /// # Errors
    /// Returns an error if the file is too large, the client is too slow, or writing to the disk fails.
    pub fn append(&mut self, bytes: &[u8], elapsed: Duration) -> Result<(), WebError> {
        self.size += bytes.len();
        if self.size > self.max_bytes {
            return Err(WebError::TooLarge(self.max_bytes));
        }
        if is_below_min_rate(self.size, elapsed) {
            return Err(WebError::BadRequest(text!(self.language, "web-error-slow", rate = MIN_UPLOAD_BYTES_S / 1024)));
        }
        if self.disk.is_none() && self.head.len() + bytes.len() > MAX_BYTES_IN_MEMORY {
            self.disk = Some(self.create_file()?);
        }
        match &mut self.disk {
            Some((file, on_disk)) => file.write_all(bytes).map_err(|error| failed(&on_disk.0, &error)),
            None => {
                self.head.extend_from_slice(bytes);
                Ok(())
            }
        }
    }

    fn create_file(&mut self) -> Result<(File, SpoolFile), WebError> {
        static FILE_COUNTER: AtomicU64 = AtomicU64::new(0);
        let name = format!("upload-{}-{}", std::process::id(), FILE_COUNTER.fetch_add(1, Ordering::Relaxed));
        let path = self.folder.join(name);
        let begun = std::fs::create_dir_all(self.folder).and_then(|()| File::create(&path));
        let (mut file, on_disk) = (begun.map_err(|error| failed(&path, &error))?, SpoolFile(path));
        file.write_all(&std::mem::take(&mut self.head)).map_err(|error| failed(&on_disk.0, &error))?;
        Ok((file, on_disk))
    }

    /// Completes the upload and returns the file.
    pub fn finish(self) -> SpooledUpload {
        match self.disk {
            Some((_, on_disk)) => SpooledUpload::Disk(on_disk),
            None => SpooledUpload::Memory(self.head),
        }
    }
}

fn is_below_min_rate(size: usize, elapsed: Duration) -> bool {
    let counted_s = elapsed.saturating_sub(MIN_RATE_GRACE_PERIOD).as_secs();
    (size as u64) < counted_s.saturating_mul(MIN_UPLOAD_BYTES_S)
}

fn unreadable(path: &Path, error: &std::io::Error) -> AppError {
    AppError::failed(format!("{}: {error}", path.display()))
}

fn failed(path: &Path, error: &std::io::Error) -> WebError {
    unreadable(path, error).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_large_uploads_are_on_disk_until_dropped() {
        let folder = tempfile::tempdir().unwrap();
        let files = || std::fs::read_dir(folder.path()).unwrap().count();
        let chunk: Vec<u8> = (0..100_000u32).map(|k| k as u8).collect();
        let mut spool = UploadSpool::new(folder.path(), 10 * chunk.len(), Language::English);
        for _ in 0..10 {
            spool.append(&chunk, Duration::ZERO).unwrap();
        }
        assert_eq!(files(), 1);
        assert_eq!(spool.finish().bytes().as_deref(), Ok(&chunk.repeat(10)[..]));
        assert_eq!(files(), 0);
        let mut small = UploadSpool::new(folder.path(), 10, Language::English);
        small.append(b"0123456789", Duration::ZERO).unwrap();
        assert_eq!(small.append(b"x", Duration::ZERO), Err(WebError::TooLarge(10)));
        let mut dropped = UploadSpool::new(folder.path(), usize::MAX, Language::English);
        dropped.append(&vec![0; 2 * MAX_BYTES_IN_MEMORY], Duration::ZERO).unwrap();
        drop(dropped);
        assert_eq!(files(), 0);
    }

    #[test]
    fn regress_slow_uploads_are_below_the_minimum_rate() {
        assert!(!is_below_min_rate(1, MIN_RATE_GRACE_PERIOD), "the grace");
        assert!(is_below_min_rate(1, MIN_RATE_GRACE_PERIOD + Duration::from_secs(1)));
        assert!(!is_below_min_rate(96 * 1024 * 1024, Duration::from_secs(600)), "a recording over a slow line");
    }
}
