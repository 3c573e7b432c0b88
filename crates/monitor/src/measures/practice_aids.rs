//! Freezes and rewinds: aids of practice, with which a flight is neither certified nor compared with others.

use serde::{Deserialize, Serialize};
use spandrel_mavlink::telemetry::signal::Signal;
use spandrel_mavlink::telemetry::{Flight, Frame};

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
    pub fn words(self) -> Option<String> {
        let times = |what: &str, count: u32| match count {
            0 => None,
            1 => Some(format!("{what} once")),
            2 => Some(format!("{what} twice")),
            n => Some(format!("{what} {n} times")),
        };
        let parts: Vec<String> = [times("rewound", self.rewinds), times("frozen", self.freezes)].into_iter().flatten().collect();
        (!parts.is_empty()).then(|| parts.join(" and "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_aids_read_as_text() {
        let words = |freezes, rewinds| PracticeAids { freezes, rewinds }.words();
        assert_eq!(words(0, 0), None);
        assert_eq!(words(1, 0).as_deref(), Some("frozen once"));
        assert_eq!(words(3, 2).as_deref(), Some("rewound twice and frozen 3 times"));
    }
}
