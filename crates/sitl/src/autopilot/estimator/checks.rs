//! Consistency of each source with the filter: a source whose measurements keep falling outside their gate is dropped, and comes back
//! once they fit again.

use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::time::SimTime;

/// The share of refused measurements is averaged over this time, s (estimate: a second of refusals drops a source, single ones do not).
const AVERAGED_S: f64 = 0.5;
/// A source is dropped above this share of refused measurements.
const DROPPED: f64 = 0.8;
/// It comes back below this one, after 2 s in which every measurement fits.
const BACK: f64 = 0.02;
/// Measurements further apart than this count as this far apart, s: one refusal after a long gap drops nothing.
const LONGEST_GAP_S: f64 = 0.25;
/// A source that is refused for this long is believed again where nothing better is left, s.
pub const REFUSED_S: f64 = 3.0;

/// How well one source fits the filter.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct InnovationCheck {
    refused_share: f64,
    last: Option<SimTime>,
    dropped: bool,
}

impl InnovationCheck {
    /// Takes note of a measurement that fits or not; true if it is to be fused.
    pub fn admits(&mut self, fits: bool, now: SimTime) -> bool {
        let gap_s = self.last.map_or(LONGEST_GAP_S, |last| (now - last).s()).min(LONGEST_GAP_S);
        self.last = Some(now);
        let refused = if fits { 0.0 } else { 1.0 };
        self.refused_share += (refused - self.refused_share) * (gap_s / AVERAGED_S);
        self.dropped = self.refused_share > if self.dropped { BACK } else { DROPPED };
        fits && !self.dropped
    }

    /// The source is not used.
    #[must_use]
    pub fn dropped(&self) -> bool {
        self.dropped
    }

    /// Drops the source: others have shown that it is wrong.
    pub fn reject(&mut self) {
        (self.refused_share, self.dropped) = (1.0, true);
    }

    /// The filter has been set to the source.
    pub fn forget(&mut self) {
        (self.refused_share, self.dropped) = (0.0, false);
    }
}

/// Whether a refused source agrees with itself: its distance from the filter stays the same, as after a jump, and is not noise.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RejectionMonitor {
    previous: Option<(Vec3<Ned>, SimTime)>,
}

impl RejectionMonitor {
    /// Takes note of a distance from the filter, m; returns for how long it has stayed within `tolerance_m`, s.
    pub fn hold_s(&mut self, distance_m: Vec3<Ned>, tolerance_m: f64, now: SimTime) -> f64 {
        match self.previous {
            Some((then, since)) if (distance_m - then).norm() <= tolerance_m => (now - since).s(),
            _ => {
                self.previous = Some((distance_m, now));
                0.0
            }
        }
    }

    /// The source fits again.
    pub fn forget(&mut self) {
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
    /// The receiver's horizontal position.
    pub gnss: InnovationCheck,
    /// The receiver's height.
    pub gnss_height: InnovationCheck,
    /// The receiver's velocity.
    pub gnss_velocity: InnovationCheck,
    /// How steady the barometer is off.
    pub baro_off: RejectionMonitor,
    /// How steady the receiver is off.
    pub gnss_off: RejectionMonitor,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_second_of_refusals_drops_a_source_and_two_of_agreement_bring_it_back() {
        let mut check = InnovationCheck::default();
        let mut at = SimTime::ZERO;
        let mut feed = |fits: bool, ms: i64| {
            for _ in 0..ms / 20 {
                at += SimTime::from_ms(20);
                check.admits(fits, at);
            }
            check.dropped()
        };
        assert!(!feed(true, 1_000) && !feed(false, 500), "half a second is an outlier");
        assert!(feed(false, 500), "a second is a fault");
        assert!(feed(true, 1_000), "not back at once");
        assert!(!feed(true, 1_000));
    }
}
