//! The documentation of scenario keys in the language of a page. The English texts are those of the reference
//! (`scenarios/README.md`), which is their only source; the catalog contains the other languages.

use spandrel_model::key_table::KeyDescription;
use spandrel_model::scenario::values::key_descriptions;
use spandrel_text::{Language, Sentence, SentenceTable, text, translation};
use std::sync::LazyLock;

/// Beginning of the names of the messages with the meanings.
const MEANING_PREFIX: &str = "scenario-keys-";
/// Beginning of the keys with the dimensions of bridges.
const BRIDGES: &str = "bridges[].";

/// Returns the meaning of a key, in Markdown, and its language: English if there is no translation.
#[must_use]
pub fn meaning(language: Language, description: &KeyDescription) -> (Language, String) {
    let english = &description.meaning;
    let translated = explained_by(description).find_map(|key| translation(language, &meaning_id(key), english));
    match translated {
        Some(meaning) => (language, meaning),
        None => (Language::English, english.clone()),
    }
}

/// Returns the keys whose messages explain a key: its own, and those of other bridge types with the same name and the same meaning.
fn explained_by(description: &KeyDescription) -> impl Iterator<Item = &str> {
    let dimension = |key: &str| key.strip_prefix(BRIDGES).and_then(|key| key.split_once('.')).map(|(_, name)| name.to_owned());
    let own = dimension(&description.key);
    let is_same =
        move |other: &&KeyDescription| own.is_some() && dimension(&other.key) == own && other.meaning == description.meaning;
    std::iter::once(description.key.as_str()).chain(key_descriptions().iter().filter(is_same).map(|other| other.key.as_str()))
}

/// Returns the name of the message with the meaning of a key, such as `scenario-keys-tasks-stand-off-m` for `tasks[].stand_off_m`.
fn meaning_id(key: &str) -> String {
    format!("{MEANING_PREFIX}{}", key.replace("[]", "").replace(['.', '_'], "-"))
}

/// Allowed values and defaults that contain words. Those with more words come first.
static VALUES: LazyLock<SentenceTable> = LazyLock::new(|| {
    SentenceTable::new([
        Sentence::new(0, |l, _| text!(l, "editor-allowed-true-or-false")),
        Sentence::new(2, |l, v| text!(l, "editor-allowed-whole-number", low = v[0], high = v[1])),
        Sentence::new(2, |l, v| text!(l, "editor-allowed-positions", low = v[0], high = v[1])),
        Sentence::new(2, |l, v| text!(l, "editor-allowed-whole-numbers", low = v[0], high = v[1])),
        Sentence::new(1, |l, v| text!(l, "editor-allowed-listed-numbers", numbers = v[0])),
        Sentence::new(3, |l, v| text!(l, "editor-allowed-numbers", count = v[0], low = v[1], high = v[2])),
        Sentence::new(2, |l, v| text!(l, "editor-allowed-range", low = v[0], high = v[1])),
        Sentence::new(0, |l, _| text!(l, "editor-default-first-form")),
        Sentence::new(0, |l, _| text!(l, "editor-default-standard-level")),
        Sentence::new(0, |l, _| text!(l, "editor-default-middle-span")),
        Sentence::new(0, |l, _| text!(l, "editor-default-first-pier")),
        Sentence::new(1, |l, v| text!(l, "editor-default-by-level", values = v[0])),
        Sentence::new(1, |l, v| text!(l, "editor-default-by-kind", values = v[0])),
        Sentence::new(2, |l, v| text!(l, "editor-default-true-for", first = v[0], second = v[1])),
    ])
});

/// Returns the allowed values of a key. Words of the file format stay.
#[must_use]
pub fn allowed_words(language: Language, allowed: &str) -> String {
    translated_allowed(language, allowed).unwrap_or_else(|| allowed.to_owned())
}

/// Returns the allowed values of a key; `None` if they contain no words, or none that are in the catalog.
pub(super) fn translated_allowed(language: Language, allowed: &str) -> Option<String> {
    VALUES.translate(allowed, language)
}

/// Returns the default of a key. Values and words of the file format stay.
#[must_use]
pub fn default_words(language: Language, default: &str) -> String {
    VALUES.translate(default, language).unwrap_or_else(|| default.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::web::scenario_form::form_keys;

    const GERMAN_FILE: &str = include_str!("../../../text/catalog/de/scenario-keys.ftl");

    /// Returns the words in backticks, and the numbers outside of them, in ascending order.
    fn quoted_words_and_numbers(text: &str) -> (Vec<&str>, Vec<&str>) {
        let mut quoted: Vec<&str> = text.split('`').skip(1).step_by(2).collect();
        let plain = text.split('`').step_by(2);
        let numbers = plain.flat_map(|part| part.split(|sign: char| !sign.is_ascii_digit() && sign != '.'));
        let mut numbers: Vec<&str> = numbers
            .map(|number| number.trim_matches('.'))
            .filter(|number| number.starts_with(|sign: char| sign.is_ascii_digit()))
            .collect();
        quoted.sort_unstable();
        numbers.sort_unstable();
        (quoted, numbers)
    }

    #[test]
    fn exact_every_default_in_words_is_translated() {
        let is_in_words = |default: &&str| default.contains(' ') && default.contains(|sign: char| sign.is_ascii_lowercase());
        for default in form_keys().map(|description| description.documented.default.as_str()).filter(is_in_words) {
            assert_ne!(default_words(Language::German, default), default);
            assert_ne!(default_words(Language::Spanish, default), default);
        }
    }

    #[test]
    fn exact_every_key_of_the_form_is_explained_in_every_language() {
        for description in form_keys() {
            for language in [Language::German, Language::Spanish] {
                let (own_language, words) = meaning(language, description);
                assert_eq!(own_language, language, "{}", description.key);
                assert_ne!(words, description.meaning, "{}", description.key);
                let expected = quoted_words_and_numbers(&description.meaning);
                assert_eq!(quoted_words_and_numbers(&words), expected, "{}: {words}", description.key);
            }
            assert_eq!(meaning(Language::English, description), (Language::English, description.meaning.clone()));
        }
    }

    #[test]
    fn exact_the_catalog_explains_no_other_keys() {
        let ids: Vec<String> = form_keys().map(|description| meaning_id(&description.key)).collect();
        let messages = GERMAN_FILE.lines().filter_map(|line| line.split_once(" = ")).map(|(id, _)| id);
        let others: Vec<&str> =
            messages.filter(|id| id.starts_with(MEANING_PREFIX) && !ids.iter().any(|known| known == id)).collect();
        assert!(others.is_empty(), "no keys of the form: {others:?}");
    }

    #[test]
    fn exact_words_of_allowed_values_and_defaults_are_translated() {
        for (english, german) in [
            ("0.2 to 7.999", "0.2 bis 7.999"),
            ("whole number 0 to 200", "ganze Zahl 0 bis 200"),
            ("3 numbers, each -5000 to 5000", "3 Zahlen, je -5000 bis 5000"),
            ("list of [east, north, up], each -5000 to 5000", "Liste von [Ost, Nord, Höhe], je -5000 bis 5000"),
            ("true or false", "true oder false"),
            ("list of whole numbers among 107, 205", "Liste ganzer Zahlen aus 107, 205"),
            ("flat, valley, file", "flat, valley, file"),
        ] {
            assert_eq!(allowed_words(Language::German, english), german);
            assert_eq!(allowed_words(Language::English, english), english);
        }
        assert_eq!(default_words(Language::German, "by level: 0, 0.12, 3, 12"), "je nach Stufe: 0, 0.12, 3, 12");
        assert_eq!(
            default_words(Language::Spanish, "true for arch_bottom and interlayer"),
            "true con arch_bottom y con interlayer"
        );
        assert_eq!(default_words(Language::Spanish, "respawn"), "respawn");
        let plain = ["text", "list of texts"];
        for description in form_keys().filter(|one| !plain.contains(&one.documented.allowed.as_str())) {
            let allowed = &description.documented.allowed;
            let has_words = allowed.contains(" to ") || allowed.contains(" or ") || allowed.contains(" of ");
            assert_eq!(allowed_words(Language::German, allowed) != *allowed, has_words, "{}: {allowed}", description.key);
        }
    }
}
