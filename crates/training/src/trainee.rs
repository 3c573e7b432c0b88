//! Trainees: pseudonym, role, and optional background information, as collected in the TASBID study.

use serde::{Deserialize, Serialize};

/// Age groups, years.
pub const AGE_BANDS: &[&str] = &["18-24", "25-34", "35-44", "45-54", "55-64", "65+"];
/// Levels of experience with drones and with video games.
pub const EXPERIENCE_LEVELS: &[&str] = &["none", "some", "regular"];

/// User role, which determines access rights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// Flies sessions and sees only their own data.
    Trainee,
    /// Sees all sessions and can intervene during flights.
    Instructor,
    /// Also manages users and data retention.
    Administrator,
}

/// A user with any role.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Trainee {
    /// Pseudonym. The user's real identity is not stored.
    pub pseudonym: String,
    /// Role, which determines access rights.
    pub role: Role,
    /// Age group; one of [`AGE_BANDS`].
    pub age_band: Option<String>,
    /// Experience with drones; one of [`EXPERIENCE_LEVELS`].
    pub drone_experience: Option<String>,
    /// Experience with video games; one of [`EXPERIENCE_LEVELS`].
    pub gaming_experience: Option<String>,
}

impl Role {
    /// All roles in ascending order of access rights.
    pub const ALL: [Self; 3] = [Self::Trainee, Self::Instructor, Self::Administrator];

    /// Returns the name used in files and databases.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Trainee => "trainee",
            Self::Instructor => "instructor",
            Self::Administrator => "administrator",
        }
    }

    /// Returns the role with this name, as used in files and databases.
    #[must_use]
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|role| role.word() == word)
    }
}

impl Trainee {
    /// Creates a trainee with a pseudonym and no further information.
    #[must_use]
    pub fn new(pseudonym: &str) -> Self {
        let pseudonym = pseudonym.to_owned();
        Self { pseudonym, role: Role::Trainee, age_band: None, drone_experience: None, gaming_experience: None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_role_names_round_trip() {
        for role in Role::ALL {
            assert_eq!(Role::from_word(role.word()), Some(role));
        }
        assert_eq!(Role::from_word("pilot"), None);
    }
}
