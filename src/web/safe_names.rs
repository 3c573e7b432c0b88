//! Checks names from browsers that are used as file names.

/// Returns true if a file with this name stays inside its folder on every operating system.
pub fn is_safe_file_name(name: &str) -> bool {
    let fits = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    !name.is_empty() && name.len() <= 200 && !name.starts_with('.') && name.chars().all(fits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_names_that_escape_their_folder_are_rejected() {
        for good in ["20260801T101010Z-anna-two-bridges-1a2b3c", "session-anna-001", "x.y"] {
            assert!(is_safe_file_name(good), "{good}");
        }
        for bad in ["", ".", "..", "../x", "a/b", "a\\b", "/etc", "a\0b", ".hidden", "é", &"x".repeat(201)] {
            assert!(!is_safe_file_name(bad), "{bad}");
        }
    }
}
