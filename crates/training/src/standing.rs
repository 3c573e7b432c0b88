//! A session compared with the trainee's other sessions on the same job.

use crate::cohort::{MeasureReliability, reliability_of};
use crate::record::{SessionOutcome, SessionRecord, differing_forms, excluded_sessions_note};
use crate::terms::error_label;
use spandrel_text::{Language, text};

/// A complete session compared with the trainee's other complete sessions on the same job and level, and on equated forms.
#[derive(Debug, Clone, PartialEq)]
pub struct SessionStanding {
    /// Highest overall score, including this session's.
    pub best: f64,
    /// Whether this session has the highest score.
    pub is_best: bool,
    /// Change of the overall score since the last session before this one; `None` for the first one.
    pub change: Option<f64>,
    /// Whether that change is smaller than the minimal detectable change; `None` if the score's reliability is unknown.
    pub within_error: Option<bool>,
    /// Number of the trainee's incomplete sessions on this job, which are left out.
    pub left_out: usize,
    /// Highest possible score.
    pub most: f64,
    /// Names of the equated forms that these sessions flew; empty if it is the same one.
    pub forms: Vec<String>,
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
        let change = last.map(|(_, score)| own - score);
        Some(Self { best, is_best: own >= best, change, within_error: None, left_out: 0, most, forms: Vec::new() })
    }

    /// Labels the change with the reliability of the measures on the job.
    #[must_use]
    pub fn labeled(self, known: &[MeasureReliability]) -> Self {
        let overall = self.change.zip(reliability_of(known, "overall"));
        Self { within_error: overall.and_then(|(change, known)| known.is_within_error(change)), ..self }
    }

    /// Returns the personal best and the change since the last session as sentences.
    #[must_use]
    pub fn words(&self, language: Language) -> String {
        let left_out = excluded_sessions_note(self.left_out, language).map(|note| note + ".");
        let forms = (!self.forms.is_empty()).then(|| text!(language, "sessions-standing-forms", forms = self.forms.join(", ")));
        [Some(self.best_words(language)), self.change_words(language), forms, left_out]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
            .join(" ")
    }

    fn best_words(&self, language: Language) -> String {
        if self.is_best {
            return text!(language, "sessions-standing-best");
        }
        text!(language, "sessions-standing-other", best = points(self.best), most = points(self.most))
    }

    fn change_words(&self, language: Language) -> Option<String> {
        let change = self.change?;
        let said = match points(change.abs()).parse::<u64>().unwrap_or_default() {
            0 => text!(language, "sessions-standing-same"),
            points if change > 0.0 => text!(language, "sessions-standing-up", points = points),
            points => text!(language, "sessions-standing-down", points = points),
        };
        let Some(within) = self.within_error else { return Some(said) };
        Some(format!("{} ({}).", said.trim_end_matches('.'), error_label(within, language)))
    }
}

/// Compares a session with the trainee's other records; `None` if it is incomplete, was frozen or rewound, or there is no other
/// comparable session.
#[must_use]
pub fn standing(record: &SessionRecord, records: &[SessionRecord]) -> Option<SessionStanding> {
    let is_on_job = |other: &&SessionRecord| {
        other.is_unaided() && other.trainee == record.trainee && other.is_same_job(record) && other.id != record.id
    };
    let (complete, left_out): (Vec<&SessionRecord>, Vec<&SessionRecord>) =
        records.iter().filter(is_on_job).partition(|other| other.is_complete());
    let is_comparable = |other: &&SessionRecord| other.scores.overall_max == record.scores.overall_max;
    let compared: Vec<&SessionRecord> = complete.into_iter().filter(is_comparable).collect();
    let others: Vec<(u64, f64)> = compared.iter().map(|other| (other.started_unix_us, other.scores.overall)).collect();
    if !record.is_complete() || !record.is_unaided() {
        return None;
    }
    let standing = SessionStanding::new((record.started_unix_us, record.scores.overall, record.scores.overall_max), &others)?;
    let forms = differing_forms(compared.iter().map(|other| &other.form).chain([&record.form]));
    Some(SessionStanding { left_out: left_out.len(), forms, ..standing })
}

/// Returns a score without decimals.
fn points(value: f64) -> String {
    format!("{value:.0}")
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
    fn exact_change_is_labeled_with_the_error_of_the_score() {
        let mut everyone = records(&[300.0, 305.0]);
        for (trainee, scores) in [("ben", [200.0, 212.0]), ("cleo", [380.0, 379.0])] {
            for (k, score) in scores.into_iter().enumerate() {
                let mut record = perfect_record(trainee, k + 1);
                record.scores.overall = score;
                everyone.push(record);
            }
        }
        let known = crate::cohort::job_reliability(&everyone, "two-bridges", crate::record::IncompletePolicy::Exclude);
        let own = |change: f64| {
            let mut all = records(&[300.0, 300.0 + change]);
            all[1].scores.overall_max = 400.0;
            standing(&all[1], &all).unwrap().labeled(&known).within_error
        };
        assert_eq!([own(5.0), own(90.0)], [Some(true), Some(false)]);
        let all = records(&[300.0, 305.0]);
        assert_eq!(standing(&all[1], &all).unwrap().labeled(&[]).within_error, None, "the reliability is unknown");
    }

    #[test]
    fn exact_only_sessions_on_equated_forms_are_compared() {
        let mut all = records(&[390.0, 350.0, 360.0]);
        for (record, (form, detection_pct)) in all.iter_mut().zip([("H", 25.0), ("A", 95.0), ("B", 95.0)]) {
            (record.form, record.form_detection_pct) = (Some(form.into()), Some(detection_pct));
        }
        let found = standing(&all[2], &all).unwrap();
        assert_eq!((found.best, found.is_best, found.change), (360.0, true, Some(10.0)), "form H is harder");
        assert!(
            found.words(Language::English).contains("on the equally difficult forms A, B."),
            "{}",
            found.words(Language::English)
        );
        assert_eq!(standing(&all[0], &all), None, "no session on a form as hard as H");
        all[1].form = Some("B".into());
        let words = standing(&all[2], &all).unwrap().words(Language::English);
        assert!(!words.contains("form"), "{words}");
    }

    #[test]
    fn exact_best_and_change_come_from_complete_sessions_on_the_same_job() {
        let mut all = records(&[300.0, 350.0, 320.0]);
        let most = all[0].scores.overall_max;
        let unlabeled = |best, is_best, change, left_out| {
            Some(SessionStanding { best, is_best, change, within_error: None, left_out, most, forms: Vec::new() })
        };
        assert_eq!(standing(&all[2], &all), unlabeled(350.0, false, Some(-30.0), 0));
        assert_eq!(standing(&all[1], &all), unlabeled(350.0, true, Some(50.0), 0));
        assert_eq!(standing(&all[0], &all).and_then(|standing| standing.change), None, "the first has no session before it");
        all[1].scenario = "practice".into();
        assert_eq!(standing(&all[2], &all), unlabeled(320.0, true, Some(20.0), 0));
        let with_aborted = [all.clone(), vec![aborted_record("anna", 4), aborted_record("ben", 1)]].concat();
        assert_eq!(
            standing(&all[2], &with_aborted),
            unlabeled(320.0, true, Some(20.0), 1),
            "only the trainee's own sessions count"
        );
        all[0] = aborted_record("anna", 1);
        assert_eq!(standing(&all[2], &all), None, "nothing to compare with");
        let mut rewound = records(&[300.0, 400.0]);
        rewound[1].practice_aids.rewinds = 1;
        assert_eq!([0, 1].map(|k| standing(&rewound[k], &rewound)), [None, None], "a rewound session is not compared");
        assert_eq!(standing(&aborted_record("anna", 4), &records(&[300.0])), None, "an incomplete session is not compared");
    }
}
