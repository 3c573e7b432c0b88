//! Display names of the key bindings, for use in page texts.

use spandrel_text::{Language, MessageId};
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

    /// Returns the name of a binding's key; for unknown bindings, the binding in braces.
    #[must_use]
    pub fn name(&self, binding: &str) -> String {
        self.0.get(binding).cloned().unwrap_or_else(|| format!("{{{binding}}}"))
    }

    /// Returns a message whose variables are bindings, with the names of their keys.
    #[must_use]
    pub fn fill(&self, language: Language, id: MessageId) -> String {
        id.fill(language, &|binding| self.name(binding))
    }
}
