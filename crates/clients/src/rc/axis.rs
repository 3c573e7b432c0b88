//! Calibration of one raw axis: endpoints, center, dead band, and expo.

/// Minimum distance of each endpoint from the center, in raw units (full range: 2; estimate: a stick axis moves
/// farther).
pub const MIN_ENDPOINT_DISTANCE: f64 = 0.1;

/// Calibration of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisCalibration {
    /// Axis number on the device.
    pub axis: u32,
    /// Raw reading with the stick fully left or down. Greater than `high` if the axis is reversed.
    pub low: f64,
    /// Raw reading at rest.
    pub centre: f64,
    /// Raw reading with the stick fully right or up.
    pub high: f64,
    /// Fraction of the travel around the center that reads as centered, 0 to 0.5.
    pub dead_band: f64,
    /// Softening of the response near the center, 0 (linear) to 1 (cubic).
    pub expo: f64,
}

impl AxisCalibration {
    /// Returns the calibrated value in [-1, 1]. It is 0 within the dead band, continuous at its edge, and ±1 at and
    /// beyond the endpoints.
    #[must_use]
    pub fn read(&self, raw: f64) -> f64 {
        let end = if (raw - self.centre) * (self.high - self.centre) >= 0.0 { self.high } else { self.low };
        let sign = if end == self.high { 1.0 } else { -1.0 };
        let way = end - self.centre;
        let part = if way == 0.0 { 0.0 } else { ((raw - self.centre) / way).clamp(0.0, 1.0) };
        let free = ((part - self.dead_band) / (1.0 - self.dead_band)).max(0.0);
        sign * ((1.0 - self.expo) * free + self.expo * free * free * free)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding error after a few multiplications of numbers below 1.
    const ROUNDING_ERROR: f64 = 1e-15;

    fn full_range_axis() -> AxisCalibration {
        AxisCalibration { axis: 0, low: -1.0, centre: 0.0, high: 1.0, dead_band: 0.0, expo: 0.0 }
    }

    #[test]
    fn exact_endpoints_and_center_map_to_one_and_zero() {
        let axis = AxisCalibration { low: -0.8, centre: 0.1, high: 0.9, ..full_range_axis() };
        for (raw, read) in [(-0.8, -1.0), (-1.0, -1.0), (0.1, 0.0), (0.5, 0.5), (0.9, 1.0), (1.0, 1.0), (-0.35, -0.5)] {
            assert!((axis.read(raw) - read).abs() < ROUNDING_ERROR, "{raw}");
        }
    }

    #[test]
    fn exact_reversed_axis_is_inverted() {
        let axis = AxisCalibration { low: 1.0, centre: 0.0, high: -1.0, ..full_range_axis() };
        assert_eq!([axis.read(1.0), axis.read(0.5), axis.read(-0.25), axis.read(-1.0)], [-1.0, -0.5, 0.25, 1.0]);
    }

    #[test]
    fn exact_dead_band_is_continuous_and_expo_keeps_the_endpoints() {
        let axis = AxisCalibration { dead_band: 0.2, expo: 0.5, ..full_range_axis() };
        assert_eq!((axis.read(0.2), axis.read(-0.2), axis.read(1.0), axis.read(-1.0)), (0.0, 0.0, 1.0, -1.0));
        let just = axis.read(0.2 + 1e-9);
        assert!(just > 0.0 && just < 1e-8);
        // The reading is halfway between the edge of the dead band and the endpoint: 0.5 · 0.5 + 0.5 · 0.125.
        assert!((axis.read(0.6) - 0.3125).abs() < ROUNDING_ERROR);
    }
}
