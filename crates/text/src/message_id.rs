//! Names of messages whose variables are filled in by their names.

use crate::catalog::{Value, message};
use crate::language::Language;
use crate::messages::{is_message, variables};

/// Name of a message. The macro [`message_id!`](crate::message_id) checks at compile time that it exists.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MessageId(&'static str);

impl MessageId {
    /// Creates the name.
    ///
    /// # Panics
    /// Panics if there is no message with this name.
    #[must_use]
    pub const fn new(id: &'static str) -> Self {
        assert!(is_message(id), "catalog/en has no message with this name");
        Self(id)
    }

    /// Returns the message in a language; `value` returns the value of each variable by its name.
    #[must_use]
    pub fn fill(self, language: Language, value: &dyn Fn(&str) -> String) -> String {
        let values: Vec<(&str, Value<'_>)> = variables(self.0).iter().map(|name| (*name, value(name).into())).collect();
        message(language, self.0, &values)
    }
}

#[cfg(test)]
mod tests {
    use crate::{Language, message_id};

    #[test]
    fn exact_all_variables_of_a_message_are_filled() {
        let words = message_id!("flight-how-turn").fill(Language::English, &|name| format!("<{name}>"));
        assert_eq!(words, "Hold <turn_left> or <turn_right>.");
        assert!(std::panic::catch_unwind(|| super::MessageId::new("flight-how-to-wait")).is_err());
    }
}
