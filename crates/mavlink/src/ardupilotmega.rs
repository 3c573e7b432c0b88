//! ArduPilot dialect messages that the codec does not support. Each definition has an ID, a name and fields, which
//! determine the wire order and CRC_EXTRA (MAVLink guide, "Serialization").

use super::checksum::checksum;
use super::codec::{Encodable, Encoder};

/// Type of a field on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldType {
    /// MAVLink `uint16_t`.
    U16,
    /// MAVLink `uint32_t`.
    U32,
    /// MAVLink `int32_t`.
    I32,
    /// MAVLink `float`.
    F32,
}

impl FieldType {
    fn name(self) -> &'static str {
        match self {
            Self::U16 => "uint16_t",
            Self::U32 => "uint32_t",
            Self::I32 => "int32_t",
            Self::F32 => "float",
        }
    }

    fn is_long(self) -> bool {
        self != Self::U16
    }

    fn write(self, value: f64, out: &mut Vec<u8>) {
        match self {
            Self::U16 => out.extend((value as u16).to_le_bytes()),
            Self::U32 => out.extend((value as u32).to_le_bytes()),
            Self::I32 => out.extend((value as i32).to_le_bytes()),
            Self::F32 => out.extend((value as f32).to_le_bytes()),
        }
    }
}

/// A message definition, with its fields in the order of `ardupilotmega.xml`.
#[derive(Debug, PartialEq)]
pub struct MessageDefinition {
    /// MAVLink message ID (24 bits in MAVLink 2).
    pub id: u32,
    /// Message name.
    pub name: &'static str,
    /// Name and type of each base field.
    pub fields: &'static [(&'static str, FieldType)],
    /// Name and type of each extension field. Extension fields are not part of CRC_EXTRA.
    pub extensions: &'static [(&'static str, FieldType)],
}

use FieldType::{F32, I32, U16, U32};

/// MEMINFO: the autopilot's free memory.
pub const MEMINFO: MessageDefinition = MessageDefinition {
    id: 152,
    name: "MEMINFO",
    fields: &[("brkval", U16), ("freemem", U16)],
    extensions: &[("freemem32", U32)],
};
/// AHRS: status of the attitude estimator.
pub const AHRS: MessageDefinition = MessageDefinition {
    id: 163,
    name: "AHRS",
    fields: &[
        ("omegaIx", F32),
        ("omegaIy", F32),
        ("omegaIz", F32),
        ("accel_weight", F32),
        ("renorm_val", F32),
        ("error_rp", F32),
        ("error_yaw", F32),
    ],
    extensions: &[],
};
/// SIMSTATE: simulator state as seen by the autopilot.
pub const SIMSTATE: MessageDefinition = MessageDefinition {
    id: 164,
    name: "SIMSTATE",
    fields: &[
        ("roll", F32),
        ("pitch", F32),
        ("yaw", F32),
        ("xacc", F32),
        ("yacc", F32),
        ("zacc", F32),
        ("xgyro", F32),
        ("ygyro", F32),
        ("zgyro", F32),
        ("lat", I32),
        ("lng", I32),
    ],
    extensions: &[],
};
/// WIND: the autopilot's wind estimate.
pub const WIND: MessageDefinition =
    MessageDefinition { id: 168, name: "WIND", fields: &[("direction", F32), ("speed", F32), ("speed_z", F32)], extensions: &[] };
/// EKF_STATUS_REPORT: estimator flags and variances.
pub const EKF_STATUS_REPORT: MessageDefinition = MessageDefinition {
    id: 193,
    name: "EKF_STATUS_REPORT",
    fields: &[
        ("flags", U16),
        ("velocity_variance", F32),
        ("pos_horiz_variance", F32),
        ("pos_vert_variance", F32),
        ("compass_variance", F32),
        ("terrain_alt_variance", F32),
    ],
    extensions: &[("airspeed_variance", F32)],
};

impl MessageDefinition {
    /// Returns the field indices in wire order: larger types first, and fields of equal size in definition order.
    fn order(&self) -> impl Iterator<Item = usize> {
        let places = |long: bool| (0..self.fields.len()).filter(move |k| self.fields[*k].1.is_long() == long);
        places(true).chain(places(false))
    }

    /// Returns CRC_EXTRA, the message's checksum seed.
    #[must_use]
    pub fn crc_extra(&self) -> u8 {
        let fields = self.order().map(|k| format!("{} {} ", self.fields[k].1.name(), self.fields[k].0));
        let text = format!("{} {}", self.name, fields.collect::<String>());
        let (last, first) = text.as_bytes().split_last().unwrap_or((&0, &[]));
        let crc = checksum(first, *last);
        (crc as u8) ^ (crc >> 8) as u8
    }

    /// Creates a message from field values in definition order, with extension fields last.
    #[must_use]
    pub fn message(&'static self, values: &[f64]) -> DialectMessage {
        DialectMessage { definition: self, values: values.to_vec() }
    }
}

/// A dialect message and its field values.
#[derive(Debug, Clone, PartialEq)]
pub struct DialectMessage {
    definition: &'static MessageDefinition,
    values: Vec<f64>,
}

impl Encodable for DialectMessage {
    fn frame(&self, encoder: &mut Encoder) -> Vec<u8> {
        let (fields, extensions) = (self.definition.fields, self.definition.extensions);
        let value = |k: usize| self.values.get(k).copied().unwrap_or(0.0);
        let mut payload = Vec::new();
        self.definition.order().for_each(|k| fields[k].1.write(value(k), &mut payload));
        extensions.iter().enumerate().for_each(|(k, (_, kind))| kind.write(value(fields.len() + k), &mut payload));
        encoder.encode_foreign(self.definition.id, self.definition.crc_extra(), &payload)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_crc_extra_matches_pymavlink() {
        for (definition, seed) in [(MEMINFO, 208), (AHRS, 127), (SIMSTATE, 154), (WIND, 1), (EKF_STATUS_REPORT, 71)] {
            assert_eq!(definition.crc_extra(), seed, "{}", definition.name);
        }
    }
}
