//! What the keys are called that do something: they can be chosen, and pages name them.

use std::collections::BTreeMap;

/// Keys for people, by what they do as files of keys name it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct KeyNames(BTreeMap<&'static str, String>);

impl KeyNames {
    /// Of these keys.
    #[must_use]
    pub fn new(keys: BTreeMap<&'static str, String>) -> Self {
        Self(keys)
    }

    /// Words with `{duty}` wherever a key is named; what no key does stays as it is written.
    #[must_use]
    pub fn fill(&self, words: &str) -> String {
        self.0.iter().fold(words.to_owned(), |words, (duty, key)| words.replace(&format!("{{{duty}}}"), key))
    }
}
