//! Speed: always shown, upper left. It is a number for displays and never a text.

/// What a display writes, from a speed in m/s.
#[must_use]
pub fn display(speed_m_s: f64) -> String {
    format!("{speed_m_s:.1} m/s")
}
