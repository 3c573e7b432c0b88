//! A sparsely sampled value with interpolation.

use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Maximum age of a sample relative to the latest one; older samples are discarded.
pub(super) const HISTORY_DURATION: SimTime = SimTime::from_ms(3_000);
/// Maximum gap between samples for interpolation.
pub(super) const MAX_INTERPOLATION_GAP: SimTime = SimTime::from_ms(1_000);

/// Recent samples in time order.
#[derive(Debug, Clone, Default)]
pub struct TimeSeries {
    points: VecDeque<(SimTime, f64)>,
}

impl TimeSeries {
    /// Inserts a sample in time order.
    pub fn push(&mut self, time: SimTime, value: f64) {
        let after = self.points.partition_point(|known| known.0 <= time);
        self.points.insert(after, (time, value));
        let newest = self.points.back().map_or(SimTime::ZERO, |last| last.0);
        while self.points.len() > 2 && self.points.front().is_some_and(|first| newest.saturating_sub(first.0) > HISTORY_DURATION)
        {
            self.points.pop_front();
        }
    }

    /// Returns the value at the given time, clamped to the first and last sample; `None` without samples.
    #[must_use]
    pub fn at(&self, time: SimTime) -> Option<f64> {
        if let Some((before, next)) = self.around(time) {
            return Some(before.1 + (next.1 - before.1) * time_fraction(before.0, next.0, time));
        }
        let after = self.points.partition_point(|known| known.0 <= time);
        self.points.get(after.saturating_sub(1)).map(|point| point.1)
    }

    /// Returns the rate of change at the given time, in 1/s; zero where the value is not interpolated.
    #[must_use]
    pub fn rate_at(&self, time: SimTime) -> f64 {
        self.around(time).map_or(0.0, |(before, next)| (next.1 - before.1) / (next.0 - before.0).s())
    }

    /// Returns the samples before and after the given time; `None` in long gaps, where values are not interpolated.
    fn around(&self, time: SimTime) -> Option<((SimTime, f64), (SimTime, f64))> {
        let after = self.points.partition_point(|known| known.0 <= time);
        let before = *self.points.get(after.checked_sub(1)?)?;
        let next = *self.points.get(after)?;
        (next.0 - before.0 <= MAX_INTERPOLATION_GAP).then_some((before, next))
    }
}

/// Returns the fraction of `at` between two times, 0 to 1.
pub(super) fn time_fraction(from: SimTime, to: SimTime, at: SimTime) -> f64 {
    (at - from).s() / (to - from).s().max(1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROUNDING_ERROR: f64 = 1e-12;

    #[test]
    fn exact_value_is_interpolated_between_samples_and_clamped_outside() {
        let mut series = TimeSeries::default();
        assert_eq!(series.at(SimTime::ZERO), None);
        for (ms, value) in [(100, 1.0), (500, 1.6), (300, 1.2), (2_000, 9.0)] {
            series.push(SimTime::from_ms(ms), value);
        }
        let at = |ms: i64| series.at(SimTime::from_ms(ms)).unwrap();
        assert!((at(350) - 1.3).abs() < ROUNDING_ERROR && (series.rate_at(SimTime::from_ms(350)) - 2.0).abs() < ROUNDING_ERROR);
        assert_eq!((at(500), at(1_999), at(2_000), at(9_000)), (1.6, 1.6, 9.0, 9.0), "long gaps must not be interpolated");
        assert_eq!((series.rate_at(SimTime::from_ms(1_200)), series.rate_at(SimTime::from_ms(9_000))), (0.0, 0.0));
    }
}
