//! Controller profiles, which assign axes to sticks and buttons to actions, and their file format.

use super::action::{self, ControllerAction};
use super::axis::{AxisCalibration, MIN_ENDPOINT_DISTANCE};
use super::{Device, RawInput, Sticks};
use spandrel_model::toml::{Problems, Reader, Section};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Newest supported format version.
pub const FORMAT: i64 = 1;
/// Default dead band of a new profile (estimate: play in a worn gamepad stick).
pub const DEFAULT_DEAD_BAND: f64 = 0.05;
/// Default expo of a new profile (estimate: transmitters typically use 0.2 to 0.4).
pub const DEFAULT_EXPO: f64 = 0.3;
/// Maximum axis or button number: the largest 32-bit unsigned integer.
const MAX_INPUT_NUMBER: i64 = u32::MAX as i64;

/// A stick axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum StickMotion {
    /// Left stick, up positive.
    LeftVertical,
    /// Left stick, right positive.
    LeftHorizontal,
    /// Right stick, up positive.
    RightVertical,
    /// Right stick, right positive.
    RightHorizontal,
}

/// All four axes, with their names in configuration files.
pub const STICK_AXES: [(&str, StickMotion); 4] = [
    ("left_vertical", StickMotion::LeftVertical),
    ("left_horizontal", StickMotion::LeftHorizontal),
    ("right_vertical", StickMotion::RightVertical),
    ("right_horizontal", StickMotion::RightHorizontal),
];

/// Stick mode, numbered as on RC transmitters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StickMode {
    /// Left: pitch and yaw. Right: throttle and roll.
    One,
    /// Left: throttle and yaw. Right: pitch and roll. The most common mode in America and Europe, and DJI's default.
    Two,
    /// Left: pitch and roll. Right: throttle and yaw.
    Three,
    /// Left: throttle and roll. Right: pitch and yaw.
    Four,
}

impl StickMode {
    /// Returns the mode with the given number, or `None` if the number is not 1 to 4.
    #[must_use]
    pub fn from_number(number: i64) -> Option<Self> {
        [Self::One, Self::Two, Self::Three, Self::Four].into_iter().find(|mode| mode.number() == number)
    }

    /// Returns the number of the mode, 1 to 4.
    #[must_use]
    pub fn number(self) -> i64 {
        match self {
            Self::One => 1,
            Self::Two => 2,
            Self::Three => 3,
            Self::Four => 4,
        }
    }

    /// Returns the positions of the physical sticks for stick inputs in this mode: left vertical, left horizontal,
    /// right vertical, right horizontal.
    #[must_use]
    pub fn physical_sticks(self, sticks: Sticks) -> [f64; 4] {
        let Sticks { forward, right, up, yaw } = sticks;
        match self {
            Self::One => [forward, yaw, up, right],
            Self::Two => [up, yaw, forward, right],
            Self::Three => [forward, right, up, yaw],
            Self::Four => [up, right, forward, yaw],
        }
    }

    /// Maps the positions of the physical sticks to stick inputs. Every mode is a permutation.
    #[must_use]
    pub fn sticks(self, read: impl Fn(StickMotion) -> f64) -> Sticks {
        let [lv, lh, rv, rh] = STICK_AXES.map(|(_, way)| read(way));
        match self {
            Self::One => Sticks { forward: lv, yaw: lh, up: rv, right: rh },
            Self::Two => Sticks { up: lv, yaw: lh, forward: rv, right: rh },
            Self::Three => Sticks { forward: lv, right: lh, up: rv, yaw: rh },
            Self::Four => Sticks { up: lv, right: lh, forward: rv, yaw: rh },
        }
    }
}

/// A calibrated device.
#[derive(Debug, Clone, PartialEq)]
pub struct ControllerProfile {
    /// Device to which the profile applies.
    pub device: Device,
    /// Stick mode selected for the device.
    pub mode: StickMode,
    /// Calibration of each stick axis.
    pub axes: BTreeMap<StickMotion, AxisCalibration>,
    /// Actions of the buttons.
    pub buttons: BTreeMap<u32, ControllerAction>,
}

impl ControllerProfile {
    /// Returns the stick inputs for the raw state; an axis without a reading is centered.
    #[must_use]
    pub fn sticks(&self, raw: &RawInput) -> Sticks {
        self.mode.sticks(|way| {
            let axis = self.axes.get(&way);
            axis.and_then(|axis| raw.axes.get(&axis.axis).map(|value| axis.read(*value))).unwrap_or(0.0)
        })
    }

    /// Returns the profile as a TOML file.
    #[must_use]
    pub fn write(&self) -> String {
        let mut text = format!(
            "# Written by `spandrel rc --calibrate`. low, centre, high: raw readings, -1 to 1.\nformat = {FORMAT}\ndevice = {}\nid = {}\nstick_mode = {}\n",
            quoted(&self.device.name),
            quoted(&self.device.id),
            self.mode.number(),
        );
        for (name, way) in STICK_AXES {
            if let Some(a) = self.axes.get(&way) {
                let _ = write!(
                    text,
                    "\n[{name}]\naxis = {}\nlow = {:?}\ncentre = {:?}\nhigh = {:?}\ndead_band = {:?}\nexpo = {:?}\n",
                    a.axis, a.low, a.centre, a.high, a.dead_band, a.expo
                );
            }
        }
        text.push_str("\n[buttons]\n");
        for (name, action) in action::ALL {
            let numbers: Vec<String> = self.buttons.iter().filter(|(_, a)| **a == action).map(|(n, _)| n.to_string()).collect();
            if !numbers.is_empty() {
                let _ = writeln!(text, "{name} = [{}]", numbers.join(", "));
            }
        }
        text
    }

    /// Parses a profile. `file` is the name used in error messages.
    ///
    /// # Errors
    /// Reports all errors in the file, each with its line, key, value, and allowed range.
    pub fn read(file: &str, text: &str) -> Result<Self, Problems> {
        let mut reader = Reader::new(file, text);
        let profile = reader.parse().map(|document| {
            let mut root = reader.root(&document);
            let profile = read_profile(&mut reader, &mut root);
            reader.finish(&root);
            profile
        });
        match profile {
            Some(profile) if reader.problems.is_empty() => Ok(profile),
            _ => Err(Problems(reader.problems)),
        }
    }
}

fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

fn read_profile(r: &mut Reader, root: &mut Section) -> ControllerProfile {
    r.integer(root, "format", (1, FORMAT), None);
    let device = Device { name: r.text(root, "device", None), id: r.text(root, "id", None) };
    let mode = StickMode::from_number(r.integer(root, "stick_mode", (1, 4), Some(2))).unwrap_or(StickMode::Two);
    let mut ways: BTreeMap<StickMotion, AxisCalibration> = BTreeMap::new();
    for (name, way) in STICK_AXES {
        let mut section = r.section(root, name);
        let axis = axis(r, &mut section);
        if let Some((other, _)) = ways.iter().find(|(_, known)| known.axis == axis.axis) {
            let other = STICK_AXES.iter().find(|(_, way)| way == other).map_or("", |(name, _)| name);
            r.add_problem(&section, "axis", &axis.axis.to_string(), "an unused axis", &format!("already used by {other}"));
        }
        r.finish(&section);
        ways.insert(way, axis);
    }
    let mut section = r.section(root, "buttons");
    let mut buttons = BTreeMap::new();
    for (name, action) in action::ALL {
        for number in r.integers(&mut section, name, (0, MAX_INPUT_NUMBER)) {
            let number = u32::try_from(number).unwrap_or(u32::MAX);
            if let Some(before) = buttons.insert(number, action) {
                r.add_problem(
                    &section,
                    name,
                    &number.to_string(),
                    "an unused button",
                    &format!("already bound to {}", before.name()),
                );
            }
        }
    }
    r.finish(&section);
    ControllerProfile { device, mode, axes: ways, buttons }
}

fn axis(r: &mut Reader, s: &mut Section) -> AxisCalibration {
    let axis = AxisCalibration {
        axis: u32::try_from(r.integer(s, "axis", (0, MAX_INPUT_NUMBER), None)).unwrap_or(u32::MAX),
        low: r.number(s, "low", (-1.0, 1.0), None),
        centre: r.number(s, "centre", (-1.0, 1.0), None),
        high: r.number(s, "high", (-1.0, 1.0), None),
        dead_band: r.number(s, "dead_band", (0.0, 0.5), Some(DEFAULT_DEAD_BAND)),
        expo: r.number(s, "expo", (0.0, 1.0), Some(DEFAULT_EXPO)),
    };
    let (below, above) = (axis.centre - axis.low, axis.high - axis.centre);
    if below * above <= 0.0 || below.abs() < MIN_ENDPOINT_DISTANCE || above.abs() < MIN_ENDPOINT_DISTANCE {
        let allowed = format!("between low and high, at least {MIN_ENDPOINT_DISTANCE} from both");
        r.add_problem(s, "centre", &axis.centre.to_string(), &allowed, "range too small for a stick");
    }
    axis
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rc::DeviceEvent;

    fn profile() -> ControllerProfile {
        let axis = |axis, high: f64| AxisCalibration { axis, low: -high, centre: 0.02, high, dead_band: 0.0, expo: 0.0 };
        ControllerProfile {
            device: Device { name: "A \"quoted\" transmitter".into(), id: "0483:5710".into() },
            mode: StickMode::Two,
            axes: STICK_AXES
                .iter()
                .enumerate()
                .map(|(k, (_, way))| (*way, axis(k as u32 + 3, if k == 1 { -1.0 } else { 1.0 })))
                .collect(),
            buttons: [
                (0, ControllerAction::Lamp),
                (7, ControllerAction::Snapshot),
                (9, ControllerAction::Snapshot),
                (11, ControllerAction::CameraZoomIn),
            ]
            .into(),
        }
    }

    #[test]
    fn exact_profile_survives_writing_and_reading() {
        let profile = profile();
        assert_eq!(ControllerProfile::read("p.toml", &profile.write()).unwrap(), profile);
    }

    #[test]
    fn exact_stick_modes_match_transmitters() {
        let mut raw = RawInput::default();
        for (axis, value) in [(3, 1.0), (4, 1.0), (5, -1.0), (6, 1.0)] {
            raw.apply(DeviceEvent::Axis { axis, value });
        }
        let flown = |mode| ControllerProfile { mode, ..profile() }.sticks(&raw);
        // Left stick up and fully left (reversed axis), right stick down and fully right.
        assert_eq!(flown(StickMode::One), Sticks { forward: 1.0, yaw: -1.0, up: -1.0, right: 1.0 });
        assert_eq!(flown(StickMode::Two), Sticks { up: 1.0, yaw: -1.0, forward: -1.0, right: 1.0 });
        assert_eq!(flown(StickMode::Three), Sticks { forward: 1.0, right: -1.0, up: -1.0, yaw: 1.0 });
        assert_eq!(flown(StickMode::Four), Sticks { up: 1.0, right: -1.0, forward: -1.0, yaw: 1.0 });
        assert_eq!(profile().sticks(&RawInput::default()), Sticks::default(), "axes without readings must be centered");
        for mode in [StickMode::One, StickMode::Two, StickMode::Three, StickMode::Four] {
            assert_eq!(mode.physical_sticks(flown(mode)), [1.0, -1.0, -1.0, 1.0], "the mapping must be reversible");
        }
    }

    #[test]
    fn exact_invalid_file_is_reported_line_by_line() {
        let text = profile()
            .write()
            .replace("axis = 4", "axis = 3")
            .replace("high = 1.0", "high = 0.05")
            .replace("stick_mode = 2", "stick_mode = 5");
        let text = text.replace("snapshot = [7, 9]", "snapshot = [0, 9]\nloop = [1]");
        let told = ControllerProfile::read("mine.toml", &text).unwrap_err().to_string();
        for part in [
            "stick_mode",
            "allowed: whole number 1 to 4",
            "already used by left_vertical",
            "range too small for a stick",
            "already bound to lamp",
            "loop",
        ] {
            assert!(told.contains(part), "{part}: {told}");
        }
        assert!(told.lines().all(|line| line.starts_with("mine.toml:")), "{told}");
    }
}
