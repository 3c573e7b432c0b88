//! Available questionnaire languages (shipped and site-specific) and language selection.

use super::language_tag::is_language_tag;
use super::wording::{Wording, read_wording};
use spandrel_model::toml::Problems;

/// File names and contents of the shipped translations.
pub const SHIPPED: [(&str, &str); 3] =
    [("en.toml", include_str!("en.toml")), ("de.toml", include_str!("de.toml")), ("es.toml", include_str!("es.toml"))];
/// Maximum number of Accept-Language entries evaluated.
const MAX_ACCEPT_ENTRIES: usize = 20;

/// All available languages; the first is the default.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Languages(Vec<Wording>);

impl Languages {
    /// Creates the list from site-specific wordings, in the given order, followed by the shipped ones. If a language
    /// occurs more than once, its first wording is used.
    ///
    /// # Errors
    /// Fails if a shipped wording is invalid, which a test excludes.
    pub fn with(own: Vec<Wording>) -> Result<Self, Problems> {
        let mut all = own;
        for (file, text) in SHIPPED {
            let shipped = read_wording(file, text)?;
            if !all.iter().any(|known| known.language.eq_ignore_ascii_case(&shipped.language)) {
                all.push(shipped);
            }
        }
        Ok(Self(all))
    }

    /// Returns all wordings.
    #[must_use]
    pub fn all(&self) -> &[Wording] {
        &self.0
    }

    /// Returns the wording for a language tag. If there is none, returns one for the same language in another region.
    #[must_use]
    pub fn of(&self, tag: &str) -> Option<&Wording> {
        let primary = |tag: &str| tag.split('-').next().unwrap_or_default().to_ascii_lowercase();
        let exactly = self.0.iter().find(|known| known.language.eq_ignore_ascii_case(tag));
        exactly.or_else(|| self.0.iter().find(|known| primary(&known.language) == primary(tag)))
    }

    /// Returns the wording that an Accept-Language header prefers (RFC 9110, section 12.5.4), or the default if none matches.
    #[must_use]
    pub fn accepted(&self, header: &str) -> &Wording {
        let mut wanted: Vec<(&str, f64)> = header.split(',').take(MAX_ACCEPT_ENTRIES).filter_map(parse_accept_entry).collect();
        // Entries with equal weights keep the browser's order.
        wanted.sort_by(|a, b| b.1.total_cmp(&a.1));
        wanted.into_iter().find_map(|(tag, _)| self.of(tag)).unwrap_or(&self.0[0])
    }
}

/// Parses an Accept-Language entry into tag and weight; `None` if the weight is zero or the tag is invalid.
fn parse_accept_entry(part: &str) -> Option<(&str, f64)> {
    let (tag, parameter) = part.split_once(';').unwrap_or((part, "q=1"));
    let weight: f64 = parameter.trim().strip_prefix("q=")?.parse().ok()?;
    let tag = tag.trim();
    (is_language_tag(tag) && weight > 0.0 && weight <= 1.0).then_some((tag, weight))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn languages() -> Languages {
        Languages::with(Vec::new()).unwrap()
    }

    #[test]
    fn exact_preferred_available_language_is_selected() {
        let all = languages();
        for (header, expected) in [
            ("", "en"),
            ("de", "de"),
            ("de-CH, de;q=0.9, en;q=0.8", "de"),
            ("fr-FR,fr;q=0.9,es;q=0.4,en;q=0.3", "es"),
            ("en;q=0.3, es-MX;q=0.7", "es"),
            ("DE;q=0, es;q=0.1", "es"),
            ("fr, it", "en"),
            ("*", "en"),
            ("de;q=nan, es;q=0.5", "es"),
            (";;;,,=,<script>", "en"),
        ] {
            assert_eq!(all.accepted(header).language, expected, "{header}");
        }
    }

    #[test]
    fn exact_site_wording_takes_precedence_over_shipped() {
        let swiss = SHIPPED[1].1.replace("language = \"de\"", "language = \"de-CH\"");
        let english = SHIPPED[0].1.replace("After the flight", "Debriefing");
        let own = [("ch.toml", swiss), ("ours.toml", english)].map(|(file, text)| read_wording(file, &text).unwrap());
        let all = Languages::with(own.to_vec()).unwrap();
        let names: Vec<&str> = all.all().iter().map(|wording| wording.language.as_str()).collect();
        assert_eq!(names, ["de-CH", "en", "de", "es"]);
        assert_eq!((all.of("en").unwrap().title.as_str(), all.of("EN-gb").unwrap().title.as_str()), ("Debriefing", "Debriefing"));
        assert_eq!(all.accepted("de").language, "de");
        assert_eq!(all.accepted("de-AT").language, "de-CH", "the first wording of the same language");
        assert_eq!(all.accepted("fr").language, "de-CH", "the site's first wording is the default");
    }

    #[test]
    fn exact_language_tags_are_recognized() {
        for good in ["en", "de-CH", "zh-Hant-TW", "es-419"] {
            assert!(is_language_tag(good), "{good}");
        }
        for bad in ["", "-", "de-", "de_CH", "d\u{e4}", "<b>", "waytoolongtag", &"ab-".repeat(20)] {
            assert!(!is_language_tag(bad), "{bad}");
        }
    }
}
