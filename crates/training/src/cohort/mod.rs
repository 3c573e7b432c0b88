//! What a group of trainees shows: everything that the paper's tables and figures show of its pilot study. A session is a trainee's n-th
//! on the job; first sessions describe the whole group, repetitions those who flew as often as asked.

mod answers;
mod causal;
pub mod columns;
mod learning;
mod progress;
mod scores;
mod tables;

pub use answers::{Contradiction, Likert, SelfRating, SelfRatingPair};
pub use causal::{IndirectEffect, MediationModel, SENSIBLE_N};
pub use learning::GroupCurve;
pub use progress::{JobProgress, Repetition, ScoreCurve, TraineeProgress, by_job};
pub use scores::{Comparison, CrashRow, CrashTable, Distribution, GroupTest, Individual, RepetitionBox, TaskShare};
pub use tables::{TABLES, table, tables};

use super::record::{IncompletePolicy, SessionRecord};
use serde::Serialize;
use std::collections::BTreeMap;

/// Below so many people the paired tests say little (a medium effect, d = 0.5, needs 34 pairs for a power of 0.8 at 0.05, two-tailed;
/// Cohen 1988).
const SENSIBLE_PAIRS: usize = 34;

/// Which sessions, and how many repetitions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Selection {
    /// Scenarios that count as the job; empty: the one flown most often.
    pub scenarios: Vec<String>,
    /// Repetitions that are compared.
    pub repetitions: usize,
    /// Whether incomplete sessions count.
    pub incomplete: IncompletePolicy,
}

/// Everything.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Cohort {
    /// Scenarios that count as the job.
    pub scenarios: Vec<String>,
    /// Sessions on it.
    pub sessions: usize,
    /// Incomplete sessions on it that were left out.
    pub left_out: usize,
    /// People who flew it.
    pub trainees: usize,
    /// Repetitions that are compared.
    pub repetitions: usize,
    /// Those who flew that often.
    pub group: Vec<String>,
    /// First sessions: each score's distribution.
    pub distributions: Vec<Distribution>,
    /// First sessions: each person's scores and tasks.
    pub individuals: Vec<Individual>,
    /// First sessions: crashes by person, task and kind.
    pub crashes: CrashTable,
    /// The group: each score by repetition.
    pub boxes: Vec<RepetitionBox>,
    /// The group: paired comparisons of the repetitions.
    pub tests: Vec<Comparison>,
    /// Whether the group scores as the others do.
    pub homogeneity: Vec<GroupTest>,
    /// Answers counted: of all first sessions, and of the group by repetition.
    pub likert: Vec<Likert>,
    /// What people think of their flight against what was measured.
    pub self_rating: SelfRating,
    /// Demand, state, performance, with feedback as moderator; absent when it cannot be estimated.
    pub causal: Option<MediationModel>,
    /// Each person over the repetitions.
    pub progress: Vec<TraineeProgress>,
    /// Learning curves of those who flew often enough for one, together; empty when nobody did.
    pub learning: Vec<GroupCurve>,
    /// What to keep in mind.
    pub warnings: Vec<String>,
}

/// A score by name.
pub(super) type ScorePicker = fn(&SessionRecord) -> Option<f64>;

/// The five scores.
pub(super) const SCORES: [(&str, ScorePicker); 5] = [
    ("conformity", |record| record.scores.conformity),
    ("efficiency", |record| Some(record.scores.efficiency)),
    ("safety", |record| Some(record.scores.safety)),
    ("accuracy", |record| record.scores.accuracy),
    OVERALL,
];
const OVERALL: (&str, ScorePicker) = ("overall", |record| Some(record.scores.overall));

/// Sessions of each trainee on the job, in their order.
pub(super) type SessionsByTrainee<'a> = BTreeMap<&'a str, Vec<&'a SessionRecord>>;

/// Works everything out.
#[must_use]
pub fn cohort(records: &[SessionRecord], selection: &Selection) -> Cohort {
    let scenarios = scenarios(records, selection);
    let on_job = records.iter().filter(|record| scenarios.contains(&record.scenario));
    let (counted, left_out): (Vec<&SessionRecord>, Vec<&SessionRecord>) =
        on_job.partition(|record| selection.incomplete.counts(record));
    let mut runs = SessionsByTrainee::new();
    for record in counted {
        runs.entry(&record.trainee).or_default().push(record);
    }
    for sessions in runs.values_mut() {
        sessions.sort_by(|a, b| (a.started_unix_us, &a.id).cmp(&(b.started_unix_us, &b.id)));
    }
    let firsts: Vec<&SessionRecord> = runs.values().filter_map(|sessions| sessions.first().copied()).collect();
    let repetitions = selection.repetitions.max(1);
    let group: SessionsByTrainee<'_> =
        runs.iter().filter(|(_, sessions)| sessions.len() >= repetitions).map(|(k, v)| (*k, v.clone())).collect();
    let mut warnings = Vec::new();
    let causal = causal::causal(&firsts, &mut warnings);
    if repetitions > 1 && group.len() < SENSIBLE_PAIRS {
        warnings.push(format!(
            "{} people flew {repetitions} times: below {SENSIBLE_PAIRS} a paired test misses most medium effects",
            group.len()
        ));
    }
    let progress: Vec<TraineeProgress> = runs.iter().map(|(trainee, sessions)| progress::progress(trainee, sessions)).collect();
    let homogeneity = scores::homogeneity_of(&firsts, &group, &mut warnings);
    Cohort {
        sessions: runs.values().map(Vec::len).sum(),
        left_out: left_out.len(),
        trainees: runs.len(),
        repetitions,
        group: group.keys().map(|trainee| (*trainee).to_owned()).collect(),
        distributions: scores::distributions(&firsts),
        individuals: firsts.iter().map(|record| scores::individual(record)).collect(),
        crashes: scores::crash_table(&firsts),
        boxes: scores::boxes(&group, repetitions),
        tests: scores::comparisons(&group, repetitions, &mut warnings),
        homogeneity,
        likert: answers::likert(&firsts, &group, repetitions),
        self_rating: answers::self_rating(&firsts),
        causal,
        learning: learning::learning(&progress),
        progress,
        warnings,
        scenarios,
    }
}

/// The scenarios asked for, else the one flown most often (of several the first by name), by the sessions that count if there are any.
fn scenarios(records: &[SessionRecord], selection: &Selection) -> Vec<String> {
    if !selection.scenarios.is_empty() {
        return selection.scenarios.clone();
    }
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let all = !records.iter().any(|record| selection.incomplete.counts(record));
    for record in records.iter().filter(|record| all || selection.incomplete.counts(record)) {
        *counts.entry(&record.scenario).or_default() += 1;
    }
    let most = counts.values().copied().max();
    counts.into_iter().find(|(_, count)| Some(*count) == most).map(|(name, _)| name.to_owned()).into_iter().collect()
}

#[cfg(test)]
mod tests;
