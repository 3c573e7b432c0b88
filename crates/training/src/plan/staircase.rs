//! Difficulty level of a drill's next session: a weighted up-down staircase (Kaernbach 1991).

use super::level_settings::level_settings;
use super::rules::StaircaseRule;
use serde::Serialize;
use spandrel_model::scenario::Difficulty;
use spandrel_text::{Language, text};

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

/// Returns the level of a drill's next session and the reason, from its sessions in chronological order.
pub(super) fn advice(
    sessions: &[StaircaseSession],
    difficulty: &Difficulty,
    rule: &StaircaseRule,
    language: Language,
) -> LevelAdvice {
    let level = rule.level_after(sessions, difficulty.standard, difficulty.levels());
    let reason = match sessions.split_last() {
        None => text!(language, "plan-level-start"),
        Some((last, earlier)) => {
            let before = rule.level_after(earlier, difficulty.standard, difficulty.levels());
            reason(*last, (!earlier.is_empty()).then_some(before), language)
        }
    };
    describe(difficulty, level, reason, language)
}

/// Explains how the last session moved the recommendation. `before` is the level that was recommended for it; `None` for the
/// first session.
fn reason(last: StaircaseSession, before: Option<u8>, language: Language) -> String {
    let StaircaseSession { level, met } = last;
    let decided = before.is_none_or(|before| decides(last, before));
    let level = level.to_string();
    match (met, decided) {
        (true, true) => text!(language, "plan-level-met", level = level),
        (false, true) => text!(language, "plan-level-not-met", level = level),
        (true, false) => text!(language, "plan-level-met-easier", level = level),
        (false, false) => text!(language, "plan-level-not-met-harder", level = level),
    }
}

fn describe(difficulty: &Difficulty, level: u8, reason: String, language: Language) -> LevelAdvice {
    let (levels, settings) = (difficulty.levels(), difficulty.settings_at(level).to_owned());
    let words = text!(
        language,
        "plan-level",
        level = level.to_string(),
        levels = levels.to_string(),
        settings = level_settings(&settings, language),
        reason = reason
    );
    LevelAdvice { level, levels, standard: difficulty.standard, settings, words }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{DEFAULT_RULES, read_rules};
    use spandrel_model::math;
    use spandrel_model::random::RandomStream;

    const LEVELS: u8 = 9;
    const STANDARD: u8 = 5;
    /// Number of sessions in a simulation.
    const SESSIONS: usize = 6000;
    /// Sessions before the staircase has settled: far more than the eight steps across all levels.
    const SETTLING: usize = 100;
    /// Largest difference between the fraction of sessions that meet the criterion and the target. A random walk of 5900 sessions
    /// has a standard error of at most 0.0065 if the results were independent; this is about three of them.
    const FRACTION_TOLERANCE: f64 = 0.02;
    /// Largest difference between the mean level and the level at which the target would be met exactly. Steps of 1 and 2 on whole
    /// levels spread the level around it, and a curved psychometric function shifts the mean.
    const LEVEL_TOLERANCE: f64 = 0.6;

    fn shipped() -> StaircaseRule {
        read_rules("rules.toml", DEFAULT_RULES).unwrap().staircase.unwrap()
    }

    /// Parses sessions such as "5+ 6-": level and whether the criterion was met.
    fn parse(text: &str) -> Vec<StaircaseSession> {
        let one = |word: &str| StaircaseSession { level: word[..1].parse().unwrap(), met: word.ends_with('+') };
        text.split_whitespace().map(one).collect()
    }

    #[test]
    fn exact_shipped_staircase_targets_two_of_three() {
        assert_eq!(shipped(), StaircaseRule { first: 0, up: 1, down: 2 });
        // Kaernbach 1991: at equilibrium, up * p = down * (1 - p).
        let rule = shipped();
        let (harder, easier) = (f64::from(rule.up) * rule.target(), f64::from(rule.down) * (1.0 - rule.target()));
        assert!((harder - easier).abs() < f64::EPSILON, "{harder} and {easier}");
        let rules = read_rules("rules.toml", DEFAULT_RULES).unwrap();
        assert_eq!(rule.target(), rules.mastery_needed as f64 / rules.mastery_of as f64);
    }

    #[test]
    fn exact_sequences_of_sessions_lead_to_their_level() {
        let expected = [
            ("", 5),
            ("5+", 6),
            ("5-", 3),
            ("5+ 6+ 7-", 5),
            ("5- 3- 1-", 1),
            ("5+ 6+ 7+ 8+ 9+", 9),
            // The first session counts at any level.
            ("2+", 3),
            ("8-", 6),
            // Easier than recommended and met, or harder and not met: the recommendation stays.
            ("5+ 3+", 6),
            ("5+ 9-", 6),
            // Harder and met, or easier and not met: the session counts from its own level.
            ("5+ 8+", 9),
            ("5+ 4-", 2),
            ("5+ 6- 4+ 5+", 6),
        ];
        for (sessions, level) in expected {
            assert_eq!(shipped().level_after(&parse(sessions), STANDARD, LEVELS), level, "{sessions}");
        }
        let easier = StaircaseRule { first: -2, up: 2, down: 6 };
        assert_eq!((easier.level_after(&[], STANDARD, LEVELS), easier.target()), (3, 0.75));
        assert_eq!(easier.level_after(&parse("3+ 5+ 7-"), STANDARD, LEVELS), 1);
        assert_eq!(StaircaseRule { first: 19, up: 1, down: 2 }.level_after(&[], STANDARD, LEVELS), LEVELS);
    }

    /// Simulates a trainee who meets the criterion with a probability that falls with the level (a logistic function with the
    /// given slope, one half at level `half`). Returns the fraction of sessions that met it and the mean level.
    fn simulate(rule: StaircaseRule, seed: u64, half: f64, slope: f64) -> (f64, f64) {
        let mut random = RandomStream::new(seed, "test.staircase");
        let mut sessions: Vec<StaircaseSession> = Vec::new();
        let mut level = rule.level_after(&[], STANDARD, LEVELS);
        for _ in 0..SESSIONS {
            let probability = 1.0 / (1.0 + math::exp(slope * (f64::from(level) - half)));
            let session = StaircaseSession { level, met: random.uniform() < probability };
            sessions.push(session);
            // The recommendation was followed, so the next one depends on the last session only.
            level = rule.level_after(&[session], STANDARD, LEVELS);
        }
        assert_eq!(rule.level_after(&sessions, STANDARD, LEVELS), level, "seed {seed}");
        let settled = &sessions[SETTLING..];
        let count = settled.len() as f64;
        let met = settled.iter().filter(|session| session.met).count() as f64;
        (met / count, settled.iter().map(|session| f64::from(session.level)).sum::<f64>() / count)
    }

    #[test]
    fn prop_staircase_settles_where_the_target_is_met() {
        let rule = shipped();
        let target = rule.target();
        for seed in 0..8 {
            for (half, slope) in [(5.0, 1.0), (6.0, 1.0), (5.5, 2.0), (6.5, 1.5)] {
                let (fraction, mean_level) = simulate(rule, seed, half, slope);
                assert!((fraction - target).abs() <= FRACTION_TOLERANCE, "seed {seed}, {half}, {slope}: {fraction}");
                let exact = half - math::ln(target / (1.0 - target)) / slope;
                assert!((mean_level - exact).abs() <= LEVEL_TOLERANCE, "seed {seed}, {half}, {slope}: {mean_level} and {exact}");
            }
        }
    }

    #[test]
    fn exact_reasons_name_the_last_session() {
        let words = |sessions: &str| {
            let sessions = parse(sessions);
            let (last, earlier) = sessions.split_last().unwrap();
            reason(*last, (!earlier.is_empty()).then(|| shipped().level_after(earlier, STANDARD, LEVELS)), Language::English)
        };
        assert_eq!(words("5+"), "the last session met the criterion at level 5");
        assert_eq!(words("5+ 6-"), "the last session did not meet the criterion at level 6");
        assert_eq!(words("5+ 4+"), "the last session met the criterion at level 4, which is easier than recommended");
        assert_eq!(words("5+ 8-"), "the last session did not meet the criterion at level 8, which is harder than recommended");
    }
}
