//! Position of a transmitter switch.

/// Pulse thresholds of the low and high switch positions, microseconds (ArduPilot: AUX_SWITCH_PWM_TRIGGER_LOW and
/// _HIGH).
const LOW_THRESHOLD_US: u16 = 1_200;
const HIGH_THRESHOLD_US: u16 = 1_800;

/// Position of a three-position switch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SwitchPosition {
    /// Below the low threshold.
    Low,
    /// Between the thresholds.
    Middle,
    /// Above the high threshold.
    High,
}

impl SwitchPosition {
    /// Returns the position for a pulse width in microseconds.
    pub(super) fn from_pulse(us: u16) -> Self {
        match us {
            us if us < LOW_THRESHOLD_US => Self::Low,
            us if us > HIGH_THRESHOLD_US => Self::High,
            _ => Self::Middle,
        }
    }

    /// Returns the position for a number from 0 to 2.
    pub(super) fn from_number(number: f64) -> Option<Self> {
        [Self::Low, Self::Middle, Self::High].into_iter().find(|position| (number - f64::from(*position as u8)).abs() < 0.5)
    }
}
