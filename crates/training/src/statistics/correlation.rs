//! Correlation between two measures for the same trainees.

use super::distribution::t_tail_probabilities;
use super::{StatisticsError, mean};
use serde::Serialize;

/// A correlation coefficient and its two-tailed p value (t distribution with n - 2 degrees of freedom).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Correlation {
    /// Number of pairs.
    pub n: usize,
    /// Correlation coefficient, -1 to 1.
    pub r: f64,
    /// Two-tailed p value; `None` with fewer than three pairs.
    pub p: Option<f64>,
}

/// Computes Pearson's correlation coefficient.
///
/// # Errors
/// Fails if there are fewer than two pairs, if one list is constant, or if a value is not finite.
pub fn pearson(x: &[f64], y: &[f64]) -> Result<Correlation, StatisticsError> {
    StatisticsError::check_pairs(x, y, 2)?;
    let n = x.len();
    let (mean_x, mean_y) = (mean(x).unwrap_or_default(), mean(y).unwrap_or_default());
    let sum = |f: &dyn Fn(f64, f64) -> f64| x.iter().zip(y).map(|(x, y)| f(x - mean_x, y - mean_y)).sum::<f64>();
    let (xx, yy, xy) = (sum(&|x, _| x * x), sum(&|_, y| y * y), sum(&|x, y| x * y));
    if xx <= 0.0 || yy <= 0.0 {
        return Err(StatisticsError::Constant("one of the two measures"));
    }
    let r = (xy / (xx.sqrt() * yy.sqrt())).clamp(-1.0, 1.0);
    let df = n as f64 - 2.0;
    // At r = 1, t is infinite and p is zero.
    let t = r * (df / ((1.0 - r) * (1.0 + r))).sqrt();
    let p = (df > 0.0).then(|| t_tail_probabilities(t, df).map_or(0.0, |tails| tails.two));
    Ok(Correlation { n, r, p })
}

/// Computes Spearman's rank correlation coefficient. Tied values get their mean rank.
///
/// # Errors
/// See [`pearson`].
pub fn spearman(x: &[f64], y: &[f64]) -> Result<Correlation, StatisticsError> {
    StatisticsError::check_pairs(x, y, 2)?;
    pearson(&ranks(x), &ranks(y))
}

fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    let mut from = 0;
    while from < order.len() {
        let same = order[from..].iter().take_while(|k| values[**k] == values[order[from]]).count();
        let rank = from as f64 + (same as f64 + 1.0) / 2.0;
        for k in &order[from..from + same] {
            ranks[*k] = rank;
        }
        from += same;
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_line_has_correlation_1_and_cross_has_0() {
        let line = pearson(&[1.0, 2.0, 3.0], &[2.0, 4.0, 6.0]).unwrap();
        assert!((line.r - 1.0).abs() < 1e-15 && line.p.unwrap() < 1e-6);
        assert!(pearson(&[-1.0, 1.0, 1.0, -1.0], &[1.0, 1.0, -1.0, -1.0]).unwrap().r.abs() < 1e-15);
        assert!(pearson(&[1.0, 1.0], &[1.0, 2.0]).is_err());
    }

    #[test]
    fn exact_tied_values_share_mean_rank() {
        assert_eq!(ranks(&[10.0, 30.0, 10.0, 20.0]), [1.5, 4.0, 1.5, 3.0]);
        let monotone = spearman(&[1.0, 2.0, 3.0, 4.0], &[1.0, 10.0, 100.0, 1000.0]).unwrap();
        assert!((monotone.r - 1.0).abs() < 1e-15);
    }
}
