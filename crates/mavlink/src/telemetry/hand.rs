//! Who flies, as the heartbeat's mode says it.

use serde::Serialize;

/// Who has the aircraft.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Hand {
    /// A person at the sticks: manual, altitude, position.
    Pilot,
    /// The uploaded mission.
    Mission,
    /// Somebody's program by external set-points (offboard, guided).
    Script,
    /// The autopilot by itself: hold, take-off, return, land.
    Autopilot,
}

/// MAV_AUTOPILOT_ARDUPILOTMEGA.
const ARDUPILOT: u8 = 3;

impl Hand {
    /// From the autopilot's kind and its mode number, PX4's layout unless it is ArduPilot (whose numbers are Copter's): a vehicle that names
    /// no autopilot is read as PX4, as SDKs do.
    #[must_use]
    pub fn of(autopilot: u8, custom_mode: u32) -> Self {
        if autopilot == ARDUPILOT { Self::of_copter(custom_mode) } else { Self::of_px4(custom_mode) }
    }

    /// The word of the records.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Pilot => "pilot",
            Self::Mission => "mission",
            Self::Script => "script",
            Self::Autopilot => "autopilot",
        }
    }

    /// Main mode in the third byte, sub-mode of the automatic modes in the fourth (PX4: `px4_custom_mode.h`).
    fn of_px4(custom_mode: u32) -> Self {
        match custom_mode.to_le_bytes() {
            [_, _, 4, 4] => Self::Mission,
            // Automatic modes, and the orbit, which is a sub-mode of position.
            [_, _, 4, _] | [_, _, 3, 1] => Self::Autopilot,
            [_, _, 6, _] => Self::Script,
            _ => Self::Pilot,
        }
    }

    /// ArduCopter's numbers: 3 auto, 4 and 20 guided, 6 RTL, 7 circle, 9 land, 17 brake, 21 smart RTL, 23 follow, 27 auto RTL.
    fn of_copter(custom_mode: u32) -> Self {
        match custom_mode {
            3 => Self::Mission,
            4 | 20 => Self::Script,
            6 | 7 | 9 | 17 | 21 | 23 | 27 => Self::Autopilot,
            _ => Self::Pilot,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_modes_of_both_autopilots_name_who_flies() {
        for (mode, by) in [
            (3 << 16, Hand::Pilot),
            (4 << 24 | 4 << 16, Hand::Mission),
            (5 << 24 | 4 << 16, Hand::Autopilot),
            (6 << 16, Hand::Script),
        ] {
            assert_eq!(Hand::of(12, mode), by);
            assert_eq!(Hand::of(0, mode), by);
        }
        for (mode, by) in [
            (5, Hand::Pilot),
            (16, Hand::Pilot),
            (3, Hand::Mission),
            (4, Hand::Script),
            (6, Hand::Autopilot),
            (7, Hand::Autopilot),
        ] {
            assert_eq!(Hand::of(3, mode), by);
        }
    }
}
