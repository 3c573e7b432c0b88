//! Cohort analysis: reproduces the tables and figures of the TASBID pilot study. Each trainee's sessions on the job are
//! numbered. First sessions describe the whole cohort; repetitions describe the group of trainees with at least the
//! requested number of sessions.

mod answers;
mod causal;
pub mod columns;
mod contradiction;
mod details;
mod learning;
mod limitation;
mod progress;
mod reliability;
mod sample_sizes;
mod samples;
mod scores;
mod tables;

pub use answers::{AnswerDistribution, SelfRating, SelfRatingPair};
pub use causal::{IndirectEffect, MediationModel};
pub use contradiction::{Contradiction, ContradictionKind};
pub use details::{TaskDetail, crash_key};
pub use learning::GroupCurve;
pub use limitation::Limitation;
pub use progress::{JobProgress, JobReliability, Repetition, ScoreCurve, TraineeProgress, by_job};
pub use reliability::{MeasureReliability, reliability_of};
pub use sample_sizes::RECOMMENDED_RESPONDENTS;
pub use scores::{Comparison, CrashRow, CrashTable, Distribution, FirstSession, GroupHomogeneityTest, RepetitionBox, TaskShare};
pub use tables::{TABLES, table, tables};

use super::record::{IncompletePolicy, SessionOutcome, SessionRecord, differing_forms};
use sample_sizes::RECOMMENDED_PAIRS;
use samples::SessionsByTrainee;
use serde::Serialize;
use std::collections::BTreeMap;

/// Sessions and number of repetitions to analyze.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Selection {
    /// Scenarios that count as the job. If empty, the most frequently flown scenario is the job.
    pub scenarios: Vec<String>,
    /// Number of repetitions to compare.
    pub repetitions: usize,
    /// Policy for incomplete sessions.
    pub incomplete: IncompletePolicy,
}

/// Result of the cohort analysis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Cohort {
    /// Scenarios that count as the job.
    pub scenarios: Vec<String>,
    /// Number of sessions on the job.
    pub sessions: usize,
    /// Number of incomplete sessions excluded from the analysis.
    pub left_out: usize,
    /// Number of incomplete sessions among the analyzed ones.
    pub incomplete: usize,
    /// Number of analyzed sessions that meet all certification requirements.
    pub certified: usize,
    /// Number of trainees who flew the job.
    pub trainees: usize,
    /// Number of repetitions compared.
    pub repetitions: usize,
    /// Trainees with at least `repetitions` sessions ("the group").
    pub group: Vec<String>,
    /// Score distributions of the first sessions.
    pub distributions: Vec<Distribution>,
    /// Scores and task results of each trainee's first session.
    pub individuals: Vec<FirstSession>,
    /// Crashes in the first sessions by trainee, task and kind.
    pub crashes: CrashTable,
    /// The group's scores by repetition.
    pub boxes: Vec<RepetitionBox>,
    /// Reliability of each measure over the group's repetitions.
    pub reliability: Vec<MeasureReliability>,
    /// Reliability of the details that two sessions are compared by. The cohort's own tables don't show them.
    #[serde(skip)]
    pub details: Vec<MeasureReliability>,
    /// Paired comparisons of the group's repetitions.
    pub tests: Vec<Comparison>,
    /// Tests of whether the group's scores are distributed like the other trainees' scores.
    pub homogeneity: Vec<GroupHomogeneityTest>,
    /// Answer counts for all first sessions and for each of the group's repetitions.
    pub likert: Vec<AnswerDistribution>,
    /// Self-ratings compared with measured scores.
    pub self_rating: SelfRating,
    /// Model of demand, strain and performance with feedback as moderator; `None` if it cannot be estimated.
    pub causal: Option<MediationModel>,
    /// Progress of each trainee by repetition.
    pub progress: Vec<TraineeProgress>,
    /// Learning curves over all trainees with enough sessions; empty if there are none.
    pub learning: Vec<GroupCurve>,
    /// Limitations to consider when interpreting the results.
    #[serde(rename = "warnings")]
    pub limitations: Vec<Limitation>,
}

/// Returns the reliability of the measures on a job, by scenario name and level, from the first two sessions of each trainee.
#[must_use]
pub fn job_reliability(records: &[SessionRecord], scenario: &str, incomplete: IncompletePolicy) -> Vec<MeasureReliability> {
    cohort(records, &Selection { scenarios: vec![scenario.to_owned()], repetitions: 2, incomplete }).all_reliabilities()
}

impl Cohort {
    /// Returns the reliability of all measures, including the details.
    #[must_use]
    pub fn all_reliabilities(&self) -> Vec<MeasureReliability> {
        [self.reliability.as_slice(), &self.details].concat()
    }
}

/// Analyzes the selected sessions of a cohort.
#[must_use]
pub fn cohort(records: &[SessionRecord], selection: &Selection) -> Cohort {
    let scenarios = scenarios(records, selection);
    let on_job = records.iter().filter(|record| scenarios.contains(&record.scenario_with_level()));
    let (on_job, aided): (Vec<&SessionRecord>, Vec<&SessionRecord>) = on_job.partition(|record| record.is_unaided());
    let (counted, left_out): (Vec<&SessionRecord>, Vec<&SessionRecord>) =
        on_job.into_iter().partition(|record| selection.incomplete.counts(record));
    let mut runs = SessionsByTrainee::new();
    for record in counted {
        runs.entry(&record.trainee).or_default().push(record);
    }
    for sessions in runs.values_mut() {
        sessions.sort_by(|a, b| (a.started_unix_us, &a.id).cmp(&(b.started_unix_us, &b.id)));
    }
    let first_sessions: Vec<&SessionRecord> = runs.values().filter_map(|sessions| sessions.first().copied()).collect();
    let repetitions = selection.repetitions.max(1);
    let group: SessionsByTrainee<'_> =
        runs.iter().filter(|(_, sessions)| sessions.len() >= repetitions).map(|(k, v)| (*k, v.clone())).collect();
    let mut limitations = Vec::new();
    if !aided.is_empty() {
        limitations.push(Limitation::AidedSessions(aided.len()));
    }
    let forms = differing_forms(runs.values().flatten().map(|record| &record.form));
    if !forms.is_empty() {
        limitations.push(Limitation::PooledForms(forms));
    }
    let causal = causal::causal(&first_sessions, &mut limitations);
    if repetitions > 1 && group.len() < RECOMMENDED_PAIRS {
        limitations.push(Limitation::FewPairs { trainees: group.len(), repetitions });
    }
    let reliability = reliability::reliabilities(&runs, &group, repetitions, &mut limitations);
    let progress: Vec<TraineeProgress> =
        runs.iter().map(|(trainee, sessions)| progress::progress(trainee, sessions, &reliability)).collect();
    let homogeneity = scores::test_group_homogeneity(&first_sessions, &group, &mut limitations);
    Cohort {
        sessions: runs.values().map(Vec::len).sum(),
        left_out: left_out.len(),
        incomplete: counted_sessions(&runs, |record| !record.is_complete()),
        certified: counted_sessions(&runs, |record| record.certified),
        trainees: runs.len(),
        repetitions,
        group: group.keys().map(|trainee| (*trainee).to_owned()).collect(),
        distributions: scores::distributions(&first_sessions),
        individuals: first_sessions.iter().map(|record| scores::first_session(record)).collect(),
        crashes: scores::crash_table(&first_sessions),
        boxes: scores::boxes(&group, repetitions),
        tests: scores::comparisons(&group, repetitions, &reliability, &mut limitations),
        homogeneity,
        likert: answers::likert(&first_sessions, &group, repetitions),
        self_rating: answers::self_rating(&first_sessions, &reliability),
        causal,
        learning: learning::learning(&progress, &reliability),
        reliability,
        details: details::details(&group, repetitions),
        progress,
        limitations,
        scenarios,
    }
}

fn counted_sessions(runs: &SessionsByTrainee<'_>, counts: fn(&SessionRecord) -> bool) -> usize {
    runs.values().flatten().filter(|record| counts(record)).count()
}

/// Returns the selected scenarios or, if none are selected, the most frequently flown one (the first by name in a tie).
/// Counts only sessions that the policy allows or, if it allows none, all sessions.
fn scenarios(records: &[SessionRecord], selection: &Selection) -> Vec<String> {
    if !selection.scenarios.is_empty() {
        return selection.scenarios.clone();
    }
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    let all = !records.iter().any(|record| selection.incomplete.counts(record));
    for record in records.iter().filter(|record| all || selection.incomplete.counts(record)) {
        *counts.entry(record.scenario_with_level()).or_default() += 1;
    }
    let most = counts.values().copied().max();
    counts.into_iter().find(|(_, count)| Some(*count) == most).map(|(name, _)| name).into_iter().collect()
}

#[cfg(test)]
mod tests;
