//! The group's learning curve: of each score the mean over those who flew often enough, and the curve through it.

use super::progress::TraineeProgress;
use super::{SCORES, progress::Repetition};
use crate::statistics::{LEARNING_NEEDS, LearningCurve, learning_curve, mean};
use serde::Serialize;

/// One score.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GroupCurve {
    /// Score.
    pub score: String,
    /// People with a curve of their own in this score.
    pub people: usize,
    /// Their mean by repetition, as far as all of them flew.
    pub means: Vec<f64>,
    /// The curve through the means.
    #[serde(flatten)]
    pub curve: LearningCurve,
}

/// The curves of those who flew at least [`LEARNING_NEEDS`] times; none when nobody did.
pub fn learning(progress: &[TraineeProgress]) -> Vec<GroupCurve> {
    SCORES.into_iter().filter_map(|(score, _)| of_score(score, progress)).collect()
}

fn of_score(score: &str, progress: &[TraineeProgress]) -> Option<GroupCurve> {
    let values = |one: &TraineeProgress| one.repetitions.iter().map(|repetition: &Repetition| repetition.score(score)).collect();
    let often = progress.iter().filter(|one| one.repetitions.len() >= LEARNING_NEEDS);
    let people: Vec<Vec<f64>> = often.filter_map(values).collect();
    let shared = people.iter().map(Vec::len).min()?;
    let at = |k: usize| mean(&people.iter().map(|values| values[k]).collect::<Vec<f64>>());
    let means: Vec<f64> = (0..shared).map(at).collect::<Option<_>>()?;
    Some(GroupCurve { score: score.to_owned(), people: people.len(), curve: learning_curve(&means).ok()?, means })
}
