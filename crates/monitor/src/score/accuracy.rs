//! Accuracy (the paper's P_A): what the pictures show.

use super::Score;

/// Counts behind the F-measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MatchCounts {
    /// Pictures taken.
    pub taken: usize,
    /// Pictures that show at least one defect for the first time.
    pub hits: usize,
    /// Distinct defects shown.
    pub found: usize,
    /// Defects placed.
    pub placed: usize,
}

impl MatchCounts {
    /// Hits per picture; 0 without a picture.
    #[must_use]
    pub fn precision(&self) -> f64 {
        if self.taken == 0 { 0.0 } else { self.hits as f64 / self.taken as f64 }
    }

    /// Defects found per defect placed; `None` when none was placed.
    #[must_use]
    pub fn recall(&self) -> Option<f64> {
        (self.placed > 0).then(|| self.found as f64 / self.placed as f64)
    }

    /// F-measure; `None` when no defect was placed. `beta` 0 is precision, infinity is recall.
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

    /// 100 F; `None` when accuracy does not apply.
    #[must_use]
    pub fn score(&self, beta: f64) -> Option<Score> {
        Some(Score::on_scale(100.0 * self.f_beta(beta)?, 0.0, 100.0))
    }
}
