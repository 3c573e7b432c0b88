//! Phrases that several sentences share, and the words that select their variants.

use super::flight_scan::{FlightScan, Stretches};
use crate::time_text::{clock, duration};
use spandrel_text::{Language, text};

/// A sentence and the index of the frame that shows it best.
pub(super) type Sentence = (String, usize);

/// Joins words as in a sentence: "a", "a and b", "a, b and c".
pub(super) fn listed(words: &[String], language: Language) -> String {
    match words.split_last() {
        Some((last, rest)) if !rest.is_empty() => {
            text!(language, "advice-and", first = rest.join(", "), last = last.as_str())
        }
        Some((last, _)) => last.clone(),
        None => String::new(),
    }
}

/// The tasks in which a mistake was made, for a sentence.
pub(super) struct Place {
    /// Selects the words: `task` or `tasks`, or `none` if the job has only one task.
    pub kind: &'static str,
    /// Task numbers, such as "1, 2 and 4".
    pub tasks: String,
}

impl Place {
    /// Returns the place that is not named.
    pub(super) fn none() -> Self {
        Self { kind: "none", tasks: String::new() }
    }

    pub(super) fn of(scan: &FlightScan<'_>, ids: &[u32]) -> Self {
        if scan.evidence.scenario.tasks.len() == 1 {
            return Self::none();
        }
        let numbers: Vec<String> = ids.iter().map(u32::to_string).collect();
        Self { kind: if ids.len() == 1 { "task" } else { "tasks" }, tasks: listed(&numbers, scan.language) }
    }
}

/// Describes where, how long and when: "in task 2 for 8 s from 3:12", "for 80 s, longest from 3:12".
pub(super) fn when(scan: &FlightScan<'_>, place: Place, stretches: &Stretches) -> String {
    let (time, from) = (duration(stretches.total_s.max(1.0)), clock(scan.t_s(stretches.longest)));
    let Place { kind, tasks } = place;
    text!(scan.language, "advice-when", place = kind, tasks = tasks, stretches = stretches.count, time = time, from = from)
}

/// Names the surface that the tasks inspect, by the kind of the only task; `structure` for several tasks.
pub(super) fn surface(scan: &FlightScan<'_>, tasks: &[usize]) -> &'static str {
    let [task] = tasks else { return "structure" };
    scan.evidence.scenario.tasks[*task].kind.key()
}
