//! List of the English messages with their variables, and the check of a call against it.

include!(concat!(env!("OUT_DIR"), "/messages.rs"));

/// Catalog files of each language, in the order of the languages.
pub const FILES: [&[&str]; 3] = [EN, DE, ES];

/// Checks at compile time that a message exists and has exactly these variables.
///
/// # Panics
/// Panics if it does not.
pub const fn check_message(id: &str, variables: &[&str]) {
    let Some(index) = position(id) else { panic!("catalog/en has no message with this name") };
    let wanted = MESSAGES[index].1;
    assert!(wanted.len() == variables.len(), "the message has another number of variables");
    let mut k = 0;
    while k < variables.len() {
        assert!(contains(wanted, variables[k]), "the message has no variable with this name");
        k += 1;
    }
}

/// Checks whether a message exists.
pub const fn is_message(id: &str) -> bool {
    position(id).is_some()
}

/// Returns the variables of a message; none if it does not exist.
pub fn variables(id: &str) -> &'static [&'static str] {
    position(id).map_or(&[], |index| MESSAGES[index].1)
}

/// Returns a message's index in the sorted list.
const fn position(id: &str) -> Option<usize> {
    let (mut from, mut to) = (0, MESSAGES.len());
    while from < to {
        let middle = usize::midpoint(from, to);
        match compare(MESSAGES[middle].0.as_bytes(), id.as_bytes()) {
            0 => return Some(middle),
            order if order < 0 => from = middle + 1,
            _ => to = middle,
        }
    }
    None
}

const fn contains(names: &[&str], name: &str) -> bool {
    let mut k = 0;
    while k < names.len() {
        if compare(names[k].as_bytes(), name.as_bytes()) == 0 {
            return true;
        }
        k += 1;
    }
    false
}

/// Compares two byte strings: negative if the first one comes first, 0 if they are equal.
const fn compare(a: &[u8], b: &[u8]) -> i32 {
    let mut k = 0;
    while k < a.len() && k < b.len() {
        if a[k] != b[k] {
            return if a[k] < b[k] { -1 } else { 1 };
        }
        k += 1;
    }
    if a.len() == b.len() {
        0
    } else if a.len() < b.len() {
        -1
    } else {
        1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_every_message_is_found_and_others_are_not() {
        for (index, (id, variables)) in MESSAGES.iter().enumerate() {
            assert_eq!(position(id), Some(index), "{id}");
            check_message(id, variables);
        }
        for id in ["", "language", "common-language-names", "zzz"] {
            assert_eq!(position(id), None, "{id}");
        }
        assert!(std::panic::catch_unwind(|| check_message("common-language-name", &["count"])).is_err());
    }
}
