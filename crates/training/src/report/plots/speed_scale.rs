//! Classes of equal width for speeds, from 0 to a round number.

use super::ticks;

/// Number of classes.
pub const CLASSES: usize = 8;

/// A scale of speeds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedScale {
    /// Width of a class, m/s.
    step_m_s: f64,
}

impl SpeedScale {
    /// Returns the scale with the narrowest round classes that contain a speed, m/s.
    #[must_use]
    pub fn up_to(max_m_s: f64) -> Self {
        let step_m_s = ticks(max_m_s, CLASSES).get(1).copied().unwrap_or(1.0);
        Self { step_m_s }
    }

    /// Returns the end of the scale, m/s.
    #[must_use]
    pub fn top_m_s(self) -> f64 {
        self.step_m_s * CLASSES as f64
    }

    /// Returns the class of a speed, from 0.
    #[must_use]
    pub fn class(self, speed_m_s: f64) -> usize {
        ((speed_m_s / self.step_m_s) as usize).min(CLASSES - 1)
    }

    /// Returns the limits of a class, m/s.
    #[must_use]
    pub fn limits_m_s(self, class: usize) -> (f64, f64) {
        (class as f64 * self.step_m_s, (class + 1) as f64 * self.step_m_s)
    }

    /// Returns the number of decimal places of the limits.
    #[must_use]
    pub fn digits(self) -> usize {
        if self.step_m_s < 0.1 { 2 } else { usize::from(self.step_m_s < 1.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_scales_have_round_classes_that_contain_the_highest_speed() {
        for (max_m_s, step_m_s, digits) in
            [(1.3, 0.2, 1), (2.9, 0.5, 1), (7.9, 1.0, 0), (8.1, 2.0, 0), (0.5, 0.1, 1), (0.3, 0.05, 2)]
        {
            let scale = SpeedScale::up_to(max_m_s);
            assert!((scale.limits_m_s(0).1 - step_m_s).abs() < 1e-12 && scale.top_m_s() >= max_m_s, "{max_m_s}: {scale:?}");
            assert_eq!(scale.digits(), digits, "{max_m_s}");
            let class = scale.class(max_m_s);
            let (low, high) = scale.limits_m_s(class);
            assert!((low..=high).contains(&max_m_s), "{max_m_s}: {low} {high}");
        }
        assert_eq!([0.0, 0.49, 0.5, 9.0].map(|speed| SpeedScale::up_to(2.9).class(speed)), [0, 0, 1, 7]);
    }
}
