//! Accuracy (the paper's P_A): defects shown in the pictures.

use super::Score;

/// Counts for the F-measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MatchCounts {
    /// Pictures taken.
    pub taken: usize,
    /// Pictures that are the first to show at least one defect.
    pub hits: usize,
    /// Distinct defects shown.
    pub found: usize,
    /// Defects placed.
    pub placed: usize,
}

impl MatchCounts {
    /// Returns hits per picture; 0 if no picture was taken.
    #[must_use]
    pub fn precision(&self) -> f64 {
        if self.taken == 0 { 0.0 } else { self.hits as f64 / self.taken as f64 }
    }

    /// Returns defects found per defect placed; `None` if none was placed.
    #[must_use]
    pub fn recall(&self) -> Option<f64> {
        (self.placed > 0).then(|| self.found as f64 / self.placed as f64)
    }

    /// Returns the F-measure; `None` if no defect was placed. With `beta` 0 it equals precision, with infinity recall.
    #[must_use]
    pub fn f_beta(&self, beta: f64) -> Option<f64> {
        let recall = self.recall()?;
        let precision = self.precision();
        if self.hits == 0 {
            return Some(0.0);
        }
        if beta.is_infinite() {
            return Some(recall);
        }
        let b2 = beta * beta;
        Some((1.0 + b2) * precision * recall / (b2 * precision + recall))
    }

    /// Returns 100 F; `None` if accuracy does not apply.
    #[must_use]
    pub fn score(&self, beta: f64) -> Option<Score> {
        Some(Score::on_scale(100.0 * self.f_beta(beta)?, 0.0, 100.0))
    }
}
