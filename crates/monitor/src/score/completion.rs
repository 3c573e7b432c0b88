//! Job completion. Every score is shown with it so that no one mistakes an incomplete flight for a complete one.

use crate::measures::coverage::PathCoverage;
use serde::{Deserialize, Serialize};
use spandrel_model::numbers::{format_limit, format_with_limit};

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
    pub fn description(self, covered: f64, done_share: f64) -> String {
        match self {
            Self::Done => format!("done ({}% of path)", format_percent(covered, done_share)),
            Self::Part => format!("partly flown ({}% of path)", format_percent(covered, done_share)),
            Self::NotAttempted => "not attempted".to_owned(),
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
    pub fn summary(&self) -> String {
        let word = if self.complete { "Complete" } else { "Incomplete" };
        // If there is only one task, its share determines whether the job is complete, so the text needs enough digits
        // to show why. Otherwise, a rounded share is enough.
        let share = if self.tasks == 1 {
            format_percent(self.path_share, self.done_share)
        } else {
            format!("{:.0}", 100.0 * self.path_share)
        };
        let tasks = if self.tasks == 1 { "task" } else { "tasks" };
        format!("{word}: {} of {} {tasks}, {share}% of the path", self.tasks_done, self.tasks)
    }

    /// Returns [`Self::summary`]. Mentions a missing landing only if all tasks are done.
    #[must_use]
    pub fn headline(&self) -> String {
        let only_landing = !self.landed_at_home && self.tasks_done == self.tasks;
        self.summary() + if only_landing { ", not landed at home" } else { "" }
    }
}

/// Formats a fraction as a percentage, with enough digits to distinguish it from the limit.
#[must_use]
pub fn format_percent(share: f64, done_share: f64) -> String {
    format_with_limit(100.0 * share, 100.0 * done_share, 0)
}

/// Describes why a task is incomplete; `None` if it is done.
#[must_use]
pub fn describe_unfinished_task(id: u32, state: TaskState, covered: f64, done_share: f64) -> Option<String> {
    match state {
        TaskState::Done => None,
        TaskState::Part => Some(format!(
            "task {id} not done: {}% of its path, {}% needed",
            format_percent(covered, done_share),
            format_limit(100.0 * done_share)
        )),
        TaskState::NotAttempted => Some(format!("task {id} not attempted")),
    }
}

/// Returns the certification verdict as text, including the first unmet requirement if the session is not certified.
#[must_use]
pub fn verdict(certified: bool, unmet: &[String]) -> String {
    match (certified, unmet) {
        (true, _) => "Certified".to_owned(),
        (false, []) => "Not certified".to_owned(),
        (false, [only]) => format!("Not certified: {only}"),
        (false, [first, rest @ ..]) => format!("Not certified: {first} (and {} more)", rest.len()),
    }
}
