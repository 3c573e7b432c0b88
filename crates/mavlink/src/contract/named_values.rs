//! Named values: all scoring data except motion, and the monitor's cues.
//!
//! Integers are sent as NAMED_VALUE_INT, and real numbers as NAMED_VALUE_FLOAT. `time_boot_ms` is simulation time.

use super::contact::ContactKind;
use crate::dialect::{MavMessage, NAMED_VALUE_FLOAT_DATA, NAMED_VALUE_INT_DATA};

/// A named value and its data.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NamedValue {
    /// `contact`: kind of the current contact (the most severe one if there are several). Sent on change and at 10 Hz.
    Contact(ContactKind),
    /// `hits`: number of contacts since simulation start, including those between two `contact` messages. Sent on
    /// change and every 5 s.
    Hits(i32),
    /// `respawns`: number of respawns since simulation start. Sent on change and every 5 s.
    Respawns(i32),
    /// `freezes`: number of freezes since simulation start, without those after a rewind. Sent on change, and every 5 s
    /// after the first one.
    Freezes(i32),
    /// `rewinds`: number of rewinds since simulation start. Sent on change, and every 5 s after the first one.
    Rewinds(i32),
    /// `frozen`: whether the flight is frozen. Sent on change, every second while it is frozen, and every 5 s after the
    /// first freeze.
    Frozen(bool),
    /// `traffic`: time at which the bridges were closed to traffic (negative) or reopened, ms since simulation start.
    /// Sent on change, and every 5 s after the first closing.
    Traffic(i32),
    /// `walk`: a walk of the inspector: its start in 1/100 s since simulation start, followed by two decimal digits for the place that
    /// it starts from (0: on the way) and the one that it leads to. Sent on change, and every 5 s after the first walk.
    Walk(i32),
    /// `seed`: session seed; the 32-bit field is interpreted as unsigned. Sent every 5 s.
    Seed(u32),
    /// `scn_crc`: CRC-32 of the active scenario. Sent every 5 s.
    ScenarioCrc(u32),
    /// `clearance`: distance from the drone's center to the nearest surface other than the landing pad, m. Sent at 30
    /// Hz.
    ClearanceM(f64),
    /// `lux`: ambient light at the drone, lx; for display only. Sent at 5 Hz.
    Lux(f64),
    /// `pace`: simulation speed as a multiple of real time. Sent every 5 s unless it is 1.
    Pace(f64),
    /// `cues`: the monitor's active cues, as [`super::cue`] bits. Sent on change and at 5 Hz.
    Cues(i32),
}

impl NamedValue {
    /// Returns the name in the MAVLink message.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Contact(_) => "contact",
            Self::Hits(_) => "hits",
            Self::Respawns(_) => "respawns",
            Self::Freezes(_) => "freezes",
            Self::Rewinds(_) => "rewinds",
            Self::Frozen(_) => "frozen",
            Self::Traffic(_) => "traffic",
            Self::Walk(_) => "walk",
            Self::Seed(_) => "seed",
            Self::ScenarioCrc(_) => "scn_crc",
            Self::ClearanceM(_) => "clearance",
            Self::Lux(_) => "lux",
            Self::Pace(_) => "pace",
            Self::Cues(_) => "cues",
        }
    }

    /// Returns whether the value reports a freeze or a rewind. Every client receives it, because everyone can request one.
    #[must_use]
    pub fn is_practice_value(self) -> bool {
        matches!(self, Self::Freezes(_) | Self::Rewinds(_) | Self::Frozen(_))
    }

    /// Encodes the message. `time_boot_ms` is the simulation time in ms, modulo 2^32.
    #[must_use]
    pub fn message(self, time_boot_ms: u32) -> MavMessage {
        let name = self.name();
        match self {
            Self::Contact(contact) => int(time_boot_ms, name, contact.code()),
            Self::Hits(value)
            | Self::Respawns(value)
            | Self::Freezes(value)
            | Self::Rewinds(value)
            | Self::Traffic(value)
            | Self::Walk(value)
            | Self::Cues(value) => int(time_boot_ms, name, value),
            Self::Frozen(on) => int(time_boot_ms, name, i32::from(on)),
            Self::Seed(value) | Self::ScenarioCrc(value) => int(time_boot_ms, name, value.cast_signed()),
            Self::ClearanceM(value) | Self::Lux(value) | Self::Pace(value) => float(time_boot_ms, name, value),
        }
    }

    /// Decodes a NAMED_VALUE_INT or NAMED_VALUE_FLOAT; `None` for other messages, unknown names and non-finite values.
    #[must_use]
    pub fn of(message: &MavMessage) -> Option<Self> {
        match message {
            MavMessage::NAMED_VALUE_INT(named) => Self::from_int(named),
            MavMessage::NAMED_VALUE_FLOAT(named) => Self::from_float(named),
            _ => None,
        }
    }

    /// Decodes a NAMED_VALUE_INT; `None` for an unknown name.
    #[must_use]
    pub fn from_int(named: &NAMED_VALUE_INT_DATA) -> Option<Self> {
        let value = named.value;
        Some(match named.name.to_str().ok()? {
            "contact" => Self::Contact(ContactKind::from_code(value)),
            "hits" => Self::Hits(value),
            "respawns" => Self::Respawns(value),
            "freezes" => Self::Freezes(value),
            "rewinds" => Self::Rewinds(value),
            "frozen" => Self::Frozen(value != 0),
            "traffic" => Self::Traffic(value),
            "walk" => Self::Walk(value),
            "seed" => Self::Seed(value.cast_unsigned()),
            "scn_crc" => Self::ScenarioCrc(value.cast_unsigned()),
            "cues" => Self::Cues(value),
            _ => return None,
        })
    }

    /// Decodes a NAMED_VALUE_FLOAT; `None` for an unknown name or a non-finite value.
    #[must_use]
    pub fn from_float(named: &NAMED_VALUE_FLOAT_DATA) -> Option<Self> {
        let value = f64::from(named.value);
        if !value.is_finite() {
            return None;
        }
        Some(match named.name.to_str().ok()? {
            "clearance" => Self::ClearanceM(value),
            "lux" => Self::Lux(value),
            "pace" => Self::Pace(value),
            _ => return None,
        })
    }
}

fn int(time_boot_ms: u32, name: &str, value: i32) -> MavMessage {
    MavMessage::NAMED_VALUE_INT(NAMED_VALUE_INT_DATA { time_boot_ms, value, name: name.into() })
}

fn float(time_boot_ms: u32, name: &str, value: f64) -> MavMessage {
    MavMessage::NAMED_VALUE_FLOAT(NAMED_VALUE_FLOAT_DATA { time_boot_ms, value: value as f32, name: name.into() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_named_values_round_trip() {
        let all = [
            NamedValue::Contact(ContactKind::Person),
            NamedValue::Hits(3),
            NamedValue::Respawns(-1),
            NamedValue::Freezes(1),
            NamedValue::Rewinds(2),
            NamedValue::Frozen(true),
            NamedValue::Traffic(-95_000),
            NamedValue::Walk(123_412),
            NamedValue::Seed(u32::MAX),
            NamedValue::ScenarioCrc(0xC0FF_EE00),
            NamedValue::ClearanceM(2.25),
            NamedValue::Lux(18_000.0),
            NamedValue::Pace(4.0),
            NamedValue::Cues(33),
        ];
        for value in all {
            assert_eq!(NamedValue::of(&value.message(7)), Some(value), "{}", value.name());
            // MAVLink names have at most 10 characters.
            assert!(value.name().len() <= 10);
        }
        assert_eq!(NamedValue::of(&float(7, "clearance", f64::NAN)), None);
        assert_eq!(NamedValue::of(&int(7, "clearance", 1)), None, "a wrong type is rejected");
        assert_eq!(NamedValue::of(&int(7, "unknown", 1)), None);
    }
}
