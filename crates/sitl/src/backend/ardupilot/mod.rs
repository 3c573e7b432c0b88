//! ArduPilot's JSON simulator interface over UDP: ArduPilot sends the motor outputs of a frame and waits for the state of the
//! aircraft, one line of JSON. GNSS, range finders, optical flow and the errors of the barometer and the compass travel as MAVLink
//! messages on the ordinary link, because the JSON line has no fields for them.

mod airframe;
mod frame;
mod interface;
mod launch;
mod sensor_errors;
mod sensor_messages;
mod servo_packet;
mod state_line;
#[cfg(test)]
mod tests;

pub use airframe::parameters;
pub use frame::{Frame, FrameError, frame};
pub use interface::ArduPilotInterface;
pub use launch::{DEFAULTS_FILE, launch};

/// Rates at which ArduPilot can receive the state, Hz, the default first: whole numbers of physics ticks a frame. Its main loop
/// runs at half the rate, because ArduPilot refuses to arm with readings that are less than 1.8 times as fast.
pub const RATES_HZ: [f64; 2] = [1000.0, 500.0];
