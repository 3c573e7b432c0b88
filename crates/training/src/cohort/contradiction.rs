//! Contradictions between trainees' answers and measurements.

use serde::{Serialize, Serializer};
use spandrel_text::{Language, text};

/// A contradiction between a trainee's answers and measurements.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Contradiction {
    /// Trainee's pseudonym.
    pub trainee: String,
    /// Statement and measurement that contradict each other.
    #[serde(rename = "words")]
    pub kind: ContradictionKind,
}

/// Answer and measurement that contradict each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ContradictionKind {
    /// A good self-rating, and a score in the bottom quarter.
    RatedTooHigh {
        /// Mean self-rating, 1 to 5; higher is better.
        own: f64,
        /// Overall score, % of the maximum.
        measured_pct: f64,
    },
    /// A low self-rating, and a score in the top quarter.
    RatedTooLow {
        /// Mean self-rating, 1 to 5; higher is better.
        own: f64,
        /// Overall score, % of the maximum.
        measured_pct: f64,
    },
    /// No time pressure, and a flight time in the slowest quarter.
    SlowWithoutPressure {
        /// Flight time, s.
        time_s: f64,
    },
    /// Time pressure, and a flight time in the fastest quarter.
    FastUnderPressure {
        /// Flight time, s.
        time_s: f64,
    },
}

impl ContradictionKind {
    /// Returns the predicate of a sentence whose subject is the trainee, without a period.
    #[must_use]
    pub fn words(self, language: Language) -> String {
        let rating = |own: f64, measured_pct: f64| (format!("{own:.1}"), format!("{measured_pct:.0}"));
        let minutes = |time_s: f64| format!("{:.1}", time_s / 60.0);
        match self {
            Self::RatedTooHigh { own, measured_pct } => {
                let (own, measured) = rating(own, measured_pct);
                text!(language, "cohort-contradiction-rated-too-high", own = own, measured = measured)
            }
            Self::RatedTooLow { own, measured_pct } => {
                let (own, measured) = rating(own, measured_pct);
                text!(language, "cohort-contradiction-rated-too-low", own = own, measured = measured)
            }
            Self::SlowWithoutPressure { time_s } => {
                text!(language, "cohort-contradiction-slow", minutes = minutes(time_s))
            }
            Self::FastUnderPressure { time_s } => {
                text!(language, "cohort-contradiction-fast", minutes = minutes(time_s))
            }
        }
    }
}

/// Files for other programs are in English.
impl Serialize for ContradictionKind {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.words(Language::English))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_contradictions_are_translated_and_files_are_in_english() {
        let kind = ContradictionKind::RatedTooHigh { own: 4.25, measured_pct: 41.6 };
        let english = "rated their own performance 4.2 of 5 but scored 42%, which is in the bottom quarter";
        assert_eq!(serde_json::to_value(kind).unwrap(), english);
        let slow = ContradictionKind::SlowWithoutPressure { time_s: 90.0 };
        assert_eq!(slow.words(Language::English), "felt no time pressure but flew for 1.5 min, which is in the slowest quarter");
        assert_eq!(
            slow.words(Language::German),
            "spürte keinen Zeitdruck, flog aber 1.5 min und gehört damit zum langsamsten Viertel"
        );
        for kind in [
            kind,
            slow,
            ContradictionKind::RatedTooLow { own: 2.0, measured_pct: 90.0 },
            ContradictionKind::FastUnderPressure { time_s: 60.0 },
        ] {
            let [english, german, spanish] = Language::ALL.map(|language| kind.words(language));
            assert!(english != german && english != spanish && german != spanish, "{english}");
        }
    }
}
