//! Accuracy (P_A in the TASBID paper), based on the defects that the pictures show.

use super::Score;

/// Counts from which the F-measure is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DetectionTally {
    /// Number of pictures taken.
    pub taken: usize,
    /// Number of pictures that show at least one new defect.
    pub hits: usize,
    /// Number of distinct defects shown.
    pub found: usize,
    /// Number of defects placed in the scene.
    pub placed: usize,
}

impl DetectionTally {
    /// Returns the number of hits divided by the number of pictures; 0 if no picture was taken.
    #[must_use]
    pub fn precision(&self) -> f64 {
        if self.taken == 0 { 0.0 } else { self.hits as f64 / self.taken as f64 }
    }

    /// Returns the number of defects found divided by the number placed; `None` if no defect was placed.
    #[must_use]
    pub fn recall(&self) -> Option<f64> {
        (self.placed > 0).then(|| self.found as f64 / self.placed as f64)
    }

    /// Returns the F-measure; `None` if no defect was placed. Equals precision for `beta` = 0 and recall for infinite
    /// `beta`.
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

    /// Returns 100 times the F-measure; `None` if no defect was placed.
    #[must_use]
    pub fn score(&self, beta: f64) -> Option<Score> {
        Some(Score::clamped_to_scale(100.0 * self.f_beta(beta)?, 0.0, 100.0))
    }
}
