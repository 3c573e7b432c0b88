//! Cohort samples: each trainee's sessions and the measures taken from them.

use crate::record::{CertificationRecord, SessionRecord};
use spandrel_monitor::score::certification::CertificationScores;
use std::collections::BTreeMap;

/// Function that returns one of a record's scores; `None` if it does not apply.
pub(super) type ScorePicker = fn(&SessionRecord) -> Option<f64>;

/// The five scores by name.
pub(super) const SCORES: [(&str, ScorePicker); 5] = [
    ("conformity", |record| record.scores.conformity),
    ("efficiency", |record| Some(record.scores.efficiency)),
    ("safety", |record| Some(record.scores.safety)),
    ("accuracy", |record| record.scores.accuracy),
    OVERALL,
];

pub(super) const OVERALL: (&str, ScorePicker) = ("overall", |record| Some(record.scores.overall));

/// Name of the flight time among the [`MEASURES`].
pub(super) const FLIGHT_TIME: &str = "flight_time";

/// A measure whose reliability is reported.
pub(super) struct Measure {
    /// Measure name, as in the tables.
    pub name: &'static str,
    /// Unit; empty for a count.
    pub unit: &'static str,
    /// Returns the value; `None` if it does not apply.
    pub pick: ScorePicker,
    /// Returns the best possible value, if there is one.
    pub best: Option<fn(&SessionRecord) -> f64>,
}

/// The five scores, the scores of the certification profile and their sum, the RMS distance from the path, and the two measures
/// behind efficiency and safety, which have no upper limit. Records before format 3 have no certification scores, and those before
/// format 7 no RMS distance.
pub(super) const MEASURES: [Measure; 14] = [
    score(SCORES[0], |_| 100.0),
    score(SCORES[1], |_| 100.0),
    score(SCORES[2], |_| 100.0),
    score(SCORES[3], |_| 100.0),
    score(SCORES[4], |record| record.scores.overall_max),
    score(("certification_conformity", |record| certification(record)?.conformity), |_| 100.0),
    score(("certification_precision", |record| certification(record)?.precision), |_| 100.0),
    score(("certification_safety", |record| Some(certification(record)?.safety)), |_| 100.0),
    score(("certification_accuracy", |record| certification(record)?.accuracy), |_| 100.0),
    score(("certification_efficiency", |record| Some(certification(record)?.efficiency)), |_| 100.0),
    score(("certification_sum", |record| Some(certification(record)?.sum)), |record| {
        certification(record).map_or(500.0, |scores| scores.sum_max)
    }),
    Measure { name: "rms_distance", unit: "%", pick: rms_distance_pct, best: Some(|_| 0.0) },
    Measure { name: FLIGHT_TIME, unit: "s", pick: |record| Some(record.seconds), best: None },
    Measure { name: "crashes", unit: "", pick: |record| Some(record.crashes().total() as f64), best: Some(|_| 0.0) },
];

fn certification(record: &SessionRecord) -> Option<&CertificationScores> {
    record.certification.as_ref().map(|one| &one.scores)
}

/// Returns the RMS distance from the path, as a percentage of the task's threshold.
fn rms_distance_pct(record: &SessionRecord) -> Option<f64> {
    let certification: &CertificationRecord = record.certification.as_ref()?;
    Some(100.0 * certification.precision?.rms_distance_ratio)
}

const fn score((name, pick): (&'static str, ScorePicker), best: fn(&SessionRecord) -> f64) -> Measure {
    Measure { name, unit: "points", pick, best: Some(best) }
}

/// Each trainee's sessions on the job, in chronological order.
pub(super) type SessionsByTrainee<'a> = BTreeMap<&'a str, Vec<&'a SessionRecord>>;
