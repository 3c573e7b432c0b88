//! Job completion. Every score is shown with it so that no one mistakes an incomplete flight for a complete one.

use crate::measures::coverage::PathCoverage;
use crate::stored_text::translated;
use serde::{Deserialize, Serialize};
use spandrel_model::numbers::{format_limit, format_with_limit};
use spandrel_text::{Language, text};

/// Task completion state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TaskState {
    /// The required fraction of the task's path was flown.
    Done,
    /// The task's path was entered, but less than the required fraction was flown.
    Part,
    /// The task's path was never entered.
    NotAttempted,
}

impl TaskState {
    /// Returns the state of a task from its coverage and whether its path was entered.
    #[must_use]
    pub fn of(attempted: bool, covered: f64, done_share: f64) -> Self {
        match (attempted, covered >= done_share) {
            (false, _) => Self::NotAttempted,
            (true, true) => Self::Done,
            (true, false) => Self::Part,
        }
    }

    /// Returns the state as text, with the percentage of the path flown.
    #[must_use]
    pub fn description(self, covered: f64, done_share: f64, language: Language) -> String {
        let share = format_percent(covered, done_share);
        match self {
            Self::Done => text!(language, "completion-task-done", share = share),
            Self::Part => text!(language, "completion-task-part", share = share),
            Self::NotAttempted => text!(language, "completion-task-not-attempted"),
        }
    }
}

/// Session completion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Completion {
    /// Whether every task is done and the session ended with a landing at home.
    pub complete: bool,
    /// Number of completed tasks.
    pub tasks_done: usize,
    /// Number of tasks in the job.
    pub tasks: usize,
    /// Fraction of the total path length that was flown, 0 to 1.
    pub path_share: f64,
    /// Whether the session ended with a landing at home.
    pub landed_at_home: bool,
    /// Fraction of a task's path that must be flown for the task to count as done, 0 to 1.
    pub done_share: f64,
}

impl Completion {
    /// Computes session completion from the states and coverage of all tasks.
    #[must_use]
    pub fn of(states: &[TaskState], covered: &[PathCoverage], landed_at_home: bool, done_share: f64) -> Self {
        let tasks_done = states.iter().filter(|state| **state == TaskState::Done).count();
        let length_m: f64 = covered.iter().map(|one| one.length_m).sum();
        let flown_m = covered.iter().fold(0.0, |sum, one| sum + one.length_m * one.share);
        let count = states.len().max(1) as f64;
        // Single-point paths have no length, so if all paths are single points, they are weighted equally.
        let by_count = covered.iter().fold(0.0, |sum, one| sum + one.share) / count;
        Self {
            complete: landed_at_home && tasks_done == states.len(),
            tasks_done,
            tasks: states.len(),
            path_share: if length_m > 0.0 { flown_m / length_m } else { by_count },
            landed_at_home,
            done_share,
        }
    }

    /// Returns the completion as text, such as "Incomplete: 1 of 4 tasks, 31% of the path".
    #[must_use]
    pub fn summary(&self, language: Language) -> String {
        let (done, tasks, share) = (self.tasks_done, self.tasks, self.share_text());
        if self.complete {
            text!(language, "completion-complete", done = done, tasks = tasks, share = share)
        } else {
            text!(language, "completion-incomplete", done = done, tasks = tasks, share = share)
        }
    }

    /// Returns [`Self::summary`]. Mentions a missing landing only if all tasks are done.
    #[must_use]
    pub fn headline(&self, language: Language) -> String {
        if self.landed_at_home || self.tasks_done < self.tasks {
            return self.summary(language);
        }
        text!(language, "completion-not-landed", done = self.tasks_done, tasks = self.tasks, share = self.share_text())
    }

    /// Returns the percentage of the path that was flown.
    fn share_text(&self) -> String {
        // If there is only one task, its share determines whether the job is complete, so the text needs enough digits
        // to show why. Otherwise, a rounded share is enough.
        if self.tasks == 1 { format_percent(self.path_share, self.done_share) } else { format!("{:.0}", 100.0 * self.path_share) }
    }
}

/// Formats a fraction as a percentage, with enough digits to distinguish it from the limit.
#[must_use]
pub fn format_percent(share: f64, done_share: f64) -> String {
    format_with_limit(100.0 * share, 100.0 * done_share, 0)
}

/// Describes why a task is incomplete, in English; `None` if it is done.
#[must_use]
pub fn describe_unfinished_task(id: u32, state: TaskState, covered: f64, done_share: f64) -> Option<String> {
    match state {
        TaskState::Done => None,
        TaskState::Part => Some(text!(
            Language::English,
            "certification-unmet-task-part",
            task = id,
            share = format_percent(covered, done_share),
            needed = format_limit(100.0 * done_share)
        )),
        TaskState::NotAttempted => Some(text!(Language::English, "certification-unmet-task-not-attempted", task = id)),
    }
}

/// Returns the certification verdict as text, including the first unmet requirement if the session is not certified. `unmet` is
/// in English.
#[must_use]
pub fn verdict(certified: bool, unmet: &[String], language: Language) -> String {
    match (certified, unmet) {
        (true, _) => text!(language, "completion-certified"),
        (false, []) => text!(language, "completion-not-certified"),
        (false, [only]) => text!(language, "completion-not-certified-why", unmet = translated(only, language)),
        (false, [first, rest @ ..]) => {
            text!(language, "completion-not-certified-more", unmet = translated(first, language), more = rest.len())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_completion_and_verdict_are_in_the_language_of_the_page() {
        let completion =
            Completion { complete: false, tasks_done: 1, tasks: 1, path_share: 1.0, landed_at_home: false, done_share: 0.8 };
        assert_eq!(completion.headline(Language::English), "Incomplete: 1 of 1 task, 100% of the path, not landed at home");
        assert_eq!(
            completion.headline(Language::German),
            "Unvollständig: 1 von 1 Aufgabe, 100% der Bahn, nicht am Landeplatz gelandet"
        );
        let four = Completion { tasks: 4, path_share: 0.31, ..completion };
        assert_eq!(four.headline(Language::Spanish), "Incompleto: 1 de 4 tareas, 31% de la trayectoria");
        let unmet = ["task 2 not attempted".to_owned(), "not landed at home".to_owned()];
        assert_eq!(verdict(false, &unmet, Language::English), "Not certified: task 2 not attempted (and 1 more)");
        assert_eq!(verdict(false, &unmet, Language::German), "Nicht zertifiziert: Aufgabe 2 nicht begonnen (und 1 weitere)");
        assert_eq!(TaskState::Part.description(0.5, 0.8, Language::German), "teilweise geflogen (50% der Bahn)");
        for shown in [four.summary(Language::Pseudo), verdict(true, &[], Language::Pseudo)] {
            assert!(!shown.contains(['a', 'e', 'i', 'o', 'u']), "{shown}");
        }
    }
}
