//! Why a dimension of a bridge must have certain values, given its other dimensions, in the language of a page. Keys, numbers and
//! numbers of standards stay as they are.

use spandrel_text::{Language, MARK, Sentence, SentenceTable, text};
use std::sync::LazyLock;

/// Reasons. Those with more words come first.
static REASONS: LazyLock<SentenceTable> = LazyLock::new(|| {
    SentenceTable::new([
        Sentence::new(0, |l, _| text!(l, "dimension-no-shallower")),
        Sentence::new(0, |l, _| text!(l, "dimension-no-deeper-beams")),
        Sentence::new(0, |l, _| text!(l, "dimension-fill")),
        Sentence::new(1, |l, v| text!(l, "dimension-fill-between", keys = v[0])),
        Sentence::new(0, |l, _| text!(l, "dimension-longest-span")),
        Sentence::new(1, |l, v| text!(l, "dimension-semicircle", key = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-water", key = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-constant-depth", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-soffit", keys = v[0])),
        Sentence::new(2, |l, v| text!(l, "dimension-webs", share = v[0], section = v[1])),
        Sentence::new(1, |l, v| text!(l, "dimension-deck-least", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-deck-most", keys = v[0])),
        Sentence::new(3, |l, v| text!(l, "dimension-mean-depth", share = v[0], keys = v[1], section = v[2])),
        Sentence::new(1, |l, v| text!(l, "dimension-bearings-apart", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-no-thinner-crown", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-no-wider-rib", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-no-wider-cap", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-no-wider-pier", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-no-narrower-cable", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-no-longer-pier", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-half-panel", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-wide-columns", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-wide-legs", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-wider-stays", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-room-stringers", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-room-barrier", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-room-bearings", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-room-columns", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-room-barrels", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-room-girders", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-room-gussets", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-room-trusses", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-cells-high", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-cells-wide", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-stays-steep", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-lowest-stays", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-four-radii", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-first-stay", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-below-cross-beam", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-below-portal", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-clear-of-deck", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-trautwine", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-half-radius", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-caps-below", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-bracing", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-longer-panels", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-stringers-apart", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-too-flat", key = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-too-steep", key = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-struts", key = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-minus-half", key = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-plus-half", key = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-no-shallower-key", key = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-no-deeper-key", key = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-no-wider-key", key = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-times-girders", keys = v[0])),
        Sentence::new(3, |l, v| text!(l, "dimension-times", factor = v[0], key = v[1], section = v[2])),
        Sentence::new(1, |l, v| text!(l, "dimension-half-estimate", key = v[0])),
        Sentence::new(1, |l, v| text!(l, "dimension-half", key = v[0])),
        Sentence::checked(1, |l, v| is_formula(v[0]).then(|| text!(l, "dimension-estimate", formula = v[0]))),
        Sentence::checked(2, |l, v| is_formula(v[0]).then(|| text!(l, "dimension-by-lrfd", formula = v[0], section = v[1]))),
    ])
});

/// Reasons with the values that follow from them.
static BOUNDS: LazyLock<SentenceTable> = LazyLock::new(|| {
    SentenceTable::new([
        Sentence::checked(2, |l, v| Some(text!(l, "dimension-at-least", why = reason(l, v[0])?, least = v[1]))),
        Sentence::checked(2, |l, v| Some(text!(l, "dimension-at-most", why = reason(l, v[0])?, most = v[1]))),
        Sentence::new(1, |l, v| text!(l, "dimension-one-of", numbers = v[0])),
    ])
});

/// Returns whether a text consists of keys, numbers, divisions, and the mark in patterns.
fn is_formula(text: &str) -> bool {
    let is_key = |word: &str| word.contains('_') || word == MARK;
    text.split(' ').all(|word| is_key(word) || word == "/" || word.parse::<f64>().is_ok())
}

/// Returns the allowed values of a dimension in a language; `None` if the English text is not about dimensions.
pub(super) fn allowed_dimension(language: Language, english: &str) -> Option<String> {
    BOUNDS.translate(english, language)
}

/// Patterns are composed in English while the tables are created, so these must not need them.
fn reason(language: Language, english: &str) -> Option<String> {
    if language == Language::English { Some(english.to_owned()) } else { REASONS.translate(english, language) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::scenario::bridges::BridgeKind;
    use std::collections::BTreeSet;

    /// Returns the reasons of all types of bridges with two dimensions at the ends of their ranges, and the others at their defaults.
    fn all_reasons() -> BTreeSet<String> {
        let mut found = BTreeSet::new();
        for bridge in BridgeKind::TYPES {
            let defaults: Vec<f64> = bridge.fields.iter().map(|field| field.default).collect();
            let ends = || bridge.fields.iter().enumerate().flat_map(|(i, field)| [(i, field.min), (i, field.max)]);
            for ((i, first), (j, second)) in ends().flat_map(|one| ends().map(move |other| (one, other))) {
                let mut values = defaults.clone();
                (values[i], values[j]) = (first, second);
                found.extend((bridge.create)(&values).inconsistencies().into_iter().map(|one| one.allowed));
            }
        }
        found.into_iter().filter(|allowed| allowed.contains(": ")).collect()
    }

    #[test]
    fn prop_reasons_of_every_type_of_bridge_are_translated() {
        let reasons = all_reasons();
        let mut sentences = BTreeSet::new();
        for english in &reasons {
            for language in [Language::German, Language::Spanish] {
                let words = allowed_dimension(language, english).unwrap_or_else(|| panic!("{english}"));
                assert!(![" of ", " at most", " at least", "the "].into_iter().any(|word| words.contains(word)), "{words}");
                let keys = |text: &str| {
                    text.split(|c: char| !(c.is_alphanumeric() || c == '_'))
                        .filter(|word| word.ends_with("_m"))
                        .map(str::to_owned)
                        .collect::<Vec<_>>()
                };
                assert_eq!(keys(english), keys(&words));
            }
            sentences.extend(english.split(": ").next().map(str::to_owned));
        }
        assert!(sentences.len() > 50, "{sentences:#?}");
    }

    #[test]
    fn exact_numbers_and_keys_stay() {
        let german = |english: &str| allowed_dimension(Language::German, english);
        assert_eq!(
            german("room for the bearings (joint_gap_m): at least 0.42").as_deref(),
            Some("Platz für die Lager (joint_gap_m): mindestens 0.42")
        );
        assert_eq!(
            german("0.25 main_span_m (estimate): at least 40.00").as_deref(),
            Some("0.25 main_span_m (Schätzung): mindestens 40.00")
        );
        assert_eq!(german("because of the weather: at least 40.00"), None);
        assert_eq!(german("the weather (estimate): at least 40.00"), None);
    }
}
