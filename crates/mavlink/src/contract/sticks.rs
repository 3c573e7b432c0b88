//! Stick positions in MAVLink: RC_CHANNELS 1 to 4 are roll, pitch, throttle and yaw. The center is at 1500 us, and full
//! travel is 500 us in each direction. Forward, right, up and clockwise are positive.

/// Pulse width at center, us.
const CENTER_US: i16 = 1500;
/// Difference in pulse width between center and full travel, us.
const HALF_TRAVEL_US: i16 = 500;

/// Stick positions at the resolution of RC_CHANNELS: forward, right, up, clockwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sticks([i16; 4]);

impl Sticks {
    /// Converts the pulse widths of RC_CHANNELS 1 to 4 (roll, pitch, throttle, yaw), in us. Widths beyond full travel
    /// are clamped.
    #[must_use]
    pub fn from_us(channels: [u16; 4]) -> Self {
        let [right, forward, up, clockwise] = channels.map(|us| {
            let off_center = i16::try_from(us).unwrap_or(i16::MAX) - CENTER_US;
            off_center.clamp(-HALF_TRAVEL_US, HALF_TRAVEL_US)
        });
        Self([forward, right, up, clockwise])
    }

    /// Returns the positions (forward, right, up, clockwise), each in [-1, 1].
    #[must_use]
    pub fn axes(self) -> [f64; 4] {
        self.0.map(|step| f64::from(step) / f64::from(HALF_TRAVEL_US))
    }
}

/// Returns the pulse widths of RC_CHANNELS 1 to 4, in us. The stick positions (forward, right, up, clockwise) are in
/// [-1, 1].
#[must_use]
pub fn to_us([forward, right, up, clockwise]: [f64; 4]) -> [u16; 4] {
    [right, forward, up, clockwise].map(|axis| (f64::from(CENTER_US) + f64::from(HALF_TRAVEL_US) * axis).round() as u16)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_sticks_round_trip_within_half_a_microsecond() {
        let sticks = [0.25, -1.0, 1.0, -0.0021];
        let back = Sticks::from_us(to_us(sticks)).axes();
        for (sent, read) in sticks.iter().zip(back) {
            assert!((sent - read).abs() <= 0.5 / f64::from(HALF_TRAVEL_US), "{sent} {read}");
        }
        assert_eq!(to_us([0.25, -1.0, 1.0, 0.0]), [1000, 1625, 2000, 1500]);
        assert_eq!(Sticks::from_us([u16::MAX, 0, 1500, 1500]).axes(), [-1.0, 1.0, 0.0, 0.0]);
    }
}
