//! Sources of stick input: gamepads and transmitters (feature `gamepad`), the terminal's keyboard, recordings, and other programs.

mod calibrated;
mod device_error;
#[cfg(feature = "gamepad")]
mod gamepad;
mod piped;
mod profiles;
mod terminal;

pub use calibrated::{CalibratedController, ControllerReading};
pub use device_error::DeviceError;
pub use piped::PipedEvents;
pub use profiles::{ProfileFolder, read as read_profile};
pub use terminal::{RawTerminal, TerminalKey};

use super::files;
use crate::errors::AppError;
use spandrel_clients::rc::input_recording::InputRecording;
use spandrel_clients::rc::keyboard::KeyBindings;
use spandrel_clients::rc::{Device, DeviceEvent};
use spandrel_model::time::SimTime;
use std::path::Path;

/// A source of raw controller events.
#[derive(Debug)]
pub enum EventSource {
    /// A device connected to this computer.
    #[cfg(feature = "gamepad")]
    Gamepad(Box<gamepad::Gamepad>),
    /// A recording of a device's input.
    Record(InputRecording),
    /// Another program that plays the part of a device.
    Piped(PipedEvents),
}

impl EventSource {
    /// Opens the device with this name or ID, or the only device.
    ///
    /// # Errors
    /// Returns an error if there is none, several match, or this build does not support gamepads.
    pub fn device(wanted: Option<&str>) -> Result<Self, DeviceError> {
        #[cfg(feature = "gamepad")]
        return gamepad::Gamepad::open(wanted).map(|gamepad| Self::Gamepad(Box::new(gamepad)));
        #[cfg(not(feature = "gamepad"))]
        Err(DeviceError::Unsupported { wanted: format!("{}: ", wanted.unwrap_or("a gamepad or transmitter")) })
    }

    /// Returns the device that produces the events.
    pub fn device_info(&self) -> &Device {
        match self {
            #[cfg(feature = "gamepad")]
            Self::Gamepad(gamepad) => gamepad.device(),
            Self::Record(record) => &record.device,
            Self::Piped(piped) => piped.device(),
        }
    }

    /// Returns the next event that occurs by time `now`.
    pub fn next(&mut self, now: SimTime) -> Option<DeviceEvent> {
        match self {
            #[cfg(feature = "gamepad")]
            Self::Gamepad(gamepad) => gamepad.next(),
            Self::Record(record) => record.due(now),
            Self::Piped(piped) => piped.next(),
        }
    }

    /// Returns true at the end of a recording, or of another program's input.
    pub fn is_over(&self) -> bool {
        match self {
            #[cfg(feature = "gamepad")]
            Self::Gamepad(_) => false,
            Self::Record(record) => record.is_over(),
            Self::Piped(piped) => piped.is_over(),
        }
    }
}

/// Detects newly connected devices.
#[derive(Debug, Default)]
#[cfg(feature = "view")]
pub struct DeviceWatcher {
    #[cfg(feature = "gamepad")]
    system: Option<gamepad::GamepadWatcher>,
}

#[cfg(feature = "view")]
impl DeviceWatcher {
    /// Starts watching, if the system supports it.
    pub fn start() -> Self {
        Self {
            // The error was already reported during the search for a device.
            #[cfg(feature = "gamepad")]
            system: gamepad::GamepadWatcher::start().ok(),
        }
    }

    /// Returns true if a device was connected since the last call.
    pub fn is_available(&mut self) -> bool {
        #[cfg(feature = "gamepad")]
        return self.system.as_mut().is_some_and(gamepad::GamepadWatcher::is_available);
        #[cfg(not(feature = "gamepad"))]
        false
    }
}

/// Returns the key bindings from a file, or the default key bindings.
///
/// # Errors
/// Returns an error if the file cannot be read or is invalid.
pub fn keys(file: Option<&Path>) -> Result<KeyBindings, AppError> {
    match file {
        Some(path) => Ok(KeyBindings::read(&path.display().to_string(), &files::read(path)?)?),
        None => Ok(KeyBindings::default()),
    }
}

/// Returns all connected devices.
///
/// # Errors
/// Returns an error if the system cannot list them, or this build does not support gamepads.
pub fn connected() -> Result<Vec<Device>, DeviceError> {
    #[cfg(feature = "gamepad")]
    return gamepad::connected();
    #[cfg(not(feature = "gamepad"))]
    Err(DeviceError::Unsupported { wanted: String::new() })
}
