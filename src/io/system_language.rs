//! The language that the user has chosen for the operating system.

use spandrel_text::Language;

/// Returns the language of messages (POSIX: `LC_ALL`, `LC_MESSAGES`, `LANG`), or English if it is not one of the product's.
pub fn system_language() -> Language {
    language_of(["LC_ALL", "LC_MESSAGES", "LANG"].map(|name| std::env::var(name).unwrap_or_default()))
}

/// Returns the language of the first variable that is set.
fn language_of(variables: [String; 3]) -> Language {
    let set = variables.iter().find(|value| !value.is_empty());
    set.and_then(|locale| Language::from_locale(locale)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_first_variable_that_is_set_determines_the_language() {
        let language = |all: &str, messages: &str, lang: &str| language_of([all, messages, lang].map(str::to_owned));
        assert_eq!(language("", "", "de_DE.UTF-8"), Language::German);
        assert_eq!(language("C.UTF-8", "", "de_DE.UTF-8"), Language::English, "LC_ALL takes precedence");
        assert_eq!(language("", "es_US", "de_DE"), Language::Spanish);
        assert_eq!(language("", "", ""), Language::English);
        assert_eq!(language("", "", "fr_FR"), Language::English, "not translated");
    }
}
