//! The drone's lamp: on or off.

/// On or off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LampState {
    /// Shines.
    pub on: bool,
}

impl LampState {
    /// Dark.
    pub const OFF: Self = Self { on: false };
}
