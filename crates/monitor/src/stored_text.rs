//! Texts that assessments and records contain in English, in another language: unmet requirements, and the reasons why pictures do
//! not count. Files keep the English text, so that they don't depend on a language; pages translate it for display.

use crate::measures::practice_aids::PracticeAids;
use crate::score::certification::names::title;
use spandrel_text::{Language, PICTURE_REASONS, Sentence, SentenceTable, text};
use std::sync::LazyLock;

/// Reasons why a picture does not count.
static REASONS: LazyLock<SentenceTable> = LazyLock::new(|| {
    let own = [
        Sentence::new(2, |l, v| text!(l, "certification-picture-resolution", value = v[0], limit = v[1])),
        Sentence::new(2, |l, v| text!(l, "certification-picture-motion-blur", value = v[0], limit = v[1])),
        Sentence::new(2, |l, v| text!(l, "certification-picture-incidence", value = v[0], limit = v[1])),
        Sentence::new(0, |l, _| text!(l, "certification-picture-too-fine")),
    ];
    SentenceTable::new(own.into_iter().chain(PICTURE_REASONS))
});

/// Other known texts. Those with more words between their values come first.
static TEXTS: LazyLock<SentenceTable> = LazyLock::new(|| {
    SentenceTable::new([
        Sentence::new(3, |l, v| text!(l, "certification-unmet-task-part", task = v[0], share = v[1], needed = v[2])),
        Sentence::new(1, |l, v| text!(l, "certification-unmet-task-not-attempted", task = v[0])),
        Sentence::new(0, |l, _| text!(l, "certification-unmet-hit")),
        Sentence::new(0, |l, _| text!(l, "certification-unmet-landing")),
        Sentence::new(2, |l, v| text!(l, "certification-unmet-battery", battery = v[0], needed = v[1])),
        Sentence::new(1, |l, v| text!(l, "certification-unmet-one-contact", limit = v[0])),
        Sentence::new(2, |l, v| text!(l, "certification-unmet-contacts", contacts = v[0], limit = v[1])),
        Sentence::new(2, |l, v| text!(l, "certification-unmet-contact-speed", speed = v[0], limit = v[1])),
        Sentence::new(2, |l, v| text!(l, "terms-picture-of-defect", defect = v[0], reason = reason(v[1], l))),
        Sentence::new(1, |l, v| text!(l, "certification-unmet-practice", aids = practice_aids(v[0], l))),
        Sentence::new(1, |l, v| text!(l, "certification-unmet-no-evidence", score = score(v[0], l))),
        Sentence::new(3, |l, v| text!(l, "certification-unmet-score", score = score(v[0], l), value = v[1], needed = v[2])),
    ])
});

/// Returns a reason why a picture does not count in a language. An unknown one stays.
fn reason(stored: &str, language: Language) -> String {
    REASONS.translate(stored, language).unwrap_or_else(|| stored.to_owned())
}

/// Returns the name of a certification score in a language; files contain its key.
fn score(key: &str, language: Language) -> String {
    title(key, language).unwrap_or_else(|| key.to_owned())
}

/// Returns a stored English text in a language, or unchanged if it is none of the known ones. Scores get the names that people
/// read, also in English.
#[must_use]
pub fn translated(stored: &str, language: Language) -> String {
    let known = REASONS.translate(stored, language).or_else(|| TEXTS.translate(stored, language));
    known.unwrap_or_else(|| stored.to_owned())
}

/// Returns stored English texts in a language.
#[must_use]
pub fn all_translated(stored: &[String], language: Language) -> Vec<String> {
    stored.iter().map(|one| translated(one, language)).collect()
}

/// Returns the words for aids of practice in a language. Other words stay.
fn practice_aids(words: &str, language: Language) -> String {
    PracticeAids::from_words(words).words(language).unwrap_or_else(|| words.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_every_stored_text_is_translated_with_its_values() {
        let texts = [
            ("task 3 not done: 45% of its path, 80% needed", "Aufgabe 3 nicht erledigt: 45% der Bahn, 80% nötig"),
            ("task 2 not attempted", "Aufgabe 2 nicht begonnen"),
            ("a person or vehicle was hit", "eine Person oder ein Fahrzeug wurde getroffen"),
            ("not landed at home", "nicht am Landeplatz gelandet"),
            ("12% battery at landing, 20% needed", "12% Akku bei der Landung, 20% nötig"),
            ("3 contacts, at most 2 allowed", "Berührungen: 3, höchstens 2 erlaubt"),
            ("contact at 1.4 m/s, at most 1 m/s allowed", "Berührung mit 1.4 m/s, höchstens 1 m/s erlaubt"),
            (
                "rewound twice and frozen 3 times, so it was practice",
                "zweimal zurückgespult und 3-mal eingefroren, daher ein Übungsflug",
            ),
            ("frozen once, so it was practice", "einmal eingefroren, daher ein Übungsflug"),
            ("defect 4: motion blur 3.1 px, limit 2 px", "Schaden 4: Bewegungsunschärfe 3.1 px, höchstens 2 px"),
            ("too dark: lamp off, 10 lx of 50 lx needed", "zu dunkel: Scheinwerfer aus, 10 lx, nötig 50 lx"),
            ("too oblique: 69 deg, limit 60 deg", "zu schräg: 69°, höchstens 60°"),
            ("line too thin: 0.2 px, at least 0.5 px", "Linie zu dünn: 0.2 px, mindestens 0.5 px"),
            ("too small: 3 px, at least 16 px", "zu klein: 3 px, mindestens 16 px"),
            ("not in the central 80% of the image", "nicht in den mittleren 80% des Bildes"),
            ("hidden behind something", "verdeckt"),
            ("too fine for this camera", "zu fein für diese Kamera"),
        ];
        for (stored, german) in texts {
            assert_eq!(translated(stored, Language::German), german);
            assert_eq!(translated(stored, Language::English), stored);
            assert!(!translated(stored, Language::Pseudo).is_ascii(), "{stored}");
        }
        assert_eq!(translated("something else", Language::Spanish), "something else");
    }

    #[test]
    fn regress_stored_certification_scores_get_names_of_their_own() {
        let texts = [
            ("precision 60, 70 needed", "flight precision 60, 70 needed", "Flugpräzision 60, 70 nötig"),
            (
                "no evidence for conformity",
                "no evidence for coverage-weighted conformity",
                "kein Nachweis für: abdeckungsgewichtete Bahntreue",
            ),
        ];
        for (stored, english, german) in texts {
            assert_eq!(translated(stored, Language::English), english);
            assert_eq!(translated(stored, Language::German), german);
            assert!(!translated(stored, Language::Pseudo).is_ascii(), "{stored}");
        }
    }
}
