//! Bridge closures: an instructor can close the bridges to traffic. Traffic that is already on a bridge leaves it, and no new
//! traffic enters.

use crate::time::SimTime;

/// Sorted times at which the bridges were closed and reopened. Bridges are open at the start. Plain data, so that
/// traffic remains a function of time.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct BridgeClosures(Vec<(SimTime, bool)>);

impl BridgeClosures {
    /// Returns the code of a change as sent in NAMED_VALUE_INT `traffic`: its time in ms, positive for an opening and
    /// negative for a closure. Each code is self-contained, so messages may be delayed, duplicated or reordered.
    #[must_use]
    pub fn code(at: SimTime, open: bool) -> i32 {
        // Zero has no sign, so a change at time 0 is encoded as 1 ms.
        let ms = i32::try_from(at.ns() / 1_000_000).unwrap_or(i32::MAX).max(1);
        if open { ms } else { -ms }
    }

    /// Creates closures from codes in any order.
    #[must_use]
    pub fn from_codes(codes: impl IntoIterator<Item = i32>) -> Self {
        let mut gates = Self::default();
        codes.into_iter().for_each(|code| gates.apply_code(code));
        gates
    }

    /// Adds the change with the given code. Ignores 0 and codes that were added before.
    pub fn apply_code(&mut self, code: i32) {
        let change = (SimTime::from_ms(i64::from(code.unsigned_abs())), code > 0);
        if code != 0 && !self.0.contains(&change) {
            self.0.push(change);
            self.0.sort_unstable();
        }
    }

    /// Returns the codes of the last two changes, 0 for a missing one. They suffice for a new subscriber to reconstruct the
    /// traffic on the bridges.
    #[must_use]
    pub fn last_codes(&self) -> [i32; 2] {
        let mut last = self.0.iter().rev().map(|(at, open)| Self::code(*at, *open));
        let newest = last.next().unwrap_or(0);
        [last.next().unwrap_or(0), newest]
    }

    /// Returns true if the bridges are open to traffic that arrives at time `t_s` in seconds.
    #[must_use]
    pub fn is_open_at(&self, t_s: f64) -> bool {
        self.0.iter().rev().find(|(since, _)| since.s() <= t_s).is_none_or(|(_, open)| *open)
    }

    /// Returns true if the bridges have never been closed or reopened.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_codes_reconstruct_closures() {
        let (close, open) =
            (BridgeClosures::code(SimTime::from_ms(4_000), false), BridgeClosures::code(SimTime::from_s(9.000_9), true));
        assert_eq!((close, open), (-4_000, 9_000), "whole milliseconds");
        let gates = BridgeClosures::from_codes([open, 0, close, close]);
        assert_eq!(gates, BridgeClosures::from_codes([close, open]));
        assert_eq!([0.0, 3.999, 4.0, 8.999, 9.0, 1e6].map(|t| gates.is_open_at(t)), [true, true, false, false, true, true]);
        assert!(gates.is_open_at(-50.0) && BridgeClosures::default().is_open_at(f64::NAN), "open before the first closure");
        assert_eq!(BridgeClosures::from_codes(gates.last_codes()), gates);
        assert_eq!(
            (BridgeClosures::default().last_codes(), BridgeClosures::from_codes([close]).last_codes()),
            ([0, 0], [0, close])
        );
        assert_eq!(BridgeClosures::code(SimTime::ZERO, false), -1);
    }
}
