//! Effect size of the difference between two independent samples, and the interval of a proportion.

use super::{StatisticsError, mean, sd};

/// Half-width of a 95% interval in standard errors (97.5% quantile of the normal distribution).
const STANDARD_ERRORS_95: f64 = 1.959_963_984_540_054;

/// Computes Cohen's d of two independent samples: the difference of the means, second minus first, divided by the pooled
/// standard deviation (Cohen 1988).
///
/// # Errors
/// Fails if a sample has fewer than two values, if a value is not finite, or if neither sample varies.
pub fn cohens_d(first: &[f64], second: &[f64]) -> Result<f64, StatisticsError> {
    for sample in [first, second] {
        StatisticsError::check_finite(sample)?;
    }
    let few = |n: usize| StatisticsError::TooFew { n, needed: 2 };
    let parts = |sample: &[f64]| mean(sample).zip(sd(sample)).ok_or(few(sample.len()));
    let ((first_mean, first_sd), (second_mean, second_sd)) = (parts(first)?, parts(second)?);
    let (a, b) = (first.len() as f64 - 1.0, second.len() as f64 - 1.0);
    let pooled = ((a * first_sd * first_sd + b * second_sd * second_sd) / (a + b)).sqrt();
    if pooled > 0.0 { Ok((second_mean - first_mean) / pooled) } else { Err(StatisticsError::Constant("the measure")) }
}

/// Returns the 95% interval of a proportion, from `hits` of `n` (Wilson 1927); `None` if `n` is zero.
#[must_use]
pub fn proportion_interval_95(hits: usize, n: usize) -> Option<[f64; 2]> {
    let (total, z) = (n as f64, STANDARD_ERRORS_95);
    let share = hits as f64 / total;
    let center = share + z * z / (2.0 * total);
    let reach = z * (share * (1.0 - share) / total + z * z / (4.0 * total * total)).sqrt();
    let scale = 1.0 + z * z / total;
    (n > 0).then(|| [(center - reach) / scale, (center + reach) / scale].map(|end| end.clamp(0.0, 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tolerance for rounding errors in a few operations.
    const ROUNDING_TOLERANCE: f64 = 1e-12;

    #[test]
    fn exact_effect_size_divides_by_the_pooled_deviation() {
        // Variances 1 and 4 with two degrees of freedom each: pooled 2.5.
        let d = cohens_d(&[1.0, 2.0, 3.0], &[4.0, 6.0, 8.0]).unwrap();
        assert!((d - 4.0 / 2.5f64.sqrt()).abs() < ROUNDING_TOLERANCE);
        assert!(cohens_d(&[1.0], &[2.0, 3.0]).is_err());
        assert_eq!(cohens_d(&[5.0, 5.0], &[6.0, 6.0]), Err(StatisticsError::Constant("the measure")));
        assert!(cohens_d(&[1.0, f64::INFINITY], &[2.0, 3.0]).is_err());
    }

    #[test]
    fn val_proportion_interval_matches_newcombe_1998() {
        /// Half a unit of the last printed digit of Newcombe's Table I, method 3.
        const PRINTED: f64 = 0.5e-4;
        for (hits, n, low, high) in
            [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718)]
        {
            let ends = proportion_interval_95(hits, n).unwrap();
            assert!((ends[0] - low).abs() <= PRINTED && (ends[1] - high).abs() <= PRINTED, "{hits} of {n}: {ends:?}");
        }
        assert_eq!(proportion_interval_95(0, 0), None);
    }
}
