//! Controllers: converts raw device input to stick positions through a calibrated profile, and stick positions to
//! MAVLink.
//!
//! A device is a list of raw axes and buttons with no assigned functions ([`raw_input`]). A [`profile`] assigns axes to
//! stick directions, with their centers and endpoints, and buttons to actions; the [`wizard`] creates one
//! interactively. The [`keyboard`] replaces a missing device, and [`key`] defines the key names. [`controller_link`]
//! sends the result to a vehicle; [`input_recording`] records and replays events. This module does not access clocks,
//! devices, or sockets.

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

/// Stick inputs, each in [-1, 1]: forward, right, up, and clockwise as seen from above.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sticks {
    /// Forward (pitch).
    pub forward: f64,
    /// Right (roll).
    pub right: f64,
    /// Up (throttle), 0 at the center.
    pub up: f64,
    /// Clockwise (yaw).
    pub yaw: f64,
}
