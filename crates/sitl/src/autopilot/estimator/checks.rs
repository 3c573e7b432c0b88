//! Innovation consistency checks. A source whose measurements keep failing the gate is rejected until they pass again.

use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::time::SimTime;

/// Time constant of the average rejection rate, s (estimate: one second of rejected measurements drops a source, but
/// single outliers do not).
const REJECTION_AVERAGING_TIME_S: f64 = 0.5;
/// Rejection rate above which a source is dropped.
const DROP_THRESHOLD: f64 = 0.8;
/// Rejection rate below which a source is used again; reached after 2 s of consistent measurements.
const RECOVERY_THRESHOLD: f64 = 0.02;
/// Cap on the interval between measurements in the average, s. Without it, one rejection after a long gap could drop a
/// source.
const MAX_MEASUREMENT_INTERVAL_S: f64 = 0.25;
/// Time after which a rejected source is used again if no better source remains, s.
pub const REJECTION_TIMEOUT_S: f64 = 3.0;

/// Consistency of one source with the filter.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct InnovationCheck {
    rejection_rate: f64,
    last: Option<SimTime>,
    dropped: bool,
}

impl InnovationCheck {
    /// Records whether a measurement passed its gate. Returns true if it should be fused.
    pub fn should_fuse(&mut self, fits: bool, now: SimTime) -> bool {
        let gap_s = self.last.map_or(MAX_MEASUREMENT_INTERVAL_S, |last| (now - last).s()).min(MAX_MEASUREMENT_INTERVAL_S);
        self.last = Some(now);
        let refused = if fits { 0.0 } else { 1.0 };
        self.rejection_rate += (refused - self.rejection_rate) * (gap_s / REJECTION_AVERAGING_TIME_S);
        self.dropped = self.rejection_rate > if self.dropped { RECOVERY_THRESHOLD } else { DROP_THRESHOLD };
        fits && !self.dropped
    }

    /// Returns true if the source is not used.
    #[must_use]
    pub fn dropped(&self) -> bool {
        self.dropped
    }

    /// Drops the source because other sources contradict it.
    pub fn reject(&mut self) {
        (self.rejection_rate, self.dropped) = (1.0, true);
    }

    /// Clears the check after a filter reset to this source.
    pub fn clear(&mut self) {
        (self.rejection_rate, self.dropped) = (0.0, false);
    }
}

/// Detects whether a rejected source has a constant offset from the filter (as after a jump) or is only noisy.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OffsetMonitor {
    previous: Option<(Vec3<Ned>, SimTime)>,
}

impl OffsetMonitor {
    /// Records an offset from the filter, m. Returns how many seconds the offset has stayed constant within
    /// `tolerance_m`.
    pub fn record_offset(&mut self, distance_m: Vec3<Ned>, tolerance_m: f64, now: SimTime) -> f64 {
        match self.previous {
            Some((then, since)) if (distance_m - then).norm() <= tolerance_m => (now - since).s(),
            _ => {
                self.previous = Some((distance_m, now));
                0.0
            }
        }
    }

    /// Clears the monitor once the source agrees with the filter again.
    pub fn clear(&mut self) {
        self.previous = None;
    }
}

/// The checks of all sources.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct InnovationChecks {
    /// Barometer.
    pub baro: InnovationCheck,
    /// Magnetometer.
    pub mag: InnovationCheck,
    /// Horizontal GNSS position.
    pub gnss: InnovationCheck,
    /// GNSS height.
    pub gnss_height: InnovationCheck,
    /// GNSS velocity.
    pub gnss_velocity: InnovationCheck,
    /// Offset monitor of the barometer.
    pub baro_offset_monitor: OffsetMonitor,
    /// Offset monitor of the GNSS receiver.
    pub gnss_offset_monitor: OffsetMonitor,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_source_is_dropped_after_1_s_and_recovers_after_2_s() {
        let mut check = InnovationCheck::default();
        let mut at = SimTime::ZERO;
        let mut feed = |fits: bool, ms: i64| {
            for _ in 0..ms / 20 {
                at += SimTime::from_ms(20);
                check.should_fuse(fits, at);
            }
            check.dropped()
        };
        assert!(!feed(true, 1_000) && !feed(false, 500), "half a second of rejections is not a fault");
        assert!(feed(false, 500), "one second of rejections is a fault");
        assert!(feed(true, 1_000), "the source must not be used again immediately");
        assert!(!feed(true, 1_000));
    }
}
