//! The vehicle's files on disk, in one folder that clients cannot escape. The folder is opened as a capability: the
//! operating system's path lookup, not a string comparison, rejects links and names that point outside the folder.

use super::flight_logs;
use super::mcap::{McapRecording, base64};
use crate::errors::AppError;
use cap_std::ambient_authority;
use cap_std::fs::{Dir, File, OpenOptions};
use spandrel_mavlink::ftp::checksum;
use spandrel_model::foxglove;
use spandrel_sitl::endpoint::files::job::{CHECKSUM_SLICE, DirectoryEntry, FileAction, FileError, FileJobResult};
use spandrel_sitl::endpoint::files::path::FilePath;
use spandrel_sitl::log::LogOutput;
use std::io::{ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Total quota for the files of all clients, bytes.
const CLIENT_QUOTA_BYTES: u64 = 256 * 1024 * 1024;
/// Maximum total number of clients' files and directories. The number is limited because a listing reads every entry.
const MAX_CLIENT_ENTRIES: u64 = 1_000;
/// Flight log folder, with one subfolder per day as in PX4. The logs belong to the vehicle: clients can read and remove
/// them, and they do not count toward the quota.
const LOG_FOLDER: &str = "log";

/// Folder for the vehicle's files, with the current flight's log.
#[derive(Debug)]
pub struct FileStore {
    root: Dir,
    path: PathBuf,
    /// Maximum size of all flight logs, bytes; the oldest are deleted first.
    max_log_bytes: u64,
    /// Site geometry as base64-encoded binary glTF, written at the start of every recording.
    site: Option<String>,
    /// Space that the clients' files use.
    used: StorageUsage,
    log: Option<FlightLog>,
    recording: Option<McapRecording<std::fs::File>>,
}

/// Log of the current flight.
#[derive(Debug)]
struct FlightLog {
    file: File,
    name: String,
    /// Length of the data written successfully, bytes.
    written_len: u64,
}

impl FlightLog {
    /// Appends the whole message or nothing, so that readers never find a message after a partial one.
    fn write(&mut self, piece: &[u8]) -> std::io::Result<()> {
        self.file.write_all(piece).inspect_err(|_| {
            // If this also fails, the partial message remains at the end of the file, where readers tolerate it.
            let _ = self.file.set_len(self.written_len);
        })?;
        self.written_len += piece.len() as u64;
        Ok(())
    }
}

impl FileStore {
    /// Opens the folder, creating it if necessary.
    ///
    /// # Errors
    /// Returns an error if the folder cannot be opened or created.
    pub fn open(path: &Path, max_log_bytes: u64) -> Result<Self, AppError> {
        let failed = |error: std::io::Error| AppError::failed(format!("--files {}: {error}", path.display()));
        std::fs::create_dir_all(path).map_err(failed)?;
        let root = Dir::open_ambient_dir(path, ambient_authority()).map_err(failed)?;
        root.create_dir_all(LOG_FOLDER).map_err(failed)?;
        let used = StorageUsage::measure(&root);
        Ok(Self { root, path: path.to_owned(), max_log_bytes, site: None, used, log: None, recording: None })
    }

    /// Sets the site geometry (binary glTF) for future recordings.
    pub fn set_site(&mut self, glb: &[u8]) {
        self.site = Some(base64(glb));
    }

    /// Carries out a client's file request.
    ///
    /// # Errors
    /// Returns the reason as a MAVLink FTP error.
    pub fn run_action(&mut self, action: &FileAction) -> Result<FileJobResult, FileError> {
        self.handle_request(action).map_err(|error| match error.kind() {
            ErrorKind::NotFound | ErrorKind::NotADirectory | ErrorKind::IsADirectory => FileError::NotFound,
            ErrorKind::AlreadyExists => FileError::Exists,
            ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => FileError::Protected,
            _ => FileError::Other,
        })
    }

    fn handle_request(&mut self, action: &FileAction) -> std::io::Result<FileJobResult> {
        match action {
            FileAction::List(path) => self.list(path).map(FileJobResult::Entries),
            FileAction::Size(path) => {
                Ok(FileJobResult::Size(u32::try_from(self.file(path)?.metadata()?.len()).unwrap_or(u32::MAX)))
            }
            FileAction::Read(path, offset, most) => self.read(path, *offset, *most).map(FileJobResult::Bytes),
            FileAction::Checksum { path, from, sum } => self.checksum(path, *from, *sum),
            FileAction::Create(path) => self.make(path, |root| root.create(path.as_str()).map(|_| ())),
            FileAction::MakeDirectory(path) => self.make(path, |root| root.create_dir(path.as_str())),
            FileAction::Write(path, offset, bytes) => {
                let offset = u64::from(*offset);
                self.write(path, offset + bytes.len() as u64, |file| {
                    file.seek(SeekFrom::Start(offset))?;
                    file.write_all(bytes)
                })
            }
            FileAction::Truncate(path, length) => self.write(path, u64::from(*length), |file| file.set_len(u64::from(*length))),
            FileAction::Remove(path) => self.change(path, |root| root.remove_file(path.as_str())),
            FileAction::RemoveDirectory(path) => self.change(path, |root| root.remove_dir(path.as_str())),
            FileAction::Rename(from, to) => {
                if self.root.symlink_metadata(to.as_str()).is_ok() {
                    return Err(ErrorKind::AlreadyExists.into());
                }
                check_client_path(from).and(check_client_path(to))?;
                self.root.rename(from.as_str(), &self.root, to.as_str()).map(|()| FileJobResult::Nothing)
            }
        }
    }

    /// Creates a file or a directory, unless the clients' quota is exhausted.
    fn make(&mut self, path: &FilePath, act: impl FnOnce(&Dir) -> std::io::Result<()>) -> std::io::Result<FileJobResult> {
        check_client_path(path)?;
        if self.used.entries >= MAX_CLIENT_ENTRIES && StorageUsage::of(&self.root, path).entries == 0 {
            return Err(ErrorKind::QuotaExceeded.into());
        }
        self.change(path, act)
    }

    /// Writes to a file, unless the clients' quota is exhausted. The new length is at most `length` or the previous
    /// length, whichever is larger.
    fn write(
        &mut self,
        path: &FilePath,
        length: u64,
        act: impl FnOnce(&mut File) -> std::io::Result<()>,
    ) -> std::io::Result<FileJobResult> {
        check_client_path(path)?;
        let more = length.saturating_sub(StorageUsage::of(&self.root, path).bytes);
        if more > 0 && self.used.bytes + more > CLIENT_QUOTA_BYTES {
            return Err(ErrorKind::QuotaExceeded.into());
        }
        self.change(path, |root| act(&mut root.open_with(path.as_str(), OpenOptions::new().write(true))?))
    }

    /// Changes a path and updates the amount of space used.
    fn change(&mut self, path: &FilePath, act: impl FnOnce(&Dir) -> std::io::Result<()>) -> std::io::Result<FileJobResult> {
        let before = StorageUsage::of(&self.root, path);
        let done = act(&self.root);
        self.used.replace(before, StorageUsage::of(&self.root, path));
        done.map(|()| FileJobResult::Nothing)
    }

    fn list(&self, path: &FilePath) -> std::io::Result<Vec<DirectoryEntry>> {
        let place = if path.is_root() { "." } else { path.as_str() };
        let mut entries = Vec::new();
        for entry in self.root.read_dir(place)? {
            let entry = entry?;
            let (name, kind) = (entry.file_name().to_string_lossy().into_owned(), entry.file_type()?);
            if kind.is_dir() {
                entries.push(DirectoryEntry::Directory(name));
            } else if kind.is_file() {
                entries.push(DirectoryEntry::File(name, entry.metadata()?.len()));
            }
        }
        let name = |entry: &DirectoryEntry| match entry {
            DirectoryEntry::Directory(name) | DirectoryEntry::File(name, _) => name.clone(),
        };
        entries.sort_by_key(name);
        Ok(entries)
    }

    fn file(&self, path: &FilePath) -> std::io::Result<File> {
        let file = self.root.open(path.as_str())?;
        if file.metadata()?.is_file() { Ok(file) } else { Err(ErrorKind::NotFound.into()) }
    }

    fn read(&self, path: &FilePath, offset: u32, most: u32) -> std::io::Result<Vec<u8>> {
        let mut file = self.file(path)?;
        file.seek(SeekFrom::Start(u64::from(offset)))?;
        let mut bytes = Vec::new();
        file.take(u64::from(most)).read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    fn checksum(&self, path: &FilePath, from: u32, sum: u32) -> std::io::Result<FileJobResult> {
        let bytes = self.read(path, from, CHECKSUM_SLICE)?;
        Ok(FileJobResult::Checksum { sum: checksum(sum, &bytes), bytes: u32::try_from(bytes.len()).unwrap_or(CHECKSUM_SLICE) })
    }

    /// Appends to the vehicle's log `log/<date>/<time>.ulg`, or to the recording with the same name and an `.mcap`
    /// extension.
    ///
    /// # Errors
    /// Returns an error if the disk cannot be written. The file then ends with the previous data, and the next flight
    /// starts a new file.
    pub fn log(&mut self, piece: &LogOutput) -> Result<(), AppError> {
        match piece {
            LogOutput::Bytes(bytes) => {
                let Some(log) = &mut self.log else { return Ok(()) };
                let written = log.write(bytes).map_err(|error| io_error(&self.path, &log.name, &error));
                written.inspect_err(|_| self.log = None)
            }
            LogOutput::Message(message) => {
                let Some(recording) = &mut self.recording else { return Ok(()) };
                let written = recording.write(message).map_err(|error| io_error(&self.path, LOG_FOLDER, &error));
                written.inspect_err(|_| self.recording = None)
            }
            LogOutput::Begin(_) | LogOutput::End => {
                self.begin_or_end_log(piece).map_err(|error| io_error(&self.path, LOG_FOLDER, &error))
            }
        }
    }

    /// Starts or ends a flight log.
    fn begin_or_end_log(&mut self, piece: &LogOutput) -> std::io::Result<()> {
        match piece {
            LogOutput::Begin(unix_us) => {
                let (readable, _) = super::clock::utc(*unix_us);
                let (date, time) = readable.split_at(10);
                let deleted = flight_logs::delete_oldest_logs(&self.root, LOG_FOLDER, self.max_log_bytes)?;
                if deleted > 0 {
                    tracing::info!("deleted {deleted} old flight logs to make room for a new one");
                }
                let folder = format!("{LOG_FOLDER}/{date}");
                self.root.create_dir_all(&folder)?;
                let stem = time.trim_matches(|c: char| !c.is_ascii_digit()).replace(':', "_");
                self.begin_log(&format!("{folder}/{stem}"), *unix_us)?;
            }
            LogOutput::Bytes(_) | LogOutput::Message(_) => {}
            LogOutput::End => {
                self.log = None;
                if let Some(recording) = self.recording.take() {
                    recording.end().map_err(std::io::Error::other)?;
                }
            }
        }
        Ok(())
    }

    fn begin_log(&mut self, stem: &str, unix_us: u64) -> std::io::Result<()> {
        let (file, stem) = self.new_log(stem)?;
        self.log = Some(FlightLog { file, name: format!("{stem}.ulg"), written_len: 0 });
        let file = self.root.open_with(format!("{stem}.mcap"), OpenOptions::new().write(true).create(true).truncate(true))?;
        let mut recording = McapRecording::begin(file.into_std()).map_err(std::io::Error::other)?;
        if let Some(site) = &self.site {
            recording.write(&foxglove::site(unix_us * 1_000, site)).map_err(std::io::Error::other)?;
        }
        self.recording = Some(recording);
        Ok(())
    }

    /// Creates a log file; flights that start in the same second of simulated UTC get separate files.
    fn new_log(&self, stem: &str) -> std::io::Result<(File, String)> {
        let mut name = stem.to_owned();
        for number in 1.. {
            match self.root.open_with(format!("{name}.ulg"), OpenOptions::new().write(true).create_new(true)) {
                Err(error) if error.kind() == ErrorKind::AlreadyExists => name = format!("{stem}-{number}"),
                other => return other.map(|file| (file, name)),
            }
        }
        Err(ErrorKind::AlreadyExists.into())
    }
}

fn io_error(root: &Path, name: &str, error: &dyn std::fmt::Display) -> AppError {
    AppError::failed(format!("{}: cannot write: {error}; the log ends at this point", root.join(name).display()))
}

/// Returns true for a path in the vehicle's log folder.
fn is_log(path: &FilePath) -> bool {
    path.as_str() == LOG_FOLDER || path.as_str().strip_prefix(LOG_FOLDER).is_some_and(|rest| rest.starts_with('/'))
}

/// Rejects paths to which clients must not write.
fn check_client_path(path: &FilePath) -> std::io::Result<()> {
    if is_log(path) { Err(ErrorKind::PermissionDenied.into()) } else { Ok(()) }
}

/// Space that the clients' files use.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct StorageUsage {
    bytes: u64,
    entries: u64,
}

impl StorageUsage {
    /// Measures a folder, excluding its logs. Clients can still read and empty a folder that exceeds the quota.
    fn measure(root: &Dir) -> Self {
        let mut used = Self::default();
        used.count(root, true);
        used
    }

    /// Adds up the contents of a directory. Stops at the quota, so that a large folder does not delay startup.
    fn count(&mut self, directory: &Dir, is_root: bool) {
        let Ok(entries) = directory.entries() else { return };
        for entry in entries.flatten().filter(|entry| !(is_root && entry.file_name() == LOG_FOLDER)) {
            if self.entries > MAX_CLIENT_ENTRIES {
                self.bytes = self.bytes.max(CLIENT_QUOTA_BYTES);
                return;
            }
            self.entries += 1;
            match entry.open_dir() {
                Ok(inside) => self.count(&inside, false),
                Err(_) => self.bytes += entry.metadata().map_or(0, |metadata| metadata.len()),
            }
        }
    }

    /// Measures a single path; logs count as zero.
    fn of(root: &Dir, path: &FilePath) -> Self {
        let metadata = root.symlink_metadata(path.as_str()).ok().filter(|_| !is_log(path));
        let bytes = metadata.as_ref().filter(|metadata| metadata.is_file()).map_or(0, |metadata| metadata.len());
        Self { bytes, entries: u64::from(metadata.is_some()) }
    }

    fn replace(&mut self, before: Self, after: Self) {
        self.bytes = (self.bytes + after.bytes).saturating_sub(before.bytes);
        self.entries = (self.entries + after.entries).saturating_sub(before.entries);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(text: &str) -> FilePath {
        FilePath::of(text.as_bytes()).unwrap()
    }

    /// Creates a test folder, a sibling folder with a similar name, and a secret file next to them.
    fn place(name: &str) -> (PathBuf, FileStore) {
        let base = std::env::temp_dir().join(format!("spandrel-store-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&base);
        std::fs::create_dir_all(base.join("root-of-another")).unwrap();
        std::fs::write(base.join("secret"), "s").unwrap();
        std::fs::write(base.join("root-of-another/secret"), "s").unwrap();
        let store = FileStore::open(&base.join("root"), u64::MAX).unwrap();
        (base, store)
    }

    #[test]
    fn exact_links_cannot_escape_folder() {
        let (base, mut store) = place("links");
        for (name, target) in [("up", "../secret"), ("sibling", "../root-of-another/secret"), ("absolute", "/etc/passwd")] {
            std::os::unix::fs::symlink(target, base.join("root").join(name)).unwrap();
            assert!(store.run_action(&FileAction::Size(path(name))).is_err(), "{name}");
            assert!(store.run_action(&FileAction::Read(path(name), 0, 10)).is_err(), "{name}");
            assert!(store.run_action(&FileAction::Checksum { path: path(name), from: 0, sum: 0 }).is_err(), "{name}");
            assert!(store.run_action(&FileAction::Write(path(name), 0, vec![1])).is_err(), "{name}");
        }
        std::os::unix::fs::symlink("..", base.join("root/above")).unwrap();
        assert!(store.run_action(&FileAction::List(path("above"))).is_err());
        assert!(store.run_action(&FileAction::Read(path("above/secret"), 0, 10)).is_err());
        assert!(store.run_action(&FileAction::Create(path("above/new"))).is_err());
        assert!(store.run_action(&FileAction::Rename(path("log"), path("above/log"))).is_err());
        assert_eq!(std::fs::read_to_string(base.join("secret")).unwrap(), "s");
        let listed = store.run_action(&FileAction::List(path("/"))).unwrap();
        assert_eq!(listed, FileJobResult::Entries(vec![DirectoryEntry::Directory("log".into())]), "links are not shown");
        std::fs::remove_dir_all(base).unwrap();
    }

    #[test]
    fn exact_file_operations_work() {
        let (base, mut store) = place("work");
        store.run_action(&FileAction::Create(path("a"))).unwrap();
        store.run_action(&FileAction::Write(path("a"), 2, b"xyz".to_vec())).unwrap();
        assert_eq!(store.run_action(&FileAction::Read(path("a"), 1, 3)), Ok(FileJobResult::Bytes(b"\0xy".to_vec())));
        let whole = FileAction::Checksum { path: path("a"), from: 0, sum: 0 };
        assert_eq!(store.run_action(&whole), Ok(FileJobResult::Checksum { sum: checksum(0, b"\0\0xyz"), bytes: 5 }));
        store.run_action(&FileAction::Truncate(path("a"), 3)).unwrap();
        assert_eq!(store.run_action(&FileAction::Size(path("a"))), Ok(FileJobResult::Size(3)));
        assert_eq!(store.run_action(&FileAction::Rename(path("a"), path("log"))), Err(FileError::Exists));
        store.run_action(&FileAction::Rename(path("a"), path("b"))).unwrap();
        assert_eq!(store.run_action(&FileAction::Size(path("a"))), Err(FileError::NotFound));
        assert_eq!(store.run_action(&FileAction::Size(path("log"))), Err(FileError::NotFound), "a directory is no file");
        assert_eq!(
            store.run_action(&FileAction::Write(path("b"), u32::MAX, vec![1])),
            Err(FileError::Other),
            "longer than allowed"
        );
        store.run_action(&FileAction::MakeDirectory(path("d"))).unwrap();
        assert_eq!(store.run_action(&FileAction::MakeDirectory(path("d"))), Err(FileError::Exists));
        store.run_action(&FileAction::RemoveDirectory(path("d"))).unwrap();
        store.run_action(&FileAction::Remove(path("b"))).unwrap();
        assert_eq!(
            store.run_action(&FileAction::List(path(""))),
            Ok(FileJobResult::Entries(vec![DirectoryEntry::Directory("log".into())]))
        );
        std::fs::remove_dir_all(base).unwrap();
    }

    #[test]
    fn regress_client_quota_and_protected_logs() {
        let (base, mut store) = place("quota");
        let most = CLIENT_QUOTA_BYTES as u32;
        for name in ["a", "b"] {
            store.run_action(&FileAction::Create(path(name))).unwrap();
        }
        store.run_action(&FileAction::Truncate(path("a"), most - 10)).unwrap();
        assert_eq!(store.run_action(&FileAction::Truncate(path("b"), 11)), Err(FileError::Other));
        assert_eq!(store.run_action(&FileAction::Write(path("b"), 8, vec![1; 3])), Err(FileError::Other));
        store.run_action(&FileAction::Write(path("b"), 0, vec![1; 10])).unwrap();
        store.run_action(&FileAction::Write(path("b"), 5, vec![1; 5])).unwrap();
        assert_eq!(StorageUsage::measure(&store.root), store.used);
        let again = FileStore::open(&base.join("root"), u64::MAX).unwrap();
        assert_eq!(again.used, StorageUsage { bytes: CLIENT_QUOTA_BYTES, entries: 2 }, "the next start measures the same");
        store.run_action(&FileAction::Remove(path("a"))).unwrap();
        store.run_action(&FileAction::Truncate(path("b"), 11)).unwrap();
        for k in 1..MAX_CLIENT_ENTRIES {
            store.run_action(&FileAction::MakeDirectory(path(&format!("d{k}")))).unwrap();
        }
        assert_eq!(store.run_action(&FileAction::Create(path("one-more"))), Err(FileError::Other));
        store.run_action(&FileAction::Create(path("b"))).unwrap();
        store.run_action(&FileAction::RemoveDirectory(path("d1"))).unwrap();
        store.run_action(&FileAction::Create(path("one-more"))).unwrap();
        assert_eq!(StorageUsage::measure(&store.root), store.used);
        for action in [
            FileAction::Create(path("log/x.ulg")),
            FileAction::MakeDirectory(path("log/2026-01-01")),
            FileAction::Rename(path("one-more"), path("log/x")),
            FileAction::Rename(path("log"), path("other")),
        ] {
            assert_eq!(store.run_action(&action), Err(FileError::Protected), "{action:?}");
        }
        std::fs::write(base.join("root/log/x.ulg"), "log").unwrap();
        assert_eq!(store.run_action(&FileAction::Truncate(path("log/x.ulg"), 0)), Err(FileError::Protected));
        store.run_action(&FileAction::Remove(path("log/x.ulg"))).unwrap();
        std::fs::remove_dir_all(base).unwrap();
    }

    #[test]
    fn regress_log_write_failure_keeps_complete_messages_and_is_reported_once() {
        let (base, mut store) = place("refused");
        store.log(&LogOutput::Begin(1_790_000_000_000_000)).unwrap();
        store.log(&LogOutput::Bytes("one".into())).unwrap();
        // A read-only descriptor simulates a full disk.
        let name = "log/2026-09-21/14_13_20.ulg";
        store.log.as_mut().unwrap().file = store.root.open(name).unwrap();
        let refused = store.log(&LogOutput::Bytes("two".into())).unwrap_err().to_string();
        assert!(refused.contains(name) && refused.contains("the log ends at this point"), "{refused}");
        store.log(&LogOutput::Bytes("three".into())).unwrap();
        assert_eq!(std::fs::read(base.join("root").join(name)).unwrap(), b"one");
        store.log(&LogOutput::End).unwrap();
        store.log(&LogOutput::Begin(1_790_000_001_000_000)).unwrap();
        store.log(&LogOutput::Bytes("four".into())).unwrap();
        assert_eq!(std::fs::read(base.join("root/log/2026-09-21/14_13_21.ulg")).unwrap(), b"four");
        std::fs::remove_dir_all(base).unwrap();
    }

    #[test]
    fn exact_flights_in_the_same_second_get_separate_logs() {
        let (base, mut store) = place("logs");
        for text in ["one", "two"] {
            for piece in [LogOutput::Begin(1_790_000_000_000_000), LogOutput::Bytes(text.into()), LogOutput::End] {
                store.log(&piece).unwrap();
            }
        }
        let day = path("log/2026-09-21");
        let FileJobResult::Entries(entries) = store.run_action(&FileAction::List(day)).unwrap() else { panic!("no list") };
        let logs: Vec<_> =
            entries.iter().filter(|e| matches!(e, DirectoryEntry::File(name, _) if name.ends_with(".ulg"))).collect();
        assert_eq!(logs, [&DirectoryEntry::File("14_13_20-1.ulg".into(), 3), &DirectoryEntry::File("14_13_20.ulg".into(), 3)]);
        for name in ["14_13_20.mcap", "14_13_20-1.mcap"] {
            let file = std::fs::read(base.join("root/log/2026-09-21").join(name)).unwrap();
            assert_eq!(crate::io::mcap::recover(&file).unwrap().truncation_reason, None, "{name}");
        }
        std::fs::remove_dir_all(base).unwrap();
    }
}
