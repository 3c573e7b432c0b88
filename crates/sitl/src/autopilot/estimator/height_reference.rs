//! The height reference and its state.

use super::checks::{InnovationCheck, OffsetMonitor};
use spandrel_model::time::SimTime;

/// Height reference, numbered as in `EKF2_HGT_REF` (ArduPilot: `EK3_SRC1_POSZ`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum HeightReference {
    /// Barometer. The GNSS height is treated as slowly drifting.
    Barometer,
    /// GNSS. The barometer is weighted by its drift.
    #[default]
    Gnss,
    /// Range finder: height above the ground below.
    RangeFinder,
}

impl HeightReference {
    /// Returns the reference for a parameter value. Vision is not supported; GNSS is used instead.
    #[must_use]
    pub fn from_number(number: i32) -> Self {
        match number {
            0 => Self::Barometer,
            2 => Self::RangeFinder,
            _ => Self::Gnss,
        }
    }
}

/// The active height reference and the checks of the range finder.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HeightReferenceState {
    pub(super) reference: HeightReference,
    /// Ground level from the range finder, m down.
    pub(super) ground_down_m: Option<f64>,
    pub(super) barometer: Option<SimTime>,
    pub(super) range: Option<SimTime>,
    pub(super) check: InnovationCheck,
    pub(super) off: OffsetMonitor,
}

impl HeightReferenceState {
    /// Records that the barometer was fused.
    pub fn record_barometer_fusion(&mut self, now: SimTime) {
        self.barometer = Some(now);
    }

    /// Clears the ground level after the vehicle has been moved.
    pub fn clear_ground_level(&mut self) {
        (self.ground_down_m, self.check, self.off) = (None, InnovationCheck::default(), OffsetMonitor::default());
    }
}
