//! Sum and longest part of the times during which a condition held.

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
    /// Sums consecutive intervals: beginning and end of each, s since lift-off, and whether the condition held.
    pub fn of(intervals: impl Iterator<Item = (f64, f64, bool)>) -> Self {
        let mut found = Self::default();
        let mut since: Option<f64> = None;
        for (from_s, until_s, held) in intervals {
            if !held {
                since = None;
                continue;
            }
            found.total_s += until_s - from_s;
            let begun_s = *since.get_or_insert(from_s);
            if until_s - begun_s > found.longest_s {
                (found.longest_s, found.longest_from_s) = (until_s - begun_s, begun_s);
            }
        }
        found
    }
}
