//! Assignments: jobs that an instructor assigns to a trainee or a class, with a due date. Whether an assignment is done
//! follows from the recorded sessions; it is not stored.

use super::record::{SessionOutcome, SessionRecord};
use serde::Serialize;
use spandrel_text::{Language, text};

/// Trainee or class that an assignment is for.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum AssignmentTarget {
    /// One trainee, by pseudonym.
    Trainee(String),
    /// All members of a class, by its name. The members may change.
    Class(String),
}

/// A job that is assigned to a trainee or a class.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Assignment {
    /// Unique ID, valid in URLs.
    pub id: String,
    /// Trainee or class.
    pub target: AssignmentTarget,
    /// Machine-readable scenario name, such as `drill-gap`.
    pub scenario: String,
    /// Form, or lowest difficulty level, of the scenario; `None` if any counts.
    pub variant: Option<String>,
    /// Time of the assignment, µs since the Unix epoch. Earlier flights do not count.
    pub assigned_unix_us: u64,
    /// Latest start of a flight that is on time, µs since the Unix epoch.
    pub due_unix_us: u64,
    /// Pseudonym of the instructor; empty if they had no login, or were erased.
    pub assigned_by: String,
}

/// State of an assignment for one trainee.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum AssignmentState {
    /// Not done, and the due date has not passed.
    Open,
    /// Not done, and the due date has passed.
    Overdue,
    /// Done.
    Done {
        /// ID of the first session that counts.
        session: String,
        /// Whether that session started after the due date.
        late: bool,
    },
}

/// An assignment and its state for one trainee.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct AssignedJob {
    /// The assignment.
    pub assignment: Assignment,
    /// State for this trainee.
    pub state: AssignmentState,
}

/// Numbers of trainees by the state of one assignment.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct AssignmentCounts {
    /// Trainees for whom it is done, on time or late.
    pub done: usize,
    /// Trainees for whom it is open.
    pub open: usize,
    /// Trainees for whom it is overdue.
    pub overdue: usize,
}

impl AssignmentCounts {
    /// Adds a trainee.
    pub fn add(&mut self, state: &AssignmentState) {
        match state {
            AssignmentState::Open => self.open += 1,
            AssignmentState::Overdue => self.overdue += 1,
            AssignmentState::Done { .. } => self.done += 1,
        }
    }
}

impl AssignmentState {
    /// Returns whether the trainee still has to fly the job.
    #[must_use]
    pub fn is_pending(&self) -> bool {
        match self {
            Self::Open | Self::Overdue => true,
            Self::Done { .. } => false,
        }
    }

    /// Returns the state as text.
    #[must_use]
    pub fn words(&self, language: Language) -> String {
        match self {
            Self::Open => text!(language, "people-state-open"),
            Self::Overdue => text!(language, "people-state-overdue"),
            Self::Done { late: false, .. } => text!(language, "people-state-done"),
            Self::Done { late: true, .. } => text!(language, "people-state-done-late"),
        }
    }
}

impl Assignment {
    /// Returns the scenario, followed by `@` and the form or level, as in arguments of the commands.
    #[must_use]
    pub fn job(&self) -> String {
        self.variant.as_ref().map_or_else(|| self.scenario.clone(), |variant| format!("{}@{variant}", self.scenario))
    }

    /// Returns the command that flies this assignment.
    #[must_use]
    pub fn command(&self, trainee: &str) -> String {
        format!("spandrel train --trainee {trainee} --scenario {}", self.job())
    }

    /// Returns the state for one trainee at `now_unix_us` (µs since the Unix epoch), from the trainee's records in
    /// chronological order.
    #[must_use]
    pub fn state(&self, records: &[SessionRecord], now_unix_us: u64) -> AssignmentState {
        match records.iter().find(|record| self.is_done_by(record)) {
            Some(record) => AssignmentState::Done { session: record.id.clone(), late: record.started_unix_us > self.due_unix_us },
            None if now_unix_us > self.due_unix_us => AssignmentState::Overdue,
            None => AssignmentState::Open,
        }
    }

    /// Returns whether a session fulfills the assignment: the assigned job, flown after the assignment, and complete.
    fn is_done_by(&self, record: &SessionRecord) -> bool {
        record.scenario == self.scenario
            && record.started_unix_us >= self.assigned_unix_us
            && record.is_complete()
            && record.is_unaided()
            && self.variant.as_ref().is_none_or(|variant| is_variant(record, variant))
    }
}

/// Returns whether a session was flown with this form, or at this difficulty level or a harder one.
fn is_variant(record: &SessionRecord, variant: &str) -> bool {
    if let Some(form) = &record.form {
        return form == variant;
    }
    record.level.zip(variant.parse::<u8>().ok()).is_some_and(|(flown, wanted)| flown.level >= wanted)
}

/// Returns one trainee's assignments with their states: pending ones first, then by due date.
#[must_use]
pub fn assigned_jobs(assignments: Vec<Assignment>, records: &[SessionRecord], now_unix_us: u64) -> Vec<AssignedJob> {
    let with_state = |assignment: Assignment| AssignedJob { state: assignment.state(records, now_unix_us), assignment };
    let mut jobs: Vec<AssignedJob> = assignments.into_iter().map(with_state).collect();
    jobs.sort_by_key(|job| (!job.state.is_pending(), job.assignment.due_unix_us));
    jobs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::SessionLevel;
    use crate::testing::{aborted_record, perfect_record};

    fn assignment(variant: Option<&str>) -> Assignment {
        Assignment {
            id: "a1".into(),
            target: AssignmentTarget::Class("spring".into()),
            scenario: "two-bridges".into(),
            variant: variant.map(str::to_owned),
            assigned_unix_us: perfect_record("anna", 2).started_unix_us,
            due_unix_us: perfect_record("anna", 3).started_unix_us,
            assigned_by: "ida".into(),
        }
    }

    fn done(number: usize, late: bool) -> AssignmentState {
        AssignmentState::Done { session: format!("session-anna-{number:03}"), late }
    }

    #[test]
    fn exact_first_complete_flight_after_the_assignment_counts() {
        let one = assignment(None);
        let (before, on_time, late) = (perfect_record("anna", 1), perfect_record("anna", 3), perfect_record("anna", 4));
        let state = |records: &[SessionRecord], now| one.state(records, now);
        assert_eq!(state(&[], one.due_unix_us), AssignmentState::Open);
        assert_eq!(state(&[], one.due_unix_us + 1), AssignmentState::Overdue);
        assert_eq!(state(std::slice::from_ref(&before), one.due_unix_us), AssignmentState::Open, "flown before the assignment");
        assert_eq!(state(&[aborted_record("anna", 3)], one.due_unix_us), AssignmentState::Open, "incomplete");
        let other = SessionRecord { scenario: "drill-gap".into(), ..on_time.clone() };
        assert_eq!(state(&[other], one.due_unix_us), AssignmentState::Open, "another job");
        assert_eq!(state(&[before, on_time, late.clone()], u64::MAX), done(3, false));
        assert_eq!(state(&[late], u64::MAX), done(4, true));
    }

    #[test]
    fn exact_level_counts_from_the_assigned_one_and_form_must_match() {
        let at = |level: u8| SessionRecord {
            level: Some(SessionLevel { level, levels: 9, standard: 5 }),
            ..perfect_record("anna", 3)
        };
        let one = assignment(Some("6"));
        assert_eq!(one.state(&[at(5)], 0), AssignmentState::Open);
        assert_eq!([6, 9].map(|level| one.state(&[at(level)], 0)), [done(3, false), done(3, false)]);
        assert_eq!(one.state(&[perfect_record("anna", 3)], 0), AssignmentState::Open, "flown without levels");
        let with = |form: &str| SessionRecord { form: Some(form.into()), ..perfect_record("anna", 3) };
        let formed = assignment(Some("B"));
        assert_eq!(["A", "B"].map(|form| formed.state(&[with(form)], 0).is_pending()), [true, false]);
        assert_eq!(formed.command("anna"), "spandrel train --trainee anna --scenario two-bridges@B");
    }

    #[test]
    fn exact_pending_assignments_come_first() {
        let finished = Assignment { id: "early".into(), due_unix_us: 1, ..assignment(None) };
        let pending =
            |id: &str, due_unix_us| Assignment { id: id.into(), scenario: "drill-gap".into(), due_unix_us, ..assignment(None) };
        let jobs = assigned_jobs(vec![finished, pending("b", 9), pending("a", 5)], &[perfect_record("anna", 3)], 7);
        let words: Vec<String> = jobs.iter().map(|job| job.state.words(Language::English)).collect();
        let ids = jobs.iter().map(|job| job.assignment.id.as_str());
        let order: Vec<(&str, &str)> = ids.zip(words.iter().map(String::as_str)).collect();
        assert_eq!(order, [("a", "overdue"), ("b", "open"), ("early", "done late")]);
        let mut counts = AssignmentCounts::default();
        jobs.iter().for_each(|job| counts.add(&job.state));
        assert_eq!(counts, AssignmentCounts { done: 1, open: 1, overdue: 1 });
    }
}
