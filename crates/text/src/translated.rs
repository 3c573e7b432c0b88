//! A value in all languages.

use crate::language::Language;

/// A value in each of the languages that users can select.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Translated<T>([T; Language::ALL.len()]);

impl<T> Translated<T> {
    /// Creates the value in each language.
    pub fn new(value: impl FnMut(Language) -> T) -> Self {
        Self(Language::ALL.map(value))
    }

    /// Returns the value in a language. The pseudo language has the English one.
    #[must_use]
    pub fn get(&self, language: Language) -> &T {
        &self.0[language.catalog()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_each_language_has_its_own_value() {
        let tags = Translated::new(Language::tag);
        for language in Language::ALL {
            assert_eq!(*tags.get(language), language.tag());
        }
        assert_eq!(*tags.get(Language::Pseudo), "en");
    }
}
