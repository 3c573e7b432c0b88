//! What a device reports, before anybody says what it means.

use std::collections::{BTreeMap, BTreeSet};

/// A gamepad or a transmitter, as it calls itself.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Device {
    /// Name for people.
    pub name: String,
    /// Identity of its kind: the same for two alike, the same after a restart (vendor and product, or the system's GUID).
    pub id: String,
}

/// Something changed at a device.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DeviceEvent {
    /// An axis moved.
    Axis {
        /// Number of the axis by the system's own count.
        axis: u32,
        /// Where it stands, -1 to 1 of what the system takes for its range.
        value: f64,
    },
    /// A button went down or up.
    Button {
        /// Number of the button by the system's own count.
        button: u32,
        /// It is down.
        pressed: bool,
    },
    /// The device is gone: unplugged, out of power.
    Lost,
    /// It is there (again).
    Found,
}

/// Where everything stands.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RawInput {
    /// Axes that have been heard of, -1 to 1.
    pub axes: BTreeMap<u32, f64>,
    /// Buttons that are down.
    pub down: BTreeSet<u32>,
    /// The device is gone.
    pub lost: bool,
}

impl RawInput {
    /// Takes an event in. A value that is no number is none.
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
    fn exact_a_lost_device_forgets_where_it_stood_and_nonsense_moves_nothing() {
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
