//! Speed display, always visible at the upper left; never produces a text.

/// Formats a speed in m/s for display.
#[must_use]
pub fn display(speed_m_s: f64) -> String {
    format!("{speed_m_s:.1} m/s")
}
