//! Who trains: a pseudonym, a role, and what the paper's study recorded of its participants, if they like to say it.

use serde::{Deserialize, Serialize};

/// Age bands, years.
pub const AGE_BANDS: &[&str] = &["18-24", "25-34", "35-44", "45-54", "55-64", "65+"];
/// Experience with drones, and with games.
pub const EXPERIENCE: &[&str] = &["none", "some", "regular"];

/// What somebody may do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// Flies, and sees only what is his.
    Trainee,
    /// Sees all sessions, acts in flights.
    Instructor,
    /// Manages people and retention, too.
    Administrator,
}

/// One person.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Trainee {
    /// Pseudonym; who is behind it is written elsewhere, or nowhere.
    pub pseudonym: String,
    /// What he may do.
    pub role: Role,
    /// One of [`AGE_BANDS`].
    pub age_band: Option<String>,
    /// One of [`EXPERIENCE`].
    pub drone_experience: Option<String>,
    /// One of [`EXPERIENCE`].
    pub gaming_experience: Option<String>,
}

impl Role {
    /// All roles.
    pub const ALL: [Self; 3] = [Self::Trainee, Self::Instructor, Self::Administrator];

    /// Word in files and databases.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Trainee => "trainee",
            Self::Instructor => "instructor",
            Self::Administrator => "administrator",
        }
    }

    /// The role of a word.
    #[must_use]
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|role| role.word() == word)
    }
}

impl Trainee {
    /// Somebody of whom only the pseudonym is known.
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
    fn exact_roles_have_words_and_back() {
        for role in Role::ALL {
            assert_eq!(Role::from_word(role.word()), Some(role));
        }
        assert_eq!(Role::from_word("pilot"), None);
    }
}
