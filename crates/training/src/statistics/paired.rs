//! Paired t tests for changes within the same trainees.

use super::distribution::{TailProbabilities, t_quantile, t_tail_probabilities};
use super::{StatisticsError, mean, sd};
use serde::Serialize;

/// Cumulative probability at the upper bound of a 95% interval.
pub(super) const UPPER_PROBABILITY_95: f64 = 0.975;

/// Result of a paired t test of later minus earlier values.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PairedTest {
    /// Number of pairs.
    pub n: usize,
    /// Mean difference, later minus earlier.
    pub mean_difference: f64,
    /// Standard deviation of the differences, with n - 1 in the denominator.
    pub sd_difference: f64,
    /// Degrees of freedom.
    pub df: usize,
    /// t statistic; `None` if all differences are equal.
    pub t: Option<f64>,
    /// p values; `None` if `t` is `None`.
    pub p: Option<TailProbabilities>,
    /// Cohen's d for pairs: mean difference divided by the standard deviation of the differences; `None` if `t` is
    /// `None`.
    pub effect_size_dz: Option<f64>,
    /// 95% confidence interval of the mean difference.
    pub interval_95: [f64; 2],
}

/// Compares earlier and later values for the same trainees.
///
/// # Errors
/// Fails if the lists differ in length, if there are fewer than two pairs, or if a value is not finite.
pub fn paired_t(earlier: &[f64], later: &[f64]) -> Result<PairedTest, StatisticsError> {
    StatisticsError::check_pairs(earlier, later, 2)?;
    let differences: Vec<f64> = earlier.iter().zip(later).map(|(earlier, later)| later - earlier).collect();
    let n = differences.len();
    let (mean, sd) = (mean(&differences).unwrap_or_default(), sd(&differences).unwrap_or_default());
    let error = sd / (n as f64).sqrt();
    let df = n - 1;
    let t = (error > 0.0).then(|| mean / error);
    let reach = error * t_quantile(UPPER_PROBABILITY_95, df as f64).unwrap_or_default();
    Ok(PairedTest {
        n,
        mean_difference: mean,
        sd_difference: sd,
        df,
        t,
        p: t.and_then(|t| t_tail_probabilities(t, df as f64)),
        effect_size_dz: t.map(|_| mean / sd),
        interval_95: [mean - reach, mean + reach],
    })
}

/// Returns the Holm-corrected p values of one family (Holm 1979), in the given order.
#[must_use]
pub fn holm(p: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|a, b| p[*a].total_cmp(&p[*b]));
    let mut corrected = vec![0.0; p.len()];
    let mut least: f64 = 0.0;
    for (rank, k) in order.into_iter().enumerate() {
        least = least.max((p[k] * (p.len() - rank) as f64).min(1.0));
        corrected[k] = least;
    }
    corrected
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tolerance for rounding errors in a few operations.
    const ROUNDING_TOLERANCE: f64 = 1e-12;

    #[test]
    fn exact_paired_test_matches_closed_form() {
        // Mean 2, standard deviation 1, t = 2 sqrt 3. With two degrees of freedom, the upper tail is 1/2 - t / (2 sqrt (2 +
        // t^2)).
        let test = paired_t(&[10.0, 20.0, 30.0], &[11.0, 22.0, 33.0]).unwrap();
        let t = 2.0 * 3.0f64.sqrt();
        assert_eq!((test.n, test.df, test.mean_difference, test.sd_difference), (3, 2, 2.0, 1.0));
        assert!((test.t.unwrap() - t).abs() < ROUNDING_TOLERANCE);
        assert!((test.p.unwrap().upper - (0.5 - t / (2.0 * (2.0 + t * t).sqrt()))).abs() < ROUNDING_TOLERANCE);
        assert_eq!(test.effect_size_dz, Some(2.0));
        // The 97.5% quantile with two degrees of freedom is 0.95 sqrt (2 / (1 - 0.95^2)).
        let reach = 0.95 * (2.0f64 / (1.0 - 0.95 * 0.95)).sqrt() / 3.0f64.sqrt();
        assert!((test.interval_95[0] - (2.0 - reach)).abs() < 1e-9 && (test.interval_95[1] - (2.0 + reach)).abs() < 1e-9);
    }

    #[test]
    fn exact_equal_differences_have_no_t_statistic() {
        let test = paired_t(&[1.0, 2.0], &[3.0, 4.0]).unwrap();
        assert_eq!((test.t, test.p, test.effect_size_dz, test.interval_95), (None, None, None, [2.0, 2.0]));
        assert!(paired_t(&[1.0], &[2.0]).is_err());
        assert!(paired_t(&[1.0, 2.0], &[2.0]).is_err());
    }

    #[test]
    fn exact_holm_correction_matches_hand_calculation() {
        // Expected by hand: 0.01 x 4, 0.02 x 3, 0.03 x 2 (raised to the preceding 0.06), 0.9 x 1.
        let corrected = holm(&[0.03, 0.01, 0.9, 0.02]);
        for (ours, hand) in corrected.iter().zip([0.06, 0.04, 0.9, 0.06]) {
            assert!((ours - hand).abs() < ROUNDING_TOLERANCE, "{corrected:?}");
        }
        assert_eq!(holm(&[0.6, 0.7]), [1.0, 1.0]);
        assert!(holm(&[]).is_empty());
    }
}
