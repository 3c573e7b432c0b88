//! The range finder as a witness: which of two heights keeps the ground below where it is.

/// A contradiction of heights is decided by the range finder where it sides with one of them this clearly: the ground by the one has moved
/// by less than this share of the contradiction, by the other by more than the rest.
const CLEAR_SHARE: f64 = 0.3;

/// Where the ground lies by the range finder, measured from each height, m down.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GroundEstimate {
    range_m: Option<f64>,
    agreed: Option<[f64; 2]>,
}

impl GroundEstimate {
    /// Takes in the vertical distance to the ground, m; infinite beyond reach.
    pub fn add_measurement(&mut self, range_m: f64) {
        self.range_m = Some(range_m).filter(|range| range.is_finite());
        if self.range_m.is_none() {
            self.agreed = None;
        }
    }

    /// The filter's height and the receiver's agree, m down.
    pub fn samples_agree(&mut self, filter_down_m: f64, receiver_down_m: f64) {
        self.agreed = self.range_m.map(|range| [filter_down_m + range, receiver_down_m + range]);
    }

    /// They contradict each other, and the ground has moved by the receiver's height alone.
    #[must_use]
    pub fn agrees_with_filter(&self, filter_down_m: f64, receiver_down_m: f64) -> bool {
        let (Some(range), Some([filter_then, receiver_then])) = (self.range_m, self.agreed) else { return false };
        let by_filter = (filter_down_m + range - filter_then).abs();
        let by_receiver = (receiver_down_m + range - receiver_then).abs();
        let apart = (by_filter - by_receiver).abs();
        by_filter < CLEAR_SHARE * apart && by_receiver > (1.0 - CLEAR_SHARE) * apart
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_the_height_that_keeps_the_ground_in_place_is_believed() {
        let mut ground = GroundEstimate::default();
        ground.add_measurement(5.0);
        ground.samples_agree(-5.0, -5.2);
        // The receiver climbs, the range does not.
        assert!(ground.agrees_with_filter(-5.1, -9.0));
        // The filter stands, the range grows with the receiver.
        ground.add_measurement(9.0);
        assert!(!ground.agrees_with_filter(-5.0, -9.1));
        ground.add_measurement(f64::INFINITY);
        assert!(!ground.agrees_with_filter(-5.1, -9.0), "nothing to see");
    }
}
