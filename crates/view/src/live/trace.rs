//! Recent motion of the aircraft, with interpolation between samples.

use super::series::{HISTORY_DURATION, MAX_INTERPOLATION_GAP, TimeSeries, time_fraction};
use crate::stage::CameraTurnRate;
use spandrel_mavlink::contract::truth::Truth;
use spandrel_model::frames::Enu;
use spandrel_model::math;
use spandrel_model::pose::Motion;
use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Additional delay of the camera's field of view, which is sent at 5 Hz. Together with the playback delay
/// ([`PLAYBACK_DELAY_S`](super::clock::PLAYBACK_DELAY_S)), it leaves enough time for the next sample to arrive,
/// including 20 ms of jitter (estimate).
const FIELD_OF_VIEW_DELAY: SimTime = SimTime::from_ms(160);

/// Recent samples in time order.
#[derive(Debug, Clone, Default)]
pub struct MotionHistory {
    truths: VecDeque<Truth>,
    gimbal: TimeSeries,
    lens: TimeSeries,
}

impl MotionHistory {
    /// Inserts a sample in time order; ignores duplicates.
    pub fn push(&mut self, truth: Truth) {
        let after = self.truths.partition_point(|known| known.time <= truth.time);
        if after.checked_sub(1).is_some_and(|k| self.truths[k].time == truth.time) {
            return;
        }
        self.truths.insert(after, truth);
        let newest = self.newest().unwrap_or_default();
        while self.truths.front().is_some_and(|first| newest.saturating_sub(first.time) > HISTORY_DURATION) {
            self.truths.pop_front();
        }
    }

    /// Adds a sample of the gimbal's pitch above the horizon, in radians.
    pub fn push_gimbal(&mut self, time: SimTime, pitch_rad: f64) {
        self.gimbal.push(time, pitch_rad);
    }

    /// Adds a sample of the camera's horizontal field of view, in radians.
    pub fn push_lens(&mut self, time: SimTime, hfov_rad: f64) {
        self.lens.push(time, hfov_rad);
    }

    /// Discards all samples.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Returns the time of the latest sample.
    #[must_use]
    pub fn newest(&self) -> Option<SimTime> {
        self.truths.back().map(|truth| truth.time)
    }

    /// Returns the motion at the given time, clamped to the first and last sample.
    #[must_use]
    pub fn at(&self, time: SimTime) -> Option<Motion<Enu>> {
        let Some((before, next)) = self.around(time) else {
            let after = self.truths.partition_point(|truth| truth.time <= time);
            return self.truths.get(after.saturating_sub(1)).map(|truth| truth.motion);
        };
        let t = time_fraction(before.time, next.time, time);
        Some(before.motion.lerp(&next.motion, t))
    }

    /// Returns the gimbal's pitch at the given time, in radians; zero without samples.
    #[must_use]
    pub fn gimbal_at(&self, time: SimTime) -> f64 {
        self.gimbal.at(time).unwrap_or(0.0)
    }

    /// Returns the horizontal field of view to draw at the given time, in radians, delayed for smooth zooming; `None`
    /// without samples.
    #[must_use]
    pub fn lens_at(&self, time: SimTime) -> Option<f64> {
        self.lens.at(time.saturating_sub(FIELD_OF_VIEW_DELAY))
    }

    /// Returns the horizontal field of view at the given time of a fully recorded flight, in radians; `None` without
    /// samples.
    #[must_use]
    pub fn reported_lens_at(&self, time: SimTime) -> Option<f64> {
        self.lens.at(time)
    }

    /// Returns the camera's turn rate at the given time, interpolated between samples; zero where interpolation is not
    /// possible.
    #[must_use]
    pub fn turn_at(&self, time: SimTime) -> CameraTurnRate {
        let heading_rad_s = self.around(time).map_or(0.0, |(before, next)| {
            math::wrap_pi(next.motion.ned_from_frd.yaw_rad() - before.motion.ned_from_frd.yaw_rad())
                / (next.time - before.time).s()
        });
        CameraTurnRate { heading_rate_rad_s: heading_rad_s, pitch_rate_rad_s: self.gimbal.rate_at(time) }
    }

    /// Returns the samples before and after the given time, used to interpolate motion.
    fn around(&self, time: SimTime) -> Option<(&Truth, &Truth)> {
        let after = self.truths.partition_point(|truth| truth.time <= time);
        let before = self.truths.get(after.checked_sub(1)?)?;
        self.truths.get(after).filter(|next| is_continuous(before, next)).map(|next| (before, next))
    }
}

fn is_continuous(before: &Truth, next: &Truth) -> bool {
    let span = next.time - before.time;
    span <= MAX_INTERPOLATION_GAP && !before.jumps_to(next)
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::frames::{Rotation, Vec3};

    fn truth(ms: i64, east: f64, yaw_deg: f64) -> Truth {
        Truth {
            time: SimTime::from_ms(ms),
            motion: Motion {
                position_m: Vec3::new(east, 0.0, 10.0),
                velocity_m_s: Vec3::new(2.0, 0.0, 0.0),
                ned_from_frd: Rotation::from_euler(0.0, 0.0, yaw_deg.to_radians()),
            },
        }
    }

    #[test]
    fn exact_motion_is_interpolated_between_samples() {
        let mut trace = MotionHistory::default();
        assert_eq!(trace.at(SimTime::ZERO), None);
        // The second sample arrives late and is duplicated.
        for sample in [truth(0, 0.0, 10.0), truth(40, 2.0, 14.0), truth(20, 1.0, 12.0), truth(20, 1.0, 12.0)] {
            trace.push(sample);
        }
        let pose = trace.at(SimTime::from_ms(25)).unwrap();
        assert!((pose.position_m.east() - 1.25).abs() < 1e-9);
        assert!((pose.ned_from_frd.yaw_rad().to_degrees() - 12.5).abs() < 1e-4);
        assert_eq!(trace.at(SimTime::from_ms(90)).map(|p| p.position_m.east()), Some(2.0), "there must be no extrapolation");
        trace.push_gimbal(SimTime::from_ms(0), 0.0);
        trace.push_gimbal(SimTime::from_ms(40), 0.4);
        assert!((trace.gimbal_at(SimTime::from_ms(10)) - 0.1).abs() < 1e-12);
    }

    #[test]
    fn exact_turn_rate_is_derived_from_the_samples() {
        let mut trace = MotionHistory::default();
        assert_eq!(trace.turn_at(SimTime::ZERO), CameraTurnRate::default());
        // The heading crosses south, where it wraps around.
        for sample in [truth(0, 0.0, 179.0), truth(20, 0.0, 181.0), truth(40, 0.0, 181.0)] {
            trace.push(sample);
        }
        trace.push_gimbal(SimTime::from_ms(0), 0.0);
        trace.push_gimbal(SimTime::from_ms(40), -0.02);
        let turn = trace.turn_at(SimTime::from_ms(5));
        assert!(
            (turn.heading_rate_rad_s.to_degrees() - 100.0).abs() < 1e-6 && (turn.pitch_rate_rad_s + 0.5).abs() < 1e-12,
            "{turn:?}"
        );
        assert!(trace.turn_at(SimTime::from_ms(25)).heading_rate_rad_s.abs() < 1e-9);
        assert_eq!(trace.turn_at(SimTime::from_ms(40)), CameraTurnRate::default(), "the rate must be zero after the last sample");
    }

    #[test]
    fn exact_zoom_is_smooth_with_telemetry_at_5_hz() {
        let mut trace = MotionHistory::default();
        assert_eq!(trace.lens_at(SimTime::ZERO), None);
        let (mut shown, from_ms) = (Vec::new(), 2_000);
        for ms in (0..3_000).step_by(20) {
            if ms % 200 == 0 {
                trace.push_lens(SimTime::from_ms(ms), 1.5 - 0.2 * ms as f64 / 1_000.0);
            }
            // The picture lags three samples behind.
            shown.extend((ms >= from_ms).then(|| trace.lens_at(SimTime::from_ms(ms - 60)).unwrap()));
        }
        for pair in shown.windows(2) {
            assert!((pair[0] - pair[1] - 0.2 * 0.02).abs() < 1e-9, "a step of {} rad", pair[1] - pair[0]);
        }
    }

    #[test]
    fn exact_respawns_and_gaps_are_not_interpolated() {
        let mut trace = MotionHistory::default();
        trace.push(truth(0, 0.0, 0.0));
        trace.push(truth(20, 50.0, 0.0));
        assert_eq!(trace.at(SimTime::from_ms(10)).map(|p| p.position_m.east()), Some(0.0));
        trace.push(truth(2_000, 51.0, 0.0));
        assert_eq!(trace.at(SimTime::from_ms(1_000)).map(|p| p.position_m.east()), Some(50.0));
        trace.push(truth(9_000, 52.0, 0.0));
        assert_eq!(trace.truths.len(), 1, "old samples must be discarded");
    }
}
