//! Learning curve: change in a measure with practice, modeled as a power law (Newell and Rosenbloom 1981).

use super::{StatisticsError, mean};
use serde::Serialize;
use spandrel_model::math;

/// Minimum number of repetitions for a curve. Two parameters would fit three repetitions almost perfectly.
pub const MIN_LEARNING_REPETITIONS: usize = 4;
/// Search range for the exponent, wider than any plausible practice effect.
const EXPONENT_RANGE: (f64, f64) = (-4.0, 4.0);
/// Number of steps in the initial grid search.
const GRID_STEPS: usize = 400;
/// Number of bisection steps; enough for machine precision.
const BISECTION_STEPS: usize = 120;

/// A power law: `first * n^exponent` for the n-th repetition.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LearningCurve {
    /// Number of repetitions.
    pub n: usize,
    /// Fitted value at the first repetition.
    pub first: f64,
    /// Exponent; positive if the measure increases with practice.
    pub exponent: f64,
    /// Fraction of the variance that the curve explains; `None` if the measure does not vary.
    pub r_squared: Option<f64>,
    /// Prediction for the next repetition. It may exceed the maximum score, which the curve ignores.
    pub next: f64,
}

impl LearningCurve {
    /// Returns the value of the curve at a repetition (from 1). Fractional repetitions are allowed, for drawing.
    #[must_use]
    pub fn at(&self, repetition: f64) -> f64 {
        self.first * math::pow(repetition, self.exponent)
    }

    /// Returns the fitted change from the first to the last repetition.
    #[must_use]
    pub fn fitted_change(&self) -> f64 {
        self.at(self.n as f64) - self.first
    }
}

/// Fits the curve to the values of consecutive repetitions by least squares, without taking logarithms, so zeros are
/// allowed.
///
/// # Errors
/// Fails if there are fewer than [`MIN_LEARNING_REPETITIONS`] values or if a value is not finite.
pub fn learning_curve(values: &[f64]) -> Result<LearningCurve, StatisticsError> {
    if values.len() < MIN_LEARNING_REPETITIONS {
        return Err(StatisticsError::TooFew { n: values.len(), needed: MIN_LEARNING_REPETITIONS });
    }
    StatisticsError::check_finite(values)?;
    let (low, high) = EXPONENT_RANGE;
    let at = |k: usize| low + (high - low) * k as f64 / GRID_STEPS as f64;
    let best = (0..=GRID_STEPS).min_by(|a, b| residual(values, at(*a)).total_cmp(&residual(values, at(*b)))).unwrap_or(0);
    let exponent = bisect_exponent(values, at(best.saturating_sub(1)), at((best + 1).min(GRID_STEPS)));
    let first = best_first_value(values, exponent);
    let average = mean(values).unwrap_or_default();
    let around: f64 = values.iter().map(|value| (value - average) * (value - average)).sum();
    Ok(LearningCurve {
        n: values.len(),
        first,
        exponent,
        r_squared: (around > 0.0).then(|| 1.0 - residual(values, exponent) / around),
        next: first * math::pow((values.len() + 1) as f64, exponent),
    })
}

/// Refines the exponent by bisecting the derivative of the residual, which changes sign at the minimum. Comparing
/// residuals would give only half as many correct digits.
fn bisect_exponent(values: &[f64], mut low: f64, mut high: f64) -> f64 {
    for _ in 0..BISECTION_STEPS {
        let middle = 0.5 * (low + high);
        if slope(values, middle) > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

fn power_law_terms(exponent: f64, count: usize) -> impl Iterator<Item = (f64, f64)> {
    (1..=count).map(move |k| (math::ln(k as f64), math::pow(k as f64, exponent)))
}

/// Returns the best-fitting first value for a given exponent.
fn best_first_value(values: &[f64], exponent: f64) -> f64 {
    let (mut both, mut own) = (0.0, 0.0);
    for ((_, power), value) in power_law_terms(exponent, values.len()).zip(values) {
        both += power * value;
        own += power * power;
    }
    both / own
}

fn residual(values: &[f64], exponent: f64) -> f64 {
    let first = best_first_value(values, exponent);
    power_law_terms(exponent, values.len())
        .zip(values)
        .map(|((_, power), value)| value - first * power)
        .map(|off| off * off)
        .sum()
}

/// Returns the derivative of the residual with respect to the exponent, up to a positive factor. The first value is
/// optimal for the exponent, so the residual does not depend on it to first order.
fn slope(values: &[f64], exponent: f64) -> f64 {
    let first = best_first_value(values, exponent);
    let terms = power_law_terms(exponent, values.len()).zip(values);
    terms.map(|((log, power), value)| -(value - first * power) * first * power * log).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_power_law_is_recovered() {
        for (first, exponent) in [(40.0, 0.3), (120.0, -0.5), (70.0, 0.0)] {
            let values: Vec<f64> = (1..=6).map(|k| first * math::pow(f64::from(k), exponent)).collect();
            let curve = learning_curve(&values).unwrap();
            assert!((curve.first - first).abs() < 1e-9 && (curve.exponent - exponent).abs() < 1e-9, "{curve:?}");
            assert!((curve.next - first * math::pow(7.0, exponent)).abs() < 1e-7);
        }
    }

    #[test]
    fn exact_curve_requires_four_values_and_allows_zeros() {
        assert!(learning_curve(&[50.0, 60.0, 65.0]).is_err());
        let curve = learning_curve(&[12.0, 0.0, 0.0, 0.0]).unwrap();
        assert!(curve.exponent < -3.0 && curve.first.is_finite());
        let flat = learning_curve(&[0.0; 4]).unwrap();
        assert_eq!((flat.first, flat.r_squared), (0.0, None));
    }
}
