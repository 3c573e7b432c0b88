//! Sum and longest part of the times during which a condition held.

use spandrel_model::time::SimTime;

/// Time between two intervals that interrupts a part, s: more than rounding.
const GAP_S: f64 = 1e-6;

/// Sum and longest part, s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct IntervalTotal {
    /// All of it, s.
    pub total_s: f64,
    /// Longest part without interruption, s.
    pub longest_s: f64,
    /// Beginning of the longest part, s since lift-off.
    pub longest_from_s: f64,
}

impl IntervalTotal {
    /// Sums intervals in the order of time: beginning and end of each, s since lift-off, and whether the condition held. A gap interrupts it.
    pub fn of(intervals: impl Iterator<Item = (f64, f64, bool)>) -> Self {
        let mut found = Self::default();
        // Beginning and end of the present part.
        let mut part: Option<(f64, f64)> = None;
        for (from_s, until_s, held) in intervals {
            if !held {
                part = None;
                continue;
            }
            found.total_s += until_s - from_s;
            let begun_s = part.filter(|part| from_s - part.1 <= GAP_S).map_or(from_s, |part| part.0);
            part = Some((begun_s, until_s));
            if until_s - begun_s > found.longest_s {
                (found.longest_s, found.longest_from_s) = (until_s - begun_s, begun_s);
            }
        }
        found
    }

    /// Sums the time during which reports from `lift_off` to `end` met a condition. A report counts until the next one, but not for longer
    /// than its largest age.
    pub fn of_reports<T>(
        reports: &[(SimTime, i64, T)],
        (lift_off, end): (SimTime, SimTime),
        max_age_s: f64,
        holds: impl Fn(&T) -> bool,
    ) -> Self {
        let interval = |(k, (time, _, report)): (usize, &(SimTime, i64, T))| {
            let until = reports.get(k + 1).map_or(end, |next| next.0);
            let (at_s, lasted_s) = ((*time - lift_off).s(), (until - *time).s().min(max_age_s));
            (at_s, at_s + lasted_s, holds(report))
        };
        Self::of(reports.iter().enumerate().map(interval))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_gaps_between_reports_interrupt_the_longest_part() {
        let at = |seconds: f64, held: bool| (SimTime::from_s(seconds), 0, held);
        let reports = [at(1.0, true), at(1.5, true), at(10.0, true), at(10.5, false), at(11.0, true)];
        let total = IntervalTotal::of_reports(&reports, (SimTime::from_s(1.0), SimTime::from_s(12.0)), 2.0, |held| *held);
        // Held from 0 to 2.5 s (the second report ages), from 9 to 9.5 s, and from 10 s to the end.
        assert!((total.total_s - 4.0).abs() < 1e-9 && (total.longest_s - 2.5).abs() < 1e-9, "{total:?}");
        assert_eq!(total.longest_from_s, 0.0);
    }
}
