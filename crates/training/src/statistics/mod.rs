//! Statistics over trainees and repetitions. The distributions behind the p values are those of the library statrs; tests compare every
//! figure with SciPy's and with the values that the project's paper prints. These numbers describe people, they steer no flight: the
//! library's own logarithms may differ in the last bit between machines.

mod correlation;
mod distribution;
mod homogeneity;
mod learning;
mod paired;
mod regression;
mod sample;

pub use correlation::{Correlation, pearson, spearman};
pub use distribution::{TailProbabilities, tails_of_t};
pub use homogeneity::{Homogeneity, homogeneity};
pub use learning::{LEARNING_NEEDS, LearningCurve, learning_curve};
pub use paired::{PairedTest, holm, paired_t};
pub use regression::{Coefficient, Regression, least_squares, solve};
pub use sample::{BoxPlot, HistogramBin, SampleSummary, box_plot, histogram, mean, quantile, sd, summary};

/// Why there is no figure.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StatisticsError {
    /// Too few values.
    #[error("{n} values, and {needed} are needed")]
    TooFew {
        /// Values given.
        n: usize,
        /// Values needed.
        needed: usize,
    },
    /// Two lists that should belong together differ in length.
    #[error("{left} values cannot be paired with {right}")]
    Unpaired {
        /// One length.
        left: usize,
        /// The other.
        right: usize,
    },
    /// A value is infinite or no number.
    #[error("value {at} is {value}, which is no finite number")]
    NotFinite {
        /// Position, from 1.
        at: usize,
        /// The value.
        value: f64,
    },
    /// Nothing varies, so that nothing can be estimated.
    #[error("{0} does not vary")]
    Constant(&'static str),
    /// Predictors say the same as one another.
    #[error("the predictors cannot be told apart in this sample")]
    Collinear,
}

impl StatisticsError {
    fn finite(values: &[f64]) -> Result<(), Self> {
        match values.iter().position(|value| !value.is_finite()) {
            Some(k) => Err(Self::NotFinite { at: k + 1, value: values[k] }),
            None => Ok(()),
        }
    }

    fn pairs(left: &[f64], right: &[f64], needed: usize) -> Result<(), Self> {
        if left.len() != right.len() {
            return Err(Self::Unpaired { left: left.len(), right: right.len() });
        }
        if left.len() < needed {
            return Err(Self::TooFew { n: left.len(), needed });
        }
        Self::finite(left)?;
        Self::finite(right)
    }
}
