//! A session compared with the trainee's other sessions on the same job.

use crate::record::{SessionOutcome, SessionRecord};

/// A complete session compared with the trainee's other complete sessions on the same job and level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SessionStanding {
    /// Highest overall score, including this session's.
    pub best: f64,
    /// Whether this session has the highest score.
    pub is_best: bool,
    /// Change of the overall score since the last session before this one; `None` for the first one.
    pub change: Option<f64>,
}

/// Compares a session with the trainee's other records; `None` if it is incomplete, was frozen or rewound, or there is no other
/// comparable session.
#[must_use]
pub fn standing(record: &SessionRecord, records: &[SessionRecord]) -> Option<SessionStanding> {
    let is_comparable = |other: &&SessionRecord| {
        other.is_complete()
            && other.is_unaided()
            && (&other.trainee, other.scenario_with_level()) == (&record.trainee, record.scenario_with_level())
            && other.scores.overall_max == record.scores.overall_max
            && other.id != record.id
    };
    let others: Vec<&SessionRecord> = records.iter().filter(is_comparable).collect();
    if !record.is_complete() || !record.is_unaided() || others.is_empty() {
        return None;
    }
    let own = record.scores.overall;
    let best = others.iter().map(|other| other.scores.overall).fold(own, f64::max);
    let earlier = others.iter().filter(|other| other.started_unix_us < record.started_unix_us);
    let last = earlier.max_by_key(|other| other.started_unix_us);
    Some(SessionStanding { best, is_best: own >= best, change: last.map(|last| own - last.scores.overall) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{aborted_record, perfect_record};

    fn records(scores: &[f64]) -> Vec<SessionRecord> {
        let one = |(k, score): (usize, &f64)| {
            let mut record = perfect_record("anna", k + 1);
            record.scores.overall = *score;
            record
        };
        scores.iter().enumerate().map(one).collect()
    }

    #[test]
    fn exact_best_and_change_come_from_complete_sessions_on_the_same_job() {
        let mut all = records(&[300.0, 350.0, 320.0]);
        assert_eq!(standing(&all[2], &all), Some(SessionStanding { best: 350.0, is_best: false, change: Some(-30.0) }));
        assert_eq!(standing(&all[1], &all), Some(SessionStanding { best: 350.0, is_best: true, change: Some(50.0) }));
        assert_eq!(standing(&all[0], &all).and_then(|standing| standing.change), None, "the first has no session before it");
        all[1].scenario = "practice".into();
        assert_eq!(standing(&all[2], &all), Some(SessionStanding { best: 320.0, is_best: true, change: Some(20.0) }));
        all[0] = aborted_record("anna", 1);
        assert_eq!(standing(&all[2], &all), None, "nothing to compare with");
        let mut rewound = records(&[300.0, 400.0]);
        rewound[1].practice_aids.rewinds = 1;
        assert_eq!([0, 1].map(|k| standing(&rewound[k], &rewound)), [None, None], "a rewound session is not compared");
        assert_eq!(standing(&aborted_record("anna", 4), &records(&[300.0])), None, "an incomplete session is not compared");
    }
}
