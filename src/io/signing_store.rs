//! What was heard with a signing key, kept beside the key's file: a program that starts again refuses what it has obeyed before.

use super::replace::replace;
use crate::errors::AppError;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Between two writings; what was heard within this before a kill may be played back for a minute.
const EVERY: Duration = Duration::from_secs(1);

/// The memory's file.
#[derive(Debug)]
pub struct SigningStore {
    path: PathBuf,
    saved_text: String,
    written: Duration,
    error_reported: bool,
}

impl SigningStore {
    /// Beside the key's file, one for each vehicle.
    pub fn of(key: &Path, system_id: u8) -> Self {
        let mut name = key.file_name().unwrap_or_default().to_os_string();
        name.push(format!(".heard.{system_id}"));
        Self { path: key.with_file_name(name), saved_text: String::new(), written: Duration::ZERO, error_reported: false }
    }

    /// What it says; `None` when it is not there.
    ///
    /// # Errors
    /// When it is there and cannot be read.
    pub fn text(&self) -> Result<Option<String>, AppError> {
        match std::fs::read_to_string(&self.path) {
            Ok(text) => Ok(Some(text)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(AppError::wrong(format!("{}: {error}", self.path.display()))),
        }
    }

    /// What is wrong with it.
    pub fn parse_error(&self, line: usize) -> AppError {
        AppError::wrong(format!(
            "{}:{line}: this is not what was heard with a signing key (allowed: a timestamp on line 1, then system, component, link and \
             timestamp); without the file nothing is known of earlier runs",
            self.path.display()
        ))
    }

    /// Time to write again?
    pub fn is_due(&self, wall: Duration) -> bool {
        wall.saturating_sub(self.written) >= EVERY
    }

    /// Writes what has changed; that it cannot be written is told once.
    pub fn save(&mut self, memory: String, wall: Duration) {
        self.written = wall;
        if memory == self.saved_text {
            return;
        }
        match replace(&self.path, memory.as_bytes()) {
            Ok(()) => self.saved_text = memory,
            Err(error) if !self.error_reported => {
                self.error_reported = true;
                tracing::warn!("after a restart, signed frames of the last minute could be played back: {error}");
            }
            Err(_) => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_memory_lies_beside_its_key_one_for_each_vehicle_and_is_written_once_a_second() {
        let folder = tempfile::tempdir().unwrap();
        let mut first = SigningStore::of(&folder.path().join("key"), 1);
        let second = SigningStore::of(&folder.path().join("key"), 2);
        assert_eq!(first.text(), Ok(None));
        assert!(!first.is_due(EVERY / 2) && first.is_due(EVERY));
        first.save("5\n".into(), EVERY);
        assert!(!first.is_due(EVERY));
        assert_eq!((first.text(), second.text()), (Ok(Some("5\n".to_owned())), Ok(None)));
        assert!(folder.path().join("key.heard.1").exists());
        assert!(first.parse_error(3).to_string().contains("key.heard.1:3"));
        let mut nowhere = SigningStore::of(&folder.path().join("none").join("key"), 1);
        nowhere.save("5\n".into(), EVERY);
        assert!(nowhere.error_reported);
    }
}
