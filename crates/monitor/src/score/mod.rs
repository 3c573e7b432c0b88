//! From measures to scores: the paper's four, and the certification profile beside them.

pub mod accuracy;
pub mod certification;
pub mod completion;
pub mod conformity;
pub mod efficiency;
pub mod safety;

use serde::Serialize;

/// Version of the scorer: it grows whenever the same flight may get other scores, so that records know which of them compare.
pub const SCORER_VERSION: u32 = 2;

/// A score on its own scale and on 0 to 100. Full precision; only what is shown is rounded.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Score {
    /// As the formula gives it.
    pub raw: f64,
    /// (raw - least) / (greatest - least) * 100.
    pub pct: f64,
}

impl Score {
    /// A raw value on the scale from `least` to `greatest`, clamped into it.
    #[must_use]
    pub fn on_scale(raw: f64, least: f64, greatest: f64) -> Self {
        // Adding 0 turns -0 into 0.
        let raw = raw.clamp(least, greatest) + 0.0;
        Self { raw, pct: (raw - least) / (greatest - least) * 100.0 }
    }
}
