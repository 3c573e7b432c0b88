//! Key that stations and the web server share, from a file on each computer.

use super::files;
use crate::errors::AppError;
use std::path::Path;

/// Shortest and longest key, characters. A shorter key could be guessed.
const LENGTHS: std::ops::RangeInclusive<usize> = 16..=256;

/// Secret that a station sends with each request.
#[derive(Clone, PartialEq, Eq)]
pub struct StationKey(String);

impl StationKey {
    /// Reads the key from a file: its only line.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read, or the key is too short, too long or contains other characters than printable
    /// ASCII.
    pub fn read(path: &Path) -> Result<Self, AppError> {
        let text = files::read(path)?;
        let key = text.trim();
        let is_plain = key.bytes().all(|byte| byte.is_ascii_graphic());
        if !is_plain || !LENGTHS.contains(&key.len()) {
            return Err(AppError::invalid(format!(
                "{}: not a station key (allowed: one line of {} to {} letters, digits and punctuation marks; create one with \
                 'openssl rand -hex 16')",
                path.display(),
                LENGTHS.start(),
                LENGTHS.end()
            )));
        }
        Ok(Self(key.to_owned()))
    }

    /// Returns the value of the Authorization header.
    pub fn authorization(&self) -> String {
        format!("Bearer {}", self.0)
    }
}

impl std::fmt::Debug for StationKey {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("StationKey(secret)")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_keys_are_one_line_of_at_least_sixteen_characters() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("key");
        let read = |text: &str| {
            std::fs::write(&path, text).unwrap();
            StationKey::read(&path)
        };
        assert_eq!(read("0123456789abcdef\n").unwrap().authorization(), "Bearer 0123456789abcdef");
        for bad in ["", "0123456789abcde", "0123456789abcdef\nx", "0123456789 abcdef", "0123456789äbcdef", &"x".repeat(257)] {
            let error = read(bad).unwrap_err().to_string();
            assert!(error.contains("16 to 256"), "{bad}: {error}");
        }
        assert!(!format!("{:?}", read("0123456789abcdef").unwrap()).contains("0123"), "keys are not logged");
        assert!(StationKey::read(&folder.path().join("missing")).is_err());
    }
}
