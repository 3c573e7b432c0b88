//! The rubric: skills that instructors sign off for each trainee. Sign-offs and withdrawals are events that are only ever
//! added, so the history is kept. The criteria come from a data file.

use serde::Serialize;
use spandrel_model::toml::{Problems, Reader, Section};
use spandrel_text::{Language, text};

/// Default rubric, in TOML.
pub const DEFAULT_RUBRIC: &str = include_str!("rubric.toml");

/// File format version.
const FORMAT_VERSION: i64 = 1;
/// Maximum number of criteria (estimate: more than one page to print).
const MAX_CRITERIA: usize = 30;
/// Maximum length of a criterion's ID, characters.
const MAX_ID_LEN: usize = 32;
/// Maximum length of a criterion's title, characters.
const MAX_TITLE_LEN: usize = 60;
/// Maximum length of a criterion's text, characters.
const MAX_TEXT_LEN: usize = 400;

/// The rubric's criteria.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rubric {
    /// Criteria in file order; never empty.
    pub criteria: Vec<RubricCriterion>,
}

/// A skill that an instructor signs off.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RubricCriterion {
    /// Unique ID, which records refer to.
    pub id: String,
    /// Skill that the trainee must show, in a few words.
    pub title: String,
    /// Description of the skill, for the instructor.
    pub text: String,
}

/// An instructor's decision on a criterion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SignOffAction {
    /// Signed it off.
    SignedOff,
    /// Withdrew an earlier sign-off.
    Withdrawn,
}

impl SignOffAction {
    /// Both actions.
    pub const ALL: [Self; 2] = [Self::SignedOff, Self::Withdrawn];

    /// Returns the name used in forms and databases.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::SignedOff => "signed_off",
            Self::Withdrawn => "withdrawn",
        }
    }

    /// Returns the action as text.
    #[must_use]
    pub fn words(self, language: Language) -> String {
        match self {
            Self::SignedOff => text!(language, "people-action-signed"),
            Self::Withdrawn => text!(language, "people-action-withdrawn"),
        }
    }

    /// Returns the action with this name, as used in forms and databases.
    #[must_use]
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|action| action.word() == word)
    }
}

/// A sign-off, or its withdrawal.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct SignOffEvent {
    /// ID of the criterion.
    pub criterion: String,
    /// Title of the criterion at that time; the rubric may have changed since.
    pub title: String,
    /// Decision.
    pub action: SignOffAction,
    /// Time, µs since the Unix epoch.
    pub unix_us: u64,
    /// Name of the instructor; empty if they were erased.
    pub by: String,
    /// The instructor's note; may be empty.
    pub note: String,
}

impl Rubric {
    /// Returns the criterion with this ID; `None` if there is none.
    #[must_use]
    pub fn criterion(&self, id: &str) -> Option<&RubricCriterion> {
        self.criteria.iter().find(|criterion| criterion.id == id)
    }

    /// Returns the number of criteria that are signed off, from a trainee's events in chronological order.
    #[must_use]
    pub fn signed_off_count(&self, events: &[SignOffEvent]) -> usize {
        self.criteria.iter().filter(|criterion| current_sign_off(events, &criterion.id).is_some()).count()
    }
}

/// Returns the sign-off of a criterion that is in force, from a trainee's events in chronological order; `None` if it was
/// never signed off or was withdrawn.
#[must_use]
pub fn current_sign_off<'a>(events: &'a [SignOffEvent], criterion: &str) -> Option<&'a SignOffEvent> {
    let last = events.iter().rev().find(|event| event.criterion == criterion)?;
    (last.action == SignOffAction::SignedOff).then_some(last)
}

/// Reads a rubric from the text of a file; `file` is named in problems.
///
/// # Errors
/// Returns all problems with line, key, value and allowed values.
pub fn read_rubric(file: &str, text: &str) -> Result<Rubric, Problems> {
    let mut reader = Reader::new(file, text);
    let rubric = reader.parse().map(|document| {
        let mut root = reader.root(&document);
        read(&mut reader, &mut root)
    });
    match rubric {
        Some(rubric) if reader.problems.is_empty() => Ok(rubric),
        Some(_) | None => Err(Problems(reader.problems)),
    }
}

fn read(reader: &mut Reader<'_>, root: &mut Section<'_>) -> Rubric {
    reader.integer(root, "format", (FORMAT_VERSION, FORMAT_VERSION), None);
    let mut criteria: Vec<RubricCriterion> = Vec::new();
    for mut section in reader.sections(root, "criteria") {
        let criterion = read_criterion(reader, &mut section);
        if criteria.iter().any(|other| other.id == criterion.id) {
            reader.add_problem(&section, "id", &criterion.id, "a unique ID", "duplicate criterion");
        }
        reader.finish(&section);
        criteria.push(criterion);
    }
    if !(1..=MAX_CRITERIA).contains(&criteria.len()) {
        let allowed = format!("1 to {MAX_CRITERIA} [[criteria]]");
        reader.add_problem(root, "criteria", &criteria.len().to_string(), &allowed, "wrong number");
    }
    reader.finish(root);
    Rubric { criteria }
}

fn read_criterion(reader: &mut Reader<'_>, section: &mut Section<'_>) -> RubricCriterion {
    let criterion = RubricCriterion {
        id: reader.text(section, "id", None),
        title: reader.text(section, "title", None),
        text: reader.text(section, "text", Some("")),
    };
    let fits = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    if !(1..=MAX_ID_LEN).contains(&criterion.id.len()) || !criterion.id.chars().all(fits) {
        let allowed = format!("1 to {MAX_ID_LEN} characters: a-z, 0-9 and -");
        reader.add_problem(section, "id", &criterion.id, &allowed, "invalid ID");
    }
    for (key, value, least, most) in [("title", &criterion.title, 1, MAX_TITLE_LEN), ("text", &criterion.text, 0, MAX_TEXT_LEN)] {
        if !(least..=most).contains(&value.chars().count()) {
            reader.add_problem(section, key, value, &format!("{least} to {most} characters"), "invalid length");
        }
    }
    criterion
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(criterion: &str, action: SignOffAction, unix_us: u64) -> SignOffEvent {
        SignOffEvent {
            criterion: criterion.into(),
            title: criterion.to_uppercase(),
            action,
            unix_us,
            by: "ida".into(),
            note: String::new(),
        }
    }

    #[test]
    fn exact_default_rubric_is_valid() {
        let rubric = read_rubric("rubric.toml", DEFAULT_RUBRIC).unwrap();
        assert_eq!(rubric.criteria.len(), 8);
        assert_eq!(rubric.criterion("path").unwrap().title, "Flies the path");
        assert_eq!(rubric.criterion("none"), None);
    }

    #[test]
    fn exact_invalid_rubrics_are_reported_with_line_and_key() {
        let told = |text: &str| read_rubric("r.toml", text).unwrap_err().to_string();
        let one = "format = 1\n[[criteria]]\nid = \"a\"\ntitle = \"A\"\n";
        assert!(read_rubric("r.toml", one).is_ok(), "the text may be missing");
        let twice = format!("{one}[[criteria]]\nid = \"a\"\ntitle = \"B\"\n");
        assert!(told(&twice).starts_with("r.toml:6: criteria[].id = a: duplicate criterion"), "{}", told(&twice));
        assert!(told("format = 1\n").contains("criteria = 0: wrong number (allowed: 1 to 30 [[criteria]])"));
        assert!(told(&one.replace("\"a\"", "\"A b\"")).contains("r.toml:3: criteria[].id = A b: invalid ID"));
        assert!(told(&one.replace("\"A\"", &format!("\"{}\"", "x".repeat(61)))).contains("invalid length (allowed: 1 to 60"));
        assert!(told(&one.replace("\"A\"", "\"\"")).contains("invalid length (allowed: 1 to 60"));
        assert!(told(&one.replace("title", "heading")).contains("heading"));
        assert!(told("]]]").contains("r.toml:1"));
    }

    #[test]
    fn exact_last_event_of_a_criterion_decides() {
        let rubric = read_rubric("rubric.toml", DEFAULT_RUBRIC).unwrap();
        let mut events = vec![event("path", SignOffAction::SignedOff, 1), event("control", SignOffAction::SignedOff, 2)];
        assert_eq!(rubric.signed_off_count(&events), 2);
        events.push(event("path", SignOffAction::Withdrawn, 3));
        assert_eq!((current_sign_off(&events, "path"), rubric.signed_off_count(&events)), (None, 1));
        events.push(event("path", SignOffAction::SignedOff, 4));
        assert_eq!(current_sign_off(&events, "path").map(|event| event.unix_us), Some(4));
        events.push(event("replaced-criterion", SignOffAction::SignedOff, 5));
        assert_eq!(rubric.signed_off_count(&events), 2, "only criteria of the rubric count");
        for action in SignOffAction::ALL {
            assert_eq!(SignOffAction::from_word(action.word()), Some(action));
        }
    }
}
