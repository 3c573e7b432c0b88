//! Numbers with their nouns.

/// Returns a number with its noun, such as "1 car" or "3 cars".
pub(super) fn count(number: usize, what: &str) -> String {
    if number == 1 { format!("1 {what}") } else { format!("{number} {what}s") }
}
