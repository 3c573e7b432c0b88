//! Recognizes English texts that were composed from messages of the catalog, and returns them in another language. What is sent or
//! stored is in English, so that it does not depend on a language.

use crate::language::Language;

/// Stands for a value in a pattern. Texts do not contain it.
pub const MARK: &str = "\u{0}";

/// Composes a sentence with its values, which are in the order in which the English sentence shows them.
type Compose = fn(Language, &[&str]) -> String;
/// Composes a sentence; `None` if the values are not those of this sentence.
type Check = fn(Language, &[&str]) -> Option<String>;

/// A sentence that can be recognized by its English words.
#[derive(Debug, Clone, Copy)]
pub struct Sentence {
    value_count: usize,
    compose: Composition,
}

#[derive(Debug, Clone, Copy)]
enum Composition {
    Always(Compose),
    Checked(Check),
}

impl Sentence {
    /// Creates a sentence with this number of values.
    #[must_use]
    pub const fn new(value_count: usize, compose: Compose) -> Self {
        Self { value_count, compose: Composition::Always(compose) }
    }

    /// Creates a sentence that does not have every value. `compose` returns `None` for other values.
    #[must_use]
    pub const fn checked(value_count: usize, compose: Check) -> Self {
        Self { value_count, compose: Composition::Checked(compose) }
    }

    fn compose(&self, language: Language, values: &[&str]) -> Option<String> {
        match self.compose {
            Composition::Always(compose) => Some(compose(language, values)),
            Composition::Checked(compose) => compose(language, values),
        }
    }

    /// Returns the English sentence with marks as values.
    fn pattern(&self) -> String {
        self.compose(Language::English, &vec![MARK; self.value_count]).unwrap_or_default()
    }
}

/// Sentences with their English patterns.
#[derive(Debug)]
pub struct SentenceTable(Vec<(String, Sentence)>);

impl SentenceTable {
    /// Creates a table. Sentences with more words between their values come first.
    #[must_use]
    pub fn new(sentences: impl IntoIterator<Item = Sentence>) -> Self {
        Self(sentences.into_iter().map(|sentence| (sentence.pattern(), sentence)).collect())
    }

    /// Returns an English text in a language; `None` if it is none of the sentences.
    #[must_use]
    pub fn translate(&self, text: &str, language: Language) -> Option<String> {
        self.0.iter().find_map(|(pattern, sentence)| sentence.compose(language, &values(text, pattern)?))
    }
}

/// Returns the parts of a text at the marks of a pattern; `None` if the rest differs.
pub(crate) fn values<'a>(text: &'a str, pattern: &str) -> Option<Vec<&'a str>> {
    let mut words = pattern.split(MARK).peekable();
    let mut rest = text.strip_prefix(words.next()?)?;
    let mut values = Vec::new();
    while let Some(word) = words.next() {
        let is_last = words.peek().is_none();
        let length = if is_last { rest.strip_suffix(word)?.len() } else { rest.find(word)? };
        let (value, following) = rest.split_at(length);
        values.push(value);
        rest = following.get(word.len()..)?;
    }
    rest.is_empty().then_some(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_values_are_the_parts_at_the_marks() {
        let pattern = "task \0 not done: \0% of its path";
        assert_eq!(values("task 3 not done: 45% of its path", pattern), Some(vec!["3", "45"]));
        assert_eq!(values("task 3 not done: 45% of its path!", pattern), None);
        assert_eq!(values("task 3", pattern), None);
        assert_eq!((values("landed", "landed"), values("landed ", "landed")), (Some(vec![]), None));
    }

    #[test]
    fn exact_a_sentence_is_translated_with_its_values_and_others_are_not() {
        let even = |_: Language, values: &[&str]| ["\0", "2"].contains(&values[0]).then(|| format!("pair {}", values[0]));
        let table = SentenceTable::new([
            Sentence::new(2, |language, values| {
                let words = if language == Language::German { "von" } else { "of" };
                format!("{} {words} {}", values[0], values[1])
            }),
            Sentence::checked(1, even),
        ]);
        assert_eq!(table.translate("3 of 4", Language::German).as_deref(), Some("3 von 4"));
        assert_eq!(table.translate("pair 2", Language::German).as_deref(), Some("pair 2"));
        assert_eq!(table.translate("pair 3", Language::German), None);
        assert_eq!(table.translate("", Language::German), None);
    }
}
