//! Raw input as reported by a device.

use std::collections::{BTreeMap, BTreeSet};

/// Identity of a gamepad or transmitter, as reported by the device.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Device {
    /// Name shown to the user.
    pub name: String,
    /// Model ID (vendor and product, or the system's GUID). The same for all devices of a model and across restarts.
    pub id: String,
}

/// A change reported by a device.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DeviceEvent {
    /// An axis moved.
    Axis {
        /// Axis number assigned by the operating system.
        axis: u32,
        /// Position, -1 to 1, as a fraction of the range reported by the system.
        value: f64,
    },
    /// A button was pressed or released.
    Button {
        /// Button number assigned by the operating system.
        button: u32,
        /// Whether the button is pressed.
        pressed: bool,
    },
    /// The device was unplugged or lost power.
    Lost,
    /// The device is connected, for the first time or again.
    Found,
}

/// Current state of a device.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RawInput {
    /// Axes reported so far, -1 to 1.
    pub axes: BTreeMap<u32, f64>,
    /// Numbers of the pressed buttons.
    pub down: BTreeSet<u32>,
    /// Whether the device is disconnected.
    pub lost: bool,
}

impl RawInput {
    /// Applies an event. Ignores values that are not finite.
    pub fn apply(&mut self, event: DeviceEvent) {
        match event {
            DeviceEvent::Axis { axis, value } if value.is_finite() => {
                self.axes.insert(axis, value.clamp(-1.0, 1.0));
            }
            DeviceEvent::Axis { .. } => {}
            DeviceEvent::Button { button, pressed: true } => {
                self.down.insert(button);
            }
            DeviceEvent::Button { button, pressed: false } => {
                self.down.remove(&button);
            }
            DeviceEvent::Lost => *self = Self { lost: true, ..Self::default() },
            DeviceEvent::Found => self.lost = false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_lost_device_clears_its_state_and_invalid_values_are_ignored() {
        let mut raw = RawInput::default();
        raw.apply(DeviceEvent::Axis { axis: 1, value: 0.5 });
        raw.apply(DeviceEvent::Axis { axis: 1, value: f64::NAN });
        raw.apply(DeviceEvent::Axis { axis: 2, value: 7.0 });
        raw.apply(DeviceEvent::Button { button: 3, pressed: true });
        assert_eq!((raw.axes[&1], raw.axes[&2], raw.down.contains(&3)), (0.5, 1.0, true));
        raw.apply(DeviceEvent::Lost);
        assert_eq!(raw, RawInput { lost: true, ..RawInput::default() });
        raw.apply(DeviceEvent::Found);
        assert!(!raw.lost);
    }
}
