//! Key names for configuration files and for display.

use spandrel_text::{Language, text};

/// Names of non-character keys in configuration files.
pub const SPECIAL_KEYS: [&str; 11] =
    ["up", "down", "left", "right", "space", "enter", "pageup", "pagedown", "tab", "escape", "backspace"];

/// Checks whether `name` is a valid key name: one lowercase character or one of [`SPECIAL_KEYS`].
#[must_use]
pub fn is_valid_key(name: &str) -> bool {
    let mut signs = name.chars();
    match (signs.next(), signs.next()) {
        (Some(sign), None) => !sign.is_whitespace() && !sign.is_control() && sign.to_lowercase().eq([sign]),
        _ => SPECIAL_KEYS.contains(&name),
    }
}

/// Returns the allowed key names, for error messages.
#[must_use]
pub fn allowed(language: Language) -> String {
    text!(language, "keys-allowed", names = SPECIAL_KEYS.join(", "))
}

/// Returns the display name of a key.
#[must_use]
pub fn label(name: &str, language: Language) -> String {
    match name {
        "escape" => text!(language, "keys-key-escape"),
        "pageup" => text!(language, "keys-key-page-up"),
        "pagedown" => text!(language, "keys-key-page-down"),
        "up" => text!(language, "keys-key-up"),
        "down" => text!(language, "keys-key-down"),
        "left" => text!(language, "keys-key-left"),
        "right" => text!(language, "keys-key-right"),
        "space" => text!(language, "keys-key-space"),
        "enter" => text!(language, "keys-key-enter"),
        "tab" => text!(language, "keys-key-tab"),
        "backspace" => text!(language, "keys-key-backspace"),
        name => capitalized(name),
    }
}

fn capitalized(name: &str) -> String {
    let mut signs = name.chars();
    let mut upper = signs.next().into_iter().flat_map(char::to_uppercase);
    match (upper.next(), upper.next()) {
        (Some(first), None) => format!("{first}{}", signs.as_str()),
        // If the uppercase form has two letters (as for ß), the label stays lowercase, because a key has only one
        // letter.
        _ => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_valid_keys_are_characters_and_special_keys() {
        for name in ["a", "ü", "ß", "7", "+", "[", ",", "я"].into_iter().chain(SPECIAL_KEYS) {
            assert!(is_valid_key(name), "{name}");
        }
        for name in ["", " ", "\n", "\u{7}", "A", "f5", "shift", "Up", "ab", "page up", "esc"] {
            assert!(!is_valid_key(name), "{name:?}");
        }
        let allowed = allowed(Language::English);
        assert!(allowed.contains("one character") && allowed.ends_with("backspace"));
    }

    #[test]
    fn exact_key_labels_differ_from_key_names() {
        let called = ["escape", "pageup", "pagedown", "up", "space", "backspace", "w", "ü", "ß", "[", "7", ""];
        let called = called.map(|name| label(name, Language::English));
        assert_eq!(called, ["Esc", "Page up", "Page down", "Up", "Space", "Backspace", "W", "Ü", "ß", "[", "7", ""]);
    }
}
