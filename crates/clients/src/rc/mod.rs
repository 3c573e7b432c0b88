//! Controllers: what a device reports, through its calibration, into sticks, and sticks into MAVLink.
//!
//! A device is a list of raw axes and buttons without meaning ([`raw`]). A [`profile`] says which axis is which stick direction, where it
//! rests and ends, and what the buttons do; the [`wizard`] makes one by asking. The [`keyboard`] stands in where there is no device, and
//! [`key`] names its keys.
//! [`link`] sends the result to a vehicle; [`record`] writes events down and plays them again. No clock, no device, no socket in here.

pub mod action;
pub mod axis;
pub mod controller_link;
pub mod input_recording;
pub mod key;
pub mod keyboard;
pub mod profile;
pub mod raw_input;
pub mod wizard;

pub use action::ControllerAction;
pub use profile::{ControllerProfile, StickMode};
pub use raw_input::{Device, DeviceEvent, RawInput};

/// What the sticks ask of the vehicle, each in [-1, 1]: forward, right, up, clockwise seen from above.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sticks {
    /// Forward (pitch).
    pub forward: f64,
    /// To the right (roll).
    pub right: f64,
    /// Up (throttle), 0 in its middle.
    pub up: f64,
    /// Clockwise (yaw).
    pub yaw: f64,
}
