//! Efficiency (P_E in the TASBID paper): flight time and return.

use super::Score;

/// Computes the efficiency score: the full score up to `time_best_s`, then a linear decrease to 0 at `time_max_s`; -100
/// if the battery failed (X_b).
#[must_use]
pub fn score(seconds: f64, battery_failed: bool, time_best_s: f64, time_max_s: f64) -> Score {
    let over = (seconds - time_best_s).max(0.0);
    let raw = if battery_failed { -100.0 } else { 100.0 - 100.0 * over / (time_max_s - time_best_s) };
    Score::clamped_to_scale(raw, -100.0, 100.0)
}
