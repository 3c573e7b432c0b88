//! The drone's lamp.

/// On or off, and how bright.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LampState {
    /// Shines.
    pub on: bool,
    /// Brightness, %.
    pub brightness_pct: f64,
}

impl LampState {
    /// Dark.
    pub const OFF: Self = Self { on: false, brightness_pct: 100.0 };
}
