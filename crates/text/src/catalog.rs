//! Formats messages with Fluent.

use crate::language::Language;
use crate::messages::{FILES, is_message};
use crate::pseudo::pseudo;
use fluent_bundle::concurrent::FluentBundle;
use fluent_bundle::{FluentArgs, FluentResource};
use std::sync::LazyLock;

/// Value of a message's variable: a text, or an integer that selects a plural form.
pub use fluent_bundle::FluentValue as Value;

type Bundle = FluentBundle<FluentResource>;

// Each catalog is read at its first use: most programs show one language only.
static ENGLISH: LazyLock<Bundle> = LazyLock::new(|| bundle(Language::English));
static GERMAN: LazyLock<Bundle> = LazyLock::new(|| bundle(Language::German));
static SPANISH: LazyLock<Bundle> = LazyLock::new(|| bundle(Language::Spanish));
static PSEUDO: LazyLock<Bundle> = LazyLock::new(|| bundle(Language::Pseudo));

/// Reads a language's catalog. The tests read it with all errors.
fn bundle(language: Language) -> Bundle {
    let mut bundle = FluentBundle::new_concurrent(vec![language.identifier()]);
    // The marks that isolate variables in bidirectional text would be visible in the window.
    bundle.set_use_isolating(false);
    if language == Language::Pseudo {
        bundle.set_transform(Some(pseudo));
    }
    for text in FILES[language.catalog()] {
        let resource = FluentResource::try_new((*text).to_owned()).unwrap_or_else(|(resource, _)| resource);
        bundle.add_resource_overriding(resource);
    }
    bundle
}

/// Returns a message in a language, or in English if the language does not have it. The macro [`text!`](crate::text) checks the
/// names.
#[must_use]
pub fn message(language: Language, id: &str, variables: &[(&str, Value<'_>)]) -> String {
    let bundle = match language {
        Language::English => &ENGLISH,
        Language::German => &GERMAN,
        Language::Spanish => &SPANISH,
        Language::Pseudo => &PSEUDO,
    };
    format(bundle, id, variables).or_else(|| format(&ENGLISH, id, variables)).unwrap_or_else(|| id.to_owned())
}

/// Returns the message with a name that is composed at run time, such as one for each bridge element; `None` if the English
/// catalog does not have it. The message may ignore variables. For all other messages, use [`text!`](crate::text), which checks
/// the names.
#[must_use]
pub fn find(language: Language, id: &str, variables: &[(&str, Value<'_>)]) -> Option<String> {
    is_message(id).then(|| message(language, id, variables))
}

/// Returns a text whose English source is not the catalog, such as the documentation of a key: in English, `english` itself; in
/// another language, the message with this name; `None` if the language does not have it.
#[must_use]
pub fn translation(language: Language, id: &str, english: &str) -> Option<String> {
    match language {
        Language::English => Some(english.to_owned()),
        Language::German => format(&GERMAN, id, &[]),
        Language::Spanish => format(&SPANISH, id, &[]),
        Language::Pseudo => Some(pseudo(english).into_owned()),
    }
}

fn format(bundle: &Bundle, id: &str, variables: &[(&str, Value<'_>)]) -> Option<String> {
    let pattern = bundle.get_message(id)?.value()?;
    let arguments: FluentArgs = variables.iter().map(|(name, value)| (*name, value.clone())).collect();
    let mut errors = Vec::new();
    let text = bundle.format_pattern(pattern, Some(&arguments), &mut errors);
    debug_assert!(errors.is_empty(), "{id}: {errors:?}");
    Some(text.into_owned())
}
