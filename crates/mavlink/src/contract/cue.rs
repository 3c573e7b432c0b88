//! Bit flags in the monitor's `cues` value, one for each active cue.

use spandrel_model::numbers::format_beyond_limit;
use std::ops::Range;

/// The battery level is in the yellow range.
pub const BATTERY_YELLOW: i32 = 1;
/// The battery level is in the red range.
pub const BATTERY_RED: i32 = 1 << 1;
/// The speed is above the limit.
pub const SPEEDING: i32 = 1 << 2;
/// The drone is off the path, but still close enough to be in the task.
pub const OFF_PATH: i32 = 1 << 3;
/// The clearance is below the task's limit.
pub const TOO_CLOSE: i32 = 1 << 4;
/// The aircraft is, or recently was, in contact with an object.
pub const CRASH: i32 = 1 << 5;
/// The distance from the inspected surface differs too much from the recommended stand-off. If the stand-off alone takes
/// the drone off the path, [`OFF_PATH`] is also set, and displays show only this cue.
pub const STAND_OFF: i32 = 1 << 6;

/// All cues with their names, most serious first.
pub const ALL: [(i32, &str); 7] = [
    (CRASH, "crash"),
    (TOO_CLOSE, "too close"),
    (SPEEDING, "speeding"),
    (STAND_OFF, "stand-off"),
    (OFF_PATH, "off path"),
    (BATTERY_RED, "battery red"),
    (BATTERY_YELLOW, "battery yellow"),
];

/// Words at the start of each cue's text. The monitor's texts, the head-up display and the spoken warnings all use them.
const LABELS: [(i32, &str); 6] = [
    (CRASH, "Crash"),
    (TOO_CLOSE, "Too close"),
    (SPEEDING, "Too fast"),
    (STAND_OFF, "Stand-off"),
    (OFF_PATH, "Off path"),
    (BATTERY_YELLOW | BATTERY_RED, "Battery"),
];

/// Returns the words at the start of a cue's text; `None` if the bit is not a cue.
#[must_use]
pub fn label(bit: i32) -> Option<&'static str> {
    LABELS.iter().find(|(bits, _)| bit & bits != 0).map(|(_, label)| *label)
}

/// Returns the bits of the cue that a text from the monitor belongs to, and the text after the label; `None` if the text
/// belongs to no cue. Both battery cues have the same label.
#[must_use]
pub fn of_text(text: &str) -> Option<(i32, &str)> {
    let detail = |(bits, label): &(i32, &str)| {
        let rest = text.strip_prefix(label)?;
        (rest.is_empty() || rest.starts_with([':', ' '])).then_some((*bits, rest))
    };
    LABELS.iter().find_map(detail)
}

/// Returns the cues to display: a display shows the stand-off cue instead of the off-path cue, because correcting the
/// stand-off also corrects the distance from the path.
#[must_use]
pub fn displayed(mask: i32) -> i32 {
    if mask & STAND_OFF != 0 { mask & !OFF_PATH } else { mask }
}

/// The latest text of each active cue.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct CueTexts {
    /// Bits of the cue, and its text.
    texts: Vec<(i32, String)>,
}

impl CueTexts {
    /// Adds a text from the monitor. Texts that belong to no cue are ignored.
    pub fn add(&mut self, text: &str) {
        if let Some((bits, _)) = of_text(text) {
            self.texts.retain(|(other, _)| *other != bits);
            self.texts.push((bits, text.to_owned()));
        }
    }

    /// Replaces the distance in a cue's text by the present one, unless that is on the other side of the limit, which is the text's second
    /// number.
    pub fn set_distance(&mut self, bit: i32, distance_m: f64) {
        let Some((_, text)) = self.texts.iter_mut().find(|(bits, _)| bit & bits != 0) else { return };
        let found = numbers(text);
        let [(place, shown_m), (_, limit_m)] = &found[..] else { return };
        if (distance_m < *limit_m) == (shown_m < limit_m) {
            text.replace_range(place.clone(), &format_beyond_limit(distance_m, *limit_m, 1));
        }
    }

    /// Removes the texts of cues that are no longer active.
    pub fn retain_active(&mut self, mask: i32) {
        self.texts.retain(|(bits, _)| mask & bits != 0);
    }

    /// Returns a cue's text: the latest one that was sent while the cue has been active, otherwise only its label. `None`
    /// if the bit is not a cue.
    #[must_use]
    pub fn text(&self, bit: i32) -> Option<&str> {
        let sent = self.texts.iter().find(|(bits, _)| bit & bits != 0).map(|(_, text)| text.as_str());
        sent.or_else(|| label(bit))
    }
}

/// Returns the numbers in a text and their places.
fn numbers(text: &str) -> Vec<(Range<usize>, f64)> {
    let (mut found, mut end) = (Vec::new(), 0);
    while let Some(start) = text[end..].find(|sign: char| sign.is_ascii_digit()).map(|at| end + at) {
        end = text[start..].find(|sign: char| !sign.is_ascii_digit() && sign != '.').map_or(text.len(), |at| start + at);
        found.extend(text[start..end].parse().ok().map(|number| (start..end, number)));
    }
    found
}

impl<'a> FromIterator<&'a str> for CueTexts {
    fn from_iter<T: IntoIterator<Item = &'a str>>(texts: T) -> Self {
        let mut all = Self::default();
        texts.into_iter().for_each(|text| all.add(text));
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_texts_belong_to_their_cue() {
        assert_eq!(of_text("Off path 3.4 m: left and up"), Some((OFF_PATH, " 3.4 m: left and up")));
        assert_eq!(of_text("Crash: fence"), Some((CRASH, ": fence")));
        assert_eq!(of_text("Too close"), Some((TOO_CLOSE, "")));
        assert_eq!(of_text("Battery 29%"), Some((BATTERY_YELLOW | BATTERY_RED, " 29%")));
        assert_eq!(of_text("Crashes: 3"), None);
        assert_eq!(of_text("Session over: 300 points, certified"), None);
        assert!(ALL.iter().all(|(bit, _)| label(*bit).is_some()));
        assert_eq!((label(OFF_PATH), label(BATTERY_RED), label(1 << 20)), (Some("Off path"), Some("Battery"), None));
    }

    #[test]
    fn exact_a_cue_keeps_its_latest_text_while_it_is_active() {
        let mut texts: CueTexts =
            ["Too close: 2.4 m, limit 2.5 m", "Session over", "Too close: 2.1 m, limit 2.5 m"].into_iter().collect();
        assert_eq!((texts.text(TOO_CLOSE), texts.text(CRASH)), (Some("Too close: 2.1 m, limit 2.5 m"), Some("Crash")));
        texts.retain_active(TOO_CLOSE | CRASH);
        assert_eq!(texts.text(TOO_CLOSE), Some("Too close: 2.1 m, limit 2.5 m"));
        texts.retain_active(CRASH);
        assert_eq!((texts.text(TOO_CLOSE), texts.text(1 << 20)), (Some("Too close"), None));
    }

    #[test]
    fn exact_texts_show_the_present_distance_on_their_side_of_the_limit() {
        let texts = || -> CueTexts {
            let sent = [
                "Too close: 2.1 m, limit 2.5 m",
                "Stand-off too large: 8.9 m, recommended 4.5 m",
                "Off path 3.1 m: left",
                "Crash: bridge",
            ];
            sent.into_iter().collect()
        };
        let shown = |bit: i32, distance_m: f64| {
            let mut texts = texts();
            texts.set_distance(bit, distance_m);
            texts.text(bit).unwrap_or_default().to_owned()
        };
        assert_eq!(shown(TOO_CLOSE, 1.62), "Too close: 1.6 m, limit 2.5 m");
        assert_eq!(shown(TOO_CLOSE, 2.47), "Too close: 2.47 m, limit 2.5 m");
        assert_eq!(shown(TOO_CLOSE, 2.7), "Too close: 2.1 m, limit 2.5 m", "the cue is about to end");
        assert_eq!(shown(STAND_OFF, 10.2), "Stand-off too large: 10.2 m, recommended 4.5 m");
        assert_eq!(shown(STAND_OFF, 3.9), "Stand-off too large: 8.9 m, recommended 4.5 m");
        // The way back in the text belongs to the distance.
        assert_eq!(shown(OFF_PATH, 4.0), "Off path 3.1 m: left");
        assert_eq!((shown(CRASH, 4.0), shown(SPEEDING, 4.0)), ("Crash: bridge".into(), "Too fast".into()));
    }

    #[test]
    fn exact_stand_off_is_displayed_instead_of_off_path() {
        assert_eq!(displayed(STAND_OFF | OFF_PATH | CRASH), STAND_OFF | CRASH);
        assert_eq!(displayed(OFF_PATH | SPEEDING), OFF_PATH | SPEEDING);
    }
}
