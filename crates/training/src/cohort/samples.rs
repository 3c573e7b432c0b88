//! Cohort samples: each trainee's sessions and the scores taken from them.

use crate::record::SessionRecord;
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
/// Each trainee's sessions on the job, in chronological order.
pub(super) type SessionsByTrainee<'a> = BTreeMap<&'a str, Vec<&'a SessionRecord>>;
