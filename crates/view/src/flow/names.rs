//! Display names of the key bindings, for use in page texts.

use std::collections::BTreeMap;

/// Display names of keys, by the binding's name in key files.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct KeyNames(BTreeMap<&'static str, String>);

impl KeyNames {
    /// Creates the names from a map of bindings to display names.
    #[must_use]
    pub fn new(keys: BTreeMap<&'static str, String>) -> Self {
        Self(keys)
    }

    /// Replaces each `{binding}` in a text with the name of its key; leaves unknown bindings unchanged.
    #[must_use]
    pub fn fill(&self, words: &str) -> String {
        self.0.iter().fold(words.to_owned(), |words, (duty, key)| words.replace(&format!("{{{duty}}}"), key))
    }
}
