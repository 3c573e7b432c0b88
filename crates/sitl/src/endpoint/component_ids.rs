//! Component IDs of the vehicle.

/// Component ID of the autopilot.
pub const AUTOPILOT: u8 = 1;
/// Component ID of the camera.
pub const CAMERA: u8 = 100;
