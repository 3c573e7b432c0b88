//! The texts of the window, reports and web pages in several languages.
//!
//! Each language has a folder in `catalog` with [Fluent](https://projectfluent.org) files. English is the reference: [`text!`]
//! checks at compile time that it contains the message, and that the message has exactly the given variables. Tests check that
//! the other languages have the same messages with the same variables. A text whose English source is elsewhere, such as the
//! documentation of a key, has messages in the other languages only ([`translation`]).
//!
//! Variables are values for display, with their units, such as `"12.5 m"`; numbers that select a plural form are integers.
//!
//! ```
//! use spandrel_text::{Language, text};
//!
//! assert_eq!(text!(Language::German, "common-language-name"), "Deutsch");
//! ```

mod catalog;
mod language;
mod message_id;
mod messages;
pub mod monitor_texts;
mod picture_reasons;
mod pseudo;
mod sentences;
pub mod terms;
mod translated;

pub use catalog::{Value, find, message, translation};
pub use language::Language;
pub use message_id::MessageId;
pub use messages::check_message;
pub use picture_reasons::PICTURE_REASONS;
pub use sentences::{MARK, Sentence, SentenceTable};
pub use translated::Translated;

/// Returns a message in a language: `text!(language, "id", variable = value)`. A wrong name is a compile error.
#[macro_export]
macro_rules! text {
    ($language:expr, $id:literal $(, $name:ident = $value:expr)* $(,)?) => {{
        const { $crate::check_message($id, &[$(stringify!($name)),*]) };
        $crate::message($language, $id, &[$((stringify!($name), $crate::Value::from($value))),*])
    }};
}

/// Returns the [`MessageId`] with this name: `message_id!("id")`. A wrong name is a compile error.
#[macro_export]
macro_rules! message_id {
    ($id:literal) => {
        const { $crate::MessageId::new($id) }
    };
}
