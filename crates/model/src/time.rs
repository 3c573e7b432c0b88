//! Simulation time as an integer: no float ever accumulates a clock.

use std::fmt;
use std::ops::{Add, AddAssign, Sub};

/// An instant on the simulation clock, in nanoseconds since the simulation started. Also used for spans of simulation time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct SimTime {
    ns: i64,
}

impl SimTime {
    /// The start of the simulation, and the empty span.
    pub const ZERO: Self = Self { ns: 0 };
    /// Later than everything that happens.
    pub const NEVER: Self = Self { ns: i64::MAX };

    /// From whole nanoseconds.
    #[must_use]
    pub const fn from_ns(ns: i64) -> Self {
        Self { ns }
    }

    /// From whole microseconds.
    #[must_use]
    pub const fn from_us(us: i64) -> Self {
        Self { ns: us * 1_000 }
    }

    /// From whole milliseconds.
    #[must_use]
    pub const fn from_ms(ms: i64) -> Self {
        Self { ns: ms * 1_000_000 }
    }

    /// From seconds, rounded to the nearest nanosecond. Values beyond the range saturate; NaN becomes zero.
    #[must_use]
    pub fn from_s(s: f64) -> Self {
        Self { ns: (s * 1e9).round() as i64 }
    }

    /// The span of one period at `rate_hz`, rounded to the nearest nanosecond.
    #[must_use]
    pub fn period(rate_hz: f64) -> Self {
        Self::from_s(1.0 / rate_hz)
    }

    /// Nanoseconds.
    #[must_use]
    pub const fn ns(self) -> i64 {
        self.ns
    }

    /// Whole microseconds, rounded toward zero.
    #[must_use]
    pub const fn us(self) -> i64 {
        self.ns / 1_000
    }

    /// Whole milliseconds, rounded toward zero.
    #[must_use]
    pub const fn ms(self) -> i64 {
        self.ns / 1_000_000
    }

    /// Seconds.
    #[must_use]
    pub fn s(self) -> f64 {
        self.ns as f64 * 1e-9
    }

    /// `self - other`, never below zero.
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

/// Fires at a fixed rate without drift: the k-th due time is the start plus k periods, each rounded on its own.
#[derive(Debug, Clone, PartialEq)]
pub struct Schedule {
    rate_hz: f64,
    count: i64,
    start: SimTime,
}

impl Schedule {
    /// First due at `start`, then `rate_hz` times a second. A rate of zero or less never fires.
    #[must_use]
    pub fn new(start: SimTime, rate_hz: f64) -> Self {
        Self { rate_hz, count: 0, start }
    }

    /// When it fires next.
    #[must_use]
    pub fn next_due(&self) -> SimTime {
        if self.rate_hz <= 0.0 { SimTime::NEVER } else { self.start + SimTime::from_s(self.count as f64 / self.rate_hz) }
    }

    /// True once per due time at or before `now`; what was missed in between is skipped, not repeated.
    pub fn fire(&mut self, now: SimTime) -> bool {
        if now < self.next_due() {
            return false;
        }
        let due = (now - self.start).s() * self.rate_hz;
        self.count = (self.count + 1).max(due.floor() as i64 + 1);
        if self.next_due() <= now {
            self.count += 1;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_schedule_of_thirty_hertz_fires_thirty_times_a_second_for_an_hour() {
        let mut schedule = Schedule::new(SimTime::ZERO, 30.0);
        let fired = (0..3_600_000).filter(|ms| schedule.fire(SimTime::from_ms(*ms))).count();
        assert_eq!(fired, 30 * 3600);
    }

    #[test]
    fn exact_missed_ticks_are_skipped() {
        let mut schedule = Schedule::new(SimTime::ZERO, 10.0);
        assert!(schedule.fire(SimTime::from_ms(950)));
        assert!(!schedule.fire(SimTime::from_ms(999)));
        assert!(schedule.fire(SimTime::from_ms(1000)));
    }
}
