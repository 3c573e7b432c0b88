//! Playback clock of a live flight. It lags slightly behind the latest telemetry, so there is a sample on either side
//! to interpolate between. It advances smoothly even if datagrams arrive in bursts or the vehicle's clock runs faster
//! or slower than wall time.

use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Picture delay relative to the latest telemetry, s of wall time (three samples at 50 Hz; estimate: hides typical
/// local network jitter and is much shorter than human reaction time).
pub const PLAYBACK_DELAY_S: f64 = 0.06;
/// Wall time period for measuring the speed of the vehicle's clock.
const SPEED_WINDOW: SimTime = SimTime::from_ms(1_000);
/// Minimum playback error at which the playback time jumps to the target, s of wall time.
const JUMP_THRESHOLD_S: f64 = 0.5;
/// Time constant for correcting smaller errors, s.
const CORRECTION_TIME_S: f64 = 0.25;
/// Maximum gap in telemetry that counts as jitter, s; in a longer gap, the picture freezes at the latest sample.
const JITTER_LIMIT_S: f64 = 0.1;

/// Playback position and speed of the vehicle's clock.
#[derive(Debug, Clone, Default)]
pub struct Playhead {
    arrivals: VecDeque<(SimTime, SimTime)>,
    shown_at: Option<(SimTime, SimTime)>,
}

impl Playhead {
    /// Records the time of a new latest sample, which arrived at the given wall time.
    pub fn handle_sample_time(&mut self, wall: SimTime, newest: SimTime) {
        if self.arrivals.back().is_some_and(|(_, last)| newest <= *last) {
            return;
        }
        self.arrivals.push_back((wall, newest));
        while self.arrivals.front().is_some_and(|(first, _)| wall.saturating_sub(*first) > SPEED_WINDOW)
            && self.arrivals.len() > 2
        {
            self.arrivals.pop_front();
        }
    }

    /// Resets the state after a restart of the vehicle's clock.
    pub fn restart(&mut self) {
        *self = Self::default();
    }

    /// Returns the speed of the vehicle's clock relative to wall time, or 1 until it has been measured.
    #[must_use]
    pub fn speed_factor(&self) -> f64 {
        match (self.arrivals.front(), self.arrivals.back()) {
            (Some(first), Some(last)) if (last.0 - first.0).s() > 0.2 => (last.1 - first.1).s() / (last.0 - first.0).s(),
            _ => 1.0,
        }
    }

    /// Advances to the given wall time and returns the time to show, or `None` before the first sample.
    pub fn advance(&mut self, wall: SimTime) -> Option<SimTime> {
        let (arrived, newest) = *self.arrivals.back()?;
        let speed_factor = self.speed_factor();
        let since_s = (wall - arrived).s().clamp(0.0, JITTER_LIMIT_S);
        let target_s = (newest.s() + speed_factor * (since_s - PLAYBACK_DELAY_S)).max(0.0);
        let shown_s = match self.shown_at {
            None => target_s,
            Some((before, shown)) => {
                let step_s = (wall - before).s().max(0.0);
                let even_s = shown.s() + speed_factor * step_s;
                let error_s = target_s - even_s;
                if error_s.abs() > JUMP_THRESHOLD_S * speed_factor.max(1.0) {
                    target_s
                } else {
                    // Playback never runs backward, because reversed motion is conspicuous.
                    (even_s + error_s * (step_s / CORRECTION_TIME_S).min(1.0)).max(shown.s())
                }
            }
        };
        let shown = SimTime::from_s(shown_s).min(newest);
        self.shown_at = Some((wall, shown));
        Some(shown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the playback times, in seconds, of pictures drawn every 1/60 s. The vehicle's clock runs at
    /// `speed_factor`, and its 50 Hz samples arrive in bursts.
    fn shown(speed_factor: f64, burst: u32) -> Vec<f64> {
        let mut head = Playhead::default();
        let mut out = Vec::new();
        let mut sample = 0;
        for picture in 0..600 {
            let wall_s = f64::from(picture) / 60.0;
            while f64::from(sample + burst) * 0.02 <= wall_s * speed_factor {
                sample += burst;
                head.handle_sample_time(SimTime::from_s(wall_s), SimTime::from_s(f64::from(sample) * 0.02));
            }
            if let Some(at) = head.advance(SimTime::from_s(wall_s)) {
                out.push(at.s());
            }
        }
        out
    }

    #[test]
    fn exact_bursty_telemetry_plays_smoothly_at_any_speed() {
        for (speed_factor, burst) in [(0.5, 1), (1.0, 3), (4.0, 3)] {
            let all = shown(speed_factor, burst);
            let settled = &all[120..];
            for pair in settled.windows(2) {
                let step = pair[1] - pair[0];
                // With bursts every 60 ms and pictures every 17 ms, steps without smoothing would be 0 or 3.6 times the
                // nominal step.
                assert!(
                    step > 0.8 * speed_factor / 60.0 && step < 1.2 * speed_factor / 60.0,
                    "speed_factor {speed_factor}: a step of {step} s"
                );
            }
            let end = settled[settled.len() - 1];
            let newest = speed_factor * 599.0 / 60.0;
            assert!(
                newest - end < 0.1 * speed_factor.max(1.0) && newest - end > 0.0,
                "speed_factor {speed_factor}: {end} of {newest}"
            );
        }
    }

    #[test]
    fn exact_playback_stops_without_data_and_skips_a_gap() {
        let mut head = Playhead::default();
        assert_eq!(head.advance(SimTime::ZERO), None);
        for k in 0..50 {
            head.handle_sample_time(SimTime::from_ms(20 * k), SimTime::from_ms(20 * k));
            head.advance(SimTime::from_ms(20 * k));
        }
        let stopped = (1..100).filter_map(|k| head.advance(SimTime::from_ms(980 + 20 * k))).next_back();
        assert_eq!(stopped, Some(SimTime::from_ms(980)), "playback must stop at the latest sample");
        head.handle_sample_time(SimTime::from_ms(10_000), SimTime::from_ms(10_000));
        let after = head.advance(SimTime::from_ms(10_000)).map(SimTime::s);
        assert!(after.is_some_and(|s| (s - (10.0 - PLAYBACK_DELAY_S)).abs() < 0.01), "{after:?}");
    }
}
