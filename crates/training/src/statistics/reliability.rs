//! Test-retest reliability of a measure: the share of its variance that distinguishes trainees, and its error in the
//! measure's unit. Based on the two-way analysis of variance of trainees by repetitions without replication.

use super::StatisticsError;
use serde::Serialize;

/// Half-width of a 95% interval in standard errors (97.5% quantile of the normal distribution).
const STANDARD_ERRORS_95: f64 = 1.959_963_984_540_054;

/// Reliability of a measure that was taken the same number of times from each trainee.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Reliability {
    /// Number of trainees.
    pub n: usize,
    /// Number of values per trainee.
    pub repetitions: usize,
    /// ICC(2,1) of Shrout and Fleiss (1979): absolute agreement of single values, at most 1. A change that all trainees
    /// share, such as practice, lowers it.
    pub icc_2_1: f64,
    /// ICC(3,1) of Shrout and Fleiss (1979): consistency of single values, at most 1. A change that all trainees share
    /// does not affect it.
    pub icc_3_1: f64,
    /// Standard error of measurement, in the measure's unit: the square root of the residual mean square, which a change
    /// that all trainees share does not affect (Weir 2005).
    pub sem: f64,
    /// Smallest change between two values of one trainee that exceeds the measurement error with 95% confidence, in the
    /// measure's unit: 1.96 √2 SEM (Weir 2005).
    pub minimal_detectable_change: f64,
}

impl Reliability {
    /// Returns the smallest change of the mean of `n` trainees that exceeds the measurement error with 95% confidence:
    /// the error of a mean is smaller by the square root of `n`.
    #[must_use]
    pub fn minimal_detectable_mean_change(&self, n: usize) -> f64 {
        self.minimal_detectable_change / (n.max(1) as f64).sqrt()
    }
}

/// Computes the reliability from one list of values per trainee, in order of the repetitions.
///
/// # Errors
/// Fails if there are fewer than two trainees or two values per trainee, if the lists differ in length, if a value is
/// not finite, or if all values are equal.
pub fn reliability(trainees: &[Vec<f64>]) -> Result<Reliability, StatisticsError> {
    let n = trainees.len();
    if n < 2 {
        return Err(StatisticsError::TooFew { n, needed: 2 });
    }
    let repetitions = trainees[0].len();
    for values in trainees {
        StatisticsError::check_pairs(&trainees[0], values, 2)?;
    }
    let squares = MeanSquares::of(trainees, repetitions);
    if squares.trainees <= 0.0 && squares.repetitions <= 0.0 && squares.residual <= 0.0 {
        return Err(StatisticsError::Constant("the measure"));
    }
    let (rows, k) = (n as f64, repetitions as f64);
    let distinguishing = squares.trainees - squares.residual;
    let consistency = squares.trainees + (k - 1.0) * squares.residual;
    let agreement = consistency + k * (squares.repetitions - squares.residual) / rows;
    // If only the repetitions differ, no variance distinguishes the trainees.
    let share = |of: f64| if of > 0.0 { distinguishing / of } else { 0.0 };
    let sem = squares.residual.sqrt();
    Ok(Reliability {
        n,
        repetitions,
        icc_2_1: share(agreement),
        icc_3_1: share(consistency),
        sem,
        minimal_detectable_change: STANDARD_ERRORS_95 * std::f64::consts::SQRT_2 * sem,
    })
}

/// Mean squares of the two-way analysis of variance.
struct MeanSquares {
    trainees: f64,
    repetitions: f64,
    residual: f64,
}

impl MeanSquares {
    fn of(trainees: &[Vec<f64>], repetitions: usize) -> Self {
        let (n, k) = (trainees.len() as f64, repetitions as f64);
        // Measured from one of the values, so that equal values give exactly zero.
        let origin = trainees[0][0];
        let centered = |values: &[f64]| values.iter().map(|value| value - origin).collect::<Vec<_>>();
        let trainees: Vec<Vec<f64>> = trainees.iter().map(|values| centered(values)).collect();
        let by_trainee: Vec<f64> = trainees.iter().map(|values| values.iter().sum::<f64>() / k).collect();
        let by_repetition: Vec<f64> =
            (0..repetitions).map(|j| trainees.iter().map(|values| values[j]).sum::<f64>() / n).collect();
        let grand = by_trainee.iter().sum::<f64>() / n;
        let spread = |means: &[f64]| means.iter().map(|mean| (mean - grand) * (mean - grand)).sum::<f64>();
        let off = |i: usize, j: usize| trainees[i][j] - by_trainee[i] - by_repetition[j] + grand;
        let residual: f64 =
            (0..trainees.len()).flat_map(|i| (0..repetitions).map(move |j| (i, j))).map(|(i, j)| off(i, j) * off(i, j)).sum();
        Self {
            trainees: k * spread(&by_trainee) / (n - 1.0),
            repetitions: n * spread(&by_repetition) / (k - 1.0),
            residual: residual / ((n - 1.0) * (k - 1.0)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tolerance for rounding errors in a few dozen operations.
    const ROUNDING_TOLERANCE: f64 = 1e-12;

    /// Table 2 of Shrout and Fleiss (1979): six targets, rated by four judges.
    fn shrout_and_fleiss() -> Vec<Vec<f64>> {
        [[9, 2, 5, 8], [6, 1, 3, 2], [8, 4, 6, 8], [7, 1, 2, 6], [10, 5, 6, 9], [6, 2, 4, 7]]
            .map(|row| row.map(f64::from).to_vec())
            .to_vec()
    }

    #[test]
    fn val_intraclass_correlations_match_shrout_and_fleiss_1979() {
        /// Half a unit of the last printed digit.
        const PRINTED: f64 = 0.005;
        let rated = reliability(&shrout_and_fleiss()).unwrap();
        assert_eq!((rated.n, rated.repetitions), (6, 4));
        // Their Table 4 prints .29 and .71; their Table 3 a residual mean square of 1.02.
        assert!((rated.icc_2_1 - 0.29).abs() < PRINTED && (rated.icc_3_1 - 0.71).abs() < PRINTED, "{rated:?}");
        assert!((rated.sem * rated.sem - 1.02).abs() < PRINTED, "{rated:?}");
    }

    #[test]
    fn exact_shared_change_lowers_agreement_but_not_consistency_or_error() {
        let rows: Vec<Vec<f64>> = [10.0, 20.0, 30.0].map(|first: f64| vec![first, first + 6.0]).to_vec();
        let changed = reliability(&rows).unwrap();
        assert!(changed.sem < ROUNDING_TOLERANCE && (changed.icc_3_1 - 1.0).abs() < ROUNDING_TOLERANCE);
        // Mean squares 200, 54 and 0: 200 / (200 + 2 * 54 / 3) = 200 / 236.
        assert!((changed.icc_2_1 - 200.0 / 236.0).abs() < ROUNDING_TOLERANCE, "{changed:?}");
    }

    #[test]
    fn exact_two_repetitions_give_the_error_of_their_differences() {
        // Differences 1, 2 and 6: mean 3, variance 7, so the residual mean square is 3.5.
        let rated = reliability(&[vec![1.0, 2.0], vec![5.0, 7.0], vec![9.0, 15.0]]).unwrap();
        assert!((rated.sem - 3.5f64.sqrt()).abs() < ROUNDING_TOLERANCE);
        let expected = STANDARD_ERRORS_95 * 7.0f64.sqrt();
        assert!((rated.minimal_detectable_change - expected).abs() < ROUNDING_TOLERANCE);
        assert!((rated.minimal_detectable_mean_change(4) - expected / 2.0).abs() < ROUNDING_TOLERANCE);
    }

    #[test]
    fn exact_constant_and_incomplete_data_have_no_reliability() {
        assert_eq!(reliability(&[vec![100.1; 3], vec![100.1; 3]]), Err(StatisticsError::Constant("the measure")));
        assert!(reliability(&[vec![1.0, 2.0]]).is_err() && reliability(&[vec![1.0], vec![2.0]]).is_err());
        assert!(reliability(&[vec![1.0, 2.0], vec![2.0]]).is_err());
        assert!(reliability(&[vec![1.0, f64::NAN], vec![2.0, 3.0]]).is_err());
        // Trainees that cannot be told apart: no agreement, rather than a division by zero.
        let same = reliability(&[vec![1.0, 2.0], vec![1.0, 2.0]]).unwrap();
        assert_eq!((same.icc_2_1, same.icc_3_1, same.sem), (0.0, 0.0, 0.0));
    }
}
