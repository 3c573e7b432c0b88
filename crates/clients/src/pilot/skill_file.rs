//! Pilot files (`--pilot FILE.toml`): a skill level as the base, numbers that differ from it, and the session number.

use super::skill::{FIELDS, LEARNING_EXPONENT, Skill};
use spandrel_model::toml::{Problems, Reader};

/// Largest session number (estimate: practice beyond it changes nothing).
const MAX_SESSION: i64 = 1000;

/// Reads a pilot file.
///
/// # Errors
/// Returns all problems in the file: syntax, unknown keys, values outside of the allowed range.
pub fn read(file: &str, text: &str) -> Result<Skill, Problems> {
    let mut reader = Reader::new(file, text);
    let Some(document) = reader.parse() else { return Err(Problems(reader.problems)) };
    let mut root = reader.root(&document);
    reader.integer(&mut root, "format", (1, 1), None);
    let levels = [("novice", Skill::NOVICE), ("trained", Skill::TRAINED), ("expert", Skill::EXPERT)];
    let mut skill = reader.keyword(&mut root, "base", &levels, None);
    for field in FIELDS {
        let value = reader.number(&mut root, field.key, field.range, Some((field.get)(&skill)));
        (field.set)(&mut skill, value);
    }
    let session = reader.integer(&mut root, "session", (1, MAX_SESSION), Some(1));
    let exponent = reader.number(&mut root, "learning_exponent", (0.0, 3.0), Some(LEARNING_EXPONENT));
    reader.finish(&root);
    if reader.problems.is_empty() {
        Ok(skill.in_session(u32::try_from(session).unwrap_or(1), exponent))
    } else {
        Err(Problems(reader.problems))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_file_changes_only_its_numbers() {
        let skill = read("anna.toml", "format = 1\nbase = \"novice\"\nnoise = 1.37\ndoubt = 0.5\n").expect("valid");
        assert_eq!(skill, Skill { noise: 1.37, doubt: 0.5, ..Skill::NOVICE });
    }

    #[test]
    fn exact_session_applies_practice_to_the_numbers_in_the_file() {
        let text = "format = 1\nbase = \"novice\"\nnoise = 2.7\nsession = 4\nlearning_exponent = 0.5\n";
        let skill = read("anna.toml", text).expect("valid");
        assert_eq!(skill.noise, 2.7 * 0.5 + 0.7 * 0.5);
    }

    #[test]
    fn exact_problems_name_file_line_key_value_and_range() {
        let text = "format = 1\nbase = \"novice\"\nnoise = 9.5\nnoize = 1.0\n";
        let problems = read("anna.toml", text).expect_err("two problems").to_string();
        assert!(problems.contains("anna.toml:3: noise = 9.5: out of range (allowed: 0 to 6)"), "{problems}");
        assert!(problems.contains("anna.toml:4: noize = 1.0: unknown key; did you mean noise?"), "{problems}");
        assert!(read("anna.toml", "format = 1\n").expect_err("no base").to_string().contains("base: missing"));
    }
}
