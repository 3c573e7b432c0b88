//! Mode numbers of PX4 (`px4_custom_mode.h`: main mode in the third byte, sub-mode in the fourth) and ArduCopter
//! (`mode.h`), with the names that ground stations show.

use serde::Serialize;

/// Source of the commands that fly the aircraft.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ControlSource {
    /// A pilot using sticks.
    Pilot,
    /// An uploaded mission.
    Mission,
    /// A program that sends setpoints.
    Script,
    /// The autopilot in an automatic mode: hold, takeoff, return or land.
    Autopilot,
}

use ControlSource::{Autopilot, Mission, Pilot, Script};

/// Value of MAV_AUTOPILOT_ARDUPILOTMEGA.
const ARDUPILOT_AUTOPILOT_TYPE: u8 = 3;

/// PX4 modes: main mode, sub-mode (`None` matches any other), name, control source.
const PX4_MODES: [(u8, Option<u8>, &str, ControlSource); 14] = [
    (1, None, "Manual", Pilot),
    (2, None, "Altitude", Pilot),
    (3, Some(1), "Orbit", Autopilot),
    (3, None, "Position", Pilot),
    (4, Some(2), "Take-off", Autopilot),
    (4, Some(3), "Hold", Autopilot),
    (4, Some(4), "Mission", Mission),
    (4, Some(5), "Return", Autopilot),
    (4, Some(6), "Land", Autopilot),
    (4, Some(8), "Follow", Autopilot),
    (4, None, "Auto", Autopilot),
    (5, None, "Acro", Pilot),
    (6, None, "Offboard", Script),
    (7, None, "Stabilized", Pilot),
];

/// ArduCopter modes: mode number, name, control source.
const COPTER_MODES: [(u32, &str, ControlSource); 15] = [
    (0, "Stabilize", Pilot),
    (1, "Acro", Pilot),
    (2, "Alt Hold", Pilot),
    (3, "Auto", Mission),
    (4, "Guided", Script),
    (5, "Loiter", Pilot),
    (6, "RTL", Autopilot),
    (7, "Circle", Autopilot),
    (9, "Land", Autopilot),
    (16, "PosHold", Pilot),
    (17, "Brake", Autopilot),
    (20, "Guided", Script),
    (21, "Smart RTL", Autopilot),
    (23, "Follow", Autopilot),
    (27, "Auto RTL", Autopilot),
];

/// Names of the modes in which the aircraft flies home or lands by itself.
const RETURN_MODES: [&str; 5] = ["Return", "Land", "RTL", "Smart RTL", "Auto RTL"];

/// Returns the name and control source of a mode; `None` if it is unknown. As in common SDKs, a generic autopilot type is treated
/// as PX4.
fn lookup(autopilot: u8, custom_mode: u32) -> Option<(&'static str, ControlSource)> {
    if autopilot == ARDUPILOT_AUTOPILOT_TYPE {
        return COPTER_MODES.iter().find(|(number, ..)| *number == custom_mode).map(|(_, name, source)| (*name, *source));
    }
    let [_, _, main, sub] = custom_mode.to_le_bytes();
    let row = PX4_MODES.iter().find(|(m, s, ..)| *m == main && s.is_none_or(|s| s == sub));
    row.map(|(.., name, source)| (*name, *source))
}

/// Returns the mode's name as shown by ground stations, or `mode N` if it is unknown.
#[must_use]
pub fn name(autopilot: u8, custom_mode: u32) -> String {
    lookup(autopilot, custom_mode).map_or_else(|| format!("mode {custom_mode}"), |(name, _)| name.to_owned())
}

/// Returns whether the aircraft flies home or lands by itself in a mode.
#[must_use]
pub fn is_return(autopilot: u8, custom_mode: u32) -> bool {
    lookup(autopilot, custom_mode).is_some_and(|(name, _)| RETURN_MODES.contains(&name))
}

impl ControlSource {
    /// Returns the control source for the autopilot type and custom mode of a heartbeat. Unknown modes count as
    /// pilot-controlled.
    #[must_use]
    pub fn of(autopilot: u8, custom_mode: u32) -> Self {
        lookup(autopilot, custom_mode).map_or(Self::Pilot, |(_, source)| source)
    }

    /// Returns the label used in session records.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::Pilot => "pilot",
            Self::Mission => "mission",
            Self::Script => "script",
            Self::Autopilot => "autopilot",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_modes_of_both_autopilots_have_control_sources() {
        for (mode, source) in [(3 << 16, Pilot), (4 << 24 | 4 << 16, Mission), (5 << 24 | 4 << 16, Autopilot), (6 << 16, Script)]
        {
            assert_eq!(ControlSource::of(12, mode), source);
            assert_eq!(ControlSource::of(0, mode), source);
        }
        for (mode, source) in [(5, Pilot), (16, Pilot), (3, Mission), (4, Script), (6, Autopilot), (7, Autopilot), (99, Pilot)] {
            assert_eq!(ControlSource::of(3, mode), source);
        }
    }

    #[test]
    fn exact_returning_modes_of_both_autopilots() {
        let px4 = |sub: u32| is_return(12, sub << 24 | 4 << 16);
        assert_eq!([2, 3, 4, 5, 6].map(px4), [false, false, false, true, true]);
        assert_eq!([5, 6, 9, 20, 21, 27].map(|mode| is_return(3, mode)), [false, true, true, false, true, true]);
        let named = |name: &&str| PX4_MODES.iter().any(|mode| mode.2 == *name) || COPTER_MODES.iter().any(|mode| mode.1 == *name);
        assert!(RETURN_MODES.iter().all(named));
    }

    #[test]
    fn exact_mode_names_match_ground_stations() {
        assert_eq!(name(12, 4 << 16 | 5 << 24), "Return");
        assert_eq!(name(12, 4 << 16 | 99 << 24), "Auto");
        assert_eq!(name(3, 5), "Loiter");
        assert_eq!(name(3, 99), "mode 99");
    }
}
