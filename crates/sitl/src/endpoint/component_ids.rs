//! The vehicle's component IDs.

/// Autopilot component ID.
pub const AUTOPILOT: u8 = 1;
/// Camera component ID.
pub const CAMERA: u8 = 100;
