//! One trainee over the repetitions: the paper's figure of participant 18.

use super::SCORES;
use crate::record::{Crashes, IncompletePolicy, SessionRecord};
use crate::statistics::{LearningCurve, learning_curve};
use serde::Serialize;
use std::collections::BTreeMap;

/// One trainee.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TraineeProgress {
    /// Who.
    pub trainee: String,
    /// Sessions on the job in their order.
    pub repetitions: Vec<Repetition>,
    /// Learning curves of the scores, from four repetitions on.
    pub curves: Vec<ScoreCurve>,
}

/// One session.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Repetition {
    /// 1, 2, ...
    pub number: usize,
    /// Session.
    pub session: String,
    /// µs since the Unix epoch.
    pub started_unix_us: u64,
    /// 0 to 100.
    pub conformity: Option<f64>,
    /// 0 to 100.
    pub efficiency: f64,
    /// 0 to 100.
    pub safety: f64,
    /// 0 to 100.
    pub accuracy: Option<f64>,
    /// Sum.
    pub overall: f64,
    /// Flight time, s.
    pub seconds: f64,
    /// By task number: share on the path, absent for a task that was left out.
    pub on_path: Vec<(u32, Option<f64>)>,
    /// By kind.
    pub crashes: Crashes,
}

/// One score's curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScoreCurve {
    /// Score.
    pub score: String,
    /// Its curve.
    #[serde(flatten)]
    pub curve: LearningCurve,
}

/// One trainee on one job: practice on a drill says nothing about practice on another job.
#[derive(Debug, Clone, PartialEq)]
pub struct JobProgress {
    /// Scenario.
    pub scenario: String,
    /// Numbers and names of its tasks, as flown last.
    pub tasks: Vec<(u32, String)>,
    /// The sessions on it that count; perhaps none.
    pub progress: TraineeProgress,
    /// Incomplete sessions on it that were left out.
    pub left_out: usize,
}

impl Repetition {
    /// A score by its name; `None` when it does not apply.
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

/// One trainee's sessions apart by scenario: the job with the most tasks first, then by name.
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

/// One trainee's sessions in their order.
pub fn progress(trainee: &str, sessions: &[&SessionRecord]) -> TraineeProgress {
    let curve = |(score, pick): (&str, super::ScorePicker)| {
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
