//! Machine-readable names of jobs, bridges and drones.

use crate::toml::{Reader, Section};

/// Maximum length of a machine-readable name, characters.
pub const MAX_NAME_CHARS: usize = 40;

/// Returns whether a character is allowed in a machine-readable name.
#[must_use]
pub const fn is_name_char(c: char) -> bool {
    c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'
}

/// Returns whether a text is a machine-readable name: 1 to 40 lowercase letters, digits and hyphens.
#[must_use]
pub fn is_name(text: &str) -> bool {
    (1..=MAX_NAME_CHARS).contains(&text.len()) && text.chars().all(is_name_char)
}

/// Reads a machine-readable name.
pub(super) fn read_name(r: &mut Reader, s: &mut Section, key: &'static str) -> String {
    let before = r.problems.len();
    let name = r.text(s, key, None);
    if !is_name(&name) && r.problems.len() == before {
        r.add_problem(s, key, &name, "1 to 40 characters: a-z, 0-9 and -", "invalid name");
    }
    name
}
