//! The product's languages.

use unic_langid::LanguageIdentifier;

/// A language of the product.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Language {
    /// American English, the reference.
    #[default]
    English,
    /// German.
    German,
    /// Spanish.
    Spanish,
    /// English with accents on all letters. Shows texts that are not in the catalog, and texts that do not fit when they are
    /// longer than in English. For tests.
    Pseudo,
}

impl Language {
    /// Languages that users can select.
    pub const ALL: [Self; 3] = [Self::English, Self::German, Self::Spanish];

    /// Returns the language tag (BCP 47).
    #[must_use]
    pub const fn tag(self) -> &'static str {
        match self {
            Self::English => "en",
            Self::German => "de",
            Self::Spanish => "es",
            Self::Pseudo => "en-XA",
        }
    }

    /// Returns the language with exactly this tag.
    #[must_use]
    pub fn from_tag(tag: &str) -> Option<Self> {
        Self::ALL.into_iter().chain([Self::Pseudo]).find(|language| language.tag().eq_ignore_ascii_case(tag))
    }

    /// Returns the language of a locale such as `de_AT.UTF-8` or a tag such as `es-MX`; `None` if it is not a language of the
    /// product.
    #[must_use]
    pub fn from_locale(locale: &str) -> Option<Self> {
        let subtags = locale.split(['_', '-', '.', '@']).next().unwrap_or_default();
        Self::from_tag(locale).or_else(|| Self::from_tag(subtags))
    }

    /// Returns the language that an Accept-Language header prefers (RFC 9110, section 12.5.4); `None` if it names none of the
    /// product's languages.
    #[must_use]
    pub fn accepted(header: &str) -> Option<Self> {
        let entry = |entry: &str| {
            let mut parts = entry.split(';');
            let language = Self::from_locale(parts.next()?.trim())?;
            let weight =
                parts.find_map(|part| part.trim().strip_prefix("q=")).map_or(Some(1.0), |weight| weight.parse::<f64>().ok())?;
            (weight > 0.0).then_some((language, weight))
        };
        let entries = header.split(',').take(MAX_ACCEPTED_ENTRIES).filter_map(entry);
        // Of entries with the same weight, the first one wins.
        entries
            .fold(None::<(Self, f64)>, |best, one| if best.is_some_and(|(_, weight)| weight >= one.1) { best } else { Some(one) })
            .map(|(language, _)| language)
    }

    /// Returns the language's name in the language itself.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::English => "English",
            Self::German => "Deutsch",
            Self::Spanish => "Español",
            Self::Pseudo => "Ƥšéúđó",
        }
    }

    /// Returns the identifier that selects the plural rules.
    pub(crate) fn identifier(self) -> LanguageIdentifier {
        let tag = if self == Self::Pseudo { Self::English.tag() } else { self.tag() };
        // All tags are valid, so the default is never used.
        tag.parse().unwrap_or_default()
    }

    /// Returns the index of the catalog in [`crate::messages::FILES`].
    pub(crate) const fn catalog(self) -> usize {
        match self {
            Self::English | Self::Pseudo => 0,
            Self::German => 1,
            Self::Spanish => 2,
        }
    }
}

/// Maximum number of Accept-Language entries that are read. Browsers send fewer than ten.
const MAX_ACCEPTED_ENTRIES: usize = 32;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_tags_and_locales_name_languages() {
        for language in Language::ALL {
            assert_eq!(Language::from_tag(language.tag()), Some(language));
        }
        let known = [
            ("de_DE.UTF-8", Some(Language::German)),
            ("de-AT", Some(Language::German)),
            ("ES", Some(Language::Spanish)),
            ("en-XA", Some(Language::Pseudo)),
            ("C", None),
            ("", None),
            ("french", None),
        ];
        for (locale, language) in known {
            assert_eq!(Language::from_locale(locale), language, "{locale}");
        }
    }

    #[test]
    fn exact_browser_gets_the_known_language_with_the_greatest_weight() {
        let cases = [
            ("es-MX,es;q=0.9,en;q=0.8", Some(Language::Spanish)),
            ("fr, de;q=0.7, en;q=0.8", Some(Language::English)),
            ("en;q=0, de;q=0.1", Some(Language::German)),
            ("en;q=0.5,es;q=0.5", Some(Language::English)),
            ("fr", None),
            ("", None),
            ("de;q=x", None),
        ];
        for (header, language) in cases {
            assert_eq!(Language::accepted(header), language, "{header}");
        }
    }
}
