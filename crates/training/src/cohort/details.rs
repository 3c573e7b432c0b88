//! Reliability of the details that two sessions are compared by: each task's measures, and the crashes by object.

use super::reliability::{MeasureReliability, of_values};
use super::samples::SessionsByTrainee;
use crate::record::{Crashes, SessionRecord, TaskRecord};
use std::collections::BTreeSet;

/// A measure of one task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TaskDetail {
    /// Fraction of the time on the path, %.
    OnPath,
    /// Time above the speed limit, s.
    Speeding,
    /// Number of crashes.
    Crashes,
}

impl TaskDetail {
    const ALL: [Self; 3] = [Self::OnPath, Self::Speeding, Self::Crashes];

    /// Returns the name of the measure for a task.
    #[must_use]
    pub fn key(self, task: &str) -> String {
        let measure = match self {
            Self::OnPath => "on_path",
            Self::Speeding => "speeding",
            Self::Crashes => "task_crashes",
        };
        format!("{measure}: {task}")
    }

    fn unit(self) -> &'static str {
        match self {
            Self::OnPath => "%",
            Self::Speeding => "s",
            Self::Crashes => "",
        }
    }

    fn value(self, task: &TaskRecord) -> f64 {
        match self {
            Self::OnPath => 100.0 * task.on_path,
            Self::Speeding => task.speeding_s,
            Self::Crashes => task.crashes.total() as f64,
        }
    }
}

/// Returns the name of the number of crashes into an object.
#[must_use]
pub fn crash_key(object: &str) -> String {
    format!("crashes: {object}")
}

/// Computes the reliability of each task's measures and of the crashes by object from the first `repetitions` sessions of each
/// trainee in the group. Only the cohort's own measures are in its tables, so these cause no limitations.
pub fn details(group: &SessionsByTrainee<'_>, repetitions: usize) -> Vec<MeasureReliability> {
    let counted = || group.values().flat_map(|sessions| sessions.iter().take(repetitions).copied());
    let tasks: BTreeSet<&str> = counted().flat_map(|record| record.tasks.iter().map(|task| task.name.as_str())).collect();
    let mut found = Vec::new();
    let mut add = |measure: String, unit: &'static str, pick: &dyn Fn(&SessionRecord) -> Option<f64>| {
        let sessions = counted().filter(|record| pick(record).is_some()).count();
        let reliability = of_values(group, repetitions, pick).ok();
        found.push(MeasureReliability { measure, unit, sessions, at_ceiling: None, reliability });
    };
    for name in tasks {
        for detail in TaskDetail::ALL {
            add(detail.key(name), detail.unit(), &|record| {
                record.tasks.iter().find(|task| task.name == name).map(|task| detail.value(task))
            });
        }
    }
    for (k, (object, _)) in Crashes::default().by_kind().into_iter().enumerate() {
        add(crash_key(object), "", &|record| Some(record.crashes().by_kind()[k].1 as f64));
    }
    found
}
