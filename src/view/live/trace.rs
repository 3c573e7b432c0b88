//! The last seconds of what moves, and what holds between two samples of it.

use crate::base::frames::{Enu, Frd, Ned, Rotation, Vec3};
use crate::base::time::SimTime;
use crate::telemetry::Truth;
use std::collections::VecDeque;

/// Samples older than this behind the newest are forgotten.
const KEPT: SimTime = SimTime::from_ms(3_000);
/// Between samples farther apart than this nothing is made up.
const GAP: SimTime = SimTime::from_ms(1_000);
/// A step that no aircraft flies, m and m/s: it was put back.
const JUMP_M: f64 = 3.0;
const JUMP_M_S: f64 = 40.0;

/// Where the aircraft was and how it moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Position, m.
    pub position_m: Vec3<Enu>,
    /// Velocity, m/s.
    pub velocity_m_s: Vec3<Enu>,
    /// Attitude.
    pub ned_from_frd: Rotation<Frd, Ned>,
}

impl Pose {
    fn of(truth: &Truth) -> Self {
        Self { position_m: truth.position_m, velocity_m_s: truth.velocity_m_s, ned_from_frd: truth.ned_from_frd }
    }
}

/// Recent samples in the order of time.
#[derive(Debug, Clone, Default)]
pub struct Trace {
    truths: VecDeque<Truth>,
    gimbal: VecDeque<(SimTime, f64)>,
}

impl Trace {
    /// Takes a sample; one that comes late finds its place, one that is known already changes nothing.
    pub fn push(&mut self, truth: Truth) {
        let after = self.truths.partition_point(|known| known.time <= truth.time);
        if after.checked_sub(1).is_some_and(|k| self.truths[k].time == truth.time) {
            return;
        }
        self.truths.insert(after, truth);
        let newest = self.newest().unwrap_or_default();
        while self.truths.front().is_some_and(|first| newest.saturating_sub(first.time) > KEPT) {
            self.truths.pop_front();
        }
    }

    /// The gimbal's pitch over the horizon, rad, at a time.
    pub fn push_gimbal(&mut self, time: SimTime, pitch_rad: f64) {
        let after = self.gimbal.partition_point(|known| known.0 <= time);
        self.gimbal.insert(after, (time, pitch_rad));
        let newest = self.gimbal.back().map_or(SimTime::ZERO, |last| last.0);
        while self.gimbal.len() > 2 && self.gimbal.front().is_some_and(|first| newest.saturating_sub(first.0) > KEPT) {
            self.gimbal.pop_front();
        }
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Time of the newest sample.
    #[must_use]
    pub fn newest(&self) -> Option<SimTime> {
        self.truths.back().map(|truth| truth.time)
    }

    /// The aircraft at a time; before the first sample as at the first, after the last as at the last.
    #[must_use]
    pub fn at(&self, time: SimTime) -> Option<Pose> {
        let after = self.truths.partition_point(|truth| truth.time <= time);
        let before = self.truths.get(after.saturating_sub(1))?;
        let next = self.truths.get(after).filter(|next| after > 0 && continues(before, next));
        let Some(next) = next else { return Some(Pose::of(before)) };
        let t = share(before.time, next.time, time);
        Some(Pose {
            position_m: before.position_m.lerp(next.position_m, t),
            velocity_m_s: before.velocity_m_s.lerp(next.velocity_m_s, t),
            ned_from_frd: before.ned_from_frd.lerp(next.ned_from_frd, t),
        })
    }

    /// The gimbal's pitch at a time, rad; level while nothing has been heard.
    #[must_use]
    pub fn gimbal_at(&self, time: SimTime) -> f64 {
        let after = self.gimbal.partition_point(|known| known.0 <= time);
        let Some(before) = self.gimbal.get(after.saturating_sub(1)) else { return 0.0 };
        match self.gimbal.get(after).filter(|next| after > 0 && next.0 - before.0 <= GAP) {
            Some(next) => before.1 + (next.1 - before.1) * share(before.0, next.0, time),
            None => before.1,
        }
    }
}

fn share(from: SimTime, to: SimTime, at: SimTime) -> f64 {
    (at - from).s() / (to - from).s().max(1e-9)
}

fn continues(before: &Truth, next: &Truth) -> bool {
    let span = next.time - before.time;
    span <= GAP && (next.position_m - before.position_m).norm() <= JUMP_M + JUMP_M_S * span.s()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(ms: i64, east: f64, yaw_deg: f64) -> Truth {
        Truth {
            time: SimTime::from_ms(ms),
            position_m: Vec3::new(east, 0.0, 10.0),
            velocity_m_s: Vec3::new(2.0, 0.0, 0.0),
            ned_from_frd: Rotation::from_euler(0.0, 0.0, yaw_deg.to_radians()),
        }
    }

    #[test]
    fn exact_between_samples_everything_goes_evenly() {
        let mut trace = Trace::default();
        assert_eq!(trace.at(SimTime::ZERO), None);
        // The second comes late, and once more.
        for sample in [truth(0, 0.0, 10.0), truth(40, 2.0, 14.0), truth(20, 1.0, 12.0), truth(20, 1.0, 12.0)] {
            trace.push(sample);
        }
        let pose = trace.at(SimTime::from_ms(25)).unwrap();
        assert!((pose.position_m.east() - 1.25).abs() < 1e-9);
        assert!((pose.ned_from_frd.yaw_rad().to_degrees() - 12.5).abs() < 1e-4);
        assert_eq!(trace.at(SimTime::from_ms(90)).map(|p| p.position_m.east()), Some(2.0), "nothing is foretold");
        trace.push_gimbal(SimTime::from_ms(0), 0.0);
        trace.push_gimbal(SimTime::from_ms(40), 0.4);
        assert!((trace.gimbal_at(SimTime::from_ms(10)) - 0.1).abs() < 1e-12);
    }

    #[test]
    fn exact_put_back_or_silent_it_does_not_glide() {
        let mut trace = Trace::default();
        trace.push(truth(0, 0.0, 0.0));
        trace.push(truth(20, 50.0, 0.0));
        assert_eq!(trace.at(SimTime::from_ms(10)).map(|p| p.position_m.east()), Some(0.0));
        trace.push(truth(2_000, 51.0, 0.0));
        assert_eq!(trace.at(SimTime::from_ms(1_000)).map(|p| p.position_m.east()), Some(50.0));
        trace.push(truth(9_000, 52.0, 0.0));
        assert_eq!(trace.truths.len(), 1, "old samples are forgotten");
    }
}
