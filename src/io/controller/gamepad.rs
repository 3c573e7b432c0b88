//! Gamepads and RC transmitters, accessed through gilrs. Axes are raw; the calibration assigns their functions.

use super::device_error::DeviceError;
use gilrs::{EventType, GamepadId, Gilrs, GilrsBuilder};
use spandrel_clients::rc::{Device, DeviceEvent};

/// Event type of an absolute axis (linux/input-event-codes.h, EV_ABS). Linux stores it in the bits above the event
/// code.
const EV_ABS: u32 = 3;

/// A connected gamepad or transmitter.
#[derive(Debug)]
pub struct Gamepad {
    system: Gilrs,
    id: GamepadId,
    device: Device,
}

fn system() -> Result<Gilrs, DeviceError> {
    // gilrs filters are off because the profile defines dead bands, and gilrs mappings are off because raw axes are
    // needed.
    let built = GilrsBuilder::new().with_default_filters(false).add_included_mappings(false).add_env_mappings(false).build();
    built.map_err(|error| DeviceError::NoAccess(error.to_string()))
}

fn describe(gamepad: gilrs::Gamepad) -> Device {
    let id = match (gamepad.vendor_id(), gamepad.product_id()) {
        (Some(vendor), Some(product)) => format!("{vendor:04x}:{product:04x}"),
        _ => gamepad.uuid().iter().map(|byte| format!("{byte:02x}")).collect(),
    };
    Device { name: gamepad.os_name().to_owned(), id }
}

/// Detects newly connected devices. The device list is read once and then updated by events.
#[cfg(feature = "view")]
#[derive(Debug)]
pub struct GamepadWatcher(Gilrs);

#[cfg(feature = "view")]
impl GamepadWatcher {
    /// Starts watching for new devices.
    pub fn start() -> Result<Self, DeviceError> {
        system().map(Self)
    }

    /// Returns true if a device was connected since the last call.
    pub fn is_available(&mut self) -> bool {
        std::iter::from_fn(|| self.0.next_event()).filter(|event| event.event == EventType::Connected).count() > 0
    }
}

/// Returns all connected devices.
pub fn connected() -> Result<Vec<Device>, DeviceError> {
    Ok(system()?.gamepads().map(|(_, gamepad)| describe(gamepad)).collect())
}

impl Gamepad {
    /// Opens the device with this ID or name, or the only device.
    pub fn open(wanted: Option<&str>) -> Result<Self, DeviceError> {
        let system = system()?;
        let all: Vec<(GamepadId, Device)> = system.gamepads().map(|(id, gamepad)| (id, describe(gamepad))).collect();
        let fits =
            |device: &Device| wanted.is_none_or(|w| device.id == w || device.name.to_lowercase().contains(&w.to_lowercase()));
        let fitting: Vec<&(GamepadId, Device)> = all.iter().filter(|(_, device)| fits(device)).collect();
        let connected = || all.iter().map(|(_, d)| format!("'{}' ({})", d.name, d.id)).collect();
        match (fitting.as_slice(), wanted) {
            ([(id, device)], _) => Ok(Self { id: *id, device: device.clone(), system }),
            ([], None) => Err(DeviceError::NotConnected),
            ([], Some(wanted)) => Err(DeviceError::NoMatch { wanted: wanted.to_owned(), connected: connected() }),
            _ => Err(DeviceError::Ambiguous { connected: connected() }),
        }
    }

    /// Returns the device's name and ID.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// Returns the device's next event.
    pub fn next(&mut self) -> Option<DeviceEvent> {
        while let Some(event) = self.system.next_event() {
            if event.id != self.id {
                continue;
            }
            match event.event {
                EventType::AxisChanged(_, value, code) => {
                    return Some(DeviceEvent::Axis { axis: code.into_u32(), value: f64::from(value) });
                }
                // Trigger axis, 0 to 1.
                EventType::ButtonChanged(_, value, code) if code.into_u32() >> 16 == EV_ABS => {
                    return Some(DeviceEvent::Axis { axis: code.into_u32(), value: 2.0 * f64::from(value) - 1.0 });
                }
                EventType::ButtonPressed(_, code) => return Some(DeviceEvent::Button { button: code.into_u32(), pressed: true }),
                EventType::ButtonReleased(_, code) => {
                    return Some(DeviceEvent::Button { button: code.into_u32(), pressed: false });
                }
                EventType::Connected => return Some(DeviceEvent::Found),
                EventType::Disconnected => return Some(DeviceEvent::Lost),
                _ => {}
            }
        }
        None
    }
}
