//! Motion since the instant that a delayed measurement describes, as predicted from the inertial sensors alone.

use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Interval between two samples. Between them, the motion is interpolated linearly: at 10 m/s², the error is at most 1 mm.
const SAMPLE_INTERVAL: SimTime = SimTime::from_ms(20);

/// Sums of all predicted changes since the start.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Travel {
    displacement_m: Vec3<Ned>,
    velocity_change_m_s: Vec3<Ned>,
}

impl Travel {
    const NONE: Self = Self { displacement_m: Vec3::zero(), velocity_change_m_s: Vec3::zero() };

    fn lerp(self, other: Self, share: f64) -> Self {
        Self {
            displacement_m: self.displacement_m + (other.displacement_m - self.displacement_m) * share,
            velocity_change_m_s: self.velocity_change_m_s + (other.velocity_change_m_s - self.velocity_change_m_s) * share,
        }
    }
}

/// Predicted motion over the last delay. Corrections by measurements don't count, so a measurement can be compared with the present
/// state even if others have corrected it in the meantime.
#[derive(Debug, Clone)]
pub(super) struct RecentMotion {
    delay: SimTime,
    travel: Travel,
    samples: VecDeque<(SimTime, Travel)>,
}

impl RecentMotion {
    /// Creates an empty history for measurements with a delay.
    pub(super) fn new(delay: SimTime) -> Self {
        Self { delay, travel: Travel::NONE, samples: VecDeque::new() }
    }

    /// Adds the predicted motion of one step that ends at `now`.
    pub(super) fn add(&mut self, displacement_m: Vec3<Ned>, velocity_change_m_s: Vec3<Ned>, now: SimTime) {
        if self.delay == SimTime::ZERO {
            return;
        }
        self.travel.displacement_m += displacement_m;
        self.travel.velocity_change_m_s += velocity_change_m_s;
        if self.samples.back().is_none_or(|(last, _)| *last + SAMPLE_INTERVAL <= now) {
            self.samples.push_back((now, self.travel));
        }
        while self.samples.get(1).is_some_and(|(next, _)| *next + self.delay <= now) {
            self.samples.pop_front();
        }
    }

    /// Returns the displacement, m, and the change of velocity, m/s, from one delay ago to `now`, the time of the last step. Of the time
    /// before the first step, nothing is known.
    pub(super) fn since_delay(&self, now: SimTime) -> (Vec3<Ned>, Vec3<Ned>) {
        let then = self.travel_at(now - self.delay, now);
        (self.travel.displacement_m - then.displacement_m, self.travel.velocity_change_m_s - then.velocity_change_m_s)
    }

    fn travel_at(&self, at: SimTime, now: SimTime) -> Travel {
        let Some((first_time, first)) = self.samples.front().copied().filter(|(time, _)| *time <= at) else {
            return self.samples.front().map_or(self.travel, |(_, first)| *first);
        };
        let (next_time, next) = self.samples.get(1).copied().unwrap_or((now, self.travel));
        let span_s = (next_time - first_time).s();
        first.lerp(next, if span_s > 0.0 { (at - first_time).s() / span_s } else { 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Adds steps of 2.5 ms with the exact motion at a constant acceleration, and returns the time of the last one.
    fn accelerate(history: &mut RecentMotion, acceleration_m_s2: f64, steps: i64) -> SimTime {
        let at = |step: i64| SimTime::from_us(2500 * step);
        for step in 1..=steps {
            let (before_s, after_s) = (at(step - 1).s(), at(step).s());
            let moved_m = 0.5 * acceleration_m_s2 * (after_s * after_s - before_s * before_s);
            let gained_m_s = acceleration_m_s2 * (after_s - before_s);
            history.add(Vec3::new(moved_m, 0.0, 0.0), Vec3::new(gained_m_s, 0.0, 0.0), at(step));
        }
        at(steps)
    }

    #[test]
    fn exact_motion_since_the_delay_follows_the_acceleration() {
        // Linear interpolation between samples that are 20 ms apart, at 10 m/s²: 10 (0.02)² / 8 = 0.5 mm.
        const TOLERANCE_M: f64 = 6e-4;
        let delay_s = 0.11;
        for steps in [400, 403, 407] {
            let mut history = RecentMotion::new(SimTime::from_s(delay_s));
            let now = accelerate(&mut history, 10.0, steps);
            let (moved, gained) = history.since_delay(now);
            let before_s = now.s() - delay_s;
            let expected_m = 5.0 * (now.s() * now.s() - before_s * before_s);
            assert!((moved.north() - expected_m).abs() < TOLERANCE_M, "{steps}: {moved:?}, expected {expected_m}");
            assert!((gained.north() - 10.0 * delay_s).abs() < 1e-9, "{steps}: {gained:?}");
        }
    }

    #[test]
    fn exact_motion_before_the_first_step_is_unknown() {
        let mut history = RecentMotion::new(SimTime::from_ms(110));
        assert_eq!(history.since_delay(SimTime::from_ms(5)), (Vec3::zero(), Vec3::zero()));
        let now = accelerate(&mut history, 10.0, 4);
        let (moved, gained) = history.since_delay(now);
        // The first sample is that of the first step.
        assert!((moved.north() - 5.0 * (0.01 * 0.01 - 0.0025 * 0.0025)).abs() < 1e-12 && (gained.north() - 0.075).abs() < 1e-12);
    }

    #[test]
    fn exact_history_without_a_delay_is_empty() {
        let mut history = RecentMotion::new(SimTime::ZERO);
        let now = accelerate(&mut history, 10.0, 400);
        assert_eq!(history.since_delay(now), (Vec3::zero(), Vec3::zero()));
        assert!(history.samples.is_empty());
    }
}
