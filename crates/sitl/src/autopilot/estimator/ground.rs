//! Uses the range finder to choose between two heights: the one that implies a constant ground level is correct.

/// Decision threshold, as a fraction of the height difference: the ground level must move by less than this according
/// to one height and by more than the remainder according to the other.
const DECISION_FRACTION: f64 = 0.3;

/// Ground levels from the range finder, computed from each height, m down.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GroundEstimate {
    range_m: Option<f64>,
    agreed: Option<[f64; 2]>,
}

impl GroundEstimate {
    /// Adds a measurement of the vertical distance to the ground, m; infinite if the ground is out of range.
    pub fn add_measurement(&mut self, range_m: f64) {
        self.range_m = Some(range_m).filter(|range| range.is_finite());
        if self.range_m.is_none() {
            self.agreed = None;
        }
    }

    /// Records the ground levels while the filter height and the GNSS height agree, m down.
    pub fn record_agreement(&mut self, filter_down_m: f64, receiver_down_m: f64) {
        self.agreed = self.range_m.map(|range| [filter_down_m + range, receiver_down_m + range]);
    }

    /// Returns true if only the GNSS height implies that the ground has moved.
    #[must_use]
    pub fn agrees_with_filter(&self, filter_down_m: f64, receiver_down_m: f64) -> bool {
        let (Some(range), Some([filter_then, receiver_then])) = (self.range_m, self.agreed) else { return false };
        let by_filter = (filter_down_m + range - filter_then).abs();
        let by_receiver = (receiver_down_m + range - receiver_then).abs();
        let apart = (by_filter - by_receiver).abs();
        by_filter < DECISION_FRACTION * apart && by_receiver > (1.0 - DECISION_FRACTION) * apart
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_height_with_constant_ground_level_is_selected() {
        let mut ground = GroundEstimate::default();
        ground.add_measurement(5.0);
        ground.record_agreement(-5.0, -5.2);
        // The GNSS height rises while the range stays constant.
        assert!(ground.agrees_with_filter(-5.1, -9.0));
        // The filter height is constant while the range increases with the GNSS height.
        ground.add_measurement(9.0);
        assert!(!ground.agrees_with_filter(-5.0, -9.1));
        ground.add_measurement(f64::INFINITY);
        assert!(!ground.agrees_with_filter(-5.1, -9.0), "no ground in range");
    }
}
