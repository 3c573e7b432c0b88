//! The group's learning curves: for each score, the mean over all trainees with enough sessions and a curve fitted to
//! the means.

use super::progress::Repetition;
use super::progress::TraineeProgress;
use super::reliability::{MeasureReliability, reliability_of};
use super::samples::SCORES;
use crate::statistics::{LearningCurve, MIN_LEARNING_REPETITIONS, learning_curve, mean};
use serde::Serialize;

/// A group's learning curve for one score.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GroupCurve {
    /// Score name, such as `conformity`.
    pub score: String,
    /// Number of trainees included in the mean.
    pub people: usize,
    /// Mean score by repetition, up to the last repetition flown by all these trainees.
    pub means: Vec<f64>,
    /// Curve fitted to the means.
    #[serde(flatten)]
    pub curve: LearningCurve,
    /// Whether the fitted change from the first to the last repetition is smaller than the minimal detectable change of
    /// the mean; `None` if the score's reliability is unknown.
    pub within_error: Option<bool>,
}

/// Computes the curves from trainees with at least [`MIN_LEARNING_REPETITIONS`] sessions; empty if there are no such trainees.
pub fn learning(progress: &[TraineeProgress], reliability: &[MeasureReliability]) -> Vec<GroupCurve> {
    SCORES.into_iter().filter_map(|(score, _)| curve_of_score(score, progress, reliability)).collect()
}

fn curve_of_score(score: &str, progress: &[TraineeProgress], reliability: &[MeasureReliability]) -> Option<GroupCurve> {
    let values = |one: &TraineeProgress| one.repetitions.iter().map(|repetition: &Repetition| repetition.score(score)).collect();
    let often = progress.iter().filter(|one| one.repetitions.len() >= MIN_LEARNING_REPETITIONS);
    let people: Vec<Vec<f64>> = often.filter_map(values).collect();
    let shared = people.iter().map(Vec::len).min()?;
    let at = |k: usize| mean(&people.iter().map(|values| values[k]).collect::<Vec<f64>>());
    let means: Vec<f64> = (0..shared).map(at).collect::<Option<_>>()?;
    let curve = learning_curve(&means).ok()?;
    let known = reliability_of(reliability, score);
    let within_error = known.and_then(|one| one.is_mean_within_error(curve.fitted_change(), people.len()));
    Some(GroupCurve { score: score.to_owned(), people: people.len(), curve, means, within_error })
}
