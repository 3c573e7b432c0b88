//! The monitor's texts in the language of the window. On the wire, they are in English; unknown texts stay as they are.

use super::lesson_words::instruction;
use super::style::DisplayUnits;
use spandrel_mavlink::contract::cue;
use spandrel_mavlink::contract::guidance::{DETOUR_PREFIX, DetourKind};
use spandrel_mavlink::contract::lesson::{self, LessonStatus, LessonTask};
use spandrel_text::{Language, text};

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
        let (bits, detail) = cue::of_text(text)?;
        let name = shown(cue_name(bits, language)?);
        let words = warning_words(bits, detail, &name, language).unwrap_or_else(|| format!("{name}{detail}"));
        Some(Self { name, words })
    }
}

fn cue_name(bits: i32, language: Language) -> Option<String> {
    const BATTERY: i32 = cue::BATTERY_YELLOW | cue::BATTERY_RED;
    Some(match bits {
        cue::CRASH => text!(language, "flight-cue-crash"),
        cue::TOO_CLOSE => text!(language, "flight-cue-too-close"),
        cue::SPEEDING => text!(language, "flight-cue-speeding"),
        cue::STAND_OFF => text!(language, "flight-cue-stand-off"),
        cue::OFF_PATH => text!(language, "flight-cue-off-path"),
        BATTERY => text!(language, "flight-cue-battery"),
        _ => return None,
    })
}

/// Returns a cue's text from its name and the rest of the monitor's text; `None` if the rest has an unknown form.
fn warning_words(bits: i32, detail: &str, name: &str, language: Language) -> Option<String> {
    Some(match bits {
        cue::CRASH => {
            let [object] = parts(detail, [": "])?;
            text!(language, "flight-warning-crash", name = name, object = object_words(object, language))
        }
        cue::TOO_CLOSE => {
            let [distance, limit] = parts(detail, [": ", ", limit "])?;
            text!(language, "flight-warning-too-close", name = name, distance = distance, limit = limit)
        }
        cue::SPEEDING => {
            let [speed, limit] = parts(detail, [": ", ", limit "])?;
            text!(language, "flight-warning-speeding", name = name, speed = speed, limit = limit)
        }
        cue::STAND_OFF => stand_off_words(detail, name, language)?,
        cue::OFF_PATH => {
            let [distance, direction] = parts(detail, [" ", ": "])?;
            let direction = direction_words(direction, language)?;
            text!(language, "flight-warning-off-path", name = name, distance = distance, direction = direction)
        }
        _ => {
            let [level] = parts(detail, [" "])?;
            text!(language, "flight-warning-battery", name = name, level = level)
        }
    })
}

fn stand_off_words(detail: &str, name: &str, language: Language) -> Option<String> {
    if let Some([distance, recommended]) = parts(detail, [" too small: ", ", recommended "]) {
        return Some(text!(
            language,
            "flight-warning-stand-off-small",
            name = name,
            distance = distance,
            recommended = recommended
        ));
    }
    let [distance, recommended] = parts(detail, [" too large: ", ", recommended "])?;
    Some(text!(language, "flight-warning-stand-off-large", name = name, distance = distance, recommended = recommended))
}

/// Returns the values in a text, each after its literal; the last one extends to the end.
fn parts<'a, const N: usize>(text: &'a str, before: [&str; N]) -> Option<[&'a str; N]> {
    let mut rest = text.strip_prefix(before.first()?)?;
    let mut values = [""; N];
    for (k, value) in values.iter_mut().enumerate() {
        (*value, rest) = match before.get(k + 1) {
            Some(next) => rest.split_once(next)?,
            None => (rest, ""),
        };
    }
    Some(values)
}

/// Returns the name of what the drone hit. Names from the scenario stay.
fn object_words(object: &str, language: Language) -> String {
    match object {
        "bridge" => return text!(language, "flight-object-bridge"),
        "pad" => return text!(language, "flight-object-pad"),
        "ground" => return text!(language, "flight-object-ground"),
        "terrain" => return text!(language, "flight-object-terrain"),
        "water" => return text!(language, "flight-object-water"),
        "vehicle" => return text!(language, "flight-object-vehicle"),
        "person" => return text!(language, "flight-object-person"),
        "inspector" => return text!(language, "flight-object-inspector"),
        "crew truck" => return text!(language, "flight-object-crew-truck"),
        "other" => return text!(language, "flight-object-other"),
        _ => {}
    }
    match object.rsplit_once(' ') {
        Some(("bridge member", name)) => text!(language, "flight-object-member", name = name),
        Some(("car", number)) => text!(language, "flight-object-car", number = number),
        Some(("truck", number)) => text!(language, "flight-object-truck", number = number),
        Some(("pedestrian", number)) => text!(language, "flight-object-pedestrian", number = number),
        _ => object.to_owned(),
    }
}

/// Returns a direction such as "forward, right and down".
fn direction_words(words: &str, language: Language) -> Option<String> {
    let named = words.split([',', ' ']).filter(|word| !word.is_empty() && *word != "and");
    let named: Vec<String> = named.map(|word| one_direction(word, language)).collect::<Option<_>>()?;
    match named.as_slice() {
        [] => Some(String::new()),
        [only] => Some(only.clone()),
        [first, second] => Some(text!(language, "flight-directions-two", first = first.as_str(), second = second.as_str())),
        [first, second, third] => Some(text!(
            language,
            "flight-directions-three",
            first = first.as_str(),
            second = second.as_str(),
            third = third.as_str()
        )),
        _ => None,
    }
}

fn one_direction(word: &str, language: Language) -> Option<String> {
    Some(match word {
        "forward" => text!(language, "flight-direction-forward"),
        "back" => text!(language, "flight-direction-back"),
        "right" => text!(language, "flight-direction-right"),
        "left" => text!(language, "flight-direction-left"),
        "up" => text!(language, "flight-direction-up"),
        "down" => text!(language, "flight-direction-down"),
        _ => return None,
    })
}

/// Returns a remark about a lesson.
#[must_use]
pub fn remark_words(remark: &str, language: Language) -> String {
    known_remark(remark, language).unwrap_or_else(|| remark.to_owned())
}

fn known_remark(remark: &str, language: Language) -> Option<String> {
    match remark {
        "the motors are off: arm them again" => return Some(text!(language, "flight-remark-motors-off")),
        "no defect in the picture" => return Some(text!(language, "flight-remark-no-defect")),
        "not in the central 80% of the image" => return Some(text!(language, "flight-remark-not-central")),
        "hidden behind something" => return Some(text!(language, "flight-remark-hidden")),
        _ => {}
    }
    if let Some([time]) = parts(remark, ["you left the ring: stay "]) {
        return Some(text!(language, "flight-remark-left-ring", time = time));
    }
    if let Some([angle, limit]) = parts(remark, ["too oblique: ", " deg, limit "]) {
        return Some(text!(language, "flight-remark-oblique", angle = angle, limit = limit.strip_suffix(" deg")?));
    }
    if let Some([size, limit]) = parts(remark, ["too small: ", " px, at least "]) {
        return Some(text!(language, "flight-remark-small", size = size, limit = limit.strip_suffix(" px")?));
    }
    if let Some([width, limit]) = parts(remark, ["line too thin: ", " px, at least "]) {
        return Some(text!(language, "flight-remark-thin", width = width, limit = limit.strip_suffix(" px")?));
    }
    if let Some([light, limit]) = parts(remark, ["too dark: lamp on, ", " lx of "]) {
        return Some(text!(language, "flight-remark-dark-lamp-on", light = light, limit = limit.strip_suffix(" lx needed")?));
    }
    let [light, limit] = parts(remark, ["too dark: lamp off, ", " lx of "])?;
    Some(text!(language, "flight-remark-dark-lamp-off", light = light, limit = limit.strip_suffix(" lx needed")?))
}

/// Returns a text message from the vehicle or the monitor. English texts stay as they were sent.
#[must_use]
pub fn message_words(message: &str, language: Language) -> String {
    if language == Language::English {
        return message.to_owned();
    }
    let warning = || Warning::of_text(message, language, |name| name).map(|warning| warning.words);
    let words = warning().or_else(|| lesson_message(message, language)).or_else(|| guidance_message(message, language));
    words.or_else(|| result_message(message, language)).unwrap_or_else(|| message.to_owned())
}

fn lesson_message(message: &str, language: Language) -> Option<String> {
    let rest = message.strip_prefix(lesson::TEXT_PREFIX)?;
    let numbered = || {
        let (number, words) = rest.split_once(' ')?;
        let (step, steps) = number.split_once('/')?;
        let words = instruction(&instruction_status(words)?, DisplayUnits::Metric, language);
        Some(text!(language, "flight-message-lesson-step", step = step, steps = steps, words = words))
    };
    let plain = || {
        let done = instruction_status(rest).map(|status| instruction(&status, DisplayUnits::Metric, language));
        let words = done.unwrap_or_else(|| remark_words(rest, language));
        text!(language, "flight-message-lesson", words = words)
    };
    Some(numbered().unwrap_or_else(plain))
}

/// Returns the step that has this instruction.
fn instruction_status(words: &str) -> Option<LessonStatus> {
    let number = words.split(' ').find_map(|word| word.parse::<f64>().ok()).unwrap_or_default();
    let targets = [number, number.to_radians(), -number.to_radians()];
    let status = |task: LessonTask, target: f64| LessonStatus {
        task,
        step: 0,
        steps: 0,
        progress: 0.0,
        way: None,
        radius_m: None,
        target: Some(target),
    };
    let mut known = LessonTask::ALL.into_iter().flat_map(|task| targets.map(|target| status(task, target)));
    known.find(|status| status.instruction() == words)
}

fn guidance_message(message: &str, language: Language) -> Option<String> {
    match message {
        "Take off" => return Some(text!(language, "flight-step-take-off")),
        "Fly home" => return Some(text!(language, "flight-step-fly-home")),
        "Land on the pad" => return Some(text!(language, "flight-step-land")),
        "The session is over" => return Some(text!(language, "flight-message-session-over")),
        _ => {}
    }
    let way_or_first = |words: &str| sent_detour(words, language).or_else(|| sent_way(words, language));
    if let Some([words]) = parts(message, ["Fly home: "]) {
        return Some(text!(language, "flight-message-fly-home", words = way_or_first(words)?));
    }
    if let Some([way]) = parts(message, [DETOUR_PREFIX]) {
        return Some(text!(language, "flight-message-first", words = sent_way(way, language)?));
    }
    if let Some([task, way]) = parts(message, ["Return to task ", ": "]) {
        return Some(text!(language, "flight-message-return", task = task, words = sent_way(way, language)?));
    }
    let [task, words] = parts(message, ["Task ", ": "])?;
    Some(match words {
        "fly to the path" => text!(language, "flight-message-fly-to-path", task = task),
        "follow the path" => text!(language, "flight-message-follow-path", task = task),
        "hold position" => text!(language, "flight-message-hold", task = task),
        way => text!(language, "flight-message-task", task = task, words = way_or_first(way)?),
    })
}

/// Returns what leads around an obstacle.
fn sent_detour(words: &str, language: Language) -> Option<String> {
    let kind = DetourKind::ALL.into_iter().find(|kind| kind.words() == words)?;
    Some(match kind {
        DetourKind::OutFromUnder => text!(language, "flight-message-out-from-under"),
        DetourKind::Climb => text!(language, "flight-message-climb"),
        DetourKind::Descend => text!(language, "flight-message-descend"),
        DetourKind::Around => text!(language, "flight-message-around"),
    })
}

/// Returns a way such as "140 m, 30 deg left, 12 m up".
fn sent_way(words: &str, language: Language) -> Option<String> {
    let mut sent = words.split(", ");
    let (distance, turn) = (sent.next()?, sent.next()?);
    let angle = |side: &str| turn.strip_suffix(side).map(|angle| format!("{angle}°"));
    let way = match (turn, angle(" deg left"), angle(" deg right")) {
        ("ahead", ..) => text!(language, "flight-way-ahead", distance = distance),
        ("behind you", ..) => text!(language, "flight-way-behind", distance = distance),
        (_, Some(angle), _) => text!(language, "flight-way-left", distance = distance, angle = angle),
        (_, None, Some(angle)) => text!(language, "flight-way-right", distance = distance, angle = angle),
        (_, None, None) => return None,
    };
    let Some(height) = sent.next() else { return Some(way) };
    if let Some(height) = height.strip_suffix(" up") {
        return Some(text!(language, "flight-message-way-up", way = way, height = height));
    }
    height.strip_suffix(" down").map(|height| text!(language, "flight-message-way-down", way = way, height = height))
}

fn result_message(message: &str, language: Language) -> Option<String> {
    if message == "Session over: nothing to score" {
        return Some(text!(language, "flight-message-nothing-to-score"));
    }
    let [points, verdict] = parts(message, ["Session over: ", " points, "])?;
    match verdict {
        "certified" => Some(text!(language, "flight-message-certified", points = points)),
        "not certified" => Some(text!(language, "flight-message-not-certified", points = points)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn warning(text: &str, language: Language) -> String {
        Warning::of_text(text, language, |name| name.to_uppercase()).map(|warning| warning.words).unwrap_or_default()
    }

    #[test]
    fn exact_english_warnings_stay_as_they_were_sent() {
        for sent in [
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
        ] {
            let words = Warning::of_text(sent, Language::English, |name| name).map(|warning| warning.words);
            assert_eq!(words.as_deref(), Some(sent));
            assert_eq!(message_words(sent, Language::English), sent);
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
    fn exact_known_messages_are_translated_and_unknown_ones_stay() {
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
            ("Failsafe enabled: no RC", "Failsafe enabled: no RC"),
            ("Task 2: 140 m, sideways", "Task 2: 140 m, sideways"),
        ] {
            assert_eq!(message_words(sent, Language::German), german);
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
        ] {
            for language in Language::ALL {
                let _ = (message_words(text, language), remark_words(text, language), warning(text, language));
            }
        }
    }
}
