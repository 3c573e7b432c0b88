//! Single-sample statistics: summary, quartiles and box plot.

use super::StatisticsError;
use serde::Serialize;

/// Maximum length of the whiskers, in interquartile ranges (Tukey 1977).
const MAX_WHISKER_LENGTH_IQR: f64 = 1.5;

/// Summary statistics of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SampleSummary {
    /// Number of values in the sample.
    pub n: usize,
    /// Arithmetic mean.
    pub mean: f64,
    /// Standard deviation, with n - 1 in the denominator; `None` for a single value.
    pub sd: Option<f64>,
    /// Smallest value in the sample.
    pub min: f64,
    /// First quartile.
    pub q1: f64,
    /// Sample median.
    pub median: f64,
    /// Third quartile.
    pub q3: f64,
    /// Largest value in the sample.
    pub max: f64,
    /// Difference between the largest and smallest values.
    pub range: f64,
    /// Skewness: third standardized moment, with n in the denominator. Negative if the lower tail is longer; `None` if all values
    /// are equal.
    pub skewness: Option<f64>,
}

/// Box plot data.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BoxPlot {
    /// First quartile.
    pub q1: f64,
    /// Sample median.
    pub median: f64,
    /// Third quartile.
    pub q3: f64,
    /// Smallest value that is not an outlier.
    pub low_whisker: f64,
    /// Largest value that is not an outlier.
    pub high_whisker: f64,
    /// Values beyond the whiskers, ascending.
    pub outliers: Vec<f64>,
    /// Arithmetic mean.
    pub mean: f64,
    /// Number of values in the sample.
    pub n: usize,
}

/// A histogram bin for values in [from, to). The last bin includes its upper end.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct HistogramBin {
    /// Lower bound, inclusive.
    pub from: f64,
    /// Upper bound; inclusive only in the last bin.
    pub to: f64,
    /// Number of values in the bin.
    pub count: usize,
}

/// Returns the arithmetic mean; `None` for an empty sample.
#[must_use]
pub fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Returns the standard deviation, with n - 1 in the denominator; `None` for fewer than two values.
#[must_use]
pub fn sd(values: &[f64]) -> Option<f64> {
    let mean = mean(values).filter(|_| values.len() > 1)?;
    let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    Some((squares / (values.len() - 1) as f64).sqrt())
}

/// Returns a quantile of sorted values by linear interpolation (type 7 of Hyndman and Fan 1996, the default of NumPy and R).
#[must_use]
pub fn quantile(ascending: &[f64], share: f64) -> Option<f64> {
    let last = ascending.len().checked_sub(1)?;
    let at = share.clamp(0.0, 1.0) * last as f64;
    let below = (at.floor() as usize).min(last);
    let above = (below + 1).min(last);
    Some(ascending[below] + (ascending[above] - ascending[below]) * (at - below as f64))
}

/// Computes the summary statistics of a sample.
///
/// # Errors
/// Fails if the sample is empty or a value is not finite.
pub fn summary(values: &[f64]) -> Result<SampleSummary, StatisticsError> {
    let sorted = ascending(values)?;
    let quarter = |share| quantile(&sorted, share).unwrap_or_default();
    let (min, max) = (quarter(0.0), quarter(1.0));
    let mean = mean(&sorted).unwrap_or_default();
    Ok(SampleSummary {
        n: sorted.len(),
        mean,
        sd: sd(&sorted),
        min,
        q1: quarter(0.25),
        median: quarter(0.5),
        q3: quarter(0.75),
        max,
        range: max - min,
        skewness: skewness(&sorted, mean),
    })
}

fn skewness(values: &[f64], mean: f64) -> Option<f64> {
    let moment = |power: fn(f64) -> f64| values.iter().map(|value| power(value - mean)).sum::<f64>() / values.len() as f64;
    let variance = moment(|d| d * d);
    (variance > 0.0).then(|| moment(|d| d * d * d) / (variance * variance.sqrt()))
}

/// Computes the box plot of a sample.
///
/// # Errors
/// Fails if the sample is empty or a value is not finite.
pub fn box_plot(values: &[f64]) -> Result<BoxPlot, StatisticsError> {
    let sorted = ascending(values)?;
    let quarter = |share| quantile(&sorted, share).unwrap_or_default();
    let (q1, q3) = (quarter(0.25), quarter(0.75));
    let reach = MAX_WHISKER_LENGTH_IQR * (q3 - q1);
    let inside = |value: &&f64| **value >= q1 - reach && **value <= q3 + reach;
    Ok(BoxPlot {
        q1,
        median: quarter(0.5),
        q3,
        low_whisker: sorted.iter().find(inside).copied().unwrap_or(q1),
        high_whisker: sorted.iter().rfind(inside).copied().unwrap_or(q3),
        outliers: sorted.iter().filter(|value| !inside(value)).copied().collect(),
        mean: mean(&sorted).unwrap_or_default(),
        n: sorted.len(),
    })
}

/// Counts values in `bars` equal-width bins over [low, high]. Values outside this range count toward the nearest bin.
#[must_use]
pub fn histogram(values: &[f64], (low, high): (f64, f64), bars: usize) -> Vec<HistogramBin> {
    let width = (high - low) / bars.max(1) as f64;
    let mut bins: Vec<HistogramBin> =
        (0..bars).map(|k| HistogramBin { from: low + width * k as f64, to: low + width * (k + 1) as f64, count: 0 }).collect();
    for value in values.iter().filter(|value| value.is_finite()) {
        let k = ((value - low) / width).floor().clamp(0.0, bars.saturating_sub(1) as f64) as usize;
        if let Some(bin) = bins.get_mut(k) {
            bin.count += 1;
        }
    }
    bins
}

fn ascending(values: &[f64]) -> Result<Vec<f64>, StatisticsError> {
    if values.is_empty() {
        return Err(StatisticsError::TooFew { n: 0, needed: 1 });
    }
    StatisticsError::check_finite(values)?;
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    Ok(sorted)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tolerance for rounding errors in a few additions.
    const ROUNDING_TOLERANCE: f64 = 1e-12;

    #[test]
    fn exact_quantiles_are_interpolated() {
        assert_eq!(quantile(&[1.0, 2.0, 3.0, 4.0, 5.0], 0.25), Some(2.0));
        assert_eq!(quantile(&[1.0, 2.0, 3.0, 4.0], 0.25), Some(1.75));
        assert_eq!(quantile(&[7.0], 0.9), Some(7.0));
        assert_eq!(quantile(&[], 0.5), None);
    }

    #[test]
    fn exact_small_sample_summary_is_correct() {
        let told = summary(&[2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]).unwrap();
        assert_eq!((told.n, told.mean, told.median, told.range), (8, 5.0, 4.5, 7.0));
        assert!((told.sd.unwrap() - (32.0f64 / 7.0).sqrt()).abs() < ROUNDING_TOLERANCE);
        // Third central moment 42/8, variance 4, so the skewness is 5.25/8.
        assert!((told.skewness.unwrap() - 5.25 / 8.0).abs() < ROUNDING_TOLERANCE);
        assert_eq!(summary(&[3.0, 3.0]).unwrap().skewness, None);
        assert!(summary(&[1.0, f64::NAN]).is_err());
    }

    #[test]
    fn exact_whiskers_end_at_values_and_outliers_are_listed() {
        let plot = box_plot(&[1.0, 2.0, 3.0, 4.0, 5.0, 30.0, -20.0]).unwrap();
        assert_eq!((plot.q1, plot.median, plot.q3), (1.5, 3.0, 4.5));
        assert_eq!((plot.low_whisker, plot.high_whisker), (1.0, 5.0));
        assert_eq!(plot.outliers, [-20.0, 30.0]);
    }

    #[test]
    fn exact_histogram_counts_every_value_once() {
        let bins = histogram(&[0.0, 9.99, 10.0, 100.0, 55.0], (0.0, 100.0), 10);
        let counts: Vec<usize> = bins.iter().map(|bin| bin.count).collect();
        assert_eq!(counts, [2, 1, 0, 0, 0, 1, 0, 0, 0, 1]);
        assert_eq!((bins[9].from, bins[9].to), (90.0, 100.0));
    }
}
