//! Freezes and rewinds: aids of practice, with which a flight is neither certified nor compared with others.

use serde::{Deserialize, Serialize};
use spandrel_mavlink::telemetry::signal::Signal;
use spandrel_mavlink::telemetry::{Flight, Frame};
use spandrel_text::{Language, text};

/// Number of freezes and rewinds in a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct PracticeAids {
    /// Number of freezes, without those after a rewind.
    pub freezes: u32,
    /// Number of rewinds and of moves to a task.
    pub rewinds: u32,
}

impl PracticeAids {
    /// Counts the freezes and rewinds in a session.
    #[must_use]
    pub fn measure(flight: &Flight, frames: &[Frame]) -> Self {
        let (Some(first), Some(last)) = (frames.first(), frames.last()) else { return Self::default() };
        let count = |signal: &Signal<i32>| {
            // The vehicle does not send the numbers before the first freeze or rewind.
            let at = |frame: &Frame| signal.at(frame.time).unwrap_or(0);
            // A recording may contain any numbers.
            u32::try_from(at(last).saturating_sub(at(first))).unwrap_or(0)
        };
        Self { freezes: count(&flight.freezes), rewinds: count(&flight.rewinds) }
    }

    /// Returns the number of aids.
    #[must_use]
    pub fn count(self) -> u32 {
        self.freezes.saturating_add(self.rewinds)
    }

    /// Returns the aids as text, such as "rewound twice and frozen once"; `None` if there were none.
    #[must_use]
    pub fn words(self, language: Language) -> Option<String> {
        let rewound = || text!(language, "completion-rewound", rewinds = self.rewinds);
        let frozen = || text!(language, "completion-frozen", freezes = self.freezes);
        match (self.rewinds, self.freezes) {
            (0, 0) => None,
            (_, 0) => Some(rewound()),
            (0, _) => Some(frozen()),
            (_, _) => Some(text!(language, "completion-rewound-and-frozen", rewound = rewound(), frozen = frozen())),
        }
    }

    /// Reads the English text of [`Self::words`]. Counts that it does not name are 0.
    #[must_use]
    pub fn from_words(words: &str) -> Self {
        let count = |what: &str| {
            let times = words.split(" and ").find_map(|part| part.strip_prefix(what))?;
            match times {
                " once" => Some(1),
                " twice" => Some(2),
                many => many.strip_suffix(" times")?.trim().parse().ok(),
            }
        };
        Self { freezes: count("frozen").unwrap_or(0), rewinds: count("rewound").unwrap_or(0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_aids_read_as_text() {
        let words = |freezes, rewinds| PracticeAids { freezes, rewinds }.words(Language::English);
        assert_eq!(words(0, 0), None);
        assert_eq!(words(1, 0).as_deref(), Some("frozen once"));
        assert_eq!(words(3, 2).as_deref(), Some("rewound twice and frozen 3 times"));
        for aids in [(0, 0), (1, 0), (3, 2), (0, 12)].map(|(freezes, rewinds)| PracticeAids { freezes, rewinds }) {
            assert_eq!(PracticeAids::from_words(&aids.words(Language::English).unwrap_or_default()), aids);
        }
        let german = PracticeAids { freezes: 1, rewinds: 4 }.words(Language::German);
        assert_eq!(german.as_deref(), Some("4-mal zurückgespult und einmal eingefroren"));
    }
}
