//! Simulation time as an integer number of nanoseconds, which avoids accumulating floating-point errors.

use std::fmt;
use std::ops::{Add, AddAssign, Sub};

/// A time on the simulation clock, in nanoseconds since simulation start. Also used for durations of simulation time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct SimTime {
    ns: i64,
}

impl SimTime {
    /// Simulation start, or a zero duration.
    pub const ZERO: Self = Self { ns: 0 };
    /// A time later than any event.
    pub const NEVER: Self = Self { ns: i64::MAX };

    /// Creates a time from integer nanoseconds.
    #[must_use]
    pub const fn from_ns(ns: i64) -> Self {
        Self { ns }
    }

    /// Creates a time from integer microseconds.
    #[must_use]
    pub const fn from_us(us: i64) -> Self {
        Self { ns: us * 1_000 }
    }

    /// Creates a time from integer milliseconds.
    #[must_use]
    pub const fn from_ms(ms: i64) -> Self {
        Self { ns: ms * 1_000_000 }
    }

    /// Creates a time from seconds, rounded to the nearest nanosecond. Out-of-range values saturate; NaN becomes zero.
    #[must_use]
    pub fn from_s(s: f64) -> Self {
        Self { ns: (s * 1e9).round() as i64 }
    }

    /// Returns the period of a rate in Hz, rounded to the nearest nanosecond.
    #[must_use]
    pub fn period(rate_hz: f64) -> Self {
        Self::from_s(1.0 / rate_hz)
    }

    /// Returns the time in nanoseconds.
    #[must_use]
    pub const fn ns(self) -> i64 {
        self.ns
    }

    /// Returns the time in microseconds, rounded toward zero.
    #[must_use]
    pub const fn us(self) -> i64 {
        self.ns / 1_000
    }

    /// Returns the time in milliseconds, rounded toward zero.
    #[must_use]
    pub const fn ms(self) -> i64 {
        self.ns / 1_000_000
    }

    /// Returns the time in seconds.
    #[must_use]
    pub fn s(self) -> f64 {
        self.ns as f64 * 1e-9
    }

    /// Returns `self - other`, or zero if the difference is negative.
    #[must_use]
    pub fn saturating_sub(self, other: Self) -> Self {
        Self { ns: self.ns.saturating_sub(other.ns).max(0) }
    }
}

impl Add for SimTime {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        Self { ns: self.ns.saturating_add(rhs.ns) }
    }
}

impl AddAssign for SimTime {
    fn add_assign(&mut self, rhs: Self) {
        *self = *self + rhs;
    }
}

impl Sub for SimTime {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        Self { ns: self.ns.saturating_sub(rhs.ns) }
    }
}

impl fmt::Display for SimTime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.3} s", self.s())
    }
}

/// A fixed-rate schedule without drift: the k-th due time is the start plus k periods, each rounded separately.
#[derive(Debug, Clone, PartialEq)]
pub struct Schedule {
    rate_hz: f64,
    count: i64,
    start: SimTime,
    /// Due time of the current count. Schedules are asked every tick and fire rarely, and the conversion from seconds is slow.
    due: SimTime,
}

impl Schedule {
    /// Creates a schedule that is first due at `start`, then `rate_hz` times per second. A rate of zero or less never fires.
    #[must_use]
    pub fn new(start: SimTime, rate_hz: f64) -> Self {
        let mut schedule = Self { rate_hz, count: 0, start, due: SimTime::NEVER };
        schedule.set_count(0);
        schedule
    }

    /// Returns the next due time.
    #[must_use]
    pub fn next_due(&self) -> SimTime {
        self.due
    }

    fn set_count(&mut self, count: i64) {
        self.count = count;
        if self.rate_hz > 0.0 {
            self.due = self.start + SimTime::from_s(count as f64 / self.rate_hz);
        }
    }

    /// Returns true once for each due time at or before `now`; missed due times are skipped, not repeated.
    #[inline]
    pub fn fire(&mut self, now: SimTime) -> bool {
        if now < self.due {
            return false;
        }
        self.skip_to(now);
        true
    }

    /// Continues with the first due time after `now`.
    fn skip_to(&mut self, now: SimTime) {
        let passed = (now - self.start).s() * self.rate_hz;
        self.set_count((self.count + 1).max(passed.floor() as i64 + 1));
        if self.due <= now {
            self.set_count(self.count + 1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_schedule_does_not_drift_over_an_hour() {
        let mut schedule = Schedule::new(SimTime::ZERO, 30.0);
        let fired = (0..3_600_000).filter(|ms| schedule.fire(SimTime::from_ms(*ms))).count();
        assert_eq!(fired, 30 * 3600);
    }

    #[test]
    fn exact_missed_due_times_are_skipped() {
        let mut schedule = Schedule::new(SimTime::ZERO, 10.0);
        assert!(schedule.fire(SimTime::from_ms(950)));
        assert!(!schedule.fire(SimTime::from_ms(999)));
        assert!(schedule.fire(SimTime::from_ms(1000)));
    }
}
