//! A session compared with the trainee's other sessions on the same job.

use crate::record::{SessionOutcome, SessionRecord};
use spandrel_text::{Language, text};

/// A complete session compared with the trainee's other complete sessions on the same job and level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SessionStanding {
    /// Highest overall score, including this session's.
    pub best: f64,
    /// Whether this session has the highest score.
    pub is_best: bool,
    /// Change of the overall score since the last session before this one; `None` for the first one.
    pub change: Option<f64>,
    /// Highest possible score.
    pub most: f64,
}

impl SessionStanding {
    /// Compares a score with those of other sessions of the same job, which are given with their start times. `None` without others.
    #[must_use]
    pub fn new((own_start_us, own, most): (u64, f64, f64), others: &[(u64, f64)]) -> Option<Self> {
        if others.is_empty() {
            return None;
        }
        let best = others.iter().map(|(_, score)| *score).fold(own, f64::max);
        let earlier = others.iter().filter(|(start_us, _)| *start_us < own_start_us);
        let last = earlier.max_by_key(|(start_us, _)| *start_us);
        Some(Self { best, is_best: own >= best, change: last.map(|(_, score)| own - score), most })
    }

    /// Returns the personal best and the change since the last session as sentences.
    #[must_use]
    pub fn words(&self, language: Language) -> String {
        let points = |value: f64| format!("{value:.0}");
        let best = if self.is_best {
            text!(language, "sessions-standing-best")
        } else {
            text!(language, "sessions-standing-other", best = points(self.best), most = points(self.most))
        };
        let change = self.change.map(|change| (change, points(change.abs())));
        let change = match change {
            Some((_, points)) if points == "0" => text!(language, "sessions-standing-same"),
            Some((change, points)) if change > 0.0 => text!(language, "sessions-standing-up", points = points),
            Some((_, points)) => text!(language, "sessions-standing-down", points = points),
            None => return best,
        };
        format!("{best} {change}")
    }
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
    let others: Vec<(u64, f64)> =
        records.iter().filter(is_comparable).map(|other| (other.started_unix_us, other.scores.overall)).collect();
    if !record.is_complete() || !record.is_unaided() {
        return None;
    }
    SessionStanding::new((record.started_unix_us, record.scores.overall, record.scores.overall_max), &others)
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
        let most = all[0].scores.overall_max;
        assert_eq!(standing(&all[2], &all), Some(SessionStanding { best: 350.0, is_best: false, change: Some(-30.0), most }));
        assert_eq!(standing(&all[1], &all), Some(SessionStanding { best: 350.0, is_best: true, change: Some(50.0), most }));
        assert_eq!(standing(&all[0], &all).and_then(|standing| standing.change), None, "the first has no session before it");
        all[1].scenario = "practice".into();
        assert_eq!(standing(&all[2], &all), Some(SessionStanding { best: 320.0, is_best: true, change: Some(20.0), most }));
        all[0] = aborted_record("anna", 1);
        assert_eq!(standing(&all[2], &all), None, "nothing to compare with");
        let mut rewound = records(&[300.0, 400.0]);
        rewound[1].practice_aids.rewinds = 1;
        assert_eq!([0, 1].map(|k| standing(&rewound[k], &rewound)), [None, None], "a rewound session is not compared");
        assert_eq!(standing(&aborted_record("anna", 4), &records(&[300.0])), None, "an incomplete session is not compared");
    }
}
