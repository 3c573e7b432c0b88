//! The vehicle's component IDs.

/// Autopilot component ID.
pub const AUTOPILOT: u8 = 1;
/// Camera component ID.
pub const CAMERA: u8 = 100;
/// Telemetry radio component ID (MAV_COMP_ID_TELEMETRY_RADIO), in jobs that simulate the radio.
pub const TELEMETRY_RADIO: u8 = 68;
/// Gimbal device component ID, behind an external autopilot (MAV_COMP_ID_GIMBAL).
pub const GIMBAL: u8 = 154;
/// Power module component ID, behind an external autopilot (MAV_COMP_ID_BATTERY).
pub const BATTERY: u8 = 180;
/// Component ID of the simulator's own messages behind an external autopilot (MAV_COMP_ID_ONBOARD_COMPUTER2): ground truth and
/// scoring data. Behind the built-in autopilot, the autopilot component sends them.
pub const SIMULATOR: u8 = spandrel_mavlink::contract::SIMULATOR_COMPONENT;
/// Lamp component ID, behind an external autopilot (MAV_COMP_ID_ILLUMINATOR).
pub const LAMP: u8 = 243;

/// Components of a vehicle with the built-in autopilot.
pub const BUILTIN: [u8; 2] = [AUTOPILOT, CAMERA];
/// The simulator's components beside an external autopilot.
pub const SEPARATE: [u8; 5] = [CAMERA, GIMBAL, BATTERY, SIMULATOR, LAMP];
