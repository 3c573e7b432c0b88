//! Difficulty level of a drill's next session: a weighted up-down staircase (Kaernbach 1991).

use super::mastery::meets_criterion;
use super::rules::{DrillCriterion, StaircaseRule};
use crate::record::SessionRecord;
use serde::Serialize;
use spandrel_model::scenario::Difficulty;

/// Recommended difficulty level of a drill.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LevelAdvice {
    /// Recommended level, from 1 (easiest).
    pub level: u8,
    /// Number of levels.
    pub levels: u8,
    /// Standard level, at which the scenario file's own values apply. Mastery refers to it.
    pub standard: u8,
    /// Values at this level as text.
    pub settings: String,
    /// Level and reason as text, such as "Level 6 of 9 (wind 2.73 m/s): the last session met the criterion at level 5."
    pub words: String,
}

/// A session, as far as the staircase depends on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StaircaseSession {
    /// Level at which the session was flown.
    pub level: u8,
    /// Whether the session met the criterion. An incomplete session did not.
    pub met: bool,
}

impl StaircaseRule {
    /// Returns the recommended level after sessions in chronological order, from 1 to the number of levels. A session moves the
    /// recommendation up or down from the level at which it was flown. A success at an easier level than recommended, and a
    /// failure at a harder one, say nothing about the recommended level, so it stays. The first session always counts.
    #[must_use]
    pub fn level_after(&self, sessions: &[StaircaseSession], standard: u8, levels: u8) -> u8 {
        let clamp = |level: i16| u8::try_from(level.clamp(1, i16::from(levels))).unwrap_or(1);
        let first = clamp(i16::from(standard) + i16::from(self.first));
        sessions.iter().enumerate().fold(first, |recommended, (number, session)| {
            let flown = i16::from(session.level);
            if number > 0 && !decides(*session, recommended) {
                return recommended;
            }
            clamp(if session.met { flown + i16::from(self.up) } else { flown - i16::from(self.down) })
        })
    }
}

/// Returns whether a session decides about a level: who meets the criterion at a harder level meets it at this one, and who
/// does not meet it at an easier level does not meet it at this one.
pub(super) fn decides(session: StaircaseSession, level: u8) -> bool {
    if session.met { session.level >= level } else { session.level <= level }
}

/// Returns a drill's sessions in the order of the records.
pub(super) fn sessions(records: &[SessionRecord], drill: &DrillCriterion) -> Vec<StaircaseSession> {
    let flown = records.iter().filter(|record| record.scenario == drill.scenario);
    let standard = drill.difficulty.as_ref().map(|difficulty| difficulty.standard);
    // A session without a level was flown before the drill had levels, with the values of the standard level.
    let level = |record: &SessionRecord| record.level.map(|one| one.level).or(standard).unwrap_or(1);
    flown.map(|record| StaircaseSession { level: level(record), met: meets_criterion(record, drill) }).collect()
}

/// Returns the level of a drill's next session and the reason; `None` if the drill has no levels.
pub(super) fn advice(records: &[SessionRecord], drill: &DrillCriterion, rule: &StaircaseRule) -> Option<LevelAdvice> {
    let difficulty = drill.difficulty.as_ref()?;
    let sessions = sessions(records, drill);
    let level = rule.level_after(&sessions, difficulty.standard, difficulty.levels());
    let reason = match sessions.split_last() {
        None => "start at this level".to_owned(),
        Some((last, earlier)) => {
            let before = rule.level_after(earlier, difficulty.standard, difficulty.levels());
            reason(*last, (!earlier.is_empty()).then_some(before))
        }
    };
    Some(describe(difficulty, level, &reason))
}

/// Explains how the last session moved the recommendation. `before` is the level that was recommended for it; `None` for the
/// first session.
fn reason(last: StaircaseSession, before: Option<u8>) -> String {
    let StaircaseSession { level, met } = last;
    let result = if met { "met" } else { "did not meet" };
    let result = format!("the last session {result} the criterion at level {level}");
    match before.filter(|before| !decides(last, *before)) {
        None => result,
        Some(_) if met => format!("{result}, which is easier than recommended"),
        Some(_) => format!("{result}, which is harder than recommended"),
    }
}

fn describe(difficulty: &Difficulty, level: u8, reason: &str) -> LevelAdvice {
    let (levels, settings) = (difficulty.levels(), difficulty.settings_at(level).to_owned());
    let words = format!("Level {level} of {levels} ({settings}): {reason}.");
    LevelAdvice { level, levels, standard: difficulty.standard, settings, words }
}
