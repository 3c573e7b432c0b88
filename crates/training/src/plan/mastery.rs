//! Mastery: a drill is done after enough of its latest sessions at its criterion.

use super::finding::findings;
use super::rules::{DrillCriterion, PlanRules};
use super::wording::limit_words;
use crate::record::{SessionOutcome, SessionRecord};
use serde::Serialize;

/// A trainee's progress on one drill.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DrillProgress {
    /// Machine-readable scenario name, such as `drill-gap`.
    pub scenario: String,
    /// Number of sessions of this drill.
    pub sessions: usize,
    /// Number of the latest sessions (at most `of`) that met the criterion.
    pub met: usize,
    /// Number of sessions that must meet the criterion.
    pub needed: usize,
    /// Number of latest sessions that count.
    pub of: usize,
    /// Whether the drill is done.
    pub done: bool,
    /// Start of the latest session of this drill, µs since the Unix epoch; absent if it was never flown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub last_unix_us: Option<u64>,
    /// The criterion as text.
    pub criterion: String,
}

impl DrillProgress {
    /// Describes the progress, such as "1 of the last 2 sessions met the criterion; done after 2 of 3".
    #[must_use]
    pub fn words(&self) -> String {
        let counted = self.sessions.min(self.of);
        let state = match (self.done, counted) {
            (true, _) => format!("done: {} of the last {counted} sessions met the criterion", self.met),
            (false, 0) => format!("not flown yet; done after {} of {} sessions at the criterion", self.needed, self.of),
            (false, 1) => format!("{} of 1 session met the criterion; done after {} of {}", self.met, self.needed, self.of),
            (false, _) => {
                format!(
                    "{} of the last {counted} sessions met the criterion; done after {} of {}",
                    self.met, self.needed, self.of
                )
            }
        };
        format!("{state} ({})", self.criterion)
    }
}

/// Returns whether a session meets a drill's criterion: the session is complete, and no limit is exceeded.
#[must_use]
pub fn meets_criterion(record: &SessionRecord, drill: &DrillCriterion) -> bool {
    let is_within = |rule| findings(rule, std::slice::from_ref(record)).iter().all(|finding| finding.value <= rule.limit);
    record.is_complete() && drill.limits.iter().all(is_within)
}

/// Returns the progress on every drill of the rules, from all of a trainee's sessions in chronological order. Incomplete
/// sessions do not meet the criterion.
#[must_use]
pub fn progress(records: &[SessionRecord], rules: &PlanRules) -> Vec<DrillProgress> {
    rules.drills.iter().map(|drill| progress_on(records, drill, rules)).collect()
}

fn progress_on(records: &[SessionRecord], drill: &DrillCriterion, rules: &PlanRules) -> DrillProgress {
    let flown: Vec<&SessionRecord> = records.iter().filter(|record| record.scenario == drill.scenario).collect();
    let met = flown.iter().rev().take(rules.mastery_of).filter(|record| meets_criterion(record, drill)).count();
    let limits: Vec<String> = drill.limits.iter().map(limit_words).collect();
    DrillProgress {
        scenario: drill.scenario.clone(),
        sessions: flown.len(),
        met,
        needed: rules.mastery_needed,
        of: rules.mastery_of,
        done: met >= rules.mastery_needed,
        last_unix_us: flown.last().map(|record| record.started_unix_us),
        criterion: format!("complete, {}", limits.join(", ")),
    }
}
