//! Difficulty level of a session.

use serde::{Deserialize, Serialize};
use spandrel_model::scenario::Difficulty;

/// Difficulty level at which a session was flown, with the scenario's levels at that time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct SessionLevel {
    /// Level, from 1 (easiest).
    pub level: u8,
    /// Number of levels.
    pub levels: u8,
    /// Standard level, at which the scenario file's own values apply.
    pub standard: u8,
}

impl SessionLevel {
    /// Returns the selected level of a scenario.
    #[must_use]
    pub fn of(difficulty: &Difficulty) -> Self {
        Self { level: difficulty.level, levels: difficulty.levels(), standard: difficulty.standard }
    }

    /// Returns a scenario's name, followed by `@` and a level other than the standard one.
    #[must_use]
    pub fn named(scenario: &str, level: Option<Self>) -> String {
        let other = level.filter(|level| level.level != level.standard);
        other.map_or_else(|| scenario.to_owned(), |level| format!("{scenario}@{}", level.level))
    }

    /// Validates the numbers in a record read from storage.
    pub(super) fn check(self) -> Result<(), String> {
        let inside = |number: u8| (1..=self.levels).contains(&number);
        if inside(self.level) && inside(self.standard) {
            return Ok(());
        }
        Err(format!("level.level = {}, level.standard = {} (allowed: 1 to {})", self.level, self.standard, self.levels))
    }
}
