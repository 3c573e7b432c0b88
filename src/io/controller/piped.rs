//! Controller events that another program writes to standard input.

use crate::errors::AppError;
use spandrel_clients::rc::input_recording::LiveInput;
use spandrel_clients::rc::{Device, DeviceEvent};
use std::io::{BufRead, StdinLock};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};

/// Name of standard input in error messages.
const NAME: &str = "standard input";

/// Events of a device whose part another program plays.
#[derive(Debug)]
pub struct PipedEvents {
    device: Device,
    events: Receiver<DeviceEvent>,
    is_over: bool,
}

impl PipedEvents {
    /// Reads the first line, which describes the device, and starts to read the events.
    ///
    /// # Errors
    /// Returns an error if standard input cannot be read or its first line is invalid.
    pub fn open() -> Result<Self, AppError> {
        let mut first = String::new();
        std::io::stdin().read_line(&mut first).map_err(|error| AppError::invalid(format!("{NAME}: {error}")))?;
        let live = LiveInput::begin(NAME, first.trim_end()).map_err(AppError::invalid)?;
        let (sender, events) = channel();
        let device = live.device.clone();
        std::thread::spawn(move || send_events(std::io::stdin().lock(), live, &sender));
        Ok(Self { device, events, is_over: false })
    }

    /// Returns the device.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// Returns the next event that has arrived.
    pub fn next(&mut self) -> Option<DeviceEvent> {
        match self.events.try_recv() {
            Ok(event) => Some(event),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => {
                self.is_over = true;
                None
            }
        }
    }

    /// Returns true once the other program has closed standard input.
    pub fn is_over(&self) -> bool {
        self.is_over
    }
}

/// Sends the events of all lines until standard input ends. Invalid lines are reported; the flight continues.
fn send_events(input: StdinLock, mut live: LiveInput, events: &Sender<DeviceEvent>) {
    for line in input.split(b'\n') {
        let Ok(bytes) = line.inspect_err(|error| tracing::warn!("{NAME}: {error}")) else { return };
        match live.next(&String::from_utf8_lossy(&bytes)) {
            Ok(event) if events.send(event).is_err() => return,
            Ok(_) => {}
            Err(error) => tracing::warn!("{error}; the line has no effect"),
        }
    }
}
