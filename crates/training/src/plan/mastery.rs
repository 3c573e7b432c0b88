//! Mastery: a drill is done after enough of its latest sessions at its criterion.

use super::finding::findings;
use super::rules::{DrillCriterion, PlanRules};
use super::staircase::{self, LevelAdvice, StaircaseSession};
use super::wording::limit_words;
use crate::record::{SessionLevel, SessionOutcome, SessionRecord};
use serde::Serialize;
use spandrel_text::{Language, text};

/// A trainee's progress on one drill.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DrillProgress {
    /// Machine-readable scenario name, such as `drill-gap`.
    pub scenario: String,
    /// Number of sessions of this drill.
    pub sessions: usize,
    /// Number of the latest sessions that count (at most `of`) and met the criterion.
    pub met: usize,
    /// Number of the latest sessions that count (at most `of`): those that decide about the standard level.
    pub counted: usize,
    /// Number of sessions that must meet the criterion.
    pub needed: usize,
    /// Number of latest sessions that count.
    pub of: usize,
    /// Whether the drill is done.
    pub done: bool,
    /// Start of the latest session of this drill, µs since the Unix epoch; absent if it was never flown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub last_unix_us: Option<u64>,
    /// The criterion as text, in the language of the plan.
    pub criterion: String,
    /// Difficulty level of the next session; absent if the drill has no levels or difficulty does not adapt.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub next_level: Option<LevelAdvice>,
}

impl DrillProgress {
    /// Describes the progress in the language of the plan, such as "1 of the last 2 sessions met the criterion; done after 2 of 3".
    #[must_use]
    pub fn words(&self, language: Language) -> String {
        let [met, counted, needed, of] = [self.met, self.counted, self.needed, self.of].map(|count| count.to_string());
        let criterion = self.criterion.as_str();
        match (self.done, self.counted) {
            (true, _) => text!(language, "plan-drill-done", met = met, counted = self.counted, criterion = criterion),
            (false, 0) if self.sessions > 0 => {
                text!(language, "plan-drill-not-at-standard", needed = needed, of = of, criterion = criterion)
            }
            (false, 0) => text!(language, "plan-drill-not-flown", needed = needed, of = of, criterion = criterion),
            (false, 1) => {
                text!(language, "plan-drill-one-session", met = met, needed = needed, of = of, criterion = criterion)
            }
            (false, _) => text!(
                language,
                "plan-drill-sessions",
                met = met,
                counted = counted,
                needed = needed,
                of = of,
                criterion = criterion
            ),
        }
    }
}

/// Returns whether a session meets a drill's criterion: the session is complete, and no limit is exceeded.
#[must_use]
pub fn meets_criterion(record: &SessionRecord, drill: &DrillCriterion) -> bool {
    let is_within = |rule| findings(rule, &[record]).iter().all(|finding| finding.value <= rule.limit);
    record.is_complete() && drill.limits.iter().all(is_within)
}

/// Returns the progress on every drill of the rules, from all of a trainee's sessions in chronological order. Incomplete
/// sessions do not meet the criterion, and sessions that were frozen or rewound do not count.
#[must_use]
pub fn progress(records: &[SessionRecord], rules: &PlanRules, language: Language) -> Vec<DrillProgress> {
    rules.drills.iter().map(|drill| progress_on(records, drill, rules, language)).collect()
}

fn progress_on(records: &[SessionRecord], drill: &DrillCriterion, rules: &PlanRules, language: Language) -> DrillProgress {
    let flown: Vec<&SessionRecord> = records.iter().filter(|record| record.scenario == drill.scenario).collect();
    let unaided: Vec<&SessionRecord> = flown.iter().copied().filter(|record| record.is_unaided()).collect();
    let results: Vec<bool> = unaided.iter().filter_map(|record| result_at_standard_level(record, drill)).collect();
    let latest = &results[results.len().saturating_sub(rules.mastery_of)..];
    let met = latest.iter().filter(|met| **met).count();
    let or_harder = |level: u8| text!(language, "plan-level-or-harder", level = level.to_string());
    let standard = drill.difficulty.as_ref().map(|difficulty| or_harder(difficulty.standard));
    let limits: Vec<String> = drill.limits.iter().map(|limit| limit_words(limit, language)).chain(standard).collect();
    DrillProgress {
        scenario: drill.scenario.clone(),
        sessions: flown.len(),
        met,
        counted: latest.len(),
        needed: rules.mastery_needed,
        of: rules.mastery_of,
        done: met >= rules.mastery_needed,
        last_unix_us: flown.last().map(|record| record.started_unix_us),
        criterion: text!(language, "plan-criterion", limits = limits.join(", ")),
        next_level: next_level(&unaided, drill, rules, language),
    }
}

/// Returns the level of the drill's next session; `None` if the drill has no levels or difficulty does not adapt.
fn next_level(flown: &[&SessionRecord], drill: &DrillCriterion, rules: &PlanRules, language: Language) -> Option<LevelAdvice> {
    let (difficulty, rule) = (drill.difficulty.as_ref()?, rules.staircase.as_ref()?);
    // A session without a level was flown before the drill had levels, with the values of the standard level.
    let level = |record: &SessionRecord| record.level.map_or(difficulty.standard, |level| level.level);
    let session = |record: &&SessionRecord| StaircaseSession { level: level(record), met: meets_criterion(record, drill) };
    Some(staircase::advice(&flown.iter().map(session).collect::<Vec<_>>(), difficulty, rule, language))
}

/// Returns whether a session met the criterion; `None` if it says nothing about the standard level, because an easier level was
/// mastered or a harder one was not.
fn result_at_standard_level(record: &SessionRecord, drill: &DrillCriterion) -> Option<bool> {
    let met = meets_criterion(record, drill);
    let decides = |level: SessionLevel| staircase::decides(StaircaseSession { level: level.level, met }, level.standard);
    record.level.is_none_or(decides).then_some(met)
}
