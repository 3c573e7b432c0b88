//! Equipment changes to report once.

use std::collections::BTreeSet;

/// Messages to broadcast once, and warnings.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct PayloadChange {
    messages: BTreeSet<u32>,
    warnings: BTreeSet<String>,
}

impl PayloadChange {
    /// Adds a message by its ID; it is built at the end of the tick.
    pub fn add_message(&mut self, message: u32) {
        self.messages.insert(message);
    }

    /// Adds a warning text.
    pub fn add_warning(&mut self, text: &str) {
        self.warnings.insert(text.to_owned());
    }

    /// Removes and returns all messages and warnings.
    pub fn take(&mut self) -> (BTreeSet<u32>, BTreeSet<String>) {
        (std::mem::take(&mut self.messages), std::mem::take(&mut self.warnings))
    }
}
