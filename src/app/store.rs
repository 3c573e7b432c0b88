//! The vehicle's files on disk: one folder that no path of a client leaves, whatever it asks. The folder is opened as a capability:
//! links and names that lead out of it are refused by the operating system's own look-up, not by comparing text.

use super::errors::AppError;
use super::mcap::{Recording, base64};
use crate::base::foxglove;
use crate::mav::ftp::checksum;
use crate::sitl::endpoint::files::job::{Action, Done, Entry, FileError};
use crate::sitl::endpoint::files::path::FilePath;
use crate::sitl::log::Piece;
use cap_std::ambient_authority;
use cap_std::fs::{Dir, File, OpenOptions};
use std::io::{ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::Path;

/// A client may not make a file longer than this, bytes.
const LONGEST: u64 = 256 * 1024 * 1024;
/// Bytes read at once for a checksum.
const CHUNK: usize = 65_536;
/// Logs are kept here, in a folder for each day, as PX4 keeps them.
const LOGS: &str = "log";

/// The folder.
#[derive(Debug)]
pub struct Store {
    root: Dir,
    /// The site as binary glTF in base64: every recording begins with it.
    site: Option<String>,
    log: Option<File>,
    recording: Option<Recording<std::fs::File>>,
}

impl Store {
    /// Opens the folder, and makes it if it is not there.
    ///
    /// # Errors
    /// When it can neither be opened nor made.
    pub fn open(path: &Path) -> Result<Self, AppError> {
        let failed = |error: std::io::Error| AppError::failed(format!("--files {}: {error}", path.display()));
        std::fs::create_dir_all(path).map_err(failed)?;
        let root = Dir::open_ambient_dir(path, ambient_authority()).map_err(failed)?;
        root.create_dir_all(LOGS).map_err(failed)?;
        Ok(Self { root, site: None, log: None, recording: None })
    }

    /// Recordings show this site from now on, binary glTF.
    pub fn show_site(&mut self, glb: &[u8]) {
        self.site = Some(base64(glb));
    }

    /// Does what a client asked.
    ///
    /// # Errors
    /// Why it cannot be done, as the wire says it.
    pub fn work(&self, action: &Action) -> Result<Done, FileError> {
        self.act(action).map_err(|error| match error.kind() {
            ErrorKind::NotFound | ErrorKind::NotADirectory | ErrorKind::IsADirectory => FileError::NotFound,
            ErrorKind::AlreadyExists => FileError::Exists,
            ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => FileError::Protected,
            _ => FileError::Other,
        })
    }

    fn act(&self, action: &Action) -> std::io::Result<Done> {
        match action {
            Action::List(path) => self.list(path).map(Done::Entries),
            Action::Size(path) => Ok(Done::Size(u32::try_from(self.file(path)?.metadata()?.len()).unwrap_or(u32::MAX))),
            Action::Create(path) => self.root.create(path.as_str()).map(|_| Done::Nothing),
            Action::Read(path, offset, most) => self.read(path, *offset, *most).map(Done::Bytes),
            Action::Write(path, offset, bytes) => {
                let mut file = self.writable(path)?;
                within(u64::from(*offset) + bytes.len() as u64)?;
                file.seek(SeekFrom::Start(u64::from(*offset)))?;
                file.write_all(bytes).map(|()| Done::Nothing)
            }
            Action::Remove(path) => self.root.remove_file(path.as_str()).map(|()| Done::Nothing),
            Action::MakeDirectory(path) => self.root.create_dir(path.as_str()).map(|()| Done::Nothing),
            Action::RemoveDirectory(path) => self.root.remove_dir(path.as_str()).map(|()| Done::Nothing),
            Action::Truncate(path, length) => {
                within(u64::from(*length))?;
                self.writable(path)?.set_len(u64::from(*length)).map(|()| Done::Nothing)
            }
            Action::Rename(from, to) => {
                if self.root.symlink_metadata(to.as_str()).is_ok() {
                    return Err(ErrorKind::AlreadyExists.into());
                }
                self.root.rename(from.as_str(), &self.root, to.as_str()).map(|()| Done::Nothing)
            }
            Action::Checksum(path) => self.checksum(path).map(Done::Checksum),
        }
    }

    fn list(&self, path: &FilePath) -> std::io::Result<Vec<Entry>> {
        let place = if path.is_root() { "." } else { path.as_str() };
        let mut entries = Vec::new();
        for entry in self.root.read_dir(place)? {
            let entry = entry?;
            let (name, kind) = (entry.file_name().to_string_lossy().into_owned(), entry.file_type()?);
            if kind.is_dir() {
                entries.push(Entry::Directory(name));
            } else if kind.is_file() {
                entries.push(Entry::File(name, entry.metadata()?.len()));
            }
        }
        let name = |entry: &Entry| match entry {
            Entry::Directory(name) | Entry::File(name, _) => name.clone(),
        };
        entries.sort_by_key(name);
        Ok(entries)
    }

    fn file(&self, path: &FilePath) -> std::io::Result<File> {
        let file = self.root.open(path.as_str())?;
        if file.metadata()?.is_file() { Ok(file) } else { Err(ErrorKind::NotFound.into()) }
    }

    fn writable(&self, path: &FilePath) -> std::io::Result<File> {
        self.root.open_with(path.as_str(), OpenOptions::new().write(true))
    }

    fn read(&self, path: &FilePath, offset: u32, most: u32) -> std::io::Result<Vec<u8>> {
        let mut file = self.file(path)?;
        file.seek(SeekFrom::Start(u64::from(offset)))?;
        let mut bytes = Vec::new();
        file.take(u64::from(most)).read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    fn checksum(&self, path: &FilePath) -> std::io::Result<u32> {
        let mut file = self.file(path)?;
        let (mut sum, mut chunk) = (0, vec![0; CHUNK]);
        loop {
            match file.read(&mut chunk)? {
                0 => return Ok(sum),
                length => sum = checksum(sum, &chunk[..length]),
            }
        }
    }

    /// Writes a piece of the vehicle's log to `log/<date>/<time>.ulg`, and of the recording beside it to the same name with `.mcap`.
    ///
    /// # Errors
    /// When the disk does not take it.
    pub fn log(&mut self, piece: &Piece) -> std::io::Result<()> {
        match piece {
            Piece::Begin(unix_us) => {
                let (readable, _) = super::clock::utc(*unix_us);
                let (date, time) = readable.split_at(10);
                let folder = format!("{LOGS}/{date}");
                self.root.create_dir_all(&folder)?;
                let stem = time.trim_matches(|c: char| !c.is_ascii_digit()).replace(':', "_");
                self.begin_log(&format!("{folder}/{stem}"), *unix_us)?;
            }
            Piece::Bytes(bytes) => {
                if let Some(file) = &mut self.log {
                    file.write_all(bytes)?;
                }
            }
            Piece::Message(message) => {
                if let Some(recording) = &mut self.recording {
                    recording.write(message).map_err(std::io::Error::other)?;
                }
            }
            Piece::End => {
                self.log = None;
                if let Some(recording) = self.recording.take() {
                    recording.end().map_err(std::io::Error::other)?;
                }
            }
        }
        Ok(())
    }

    fn begin_log(&mut self, stem: &str, unix_us: u64) -> std::io::Result<()> {
        let (log, name) = self.new_log(stem)?;
        self.log = Some(log);
        let file = self.root.open_with(name, OpenOptions::new().write(true).create(true).truncate(true))?;
        let mut recording = Recording::begin(file.into_std()).map_err(std::io::Error::other)?;
        if let Some(site) = &self.site {
            recording.write(&foxglove::site(unix_us * 1_000, site)).map_err(std::io::Error::other)?;
        }
        self.recording = Some(recording);
        Ok(())
    }

    /// Two flights that begin in the same second of simulated UTC have logs of their own.
    fn new_log(&self, stem: &str) -> std::io::Result<(File, String)> {
        let mut name = stem.to_owned();
        for number in 1.. {
            match self.root.open_with(format!("{name}.ulg"), OpenOptions::new().write(true).create_new(true)) {
                Err(error) if error.kind() == ErrorKind::AlreadyExists => name = format!("{stem}-{number}"),
                other => return other.map(|file| (file, format!("{name}.mcap"))),
            }
        }
        Err(ErrorKind::AlreadyExists.into())
    }
}

fn within(length: u64) -> std::io::Result<()> {
    if length > LONGEST { Err(ErrorKind::FileTooLarge.into()) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    fn path(text: &str) -> FilePath {
        FilePath::of(text.as_bytes()).unwrap()
    }

    /// A folder of this test, with a sibling whose name begins alike, and a secret beside them.
    fn place(name: &str) -> (PathBuf, Store) {
        let base = std::env::temp_dir().join(format!("spandrel-store-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&base);
        std::fs::create_dir_all(base.join("root-of-another")).unwrap();
        std::fs::write(base.join("secret"), "s").unwrap();
        std::fs::write(base.join("root-of-another/secret"), "s").unwrap();
        let store = Store::open(&base.join("root")).unwrap();
        (base, store)
    }

    #[test]
    fn exact_no_link_leads_out() {
        let (base, store) = place("links");
        for (name, target) in [("up", "../secret"), ("sibling", "../root-of-another/secret"), ("absolute", "/etc/passwd")] {
            std::os::unix::fs::symlink(target, base.join("root").join(name)).unwrap();
            assert!(store.work(&Action::Size(path(name))).is_err(), "{name}");
            assert!(store.work(&Action::Read(path(name), 0, 10)).is_err(), "{name}");
            assert!(store.work(&Action::Checksum(path(name))).is_err(), "{name}");
            assert!(store.work(&Action::Write(path(name), 0, vec![1])).is_err(), "{name}");
        }
        std::os::unix::fs::symlink("..", base.join("root/above")).unwrap();
        assert!(store.work(&Action::List(path("above"))).is_err());
        assert!(store.work(&Action::Read(path("above/secret"), 0, 10)).is_err());
        assert!(store.work(&Action::Create(path("above/new"))).is_err());
        assert!(store.work(&Action::Rename(path("log"), path("above/log"))).is_err());
        assert_eq!(std::fs::read_to_string(base.join("secret")).unwrap(), "s");
        let listed = store.work(&Action::List(path("/"))).unwrap();
        assert_eq!(listed, Done::Entries(vec![Entry::Directory("log".into())]), "links are not shown");
        std::fs::remove_dir_all(base).unwrap();
    }

    #[test]
    fn exact_files_are_written_read_cut_renamed_and_removed() {
        let (base, store) = place("work");
        store.work(&Action::Create(path("a"))).unwrap();
        store.work(&Action::Write(path("a"), 2, b"xyz".to_vec())).unwrap();
        assert_eq!(store.work(&Action::Read(path("a"), 1, 3)), Ok(Done::Bytes(b"\0xy".to_vec())));
        assert_eq!(store.work(&Action::Checksum(path("a"))), Ok(Done::Checksum(checksum(0, b"\0\0xyz"))));
        store.work(&Action::Truncate(path("a"), 3)).unwrap();
        assert_eq!(store.work(&Action::Size(path("a"))), Ok(Done::Size(3)));
        assert_eq!(store.work(&Action::Rename(path("a"), path("log"))), Err(FileError::Exists));
        store.work(&Action::Rename(path("a"), path("b"))).unwrap();
        assert_eq!(store.work(&Action::Size(path("a"))), Err(FileError::NotFound));
        assert_eq!(store.work(&Action::Size(path("log"))), Err(FileError::NotFound), "a directory is no file");
        assert_eq!(store.work(&Action::Write(path("b"), u32::MAX, vec![1])), Err(FileError::Other), "longer than allowed");
        store.work(&Action::MakeDirectory(path("d"))).unwrap();
        assert_eq!(store.work(&Action::MakeDirectory(path("d"))), Err(FileError::Exists));
        store.work(&Action::RemoveDirectory(path("d"))).unwrap();
        store.work(&Action::Remove(path("b"))).unwrap();
        assert_eq!(store.work(&Action::List(path(""))), Ok(Done::Entries(vec![Entry::Directory("log".into())])));
        std::fs::remove_dir_all(base).unwrap();
    }

    #[test]
    fn exact_two_flights_of_one_second_have_two_logs() {
        let (base, mut store) = place("logs");
        for text in ["one", "two"] {
            for piece in [Piece::Begin(1_790_000_000_000_000), Piece::Bytes(text.into()), Piece::End] {
                store.log(&piece).unwrap();
            }
        }
        let day = path("log/2026-09-21");
        let Done::Entries(entries) = store.work(&Action::List(day)).unwrap() else { panic!("no list") };
        let logs: Vec<_> = entries.iter().filter(|e| matches!(e, Entry::File(name, _) if name.ends_with(".ulg"))).collect();
        assert_eq!(logs, [&Entry::File("14_13_20-1.ulg".into(), 3), &Entry::File("14_13_20.ulg".into(), 3)]);
        for name in ["14_13_20.mcap", "14_13_20-1.mcap"] {
            let file = std::fs::read(base.join("root/log/2026-09-21").join(name)).unwrap();
            assert_eq!(super::super::mcap::recover(&file).unwrap().broken, None, "{name}");
        }
        std::fs::remove_dir_all(base).unwrap();
    }
}
