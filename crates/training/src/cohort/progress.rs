//! Progress of one trainee over the repetitions, as in the paper's figure of participant 18.

use super::samples::{SCORES, ScorePicker};
use crate::record::{Crashes, IncompletePolicy, SessionRecord};
use crate::statistics::{LearningCurve, learning_curve};
use serde::Serialize;
use std::collections::BTreeMap;

/// Sessions and learning curves of one trainee.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TraineeProgress {
    /// Trainee name.
    pub trainee: String,
    /// Sessions on the job, in chronological order.
    pub repetitions: Vec<Repetition>,
    /// Learning curves of the scores, if there are at least four repetitions.
    pub curves: Vec<ScoreCurve>,
}

/// One repetition.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Repetition {
    /// Number of the repetition, from 1.
    pub number: usize,
    /// Session id.
    pub session: String,
    /// Start time, µs since the Unix epoch.
    pub started_unix_us: u64,
    /// Conformity, 0 to 100; `None` if it does not apply.
    pub conformity: Option<f64>,
    /// Efficiency, 0 to 100.
    pub efficiency: f64,
    /// Safety, 0 to 100.
    pub safety: f64,
    /// Accuracy, 0 to 100; `None` if it does not apply.
    pub accuracy: Option<f64>,
    /// Sum of the scores that apply.
    pub overall: f64,
    /// Flight time, s.
    pub seconds: f64,
    /// For each task number, the on-path share; `None` if the task was not attempted.
    pub on_path: Vec<(u32, Option<f64>)>,
    /// Crashes by kind.
    pub crashes: Crashes,
}

/// Learning curve of one score.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScoreCurve {
    /// Name of the score.
    pub score: String,
    /// Fitted curve.
    #[serde(flatten)]
    pub curve: LearningCurve,
}

/// Progress of one trainee on one job. Jobs are kept separate because practice on one says little about another.
#[derive(Debug, Clone, PartialEq)]
pub struct JobProgress {
    /// Scenario name.
    pub scenario: String,
    /// Numbers and names of its tasks, as of the latest session.
    pub tasks: Vec<(u32, String)>,
    /// Eligible sessions; may be empty.
    pub progress: TraineeProgress,
    /// Number of incomplete sessions excluded.
    pub left_out: usize,
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

/// Groups one trainee's sessions by scenario: the job with the most tasks first, then by name.
#[must_use]
pub fn by_job(records: &[SessionRecord], incomplete: IncompletePolicy) -> Vec<JobProgress> {
    let mut jobs: BTreeMap<&str, Vec<&SessionRecord>> = BTreeMap::new();
    for record in records {
        jobs.entry(&record.scenario).or_default().push(record);
    }
    let on_job = |(scenario, mut sessions): (&str, Vec<&SessionRecord>)| {
        sessions.sort_by(|a, b| (a.started_unix_us, &a.id).cmp(&(b.started_unix_us, &b.id)));
        let last = sessions.last()?;
        let tasks = last.tasks.iter().map(|task| (task.id, task.name.clone())).collect();
        let trainee = last.trainee.clone();
        let all = sessions.len();
        sessions.retain(|record| incomplete.counts(record));
        let left_out = all - sessions.len();
        Some(JobProgress { scenario: scenario.to_owned(), tasks, progress: progress(&trainee, &sessions), left_out })
    };
    let mut found: Vec<JobProgress> = jobs.into_iter().filter_map(on_job).collect();
    found.sort_by_key(|job| std::cmp::Reverse(job.tasks.len()));
    found
}

/// Computes the progress over one trainee's sessions, given in chronological order.
pub fn progress(trainee: &str, sessions: &[&SessionRecord]) -> TraineeProgress {
    let curve = |(score, pick): (&str, ScorePicker)| {
        let values: Option<Vec<f64>> = sessions.iter().map(|record| pick(record)).collect();
        Some(ScoreCurve { score: score.to_owned(), curve: learning_curve(&values?).ok()? })
    };
    TraineeProgress {
        trainee: trainee.to_owned(),
        repetitions: sessions.iter().enumerate().map(|(k, record)| repetition(k + 1, record)).collect(),
        curves: SCORES.into_iter().filter_map(curve).collect(),
    }
}

fn repetition(number: usize, record: &SessionRecord) -> Repetition {
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
    }
}
