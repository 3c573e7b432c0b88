//! Reliability of each measure, and the changes that are too small to be told apart from measurement error.

use super::limitation::Limitation;
use super::sample_sizes::RECOMMENDED_REPEATERS;
use super::samples::{MEASURES, Measure, SessionsByTrainee};
use crate::record::SessionRecord;
use crate::statistics::{Reliability, StatisticsError, reliability};
use serde::Serialize;

/// Reliability of one measure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasureReliability {
    /// Measure name, such as `conformity` or `flight_time`.
    pub measure: String,
    /// Unit of the error and of the minimal detectable change; empty for a count.
    pub unit: &'static str,
    /// Number of sessions in which the measure applies.
    pub sessions: usize,
    /// Fraction of these sessions with the best possible value, 0 to 1; `None` if there is no best possible value.
    pub at_ceiling: Option<f64>,
    /// Reliability over the group's repetitions; `None` if there are too few or the measure does not vary.
    pub reliability: Option<Reliability>,
}

impl MeasureReliability {
    /// Returns whether a trainee's change is zero or smaller than the minimal detectable change; `None` if that is unknown.
    #[must_use]
    pub fn is_within_error(&self, change: f64) -> Option<bool> {
        self.is_mean_within_error(change, 1)
    }

    /// Returns whether a change of the mean of `n` trainees is zero or smaller than the minimal detectable change of such a mean.
    #[must_use]
    pub fn is_mean_within_error(&self, change: f64, n: usize) -> Option<bool> {
        self.reliability.map(|one| change == 0.0 || change.abs() < one.minimal_detectable_mean_change(n))
    }
}

/// Returns the entry for a measure, if there is one.
#[must_use]
pub fn reliability_of<'a>(all: &'a [MeasureReliability], measure: &str) -> Option<&'a MeasureReliability> {
    all.iter().find(|one| one.measure == measure)
}

/// Computes the reliability of every measure from the first `repetitions` sessions of each trainee in the group, and the
/// share at the ceiling from all sessions.
pub fn reliabilities(
    runs: &SessionsByTrainee<'_>,
    group: &SessionsByTrainee<'_>,
    repetitions: usize,
    limitations: &mut Vec<Limitation>,
) -> Vec<MeasureReliability> {
    if repetitions > 1 && (2..RECOMMENDED_REPEATERS).contains(&group.len()) {
        limitations.push(Limitation::ImpreciseReliability(group.len()));
    }
    let all: Vec<&SessionRecord> = runs.values().flatten().copied().collect();
    let mut one = |measure: &Measure| {
        let reliability = match of_values(group, repetitions, &measure.pick) {
            Ok(found) => Some(found),
            Err(StatisticsError::Constant(_)) => {
                limitations.push(Limitation::NoReliability(measure.name));
                None
            }
            Err(_) => None,
        };
        let applicable: Vec<&&SessionRecord> = all.iter().filter(|record| (measure.pick)(record).is_some()).collect();
        MeasureReliability {
            measure: measure.name.to_owned(),
            unit: measure.unit,
            sessions: applicable.len(),
            at_ceiling: ceiling_share(measure, &applicable),
            reliability,
        }
    };
    MEASURES.iter().map(&mut one).collect()
}

/// Computes the reliability of a value from the first `repetitions` sessions of each trainee to whom it always applies.
pub fn of_values(
    group: &SessionsByTrainee<'_>,
    repetitions: usize,
    pick: &dyn Fn(&SessionRecord) -> Option<f64>,
) -> Result<Reliability, StatisticsError> {
    let values = |sessions: &Vec<&SessionRecord>| sessions.iter().take(repetitions).map(|record| pick(record)).collect();
    let complete: Vec<Vec<f64>> = group.values().filter_map(values).collect();
    reliability(&complete)
}

fn ceiling_share(measure: &Measure, records: &[&&SessionRecord]) -> Option<f64> {
    let best = measure.best?;
    let at_best = records.iter().filter(|record| (measure.pick)(record) == Some(best(record))).count();
    (!records.is_empty()).then(|| at_best as f64 / records.len() as f64)
}
