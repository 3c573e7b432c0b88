//! Where sticks come from: a gamepad or transmitter (feature `gamepad`), the terminal's keyboard, a record.

mod calibrated;
#[cfg(feature = "gamepad")]
mod gamepad;
mod profiles;
mod terminal;

pub use calibrated::{CalibratedController, ControllerReading};
pub use profiles::{ProfileFolder, read as read_profile};
pub use terminal::{RawTerminal, TerminalKey};

use super::files;
use crate::errors::AppError;
use spandrel_clients::rc::input_recording::InputRecording;
use spandrel_clients::rc::keyboard::KeyBindings;
use spandrel_clients::rc::{Device, DeviceEvent};
use spandrel_model::time::SimTime;
use std::path::Path;

/// A source of raw events.
#[derive(Debug)]
pub enum EventSource {
    /// A device on this machine.
    #[cfg(feature = "gamepad")]
    Gamepad(Box<gamepad::Gamepad>),
    /// What one reported earlier.
    Record(InputRecording),
}

impl EventSource {
    /// The device with this name or id, or the only one.
    ///
    /// # Errors
    /// When there is none, several fit, or this build has no support for them.
    pub fn device(wanted: Option<&str>) -> Result<Self, AppError> {
        #[cfg(feature = "gamepad")]
        return gamepad::Gamepad::open(wanted).map(|gamepad| Self::Gamepad(Box::new(gamepad)));
        #[cfg(not(feature = "gamepad"))]
        Err(AppError::failed(format!("{}: {NO_GAMEPADS}", wanted.unwrap_or("a gamepad or transmitter"))))
    }

    /// Whose events these are.
    pub fn of(&self) -> &Device {
        match self {
            #[cfg(feature = "gamepad")]
            Self::Gamepad(gamepad) => gamepad.device(),
            Self::Record(record) => &record.device,
        }
    }

    /// The next event by now.
    pub fn next(&mut self, now: SimTime) -> Option<DeviceEvent> {
        match self {
            #[cfg(feature = "gamepad")]
            Self::Gamepad(gamepad) => gamepad.next(),
            Self::Record(record) => record.due(now),
        }
    }

    /// A record that has been played to its end.
    pub fn is_over(&self) -> bool {
        match self {
            #[cfg(feature = "gamepad")]
            Self::Gamepad(_) => false,
            Self::Record(record) => record.is_over(),
        }
    }
}

#[cfg(not(feature = "gamepad"))]
const NO_GAMEPADS: &str = "this build reads no gamepads (build with --features gamepad; on Debian and Ubuntu that needs libudev-dev); --keyboard flies without one";

/// Waits for a device while there is none.
#[derive(Debug, Default)]
#[cfg(feature = "view")]
pub struct DeviceWatcher {
    #[cfg(feature = "gamepad")]
    system: Option<gamepad::GamepadWatcher>,
}

#[cfg(feature = "view")]
impl DeviceWatcher {
    /// Begins to wait, where the system can tell.
    pub fn start() -> Self {
        Self {
            // Why it cannot was told when a device was looked for.
            #[cfg(feature = "gamepad")]
            system: gamepad::GamepadWatcher::start().ok(),
        }
    }

    /// A device has come since the last look.
    pub fn is_available(&mut self) -> bool {
        #[cfg(feature = "gamepad")]
        return self.system.as_mut().is_some_and(gamepad::GamepadWatcher::is_available);
        #[cfg(not(feature = "gamepad"))]
        false
    }
}

/// Which key does what: a file's, or the usual ones.
///
/// # Errors
/// When the file cannot be read or is wrong.
pub fn keys(file: Option<&Path>) -> Result<KeyBindings, AppError> {
    match file {
        Some(path) => Ok(KeyBindings::read(&path.display().to_string(), &files::read(path)?)?),
        None => Ok(KeyBindings::default()),
    }
}

/// All devices that are connected.
///
/// # Errors
/// When the system cannot tell, or this build has no support for them.
pub fn connected() -> Result<Vec<Device>, AppError> {
    #[cfg(feature = "gamepad")]
    return gamepad::connected();
    #[cfg(not(feature = "gamepad"))]
    Err(AppError::failed(NO_GAMEPADS))
}
