//! Problems of scenario files in the language of a page. The readers of the model state them in English, in fixed sentences with
//! values; keys and values stay as they are in the file.

use super::dimension_words::allowed_dimension;
use super::key_texts::translated_allowed;
use spandrel_model::toml::{Problem, SYNTAX};
use spandrel_text::{Language, Sentence, SentenceTable, text};
use std::sync::LazyLock;

/// Messages. Those with more words come first.
static MESSAGES: LazyLock<SentenceTable> = LazyLock::new(|| {
    SentenceTable::new([
        Sentence::new(3, |l, v| {
            let problem = message_words(l, v[2]);
            text!(l, "problem-at-easiest", key = v[0], value = v[1], problem = problem)
        }),
        Sentence::new(3, |l, v| {
            let problem = message_words(l, v[2]);
            text!(l, "problem-at-hardest", key = v[0], value = v[1], problem = problem)
        }),
        Sentence::new(2, |l, v| text!(l, "problem-at-level", level = v[0], problem = message_words(l, v[1]))),
        Sentence::new(6, |l, v| {
            let (task, name, object) = (v[0], v[1], v[2]);
            text!(l, "problem-close-path", task = task, name = name, object = object, east = v[3], north = v[4], up = v[5])
        }),
        Sentence::new(5, |l, v| {
            let (name, object) = (v[0], drone_obstacle_words(l, v[1]));
            text!(l, "problem-close-drone", name = name, object = object, east = v[2], north = v[3], up = v[4])
        }),
        Sentence::new(2, |l, v| text!(l, "problem-point-repeated", point = v[0], before = v[1])),
        Sentence::new(2, |l, v| text!(l, "problem-place-in", place = v[0], obstacle = obstacle_words(l, v[1]))),
        Sentence::new(3, |l, v| text!(l, "problem-way", obstacle = obstacle_words(l, v[0]), east = v[1], north = v[2])),
        Sentence::new(0, |l, _| text!(l, "problem-out-of-range")),
        Sentence::new(0, |l, _| text!(l, "problem-not-a-number")),
        Sentence::new(0, |l, _| text!(l, "problem-not-whole")),
        Sentence::new(0, |l, _| text!(l, "problem-missing")),
        Sentence::new(0, |l, _| text!(l, "problem-not-a-table")),
        Sentence::new(0, |l, _| text!(l, "problem-not-tables")),
        Sentence::new(0, |l, _| text!(l, "problem-not-boolean")),
        Sentence::new(0, |l, _| text!(l, "problem-not-text")),
        Sentence::new(0, |l, _| text!(l, "problem-unknown-keyword")),
        Sentence::new(0, |l, _| text!(l, "problem-not-a-list")),
        Sentence::new(0, |l, _| text!(l, "problem-unknown-key")),
        Sentence::new(1, |l, v| text!(l, "problem-unknown-key-like", key = v[0])),
        Sentence::new(0, |l, _| text!(l, "problem-invalid-name")),
        Sentence::new(0, |l, _| text!(l, "problem-duplicate-name")),
        Sentence::new(0, |l, _| text!(l, "problem-duplicate-number")),
        Sentence::new(0, |l, _| text!(l, "problem-duplicate-file")),
        Sentence::new(0, |l, _| text!(l, "problem-invalid-file-name")),
        Sentence::new(0, |l, _| text!(l, "problem-invalid-caption")),
        Sentence::new(0, |l, _| text!(l, "problem-too-many")),
        Sentence::new(0, |l, _| text!(l, "problem-too-long")),
        Sentence::new(0, |l, _| text!(l, "problem-too-large")),
        Sentence::new(0, |l, _| text!(l, "problem-too-small")),
        Sentence::new(0, |l, _| text!(l, "problem-too-short")),
        Sentence::new(0, |l, _| text!(l, "problem-points-above")),
        Sentence::new(0, |l, _| text!(l, "problem-inconsistent")),
        Sentence::new(0, |l, _| text!(l, "problem-not-utc")),
        Sentence::new(0, |l, _| text!(l, "problem-no-clear")),
        Sentence::new(0, |l, _| text!(l, "problem-both-limits")),
        Sentence::new(0, |l, _| text!(l, "problem-no-forms")),
        Sentence::new(0, |l, _| text!(l, "problem-unknown-form")),
        Sentence::new(0, |l, _| text!(l, "problem-form-detection")),
        Sentence::new(0, |l, _| text!(l, "problem-not-unit")),
        Sentence::new(0, |l, _| text!(l, "problem-stain")),
        Sentence::new(0, |l, _| text!(l, "problem-no-photograph")),
        Sentence::new(0, |l, _| text!(l, "problem-after-landing")),
        Sentence::new(0, |l, _| text!(l, "problem-no-task")),
        Sentence::new(0, |l, _| text!(l, "problem-no-tasks")),
        Sentence::new(0, |l, _| text!(l, "problem-no-levels")),
        Sentence::new(0, |l, _| text!(l, "problem-unknown-level")),
        Sentence::new(0, |l, _| text!(l, "problem-no-change")),
        Sentence::new(0, |l, _| text!(l, "problem-wrong-order")),
        Sentence::new(0, |l, _| text!(l, "problem-levels-and-forms")),
        Sentence::new(0, |l, _| text!(l, "problem-no-effect")),
        Sentence::new(0, |l, _| text!(l, "problem-own-outside")),
        Sentence::new(0, |l, _| text!(l, "problem-no-such-kind")),
        Sentence::new(0, |l, _| text!(l, "problem-stand-off")),
        Sentence::new(0, |l, _| text!(l, "problem-unknown-bridge")),
        Sentence::new(0, |l, _| text!(l, "problem-no-points")),
        Sentence::new(0, |l, _| text!(l, "problem-cells")),
        Sentence::new(0, |l, _| text!(l, "problem-unknown-member")),
        Sentence::new(0, |l, _| text!(l, "problem-other-element")),
        Sentence::new(0, |l, _| text!(l, "problem-not-on-element")),
        Sentence::new(0, |l, _| text!(l, "problem-off-surface")),
        Sentence::new(0, |l, _| text!(l, "problem-no-room")),
        Sentence::new(2, |l, v| text!(l, "problem-place-far", place = v[0], distance = v[1])),
        Sentence::new(1, |l, v| text!(l, "problem-place-on-pad", place = v[0])),
        Sentence::new(3, |l, v| text!(l, "problem-place-near", place = v[0], distance = v[1], other = v[2])),
        Sentence::new(2, |l, v| text!(l, "problem-place-above", place = v[0], distance = v[1])),
        Sentence::new(2, |l, v| text!(l, "problem-place-below", place = v[0], distance = v[1])),
    ])
});

/// Obstacles in the messages about the places of the inspector.
static OBSTACLES: LazyLock<SentenceTable> = LazyLock::new(|| {
    SentenceTable::new([
        Sentence::new(0, |l, _| text!(l, "problem-obstacle-edge")),
        Sentence::new(0, |l, _| text!(l, "problem-obstacle-water")),
        Sentence::new(0, |l, _| text!(l, "problem-obstacle-bridge")),
        Sentence::new(0, |l, _| text!(l, "problem-obstacle-pad")),
        Sentence::new(0, |l, _| text!(l, "problem-obstacle-truck")),
    ])
});

/// Obstacles in the messages about the paths of drones that have no name of their own.
static DRONE_OBSTACLES: LazyLock<SentenceTable> = LazyLock::new(|| {
    SentenceTable::new([
        Sentence::new(0, |l, _| text!(l, "problem-obstacle-ground")),
        Sentence::new(0, |l, _| text!(l, "problem-obstacle-lake")),
        Sentence::new(0, |l, _| text!(l, "problem-obstacle-start")),
        Sentence::new(0, |l, _| text!(l, "problem-obstacle-others")),
    ])
});

/// Allowed values that are not those of a documented key ([`translated_allowed`]). Those with more words come first.
static ALLOWED: LazyLock<SentenceTable> = LazyLock::new(|| {
    SentenceTable::new([
        Sentence::new(0, |l, _| text!(l, "problem-allowed-text")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-texts")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-whole")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-even")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-table")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-tables")),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-name", most = v[0])),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-form-name")),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-caption", most = v[0])),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-paragraph", most = v[0])),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-unique-name")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-unique-number")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-own-file")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-picture")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-only-forms")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-only-no-forms")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-only-levels")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-here-or-defects")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-unit")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-stain")),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-places", most = v[0])),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-lines")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-low-battery")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-green-battery")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-too-close")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-one-of-two")),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-over-limit", limit = v[0])),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-over-best", time = v[0])),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-almanac")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-elements-file")),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-model", most = v[0])),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-heights")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-geotiff")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-photo")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-with-defects")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-land-last")),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-task-number", most = v[0])),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-tasks")),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-one-of-keys", keys = v[0])),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-levels", levels = v[0])),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-order-smaller")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-order-larger")),
        Sentence::new(2, |l, v| text!(l, "problem-allowed-within", key = v[0], value = v[1])),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-bridges", names = v[0])),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-points")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-rope-points")),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-rope-length", least = v[0])),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-rope-span", least = v[0])),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-path-length", most = v[0])),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-stand-off", most = v[0])),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-spacing", least = v[0])),
        Sentence::new(2, |l, v| {
            if l == Language::English {
                return text!(l, "problem-allowed-kinds", bridge = v[0], kinds = v[1]);
            }
            // The type of the bridge is stated in English.
            text!(l, "problem-allowed-kinds-here", kinds = v[1])
        }),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-member")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-on-member")),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-free-surface")),
        Sentence::new(4, |l, v| {
            text!(l, "problem-allowed-clearance", needed = v[0], aircraft = v[1], width = v[2], margin = v[3])
        }),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-far", most = v[0])),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-pad-edge", least = v[0])),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-apart", least = v[0])),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-from-point", least = v[0])),
        Sentence::new(1, |l, v| text!(l, "problem-allowed-point-count", most = v[0])),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-land")),
        Sentence::new(2, |l, v| text!(l, "problem-allowed-height", up = v[0], most = v[1])),
        Sentence::new(0, |l, _| text!(l, "problem-allowed-way")),
        Sentence::new(2, |l, v| text!(l, "problem-allowed-tables-most", most = v[0], table = v[1])),
    ])
});

/// Words about a problem, with their language: English if there is no translation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ProblemWords {
    /// Language of the words.
    pub language: Language,
    /// The problem, and the allowed values.
    pub text: String,
}

impl ProblemWords {
    /// Returns the words beside a field.
    #[must_use]
    pub fn new(language: Language, problem: &Problem) -> Self {
        if problem.key == SYNTAX {
            return Self { language, text: text!(language, "problem-syntax", words = problem.message.as_str()) };
        }
        Self::translated(language, problem).unwrap_or_else(|| Self::english(problem))
    }

    /// Returns the words in a language; `None` if the catalog does not have them.
    fn translated(language: Language, problem: &Problem) -> Option<Self> {
        let message = translated(&MESSAGES, language, &problem.message)?;
        if problem.allowed.is_empty() {
            return Some(Self { language, text: message });
        }
        let allowed = allowed_in(language, &problem.allowed)?;
        Some(Self { language, text: text!(language, "problem-with-allowed", problem = message, allowed = allowed) })
    }

    fn english(problem: &Problem) -> Self {
        let (language, message, allowed) = (Language::English, problem.message.as_str(), problem.allowed.as_str());
        let text = match allowed {
            "" => message.to_owned(),
            _ => text!(language, "problem-with-allowed", problem = message, allowed = allowed),
        };
        Self { language, text }
    }

    /// Returns the tag of the language if it is not that of the page.
    #[must_use]
    pub fn own_tag(&self, page: Language) -> Option<&'static str> {
        (self.language != page).then(|| self.language.tag())
    }
}

/// Returns an English text in a language; `None` if it is none of the sentences.
fn translated(table: &SentenceTable, language: Language, english: &str) -> Option<String> {
    if language == Language::English { Some(english.to_owned()) } else { table.translate(english, language) }
}

/// Returns the allowed values in a language. Keywords and keys stay; `None` for other words that the catalog does not have.
fn allowed_in(language: Language, english: &str) -> Option<String> {
    let is_list_of_words = || english.split(", ").all(|word| !word.contains(' '));
    let known = translated(&ALLOWED, language, english).or_else(|| allowed_dimension(language, english));
    known.or_else(|| translated_allowed(language, english)).or_else(|| is_list_of_words().then(|| english.to_owned()))
}

/// Returns the message in a message.
fn message_words(language: Language, english: &str) -> String {
    translated_or_same(&MESSAGES, language, english)
}

fn obstacle_words(language: Language, english: &str) -> String {
    translated_or_same(&OBSTACLES, language, english)
}

fn drone_obstacle_words(language: Language, english: &str) -> String {
    translated_or_same(&DRONE_OBSTACLES, language, english)
}

/// The English texts are composed while the table is created, so they must not need it.
fn translated_or_same(table: &LazyLock<SentenceTable>, language: Language, english: &str) -> String {
    if language == Language::English {
        return english.to_owned();
    }
    translated(table, language, english).unwrap_or_else(|| english.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::web::scenario_form::form_keys;
    use spandrel_model::scenario::edit::{Edit, apply};
    use spandrel_model::scenario::{self, select_form};
    use spandrel_model::shipped::{PILOT_STUDY, PRACTICE, TWO_BRIDGES};

    fn problems(text: &str) -> Vec<Problem> {
        scenario::read("job.toml", text, &|_| Err("no file".to_owned())).err().map_or_else(Vec::new, |problems| problems.0)
    }

    fn german(text: &str) -> Vec<String> {
        problems(text).iter().map(|problem| ProblemWords::new(Language::German, problem).text).collect()
    }

    /// Asserts that a problem has words in German and Spanish, and that the English ones are those of the file.
    fn assert_translated(problem: &Problem) {
        let english = ProblemWords::new(Language::English, problem).text;
        let own = format!("{} (allowed: {})", problem.message, problem.allowed);
        assert!(english == own || english == problem.message || problem.key == SYNTAX, "{english}");
        for language in [Language::German, Language::Spanish] {
            let words = ProblemWords::new(language, problem);
            assert_eq!(words.language, language, "{problem:?}");
            assert_ne!(words.text, english);
            let untranslated = |mark: &str| words.text.contains(mark);
            assert!(![" of ", " at most ", " at least ", " the "].into_iter().any(untranslated), "{}", words.text);
        }
    }

    /// Sets each key of the form to a wrong value, and removes it.
    #[test]
    fn prop_problems_of_every_key_are_translated() {
        let mut seen = std::collections::BTreeSet::new();
        for description in form_keys() {
            let location = description.key.replace("[]", "[0]");
            for (text, typed) in
                [PRACTICE, PILOT_STUDY].into_iter().flat_map(|text| ["?", "-99999999", "[1]", ""].map(|typed| (text, typed)))
            {
                let edit = Edit::Set { location: location.clone(), text: typed.into() };
                let Ok(edited) = apply(text, &[edit]) else { continue };
                for problem in problems(&edited).iter().filter(|problem| !problem.message.contains("no file")) {
                    assert_translated(problem);
                    seen.insert(problem.message.clone());
                }
            }
        }
        assert!(seen.len() > 8, "{seen:?}");
    }

    #[test]
    fn exact_messages_keep_keys_and_values() {
        let changed = |from: &str, to: &str| {
            assert!(TWO_BRIDGES.contains(from), "{from}");
            german(&TWO_BRIDGES.replacen(from, to, 1))
        };
        assert_eq!(
            changed("[wind]\n", "[wind]\nlevl = 1\n")[0].split(" (").next(),
            Some("unbekannter Schlüssel; meinten Sie level?")
        );
        assert_eq!(german(&select_form(PILOT_STUDY, "X")), ["unbekannte Variante (zulässig: A, B, C, H)"]);
        let own = "dieser Auftrag hat keine Varianten (zulässig: nur in einer Datei mit [[forms]])";
        assert_eq!(german(&select_form(TWO_BRIDGES, "A")), [own]);
        let bridge = apply(PRACTICE, &[Edit::Set { location: "tasks[3].bridge".into(), text: "none".into() }]).unwrap();
        assert_eq!(german(&bridge), ["unbekannte Brücke (zulässig: eine Brücke in dieser Datei: arch, suspension)"]);
        assert!(german("name = ")[0].starts_with("kein gültiges TOML: "));
    }

    #[test]
    fn exact_nested_and_unknown_messages() {
        let problem = |message: &str, allowed: &str| Problem {
            file: "job.toml".into(),
            line: 1,
            key: "tasks.0".into(),
            location: "tasks[0]".into(),
            value: String::new(),
            allowed: allowed.into(),
            message: message.into(),
        };
        let german = |message: &str, allowed: &str| ProblemWords::new(Language::German, &problem(message, allowed));
        let close = "the path of task 3 'Pier' passes too close to arch/rib (144) at east 1.5 m, north -2.0 m, up 30.0 m";
        let allowed = "at least 0.79 m for phantom2: half its 0.59 m tip-to-tip width plus 0.5 m";
        assert_eq!(
            german(&format!("at level 9: {close}"), allowed).text,
            "auf Stufe 9: die Bahn der Aufgabe 3 „Pier“ führt zu nah an arch/rib (144) vorbei, bei Ost 1.5 m, Nord -2.0 m, Höhe 30.0 m \
             (zulässig: mindestens 0.79 m für phantom2: die Hälfte der 0.59 m von Spitze zu Spitze plus 0.5 m)"
        );
        let drone = "the path of drone survey passes too close to vehicles or people at east 1.5 m, north -2.0 m, up 30.0 m";
        assert_eq!(
            german(drone, "").text,
            "die Bahn der Drohne survey führt zu nah an Fahrzeugen oder Personen vorbei, bei Ost 1.5 m, Nord -2.0 m, Höhe 30.0 m"
        );
        assert_eq!(german("point 3 is where point 2 is", "at least 0.1 m from the point before it").language, Language::German);
        assert_eq!(german("place 2 is in or too close to the water", "").text, "Standort 2: das Wasser ist dort oder zu nah");
        let at_end = german("invalid at the easiest level: wind.speed_m_s = 90: out of range", "0 to 30");
        let words = "ungültig auf der leichtesten Stufe: wind.speed_m_s = 90: außerhalb des Bereichs (zulässig: 0 bis 30)";
        assert_eq!(at_end.text, words);
        let unknown = german("heights.csv: not enough rows", "rows of comma-separated heights in meters");
        assert_eq!((unknown.language, unknown.own_tag(Language::German)), (Language::English, Some("en")));
        assert_eq!(unknown.text, "heights.csv: not enough rows (allowed: rows of comma-separated heights in meters)");
    }
}
