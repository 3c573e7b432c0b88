//! Timestamps of signed MAVLink messages, saved next to the key file so that the program rejects replayed messages even
//! after a restart.

use super::replace::replace;
use crate::errors::AppError;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Interval at which the timestamps are saved. If the program is killed, attackers could replay messages received since
/// the last save within one minute.
const SAVE_INTERVAL: Duration = Duration::from_secs(1);

/// File with one vehicle's signing timestamps.
#[derive(Debug)]
pub struct SigningStore {
    path: PathBuf,
    saved_text: String,
    last_saved: Duration,
    error_reported: bool,
}

impl SigningStore {
    /// Returns a vehicle's store, which is next to the key file.
    pub fn for_vehicle(key: &Path, system_id: u8) -> Self {
        let mut name = key.file_name().unwrap_or_default().to_os_string();
        name.push(format!(".heard.{system_id}"));
        Self { path: key.with_file_name(name), saved_text: String::new(), last_saved: Duration::ZERO, error_reported: false }
    }

    /// Returns the contents; `None` if the file does not exist.
    ///
    /// # Errors
    /// Returns an error if the file exists and cannot be read.
    pub fn text(&self) -> Result<Option<String>, AppError> {
        match std::fs::read_to_string(&self.path) {
            Ok(text) => Ok(Some(text)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(AppError::invalid(format!("{}: {error}", self.path.display()))),
        }
    }

    /// Returns the error for an invalid line.
    pub fn parse_error(&self, line: usize) -> AppError {
        AppError::invalid(format!(
            "{}:{line}: not a signing timestamp (allowed: a timestamp on line 1, then system, component, link and \
             timestamp); if you delete the file, attackers could replay messages from earlier runs",
            self.path.display()
        ))
    }

    /// Returns true if the file should be saved again.
    pub fn is_due(&self, wall: Duration) -> bool {
        wall.saturating_sub(self.last_saved) >= SAVE_INTERVAL
    }

    /// Saves the timestamps if they have changed. A failure is logged once.
    pub fn save(&mut self, memory: String, wall: Duration) {
        self.last_saved = wall;
        if memory == self.saved_text {
            return;
        }
        match replace(&self.path, memory.as_bytes()) {
            Ok(()) => self.saved_text = memory,
            Err(error) if !self.error_reported => {
                self.error_reported = true;
                tracing::warn!(
                    "cannot save signing timestamps, so attackers could replay messages from the last minute after a restart: \
                     {error}"
                );
            }
            Err(_) => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_each_vehicle_saves_its_timestamps_once_a_second() {
        let folder = tempfile::tempdir().unwrap();
        let mut first = SigningStore::for_vehicle(&folder.path().join("key"), 1);
        let second = SigningStore::for_vehicle(&folder.path().join("key"), 2);
        assert_eq!(first.text(), Ok(None));
        assert!(!first.is_due(SAVE_INTERVAL / 2) && first.is_due(SAVE_INTERVAL));
        first.save("5\n".into(), SAVE_INTERVAL);
        assert!(!first.is_due(SAVE_INTERVAL));
        assert_eq!((first.text(), second.text()), (Ok(Some("5\n".to_owned())), Ok(None)));
        assert!(folder.path().join("key.heard.1").exists());
        assert!(first.parse_error(3).to_string().contains("key.heard.1:3"));
        let mut nowhere = SigningStore::for_vehicle(&folder.path().join("none").join("key"), 1);
        nowhere.save("5\n".into(), SAVE_INTERVAL);
        assert!(nowhere.error_reported);
    }
}
