//! Functions for the t, chi-squared and F distributions, based on the statistics library.

use serde::Serialize;
use statrs::distribution::{ChiSquared, Continuous, ContinuousCDF, FisherSnedecor, StudentsT};

/// Number of Newton steps that refine the library's quantile (accurate to about 1e-6) to machine precision. Each step
/// doubles the number of correct digits.
const NEWTON_STEPS: usize = 4;

/// One- and two-tailed p values of a t statistic.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TailProbabilities {
    /// Upper-tail probability; tests for an increase.
    pub upper: f64,
    /// Lower-tail probability; tests for a decrease.
    pub lower: f64,
    /// Two-tailed probability; tests for a change in either direction.
    pub two: f64,
}

/// Returns the p values of `t` with `df` degrees of freedom; `None` if `df` is not positive or `t` is NaN.
#[must_use]
pub fn t_tail_probabilities(t: f64, df: f64) -> Option<TailProbabilities> {
    let student = student_t_distribution(df)?;
    if t.is_nan() {
        return None;
    }
    let (lower, upper) = (student.cdf(t), student.sf(t));
    Some(TailProbabilities { upper, lower, two: (2.0 * lower.min(upper)).min(1.0) })
}

/// Returns the quantile of the t distribution for probability `share`.
pub(super) fn t_quantile(share: f64, df: f64) -> Option<f64> {
    let student = student_t_distribution(df).filter(|_| share > 0.0 && share < 1.0)?;
    let mut t = student.inverse_cdf(share);
    for _ in 0..NEWTON_STEPS {
        let slope = student.pdf(t);
        if slope > 0.0 {
            t -= (student.cdf(t) - share) / slope;
        }
    }
    t.is_finite().then_some(t)
}

/// Returns the upper-tail probability of the chi-squared distribution with `df` degrees of freedom.
pub(super) fn chi_squared_upper_tail(statistic: f64, df: f64) -> Option<f64> {
    let distribution = ChiSquared::new(df).ok()?;
    (statistic >= 0.0).then(|| distribution.sf(statistic))
}

/// Returns the upper-tail probability of the F distribution.
pub(super) fn f_upper_tail(statistic: f64, df_model: f64, df_residual: f64) -> Option<f64> {
    let distribution = FisherSnedecor::new(df_model, df_residual).ok()?;
    (statistic >= 0.0).then(|| if statistic.is_finite() { distribution.sf(statistic) } else { 0.0 })
}

fn student_t_distribution(df: f64) -> Option<StudentsT> {
    StudentsT::new(0.0, 1.0, df).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tolerance for rounding errors in the library's functions.
    const TOLERANCE: f64 = 1e-12;

    #[test]
    fn exact_t_with_one_degree_of_freedom_is_cauchy() {
        // Closed form for one degree of freedom: P(T > 1) = 1/4; the 97.5% quantile is tan(0.475 pi).
        let tails = t_tail_probabilities(1.0, 1.0).unwrap();
        assert!(
            (tails.upper - 0.25).abs() < TOLERANCE
                && (tails.lower - 0.75).abs() < TOLERANCE
                && (tails.two - 0.5).abs() < TOLERANCE
        );
        let exact = spandrel_model::math::tan(0.475 * spandrel_model::math::PI);
        assert!((t_quantile(0.975, 1.0).unwrap() - exact).abs() < 1e-9 * exact);
        assert!(t_tail_probabilities(1.0, 0.0).is_none() && t_tail_probabilities(f64::NAN, 3.0).is_none());
    }

    #[test]
    fn exact_chi_squared_with_two_degrees_of_freedom_is_exponential() {
        let exact = spandrel_model::math::exp(-1.5);
        assert!((chi_squared_upper_tail(3.0, 2.0).unwrap() - exact).abs() < TOLERANCE);
    }

    #[test]
    fn exact_f_with_two_and_two_degrees_of_freedom_has_closed_form() {
        // P(F > x) = 1 / (1 + x) for 2 and 2 degrees of freedom.
        assert!((f_upper_tail(3.0, 2.0, 2.0).unwrap() - 0.25).abs() < TOLERANCE);
        assert_eq!(f_upper_tail(f64::INFINITY, 2.0, 2.0), Some(0.0));
    }

    #[test]
    fn val_p_values_match_tasbid_table() {
        /// Half a unit of the table's last digit, plus a margin because its t values are rounded (0.475 by up to 1e-7).
        const TABLE_TOLERANCE: f64 = 0.5e-4 + 2e-7;
        let table = [
            (2.609, 0.0175, 0.9825, 0.0350),
            (2.969, 0.0104, 0.9896, 0.0208),
            (1.090, 0.1559, 0.8441, 0.3118),
            (-0.175, 0.5670, 0.4330, 0.8660),
            (-0.938, 0.8103, 0.1897, 0.3795),
            (-0.661, 0.7351, 0.2649, 0.5298),
            (3.340, 0.0062, 0.9938, 0.0124),
            (3.498, 0.0050, 0.9950, 0.0100),
            (0.475, 0.3246, 0.6754, 0.6493),
            (1.930, 0.0475, 0.9525, 0.0949),
            (-0.662, 0.7354, 0.2646, 0.5292),
            (-7.638, 0.9999, 0.0001, 0.0001),
        ];
        for (t, upper, lower, two) in table {
            let tails = t_tail_probabilities(t, 7.0).unwrap();
            for (ours, printed) in [(tails.upper, upper), (tails.lower, lower), (tails.two, two)] {
                assert!((ours - printed).abs() <= TABLE_TOLERANCE, "t = {t}: {ours} is printed as {printed}");
            }
        }
    }
}
