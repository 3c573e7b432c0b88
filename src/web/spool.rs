//! Files of forms. A small one stays in memory; a large one goes to disk while it arrives, so that slow senders hold neither memory nor a place
//! in a queue, and a sender that is too slow is put out.

use super::answer::Refusal;
use crate::errors::AppError;
use std::borrow::Cow;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// A file up to this size stays in memory, bytes.
const IN_MEMORY: usize = 512 * 1024;
/// A sender has this long before its rate counts.
const GRACE: Duration = Duration::from_secs(30);
/// Lowest rate after that, bytes a second. Estimate: a sixteenth of a 1 Mbit/s line.
const LEAST_RATE: u64 = 8 * 1024;

/// A file of a form, complete.
#[derive(Debug)]
pub enum Spooled {
    /// In memory.
    Memory(Vec<u8>),
    /// On disk, removed when this is dropped.
    Disk(OnDisk),
}

/// A file that is removed when this is dropped.
#[derive(Debug)]
pub struct OnDisk(PathBuf);

impl Drop for OnDisk {
    fn drop(&mut self) {
        if let Err(error) = std::fs::remove_file(&self.0) {
            tracing::warn!("{}: cannot be removed: {error}", self.0.display());
        }
    }
}

impl Spooled {
    /// Returns the whole file.
    ///
    /// # Errors
    /// When the disk refuses.
    pub fn bytes(&self) -> Result<Cow<'_, [u8]>, AppError> {
        match self {
            Self::Memory(bytes) => Ok(Cow::Borrowed(bytes)),
            Self::Disk(file) => std::fs::read(&file.0).map(Cow::Owned).map_err(|error| unreadable(&file.0, &error)),
        }
    }
}

/// A file that is arriving.
#[derive(Debug)]
pub struct Spool<'a> {
    folder: &'a Path,
    most: usize,
    size: usize,
    head: Vec<u8>,
    disk: Option<(File, OnDisk)>,
}

impl<'a> Spool<'a> {
    /// An empty file of at most `most` bytes, which may be kept in this folder meanwhile.
    pub fn new(folder: &'a Path, most: usize) -> Self {
        Self { folder, most, size: 0, head: Vec::new(), disk: None }
    }

    /// Largest size, bytes.
    pub fn most(&self) -> usize {
        self.most
    }

    /// Takes what has arrived after this time.
    ///
    /// # Errors
    /// When the file is too large or its sender too slow, or the disk refuses.
    pub fn take(&mut self, bytes: &[u8], elapsed: Duration) -> Result<(), Refusal> {
        self.size += bytes.len();
        if self.size > self.most {
            return Err(Refusal::TooLarge(self.most));
        }
        if is_too_slow(self.size, elapsed) {
            return Err(Refusal::Wrong(format!("the file came too slowly (allowed: {} KiB/s or more)", LEAST_RATE / 1024)));
        }
        if self.disk.is_none() && self.head.len() + bytes.len() > IN_MEMORY {
            self.disk = Some(self.begin()?);
        }
        match &mut self.disk {
            Some((file, on_disk)) => file.write_all(bytes).map_err(|error| failed(&on_disk.0, &error)),
            None => {
                self.head.extend_from_slice(bytes);
                Ok(())
            }
        }
    }

    fn begin(&mut self) -> Result<(File, OnDisk), Refusal> {
        static BEGUN: AtomicU64 = AtomicU64::new(0);
        let name = format!("upload-{}-{}", std::process::id(), BEGUN.fetch_add(1, Ordering::Relaxed));
        let path = self.folder.join(name);
        let begun = std::fs::create_dir_all(self.folder).and_then(|()| File::create(&path));
        let (mut file, on_disk) = (begun.map_err(|error| failed(&path, &error))?, OnDisk(path));
        file.write_all(&std::mem::take(&mut self.head)).map_err(|error| failed(&on_disk.0, &error))?;
        Ok((file, on_disk))
    }

    /// The file is complete.
    pub fn end(self) -> Spooled {
        match self.disk {
            Some((_, on_disk)) => Spooled::Disk(on_disk),
            None => Spooled::Memory(self.head),
        }
    }
}

fn is_too_slow(size: usize, elapsed: Duration) -> bool {
    let counted_s = elapsed.saturating_sub(GRACE).as_secs();
    (size as u64) < counted_s.saturating_mul(LEAST_RATE)
}

fn unreadable(path: &Path, error: &std::io::Error) -> AppError {
    AppError::failed(format!("{}: {error}", path.display()))
}

fn failed(path: &Path, error: &std::io::Error) -> Refusal {
    unreadable(path, error).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_large_file_lies_on_disk_until_it_is_read_or_dropped() {
        let folder = tempfile::tempdir().unwrap();
        let files = || std::fs::read_dir(folder.path()).unwrap().count();
        let chunk: Vec<u8> = (0..100_000u32).map(|k| k as u8).collect();
        let mut spool = Spool::new(folder.path(), 10 * chunk.len());
        for _ in 0..10 {
            spool.take(&chunk, Duration::ZERO).unwrap();
        }
        assert_eq!(files(), 1);
        assert_eq!(spool.end().bytes().as_deref(), Ok(&chunk.repeat(10)[..]));
        assert_eq!(files(), 0);
        let mut small = Spool::new(folder.path(), 10);
        small.take(b"0123456789", Duration::ZERO).unwrap();
        assert_eq!(small.take(b"x", Duration::ZERO), Err(Refusal::TooLarge(10)));
        let mut dropped = Spool::new(folder.path(), usize::MAX);
        dropped.take(&vec![0; 2 * IN_MEMORY], Duration::ZERO).unwrap();
        drop(dropped);
        assert_eq!(files(), 0);
    }

    #[test]
    fn regress_a_sender_that_trickles_is_put_out() {
        assert!(!is_too_slow(1, GRACE), "the grace");
        assert!(is_too_slow(1, GRACE + Duration::from_secs(1)));
        assert!(!is_too_slow(96 * 1024 * 1024, Duration::from_secs(600)), "a recording over a slow line");
    }
}
