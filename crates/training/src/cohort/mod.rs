//! Cohort analysis: reproduces the tables and figures of the paper's pilot study. Sessions are numbered per trainee on the job.
//! First sessions describe the whole cohort; repetitions describe the group that flew at least the requested number of sessions.

mod answers;
mod causal;
pub mod columns;
mod learning;
mod progress;
mod samples;
mod scores;
mod tables;

pub use answers::{Contradiction, Likert, SelfRating, SelfRatingPair};
pub use causal::{IndirectEffect, MediationModel, SENSIBLE_N};
pub use learning::GroupCurve;
pub use progress::{JobProgress, Repetition, ScoreCurve, TraineeProgress, by_job};
pub use scores::{Comparison, CrashRow, CrashTable, Distribution, GroupTest, Individual, RepetitionBox, TaskShare};
pub use tables::{TABLES, table, tables};

use super::record::{IncompletePolicy, SessionRecord};
use samples::SessionsByTrainee;
use serde::Serialize;
use std::collections::BTreeMap;

/// Minimum number of pairs for meaningful paired tests (a medium effect, d = 0.5, needs 34 pairs for a power of 0.8 at 0.05,
/// two-tailed; Cohen 1988).
const SENSIBLE_PAIRS: usize = 34;

/// Sessions and number of repetitions to analyze.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Selection {
    /// Scenarios that count as the job; if empty, the one flown most often.
    pub scenarios: Vec<String>,
    /// Number of repetitions to compare.
    pub repetitions: usize,
    /// Whether incomplete sessions count.
    pub incomplete: IncompletePolicy,
}

/// Result of the cohort analysis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Cohort {
    /// Scenarios that count as the job.
    pub scenarios: Vec<String>,
    /// Number of sessions on the job.
    pub sessions: usize,
    /// Number of incomplete sessions excluded.
    pub left_out: usize,
    /// Number of trainees who flew the job.
    pub trainees: usize,
    /// Number of repetitions compared.
    pub repetitions: usize,
    /// Trainees with at least that number of sessions.
    pub group: Vec<String>,
    /// First sessions: distribution of each score.
    pub distributions: Vec<Distribution>,
    /// First sessions: scores and tasks of each trainee.
    pub individuals: Vec<Individual>,
    /// First sessions: crashes by trainee, task and kind.
    pub crashes: CrashTable,
    /// The group: each score by repetition.
    pub boxes: Vec<RepetitionBox>,
    /// The group: paired comparisons of the repetitions.
    pub tests: Vec<Comparison>,
    /// Tests of whether the group's scores are distributed like those of the other trainees.
    pub homogeneity: Vec<GroupTest>,
    /// Answer counts: over all first sessions, and for the group by repetition.
    pub likert: Vec<Likert>,
    /// Self-ratings compared with measured scores.
    pub self_rating: SelfRating,
    /// Demand, strain and performance with feedback as moderator; `None` if the model cannot be estimated.
    pub causal: Option<MediationModel>,
    /// Progress of each trainee over the repetitions.
    pub progress: Vec<TraineeProgress>,
    /// Learning curves over all trainees with enough sessions; empty if there are none.
    pub learning: Vec<GroupCurve>,
    /// Reasons for caution in interpreting the results.
    pub warnings: Vec<String>,
}

/// Analyzes a cohort.
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
            "{} trainees flew {repetitions} times; with fewer than {SENSIBLE_PAIRS}, a paired test misses most medium effects",
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

/// Returns the selected scenarios, otherwise the one flown most often (ties: first by name). Counts only eligible sessions, if
/// there are any.
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
