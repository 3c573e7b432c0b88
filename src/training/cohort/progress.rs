//! One trainee over the repetitions: the paper's figure of participant 18.

use super::SCORES;
use crate::training::record::{Crashes, Record};
use crate::training::statistics::{LearningCurve, learning_curve};
use serde::Serialize;

/// One trainee.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Progress {
    /// Who.
    pub trainee: String,
    /// Sessions on the job in their order.
    pub repetitions: Vec<Repetition>,
    /// Learning curves of the scores, from four repetitions on.
    pub curves: Vec<Curve>,
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
pub struct Curve {
    /// Score.
    pub score: String,
    /// Its curve.
    #[serde(flatten)]
    pub curve: LearningCurve,
}

pub fn progress(trainee: &str, sessions: &[&Record]) -> Progress {
    let curve = |(score, pick): (&str, super::Pick)| {
        let values: Option<Vec<f64>> = sessions.iter().map(|record| pick(record)).collect();
        Some(Curve { score: score.to_owned(), curve: learning_curve(&values?).ok()? })
    };
    Progress {
        trainee: trainee.to_owned(),
        repetitions: sessions.iter().enumerate().map(|(k, record)| repetition(k + 1, record)).collect(),
        curves: SCORES.into_iter().filter_map(curve).collect(),
    }
}

fn repetition(number: usize, record: &Record) -> Repetition {
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
