//! One trainee's progress by repetition, as in the TASBID paper's figure for participant 18.

use super::reliability::{MeasureReliability, reliability_of};
use super::samples::{SCORES, ScorePicker};
use crate::record::{Crashes, IncompletePolicy, SessionRecord};
use crate::statistics::{LearningCurve, learning_curve};
use serde::Serialize;
use std::collections::BTreeMap;

/// One trainee's sessions and learning curves.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TraineeProgress {
    /// Trainee's pseudonym.
    pub trainee: String,
    /// Sessions on the job, in chronological order.
    pub repetitions: Vec<Repetition>,
    /// Learning curve for each score, if there are at least four repetitions.
    pub curves: Vec<ScoreCurve>,
}

/// A trainee's session on a job.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Repetition {
    /// Repetition number, from 1.
    pub number: usize,
    /// Session ID (its folder name).
    pub session: String,
    /// Start time, µs since the Unix epoch.
    pub started_unix_us: u64,
    /// Conformity, 0 to 100; `None` if it does not apply.
    pub conformity: Option<f64>,
    /// Efficiency score, 0 to 100.
    pub efficiency: f64,
    /// Safety score, 0 to 100.
    pub safety: f64,
    /// Accuracy, 0 to 100; `None` if it does not apply.
    pub accuracy: Option<f64>,
    /// Sum of all applicable scores.
    pub overall: f64,
    /// Flight duration, s.
    pub seconds: f64,
    /// On-path share by task number; `None` if the task was not attempted.
    pub on_path: Vec<(u32, Option<f64>)>,
    /// Crash counts by kind of object hit.
    pub crashes: Crashes,
    /// Scores that changed since the preceding repetition by less than the minimal detectable change.
    pub within_error: Vec<String>,
}

/// Learning curve for one score.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScoreCurve {
    /// Score name, such as `conformity`.
    pub score: String,
    /// Power law fitted to the scores.
    #[serde(flatten)]
    pub curve: LearningCurve,
    /// Whether the fitted change from the first to the last repetition is smaller than the minimal detectable change; `None`
    /// if the score's reliability is unknown.
    pub within_error: Option<bool>,
}

/// Reliability of the measures on each job, by scenario name.
pub type JobReliability = BTreeMap<String, Vec<MeasureReliability>>;

/// One trainee's progress on one job. Jobs are kept separate because practice on one says little about another.
#[derive(Debug, Clone, PartialEq)]
pub struct JobProgress {
    /// Machine-readable scenario name, such as `two-bridges`.
    pub scenario: String,
    /// Names of the equated forms that were flown; empty if the job has no forms.
    pub forms: Vec<String>,
    /// Task numbers and names, as of the latest session.
    pub tasks: Vec<(u32, String)>,
    /// Sessions that the policy allows; may be empty.
    pub progress: TraineeProgress,
    /// Number of excluded incomplete sessions.
    pub left_out: usize,
    /// Reliability of the measures on this job, from all trainees; empty if unknown.
    pub reliability: Vec<MeasureReliability>,
}

impl Repetition {
    /// Returns a score by name; `None` if it does not apply.
    #[must_use]
    pub fn score(&self, name: &str) -> Option<f64> {
        match name {
            "conformity" => self.conformity,
            "efficiency" => Some(self.efficiency),
            "safety" => Some(self.safety),
            "accuracy" => self.accuracy,
            "overall" => Some(self.overall),
            _ => None,
        }
    }
}

/// Groups one trainee's sessions by scenario, level and equated forms, sorted by descending number of tasks, then by name. Changes are labeled
/// with the reliability of the measures on that job, as far as it is known.
#[must_use]
pub fn by_job(records: &[SessionRecord], incomplete: IncompletePolicy, reliability: &JobReliability) -> Vec<JobProgress> {
    let mut jobs: Vec<Vec<&SessionRecord>> = Vec::new();
    for record in records.iter().filter(|record| record.is_unaided()) {
        match jobs.iter_mut().find(|sessions| sessions[0].is_same_job(record)) {
            Some(sessions) => sessions.push(record),
            None => jobs.push(vec![record]),
        }
    }
    let on_job = |mut sessions: Vec<&SessionRecord>| {
        sessions.sort_by(|a, b| (a.started_unix_us, &a.id).cmp(&(b.started_unix_us, &b.id)));
        let last = sessions.last()?;
        let scenario = last.scenario_with_level();
        let mut forms: Vec<String> = sessions.iter().filter_map(|record| record.form.clone()).collect();
        forms.sort();
        forms.dedup();
        let tasks = last.tasks.iter().map(|task| (task.id, task.name.clone())).collect();
        let trainee = last.trainee.clone();
        let all = sessions.len();
        sessions.retain(|record| incomplete.counts(record));
        let left_out = all - sessions.len();
        let reliability = reliability.get(&scenario).cloned().unwrap_or_default();
        let progress = progress(&trainee, &sessions, &reliability);
        Some(JobProgress { scenario, forms, tasks, progress, left_out, reliability })
    };
    let mut found: Vec<JobProgress> = jobs.into_iter().filter_map(on_job).collect();
    found.sort_by(|a, b| (b.tasks.len(), &a.scenario, &a.forms).cmp(&(a.tasks.len(), &b.scenario, &b.forms)));
    found
}

/// Computes one trainee's progress from sessions in chronological order.
pub fn progress(trainee: &str, sessions: &[&SessionRecord], reliability: &[MeasureReliability]) -> TraineeProgress {
    let curve = |(score, pick): (&str, ScorePicker)| {
        let values: Option<Vec<f64>> = sessions.iter().map(|record| pick(record)).collect();
        let curve = learning_curve(&values?).ok()?;
        let within_error = reliability_of(reliability, score).and_then(|one| one.is_within_error(curve.fitted_change()));
        Some(ScoreCurve { score: score.to_owned(), curve, within_error })
    };
    TraineeProgress {
        trainee: trainee.to_owned(),
        repetitions: sessions
            .iter()
            .enumerate()
            .map(|(k, record)| repetition(k + 1, record, k.checked_sub(1).map(|k| sessions[k]), reliability))
            .collect(),
        curves: SCORES.into_iter().filter_map(curve).collect(),
    }
}

fn repetition(
    number: usize,
    record: &SessionRecord,
    preceding: Option<&SessionRecord>,
    reliability: &[MeasureReliability],
) -> Repetition {
    let within_error = |(score, pick): &(&str, ScorePicker)| {
        let change = preceding.and_then(|preceding| Some(pick(record)? - pick(preceding)?));
        change.zip(reliability_of(reliability, score)).and_then(|(change, known)| known.is_within_error(change)) == Some(true)
    };
    Repetition {
        number,
        session: record.id.clone(),
        started_unix_us: record.started_unix_us,
        conformity: record.scores.conformity,
        efficiency: record.scores.efficiency,
        safety: record.scores.safety,
        accuracy: record.scores.accuracy,
        overall: record.scores.overall,
        seconds: record.seconds,
        on_path: record.tasks.iter().map(|task| (task.id, task.attempted.then_some(task.on_path))).collect(),
        crashes: record.crashes(),
        within_error: SCORES.iter().filter(|one| within_error(one)).map(|(score, _)| (*score).to_owned()).collect(),
    }
}
