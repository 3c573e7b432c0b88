//! The texts that the monitor sends during a flight, in the language of the window or of a web page. On the wire, they are in
//! English.

use crate::language::Language;
use crate::picture_reasons::PICTURE_REASONS;
use crate::sentences::{MARK, Sentence, SentenceTable, values};
use crate::terms::contact_title;
use crate::text;
use std::sync::LazyLock;

/// A warning in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// Name of the cue.
    pub name: String,
    /// The whole text, which begins with the name.
    pub words: String,
}

impl Warning {
    /// Returns the warning of a cue's text; `None` if the text belongs to no cue. `shown` changes the name, such as to capitals.
    #[must_use]
    pub fn of_text(text: &str, language: Language, shown: impl Fn(String) -> String) -> Option<Self> {
        let (cue, detail) = CUES.iter().find_map(|cue| Some((cue, cue.detail(text)?)))?;
        let name = shown((cue.name)(language));
        let words = cue.words(detail, &name, language).unwrap_or_else(|| format!("{name}{detail}"));
        Some(Self { name, words })
    }
}

/// Composes a warning from the name of its cue and the values.
type ComposeWarning = fn(Language, &str, &[&str]) -> String;

/// A cue with the patterns of its details.
struct CueSentences {
    name: fn(Language) -> String,
    /// The English name, with which the texts begin.
    label: String,
    details: Vec<(String, ComposeWarning)>,
}

impl CueSentences {
    fn new(name: fn(Language) -> String, details: &[(usize, ComposeWarning)]) -> Self {
        let pattern =
            |(count, compose): &(usize, ComposeWarning)| (compose(Language::English, "", &vec![MARK; *count]), *compose);
        Self { name, label: name(Language::English), details: details.iter().map(pattern).collect() }
    }

    /// Returns the text after the label; `None` if the text belongs to another cue.
    fn detail<'a>(&self, text: &'a str) -> Option<&'a str> {
        let rest = text.strip_prefix(self.label.as_str())?;
        (rest.is_empty() || rest.starts_with([':', ' '])).then_some(rest)
    }

    fn words(&self, detail: &str, name: &str, language: Language) -> Option<String> {
        let composed = |(pattern, compose): &(String, ComposeWarning)| Some(compose(language, name, &values(detail, pattern)?));
        self.details.iter().find_map(composed)
    }
}

static CUES: LazyLock<[CueSentences; 6]> = LazyLock::new(|| {
    [
        CueSentences::new(
            |l| text!(l, "flight-cue-crash"),
            &[(1, |l, name, v| text!(l, "flight-warning-crash", name = name, object = object_words(v[0], l)))],
        ),
        CueSentences::new(
            |l| text!(l, "flight-cue-too-close"),
            &[(2, |l, name, v| text!(l, "flight-warning-too-close", name = name, distance = v[0], limit = v[1]))],
        ),
        CueSentences::new(
            |l| text!(l, "flight-cue-speeding"),
            &[(2, |l, name, v| text!(l, "flight-warning-speeding", name = name, speed = v[0], limit = v[1]))],
        ),
        CueSentences::new(
            |l| text!(l, "flight-cue-stand-off"),
            &[
                (2, |l, name, v| text!(l, "flight-warning-stand-off-small", name = name, distance = v[0], recommended = v[1])),
                (2, |l, name, v| text!(l, "flight-warning-stand-off-large", name = name, distance = v[0], recommended = v[1])),
            ],
        ),
        CueSentences::new(
            |l| text!(l, "flight-cue-off-path"),
            &[(2, |l, name, v| {
                text!(l, "flight-warning-off-path", name = name, distance = v[0], direction = direction_words(v[1], l))
            })],
        ),
        CueSentences::new(
            |l| text!(l, "flight-cue-battery"),
            &[(1, |l, name, v| text!(l, "flight-warning-battery", name = name, level = v[0]))],
        ),
    ]
});

/// Returns the name of what the drone hit. Names from the scenario stay.
fn object_words(object: &str, language: Language) -> String {
    match object {
        "ground" => return text!(language, "terms-contact-ground"),
        "pad" => return text!(language, "flight-object-pad"),
        "inspector" => return text!(language, "flight-object-inspector"),
        "crew truck" => return text!(language, "flight-object-crew-truck"),
        _ => {}
    }
    match object.rsplit_once(' ') {
        Some(("bridge member", name)) => text!(language, "flight-object-member", name = name),
        Some(("car", number)) => text!(language, "flight-object-car", number = number),
        Some(("truck", number)) => text!(language, "flight-object-truck", number = number),
        Some(("pedestrian", number)) => text!(language, "flight-object-pedestrian", number = number),
        _ => contact_title(object, language),
    }
}

/// Returns a direction such as "forward, right and down". Other words stay.
fn direction_words(words: &str, language: Language) -> String {
    let named = words.split([',', ' ']).filter(|word| !word.is_empty() && *word != "and");
    let named: Option<Vec<String>> = named.map(|word| one_direction(word, language)).collect();
    match named.as_deref() {
        Some([]) => String::new(),
        Some([only]) => only.clone(),
        Some([first, second]) => {
            text!(language, "flight-directions-two", first = first.as_str(), second = second.as_str())
        }
        Some([first, second, third]) => {
            text!(language, "flight-directions-three", first = first.as_str(), second = second.as_str(), third = third.as_str())
        }
        Some(_) | None => words.to_owned(),
    }
}

fn one_direction(word: &str, language: Language) -> Option<String> {
    Some(match word {
        "forward" => text!(language, "terms-direction-forward"),
        "back" => text!(language, "terms-direction-back"),
        "right" => text!(language, "terms-direction-right"),
        "left" => text!(language, "terms-direction-left"),
        "up" => text!(language, "terms-direction-up"),
        "down" => text!(language, "terms-direction-down"),
        _ => return None,
    })
}

/// Remarks about mistakes in the steps of a lesson.
static REMARKS: LazyLock<SentenceTable> = LazyLock::new(|| {
    let own = [
        Sentence::new(0, |l, _| text!(l, "flight-remark-motors-off")),
        Sentence::new(0, |l, _| text!(l, "flight-remark-no-defect")),
        Sentence::new(1, |l, v| text!(l, "flight-remark-left-ring", time = v[0])),
        Sentence::new(0, |l, _| text!(l, "flight-remark-passed-ring")),
        Sentence::new(0, |l, _| text!(l, "flight-remark-tilt-up")),
        Sentence::new(0, |l, _| text!(l, "flight-remark-tilt-down")),
        Sentence::new(1, |l, v| text!(l, "flight-remark-landed-elsewhere", distance = v[0])),
    ];
    SentenceTable::new(own.into_iter().chain(PICTURE_REASONS))
});

/// Returns a remark about a lesson. An unknown one stays.
#[must_use]
pub fn remark_words(remark: &str, language: Language) -> String {
    REMARKS.translate(remark, language).unwrap_or_else(|| remark.to_owned())
}

/// Instructions for the steps of a lesson.
static INSTRUCTIONS: LazyLock<SentenceTable> = LazyLock::new(|| {
    SentenceTable::new([
        Sentence::new(0, |l, _| in_message(l, text!(l, "flight-lesson-arm"))),
        Sentence::new(1, |l, v| in_message(l, text!(l, "flight-lesson-take-off", height = v[0]))),
        Sentence::new(1, |l, v| in_message(l, text!(l, "flight-lesson-hover", time = v[0]))),
        Sentence::new(1, |l, v| in_message(l, text!(l, "flight-lesson-turn", angle = degrees(l, v[0])))),
        Sentence::new(0, |l, _| in_message(l, text!(l, "flight-lesson-fly-path"))),
        Sentence::new(1, |l, v| in_message(l, text!(l, "flight-lesson-stop-at", time = v[0]))),
        Sentence::new(1, |l, v| in_message(l, text!(l, "flight-lesson-tilt-down", angle = degrees(l, v[0])))),
        Sentence::new(1, |l, v| in_message(l, text!(l, "flight-lesson-tilt-up", angle = degrees(l, v[0])))),
        Sentence::new(0, |l, _| in_message(l, text!(l, "flight-lesson-lamp"))),
        Sentence::new(0, |l, _| in_message(l, text!(l, "flight-lesson-photograph"))),
        Sentence::new(0, |l, _| in_message(l, text!(l, "flight-lesson-fly-home"))),
        Sentence::new(0, |l, _| in_message(l, text!(l, "flight-lesson-land"))),
        Sentence::new(0, |l, _| in_message(l, text!(l, "flight-lesson-done"))),
    ])
});

/// Returns an instruction as it stands in a message: in English, with a lowercase first letter.
fn in_message(language: Language, instruction: String) -> String {
    match language {
        Language::English => {
            let mut letters = instruction.chars();
            letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
        }
        Language::German | Language::Spanish | Language::Pseudo => instruction,
    }
}

/// Returns an angle with its unit: in English, as in the monitor's texts.
fn degrees(language: Language, angle: &str) -> String {
    match language {
        Language::English => format!("{angle} deg"),
        Language::German | Language::Spanish | Language::Pseudo => format!("{angle}°"),
    }
}

/// The next step of the job, and the result.
static GUIDANCE: LazyLock<SentenceTable> = LazyLock::new(|| {
    SentenceTable::new([
        Sentence::new(0, |l, _| text!(l, "flight-step-take-off")),
        Sentence::new(0, |l, _| text!(l, "flight-step-fly-home")),
        Sentence::new(0, |l, _| text!(l, "flight-step-land")),
        Sentence::new(0, |l, _| text!(l, "flight-message-session-over")),
        Sentence::checked(1, |l, v| Some(text!(l, "flight-message-fly-home", words = detour_or_way(v[0], l)?))),
        Sentence::checked(1, |l, v| Some(text!(l, "flight-message-first", words = way_words(v[0], l)?))),
        Sentence::checked(2, |l, v| Some(text!(l, "flight-message-return", task = v[0], words = way_words(v[1], l)?))),
        Sentence::new(1, |l, v| text!(l, "flight-message-fly-to-path", task = v[0])),
        Sentence::new(1, |l, v| text!(l, "flight-message-follow-path", task = v[0])),
        Sentence::new(1, |l, v| text!(l, "flight-message-hold", task = v[0])),
        Sentence::checked(2, |l, v| Some(text!(l, "flight-message-task", task = v[0], words = detour_or_way(v[1], l)?))),
        Sentence::new(0, |l, _| text!(l, "flight-message-nothing-to-score")),
        Sentence::new(1, |l, v| text!(l, "flight-message-certified", points = v[0])),
        Sentence::new(1, |l, v| text!(l, "flight-message-not-certified", points = v[0])),
    ])
});

/// Maneuvers around an obstacle.
static DETOURS: LazyLock<SentenceTable> = LazyLock::new(|| {
    SentenceTable::new([
        Sentence::new(0, |l, _| text!(l, "flight-detour-out-from-under")),
        Sentence::new(0, |l, _| text!(l, "flight-detour-climb")),
        Sentence::new(0, |l, _| text!(l, "flight-detour-descend")),
        Sentence::new(0, |l, _| text!(l, "flight-detour-around")),
    ])
});

/// Returns a maneuver around an obstacle, or a way; `None` for other words.
fn detour_or_way(words: &str, language: Language) -> Option<String> {
    DETOURS.translate(words, language).or_else(|| way_words(words, language))
}

/// Returns a way such as "140 m, 30 deg left, 12 m up"; `None` for other words.
#[must_use]
pub fn way_words(words: &str, language: Language) -> Option<String> {
    if words == MARK {
        return Some(MARK.to_owned());
    }
    let mut sent = words.split(", ");
    let (distance, turn) = (sent.next()?, sent.next()?);
    let way = turn_words(distance, turn, language)?;
    let Some(height) = sent.next() else { return Some(way) };
    if let Some(height) = height.strip_suffix(" up") {
        return Some(text!(language, "flight-message-way-up", way = way, height = height));
    }
    height.strip_suffix(" down").map(|height| text!(language, "flight-message-way-down", way = way, height = height))
}

fn turn_words(distance: &str, turn: &str, language: Language) -> Option<String> {
    let angle = |side: &str| turn.strip_suffix(side).map(|angle| degrees(language, angle));
    Some(match (turn, angle(" deg left"), angle(" deg right")) {
        ("ahead", ..) => text!(language, "flight-way-ahead", distance = distance),
        ("behind you", ..) => text!(language, "flight-way-behind", distance = distance),
        (_, Some(angle), _) => text!(language, "flight-way-left", distance = distance, angle = angle),
        (_, None, Some(angle)) => text!(language, "flight-way-right", distance = distance, angle = angle),
        (_, None, None) => return None,
    })
}

/// Returns a text of the monitor in a language; `None` if the monitor does not send such a text.
#[must_use]
pub fn message_words(message: &str, language: Language) -> Option<String> {
    let warning = || Warning::of_text(message, language, |name| name).map(|warning| warning.words);
    warning().or_else(|| lesson_message(message, language)).or_else(|| GUIDANCE.translate(message, language))
}

/// Words at the start of each text about a lesson.
const LESSON_PREFIX: &str = "Lesson: ";

fn lesson_message(message: &str, language: Language) -> Option<String> {
    let rest = message.strip_prefix(LESSON_PREFIX)?;
    let numbered = || {
        let (number, words) = rest.split_once(' ')?;
        let (step, steps) = number.split_once('/')?;
        let words = INSTRUCTIONS.translate(words, language).or_else(|| way_words(words, language))?;
        Some(text!(language, "flight-message-lesson-step", step = step, steps = steps, words = words))
    };
    let plain = || {
        let words = INSTRUCTIONS.translate(rest, language).unwrap_or_else(|| remark_words(rest, language));
        text!(language, "flight-message-lesson", words = words)
    };
    Some(numbered().unwrap_or_else(plain))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn warning(text: &str, language: Language) -> String {
        Warning::of_text(text, language, |name| name.to_uppercase()).map(|warning| warning.words).unwrap_or_default()
    }

    /// Texts of every kind, as the monitor sends them.
    const SENT: [&str; 30] = [
        "Return to task 2: 140 m, 30 deg left",
        "Task 2: fly out from under the bridge first",
        "First: 12 m, 90 deg right, 3 m up",
        "Fly home: climb first",
        "Crash",
        "Crash: bridge member arch/rib-left/07",
        "Crash: fence",
        "Too close: 1.2 m, limit 2.5 m",
        "Too fast: 11 mph, limit 10 mph",
        "Stand-off too small: 3.4 m, recommended 5 m",
        "Stand-off too large: 7.1 m, recommended 5 m",
        "Off path 3.4 m: forward, left and up",
        "Off path 3.4 m: down",
        "Battery 29%",
        "Too close for comfort",
        "Task 2: 140 m, 30 deg left, 12 m up",
        "Task 2: 60 m, behind you",
        "Fly home: 14 m, ahead, 3 m down",
        "Task 1: follow the path",
        "Take off",
        "The session is over",
        "Lesson: 2/11 take off to 2 m",
        "Lesson: 8/11 tilt the camera down 30 deg",
        "Lesson: 3/11 12 m, 30 deg left, 3 m up",
        "Lesson: you flew through the ring: stop in it",
        "Lesson: tilt the camera up, not down",
        "Lesson: you landed 12 m from the pad",
        "Lesson: all steps done",
        "Lesson: too dark: lamp off, 3 lx of 50 lx needed",
        "Session over: 300 points, not certified",
    ];

    #[test]
    fn exact_english_texts_stay_as_they_were_sent() {
        for sent in SENT {
            assert_eq!(message_words(sent, Language::English).as_deref(), Some(sent));
        }
    }

    #[test]
    fn exact_warnings_in_german_and_spanish() {
        let cases = [
            (
                "Crash: bridge member arch/rib-left/07",
                "KOLLISION: Bauteil arch/rib-left/07",
                "COLISIÓN: elemento arch/rib-left/07",
            ),
            ("Crash: truck 3", "KOLLISION: Lkw 3", "COLISIÓN: camión 3"),
            ("Crash: terrain", "KOLLISION: Boden", "COLISIÓN: suelo"),
            ("Too close: 1.2 m, limit 2.5 m", "ZU NAH: 1.2 m, mindestens 2.5 m", "MUY CERCA: 1.2 m, límite 2.5 m"),
            ("Too close", "ZU NAH", "MUY CERCA"),
            (
                "Stand-off too small: 3.4 m, recommended 5 m",
                "ABSTAND zu klein: 3.4 m, empfohlen 5 m",
                "DISTANCIA muy corta: 3.4 m, recomendada 5 m",
            ),
            (
                "Off path 3.4 m: forward, left and up",
                "ABWEICHUNG 3.4 m: vor, links und hoch",
                "DESVÍO 3.4 m: adelante, izquierda y arriba",
            ),
            ("Battery 29%", "AKKU 29%", "BATERÍA 29%"),
        ];
        for (sent, german, spanish) in cases {
            assert_eq!((warning(sent, Language::German).as_str(), warning(sent, Language::Spanish).as_str()), (german, spanish));
        }
    }

    #[test]
    fn exact_known_messages_are_translated_and_others_are_not_recognized() {
        for (sent, german) in [
            ("Task 2: 140 m, 30 deg left, 12 m up", "Aufgabe 2: 140 m, 30° links, 12 m höher"),
            ("Task 2: 60 m, behind you", "Aufgabe 2: 60 m, hinter Ihnen"),
            ("Task 1: hold position", "Aufgabe 1: Position halten"),
            ("Fly home: 14 m, ahead, 3 m down", "Zurückfliegen: 14 m, geradeaus, 3 m tiefer"),
            ("Return to task 2: 140 m, 30 deg left", "Zurück zu Aufgabe 2: 140 m, 30° links"),
            ("Task 2: fly out from under the bridge first", "Aufgabe 2: zuerst unter der Brücke herausfliegen"),
            ("First: 12 m, 90 deg right, 3 m up", "Zuerst: 12 m, 90° rechts, 3 m höher"),
            ("Fly home: climb first", "Zurückfliegen: zuerst steigen"),
            ("Land on the pad", "Auf dem Landeplatz landen"),
            ("Lesson: 2/11 take off to 2 m", "Lektion: 2/11 Auf 2 m Höhe steigen"),
            ("Lesson: 8/11 tilt the camera down 30 deg", "Lektion: 8/11 Kamera 30° nach unten neigen"),
            ("Lesson: all steps done", "Lektion: Alle Schritte erledigt"),
            ("Lesson: too dark: lamp off, 3 lx of 50 lx needed", "Lektion: zu dunkel: Scheinwerfer aus, 3 lx, nötig 50 lx"),
            ("Session over: 300 points, not certified", "Sitzung beendet: 300 Punkte, nicht zertifiziert"),
            ("Session over: 300 points, certified", "Sitzung beendet: 300 Punkte, zertifiziert"),
        ] {
            assert_eq!(message_words(sent, Language::German).as_deref(), Some(german));
        }
        for other in ["Failsafe enabled: no RC", "Task 2: 140 m, sideways", "Crashes: 3", ""] {
            assert_eq!(message_words(other, Language::German), None, "{other}");
        }
    }

    #[test]
    fn prop_any_text_is_accepted() {
        for text in [
            "",
            ":",
            "Crash:",
            "Too close: ",
            "Off path : and",
            "Task : ,",
            "Lesson: ",
            "Lesson: 1/ ",
            "too oblique:  deg, limit ",
            "\0",
        ] {
            for language in Language::ALL {
                let _ = (message_words(text, language), remark_words(text, language), warning(text, language));
            }
        }
    }
}
