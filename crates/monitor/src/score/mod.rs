//! Scores computed from the measures: the four TASBID scores and the certification profile.

pub mod accuracy;
pub mod certification;
pub mod completion;
pub mod conformity;
pub mod efficiency;
pub mod safety;

use serde::Serialize;

/// Scorer version. Increment it with every change that could give the same flight a different score. Scores are
/// compared only within the same version.
pub const SCORER_VERSION: u32 = 3;

/// A score, on its own scale and as a percentage, in full precision. Scores are rounded only for display.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Score {
    /// Result of the formula, clamped to its scale.
    pub raw: f64,
    /// Percentage of the scale, 100 (raw - least) / (greatest - least).
    pub pct: f64,
}

impl Score {
    /// Creates a score from a raw value, clamped to the range from `least` to `greatest`.
    #[must_use]
    pub fn clamped_to_scale(raw: f64, least: f64, greatest: f64) -> Self {
        // Adding 0.0 turns -0.0 into +0.0.
        let raw = raw.clamp(least, greatest) + 0.0;
        Self { raw, pct: (raw - least) / (greatest - least) * 100.0 }
    }
}
