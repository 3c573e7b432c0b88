//! Sample rate, and click-free level changes.

/// Sample rate, Hz: more than twice the highest harmonic.
pub const SAMPLE_RATE_HZ: u32 = 24_000;
/// Time constant of level changes, s (estimate: faster than a motor, slow enough to prevent clicks).
const SLEW_TIME_S: f64 = 0.02;

/// A value that approaches its target without jumps.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct SmoothedValue(f64);

impl SmoothedValue {
    /// Advances by one sample and returns the new value.
    pub(super) fn follow(&mut self, target: f64) -> f64 {
        self.0 += (target - self.0) / (SLEW_TIME_S * f64::from(SAMPLE_RATE_HZ));
        self.0
    }
}
