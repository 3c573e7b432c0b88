//! Ordinary least squares with an intercept, with coefficient statistics.

use super::StatisticsError;
use super::distribution::{f_upper_tail, t_quantile, t_tail_probabilities};
use super::paired::UPPER_PROBABILITY_95;
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

/// A column counts as collinear if its component orthogonal to the preceding columns is less than this fraction of its length.
const COLLINEARITY_TOLERANCE: f64 = 1e-9;

/// Coefficient of a fitted regression model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Coefficient {
    /// Name of the predictor; `intercept` for the first coefficient.
    pub name: String,
    /// Estimated value of the coefficient.
    pub estimate: f64,
    /// Standard error of the estimate.
    pub standard_error: f64,
    /// t statistic: estimate divided by standard error; `None` if the fit is perfect.
    pub t: Option<f64>,
    /// Two-tailed p value; `None` if `t` is `None`.
    pub p: Option<f64>,
    /// 95% confidence interval of the estimate.
    pub interval_95: [f64; 2],
}

/// A fitted regression model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Regression {
    /// Number of observations.
    pub n: usize,
    /// Coefficients: the intercept, then the predictors in the given order.
    pub coefficients: Vec<Coefficient>,
    /// Residual degrees of freedom.
    pub df: usize,
    /// Standard deviation of the residuals.
    pub residual_sd: f64,
    /// Fraction of the variance that the predictors explain; `None` if the outcome is constant.
    pub r_squared: Option<f64>,
    /// F statistic for the comparison with a mean-only model; `None` if `r_squared` is `None`.
    pub f: Option<f64>,
    /// p value of the F statistic.
    pub p: Option<f64>,
}

/// Fits `outcome` as a linear function of the named predictors. All lists have the same length.
///
/// # Errors
/// Fails if the lists differ in length, a value is not finite, there are not more observations than coefficients, or the
/// predictors are collinear.
pub fn least_squares(outcome: &[f64], predictors: &[(&str, &[f64])]) -> Result<Regression, StatisticsError> {
    let (n, p) = (outcome.len(), predictors.len() + 1);
    for (_, values) in predictors {
        StatisticsError::check_pairs(outcome, values, p + 1)?;
    }
    StatisticsError::check_pairs(outcome, outcome, p + 1)?;
    let x = DMatrix::from_fn(n, p, |row, column| if column == 0 { 1.0 } else { predictors[column - 1].1[row] });
    let y = DVector::from_column_slice(outcome);
    let lengths: Vec<f64> = (0..p).map(|column| x.column(column).norm()).collect();
    let qr = x.clone().qr();
    let r = qr.r();
    if (0..p).any(|k| r[(k, k)].abs() <= COLLINEARITY_TOLERANCE * lengths[k]) {
        return Err(StatisticsError::Collinear);
    }
    let estimates = r.solve_upper_triangular(&(qr.q().transpose() * &y)).ok_or(StatisticsError::Collinear)?;
    let inverse = r.solve_upper_triangular(&DMatrix::identity(p, p)).ok_or(StatisticsError::Collinear)?;
    let left = (&y - &x * &estimates).norm_squared();
    let around = y.add_scalar(-y.mean()).norm_squared();
    let df = n - p;
    let variance = left / df as f64;
    let names = std::iter::once("intercept").chain(predictors.iter().map(|(name, _)| *name));
    let coefficients = names.enumerate().map(|(k, name)| {
        let error = inverse.row(k).norm() * variance.sqrt();
        coefficient(name, estimates[k], error, df as f64)
    });
    let explained = (around > 0.0 && p > 1).then(|| 1.0 - left / around);
    let f = explained.map(|_| (around - left) / (p - 1) as f64 / variance).filter(|f| f.is_finite());
    Ok(Regression {
        n,
        coefficients: coefficients.collect(),
        df,
        residual_sd: variance.sqrt(),
        r_squared: explained,
        f,
        p: f.and_then(|f| f_upper_tail(f, (p - 1) as f64, df as f64)),
    })
}

fn coefficient(name: &str, estimate: f64, standard_error: f64, df: f64) -> Coefficient {
    let t = (standard_error > 0.0).then(|| estimate / standard_error);
    let reach = standard_error * t_quantile(UPPER_PROBABILITY_95, df).unwrap_or_default();
    Coefficient {
        name: name.to_owned(),
        estimate,
        standard_error,
        t,
        p: t.and_then(|t| t_tail_probabilities(t, df)).map(|tails| tails.two),
        interval_95: [estimate - reach, estimate + reach],
    }
}

/// Returns only the estimates of a weighted least-squares fit, computed from the normal equations. Used for
/// bootstrapping, where a full [`Regression`] would be too slow. Rows contain the predictors without the intercept; the
/// result starts with the intercept. `None` if the predictors are collinear.
#[must_use]
pub fn solve<const P: usize>(rows: &[[f64; P]], outcome: &[f64], weights: &[u32]) -> Option<Vec<f64>> {
    let mut normal = DMatrix::<f64>::zeros(P + 1, P + 1);
    let mut right = DVector::<f64>::zeros(P + 1);
    let value = |row: &[f64; P], k: usize| if k == 0 { 1.0 } else { row[k - 1] };
    for ((row, y), weight) in rows.iter().zip(outcome).zip(weights).filter(|(_, weight)| **weight > 0) {
        let weight = f64::from(*weight);
        for i in 0..=P {
            let weighted = weight * value(row, i);
            right[i] += weighted * y;
            for j in 0..=i {
                normal[(i, j)] += weighted * value(row, j);
            }
        }
    }
    let factor = normal.clone().cholesky()?;
    let lower = factor.l();
    // Each diagonal element of the Cholesky factor is the length of a column's component orthogonal to the preceding
    // columns.
    let distinct = (0..=P).all(|k| lower[(k, k)] > COLLINEARITY_TOLERANCE.sqrt() * normal[(k, k)].sqrt());
    distinct.then(|| factor.solve(&right).iter().copied().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tolerance for rounding errors in a small decomposition.
    const ROUNDING_TOLERANCE: f64 = 1e-11;

    #[test]
    fn exact_line_fit_to_three_points_matches_closed_form() {
        // y = 1, 3, 2 at x = 0, 1, 2: slope 1/2, intercept 3/2, residual sum of squares 3/2, standard error of the slope
        // sqrt(3/2/2) = sqrt 3/2.
        let model = least_squares(&[1.0, 3.0, 2.0], &[("x", &[0.0, 1.0, 2.0])]).unwrap();
        assert!(
            (model.coefficients[0].estimate - 1.5).abs() < ROUNDING_TOLERANCE
                && (model.coefficients[1].estimate - 0.5).abs() < ROUNDING_TOLERANCE
        );
        assert!((model.coefficients[1].standard_error - 0.75f64.sqrt()).abs() < ROUNDING_TOLERANCE);
        assert!((model.r_squared.unwrap() - 0.25).abs() < ROUNDING_TOLERANCE);
        // With a single predictor, F is the square of t and has the same p value.
        let t = model.coefficients[1].t.unwrap();
        assert!((model.f.unwrap() - t * t).abs() < ROUNDING_TOLERANCE);
        assert!((model.p.unwrap() - model.coefficients[1].p.unwrap()).abs() < ROUNDING_TOLERANCE);
    }

    #[test]
    fn exact_regression_recovers_coefficients() {
        let a: Vec<f64> = (0..12).map(|k| f64::from(k % 5)).collect();
        let b: Vec<f64> = (0..12).map(|k| f64::from(k * k % 7)).collect();
        let y: Vec<f64> = a.iter().zip(&b).map(|(a, b)| 3.0 - 2.0 * a + 0.25 * b).collect();
        let model = least_squares(&y, &[("a", &a), ("b", &b)]).unwrap();
        for (found, true_value) in model.coefficients.iter().zip([3.0, -2.0, 0.25]) {
            assert!((found.estimate - true_value).abs() < ROUNDING_TOLERANCE, "{found:?}");
        }
        let rows: Vec<[f64; 2]> = a.iter().zip(&b).map(|(a, b)| [*a, *b]).collect();
        let quick = solve(&rows, &y, &[1; 12]).unwrap();
        assert!((quick[1] + 2.0).abs() < ROUNDING_TOLERANCE && (quick[2] - 0.25).abs() < ROUNDING_TOLERANCE);
    }

    #[test]
    fn exact_weights_equal_repeated_rows() {
        let rows = [[0.0], [1.0], [3.0]];
        let weighted = solve(&rows, &[1.0, 4.0, 2.0], &[2, 1, 1]).unwrap();
        let repeated = solve(&[[0.0], [0.0], [1.0], [3.0]], &[1.0, 1.0, 4.0, 2.0], &[1; 4]).unwrap();
        assert!((weighted[0] - repeated[0]).abs() < ROUNDING_TOLERANCE && (weighted[1] - repeated[1]).abs() < ROUNDING_TOLERANCE);
        assert_eq!(solve(&rows, &[1.0, 4.0, 2.0], &[3, 0, 0]), None);
    }

    #[test]
    fn exact_collinear_or_too_few_observations_are_rejected() {
        let x = [1.0, 2.0, 3.0, 4.0];
        let twice = [2.0, 4.0, 6.0, 8.0];
        assert_eq!(least_squares(&x, &[("x", &x), ("twice", &twice)]).unwrap_err(), StatisticsError::Collinear);
        assert!(least_squares(&[1.0, 2.0], &[("x", &[1.0, 2.0])]).is_err());
        let flat = least_squares(&[5.0; 4], &[("x", &x)]).unwrap();
        assert_eq!(flat.r_squared, None);
    }
}
