//! Phrases that several sentences share.

use super::flight_scan::{FlightScan, Stretches};
use crate::time_text::{clock, duration};
use spandrel_model::scenario::TaskKind;

/// A sentence and the index of the frame that shows it best.
pub(super) type Sentence = (String, usize);

/// Joins words as in a sentence: "a", "a and b", "a, b and c".
pub(super) fn listed(words: &[String]) -> String {
    match words.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        Some((last, _)) => last.clone(),
        None => String::new(),
    }
}

/// Names tasks by number: "task 2", "tasks 1, 2 and 4".
pub(super) fn tasks(ids: &[u32]) -> String {
    let numbers: Vec<String> = ids.iter().map(u32::to_string).collect();
    format!("{} {}", if ids.len() == 1 { "task" } else { "tasks" }, listed(&numbers))
}

/// Returns " in task 2"; empty if the job has only one task.
pub(super) fn in_tasks(scan: &FlightScan<'_>, ids: &[u32]) -> String {
    if scan.evidence.scenario.tasks.len() == 1 { String::new() } else { format!(" in {}", tasks(ids)) }
}

/// Describes how long and when: "for 8 s from 3:12", "for 80 s, longest from 3:12".
pub(super) fn how_long(scan: &FlightScan<'_>, stretches: &Stretches) -> String {
    let (time, from) = (duration(stretches.total_s.max(1.0)), clock(scan.t_s(stretches.longest)));
    if stretches.count == 1 { format!("for {time} from {from}") } else { format!("for {time}, longest from {from}") }
}

/// Returns a number of times as a word: "once", "twice", "3 times".
pub(super) fn times(count: usize) -> String {
    match count {
        1 => "once".to_owned(),
        2 => "twice".to_owned(),
        many => format!("{many} times"),
    }
}

/// Names the surface that the tasks inspect.
pub(super) fn surface(scan: &FlightScan<'_>, tasks: &[usize]) -> &'static str {
    let [task] = tasks else { return "the structure" };
    match scan.evidence.scenario.tasks[*task].kind {
        TaskKind::SlabSide => "the deck",
        TaskKind::ArchBottom => "the arch",
        TaskKind::PierCircle => "the pier",
        TaskKind::Interlayer | TaskKind::Free => "the structure",
    }
}
