//! Walks of the inspector to other places, each coded as one integer.

use crate::scenario::places::MAX_PLACES;
use crate::time::SimTime;

/// Maximum number of walks without an arrival in between: a walk and its turns. All of them are repeated in the telemetry.
pub const MAX_TURNS: usize = 8;
/// Time resolution of the codes.
const RESOLUTION: SimTime = SimTime::from_ms(10);
/// Factors of the place that a walk starts from and of its time, in decimal digits.
const FROM_FACTOR: i64 = 10;
const TIME_FACTOR: i64 = 100;

/// A walk to a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Walk {
    /// Start.
    pub at: SimTime,
    /// Number of the place where the inspector stands before the walk; `None` if the inspector turns in the middle of another walk.
    pub from: Option<u8>,
    /// Number of the destination.
    pub to: u8,
}

impl Walk {
    /// Returns the code as sent in NAMED_VALUE_INT `walk`: the start in 1/100 s, followed by two decimal digits for the two places.
    /// The first of them is 0 for a turn. A walk from a place is self-contained, so messages may be delayed, duplicated or
    /// reordered. `None` if the walk starts too late for 32 bits: after 59 h.
    #[must_use]
    pub fn code(self) -> Option<i32> {
        let hundredths = self.at.ns() / RESOLUTION.ns();
        i32::try_from(TIME_FACTOR * hundredths + FROM_FACTOR * i64::from(self.from.unwrap_or(0)) + i64::from(self.to)).ok()
    }

    /// Returns the walk with a code; `None` if there is none.
    #[must_use]
    pub fn from_code(code: i32) -> Option<Self> {
        let code = i64::from(code);
        let place = |number: i64| u8::try_from(number).ok().filter(|number| (1..=MAX_PLACES).contains(&usize::from(*number)));
        let (start, to) = ((code % TIME_FACTOR) / FROM_FACTOR, place(code % FROM_FACTOR)?);
        let from = if start == 0 { None } else { Some(place(start)?) };
        (code > 0 && from != Some(to)).then(|| Self { at: SimTime::from_ns(code / TIME_FACTOR * RESOLUTION.ns()), from, to })
    }

    /// Returns the first time that a code can express at or after `now`.
    #[must_use]
    pub fn start_at(now: SimTime) -> SimTime {
        let whole = now.ns() / RESOLUTION.ns() + i64::from(now.ns() % RESOLUTION.ns() != 0);
        SimTime::from_ns(whole * RESOLUTION.ns())
    }

    /// Returns the start of a walk that follows one at `before`, at or after `now`.
    #[must_use]
    pub fn start_after(before: SimTime, now: SimTime) -> SimTime {
        Self::start_at(now).max(before + RESOLUTION)
    }
}

/// The inspector's walks in the order of time. Plain data, so that the inspector's position remains a function of time.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct InspectorWalks(Vec<Walk>);

impl InspectorWalks {
    /// Creates walks from codes in any order.
    #[must_use]
    pub fn from_codes(codes: impl IntoIterator<Item = i32>) -> Self {
        let mut walks = Self::default();
        codes.into_iter().for_each(|code| walks.apply_code(code));
        walks
    }

    /// Adds the walk with the given code. Ignores invalid codes and codes that were added before.
    pub fn apply_code(&mut self, code: i32) {
        if let Some(walk) = Walk::from_code(code)
            && let Err(place) = self.0.binary_search(&walk)
        {
            self.0.insert(place, walk);
        }
    }

    /// Returns all walks.
    #[must_use]
    pub fn all(&self) -> &[Walk] {
        &self.0
    }

    /// Returns the latest walk from a place and its turns.
    #[must_use]
    pub fn since_last_place(&self) -> &[Walk] {
        let first = self.0.iter().rposition(|walk| walk.from.is_some()).unwrap_or(0);
        &self.0[first..]
    }

    /// Returns the codes of the latest walk from a place and of its turns, 0 for a missing one. They suffice for a new subscriber to
    /// compute the position.
    #[must_use]
    pub fn last_codes(&self) -> [i32; MAX_TURNS] {
        let mut codes = [0; MAX_TURNS];
        for (slot, walk) in codes.iter_mut().zip(self.since_last_place()) {
            *slot = walk.code().unwrap_or(0);
        }
        codes
    }

    /// Returns true if the inspector has not walked.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walk(ms: i64, from: Option<u8>, to: u8) -> Walk {
        Walk { at: SimTime::from_ms(ms), from, to }
    }

    #[test]
    fn exact_codes_are_decimal_and_survive() {
        assert_eq!(walk(12_340, Some(1), 2).code(), Some(123_412));
        assert_eq!(walk(12_340, None, 8).code(), Some(123_408));
        for one in [walk(0, Some(8), 1), walk(0, None, 1), walk(10, Some(1), 2), walk(214_748_360, Some(1), 8)] {
            assert_eq!(one.code().and_then(Walk::from_code), Some(one));
        }
        assert_eq!(walk(214_748_370, Some(1), 2).code(), None, "59.7 h");
        for code in [0, 10, 11, 90, 92, 19, -123_412, i32::MIN, 123_400, 123_409] {
            assert_eq!(Walk::from_code(code), None, "{code}");
        }
    }

    #[test]
    fn exact_walks_start_at_the_next_hundredth() {
        let start = |us: i64| Walk::start_at(SimTime::from_us(us)).ms();
        assert_eq!([0, 1, 9_999, 10_000, 10_001].map(start), [0, 10, 10, 10, 20]);
        let after = |before: i64, now: i64| Walk::start_after(SimTime::from_ms(before), SimTime::from_ms(now)).ms();
        assert_eq!((after(20, 11), after(20, 20), after(20, 55)), (30, 30, 60), "two walks never start at the same time");
    }

    #[test]
    fn exact_walks_are_sorted_and_unique_and_the_last_ones_are_repeated() {
        let all = [walk(5_000, Some(1), 2), walk(60_000, Some(2), 3), walk(70_000, None, 1), walk(75_000, None, 3)];
        let codes = all.map(|one| one.code().unwrap());
        let walks = InspectorWalks::from_codes([codes[3], 0, codes[0], codes[1], codes[3], codes[2], -7]);
        assert_eq!(walks.all(), all);
        assert_eq!(walks.last_codes(), [codes[1], codes[2], codes[3], 0, 0, 0, 0, 0]);
        assert_eq!(InspectorWalks::from_codes(walks.last_codes()).all(), &all[1..]);
        assert_eq!((InspectorWalks::default().last_codes(), walks.is_empty()), ([0; MAX_TURNS], false));
        assert_eq!(InspectorWalks::from_codes([codes[2]]).since_last_place(), &all[2..3], "a turn without its walk");
    }
}
