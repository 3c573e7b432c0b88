//! Statistics across trainees and repetitions. The distributions behind p values come from the statrs library. Tests
//! compare all results with SciPy and with values published in the TASBID paper. Results may differ between machines in
//! the last bit, but they do not affect the simulation.

mod correlation;
mod distribution;
mod effect_size;
mod homogeneity;
mod learning;
mod paired;
mod regression;
mod reliability;
mod sample;

pub use correlation::{Correlation, pearson, spearman};
pub use distribution::{TailProbabilities, t_tail_probabilities};
pub use effect_size::{cohens_d, proportion_interval_95};
pub use homogeneity::{Homogeneity, homogeneity};
pub use learning::{LearningCurve, MIN_LEARNING_REPETITIONS, learning_curve};
pub use paired::{PairedTest, holm, paired_t};
pub use regression::{Coefficient, Regression, least_squares, solve};
pub use reliability::{Reliability, reliability};
pub use sample::{BoxPlot, HistogramBin, SampleSummary, box_plot, histogram, mean, quantile, sd, summary};

/// Reason why a statistic cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StatisticsError {
    /// There are too few values.
    #[error("only {n} values; at least {needed} are required")]
    TooFew {
        /// Number of values given.
        n: usize,
        /// Number of values required.
        needed: usize,
    },
    /// Paired lists differ in length.
    #[error("the lists have different lengths: {left} and {right} values")]
    Unpaired {
        /// Length of the first list.
        left: usize,
        /// Length of the second list.
        right: usize,
    },
    /// A value is infinite or NaN.
    #[error("value {at} is {value}, which is not a finite number")]
    NotFinite {
        /// The value's position in the list, from 1.
        at: usize,
        /// The value, which is infinite or NaN.
        value: f64,
    },
    /// A measure is constant, so nothing can be estimated.
    #[error("{0} is constant")]
    Constant(&'static str),
    /// The predictors are linearly dependent.
    #[error("the predictors are collinear in this sample")]
    Collinear,
}

impl StatisticsError {
    fn check_finite(values: &[f64]) -> Result<(), Self> {
        match values.iter().position(|value| !value.is_finite()) {
            Some(k) => Err(Self::NotFinite { at: k + 1, value: values[k] }),
            None => Ok(()),
        }
    }

    fn check_pairs(left: &[f64], right: &[f64], needed: usize) -> Result<(), Self> {
        if left.len() != right.len() {
            return Err(Self::Unpaired { left: left.len(), right: right.len() });
        }
        if left.len() < needed {
            return Err(Self::TooFew { n: left.len(), needed });
        }
        Self::check_finite(left)?;
        Self::check_finite(right)
    }
}
