//! Trainee IDs as they appear in folder names and records.

use std::str::FromStr;

/// Trainee ID, valid in folder names and records.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TraineeId(String);

impl TraineeId {
    /// Returns the ID as text.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

/// Allowed form of an ID, for error messages.
pub const ALLOWED_IDS: &str = "1 to 32 letters, digits, '-' or '_', starting with a letter or digit";

/// Returns true for an ID that needs no escaping in paths and URLs, as described by [`ALLOWED_IDS`].
pub fn is_plain_id(text: &str) -> bool {
    let fits = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    text.starts_with(|c: char| c.is_ascii_alphanumeric()) && text.len() <= 32 && text.chars().all(fits)
}

impl FromStr for TraineeId {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        if is_plain_id(text) {
            return Ok(Self(text.to_owned()));
        }
        Err(format!("'{text}' is not a trainee ID (allowed: {ALLOWED_IDS})"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_trainee_ids_are_safe_in_paths() {
        for good in ["anna", "t-07", "A_1", "7"] {
            assert_eq!(good.parse::<TraineeId>().map(|id| id.0), Ok(good.to_owned()));
        }
        for bad in ["", "-x", "../up", "a b", "é", "a/b", "123456789012345678901234567890123"] {
            assert!(bad.parse::<TraineeId>().is_err(), "{bad}");
        }
    }
}
