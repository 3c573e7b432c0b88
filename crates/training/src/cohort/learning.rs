//! The group's learning curves: for each score, the mean over trainees with enough sessions and a curve fitted to it.

use super::progress::Repetition;
use super::progress::TraineeProgress;
use super::samples::SCORES;
use crate::statistics::{LEARNING_NEEDS, LearningCurve, learning_curve, mean};
use serde::Serialize;

/// Learning curve of one score.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GroupCurve {
    /// Name of the score.
    pub score: String,
    /// Number of trainees with their own curve for this score.
    pub people: usize,
    /// Mean score by repetition, up to the last repetition that all of them flew.
    pub means: Vec<f64>,
    /// Curve fitted to the means.
    #[serde(flatten)]
    pub curve: LearningCurve,
}

/// Computes the curves of trainees with at least [`LEARNING_NEEDS`] sessions; empty if there are none.
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
