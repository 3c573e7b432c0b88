//! The autopilot's reports about itself, read from its MAVLink messages.

use mavlink::MessageData;
use spandrel_mavlink::codec::ReceivedFrame;
use spandrel_mavlink::dialect::{
    AUTOPILOT_VERSION_DATA, HEARTBEAT_DATA, MavLandedState, MavMessage, MavModeFlag, MavParamType, MavSysStatusSensor,
    PARAM_VALUE_DATA,
};
use std::collections::BTreeMap;

/// Maximum number of recorded parameters: both autopilots have about 1,500.
const MAX_PARAMETERS: usize = 8_192;

/// Firmware of the autopilot, from AUTOPILOT_VERSION.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FirmwareVersion {
    /// Major, minor and patch number.
    pub number: [u8; 3],
    /// Type: 0 development, 64 alpha, 128 beta, 192 release candidate, 255 release (FIRMWARE_VERSION_TYPE).
    pub release_type: u8,
    /// First eight bytes of the Git hash: binary for PX4, text for ArduPilot.
    pub hash: [u8; 8],
}

impl FirmwareVersion {
    fn of(message: &AUTOPILOT_VERSION_DATA) -> Self {
        let [release_type, patch, minor, major] = message.flight_sw_version.to_le_bytes();
        Self { number: [major, minor, patch], release_type, hash: message.flight_custom_version }
    }

    /// Returns the version number, such as `1.16.0`.
    #[must_use]
    pub fn number_text(&self) -> String {
        self.number.map(|part| part.to_string()).join(".")
    }

    /// Returns the Git hash as text. PX4 sends its bytes in reverse order; ArduPilot sends characters.
    #[must_use]
    pub fn hash_text(&self) -> String {
        let is_text = self.hash.iter().all(u8::is_ascii_hexdigit);
        if is_text {
            return self.hash.iter().map(|byte| char::from(*byte)).collect();
        }
        self.hash.iter().rev().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// Latest reports of the autopilot.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AutopilotReport {
    /// The latest heartbeat.
    pub heartbeat: Option<HEARTBEAT_DATA>,
    /// Whether the autopilot reports that it could arm.
    pub is_ready: bool,
    /// Whether the autopilot reports that the aircraft is on the ground; `None` before its first report.
    pub is_on_ground: Option<bool>,
    /// Whether the autopilot reports that the aircraft is in the air.
    pub is_flying: bool,
    /// Firmware version, once reported.
    pub version: Option<FirmwareVersion>,
    /// Parameter values, as far as the autopilot has reported them.
    pub parameters: BTreeMap<String, ReportedParam>,
    /// Number of parameters that the autopilot has, once it has reported one of them.
    pub parameter_count: Option<u16>,
    /// Primary control of the gimbal, from GIMBAL_MANAGER_STATUS: system and component ID.
    pub gimbal_control: (u8, u8),
    /// Whether the autopilot is the manager of the gimbal.
    pub manages_gimbal: bool,
}

/// A parameter value as sent by the autopilot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReportedParam {
    /// Value of the message's float field.
    pub wire: f32,
    /// Type of the parameter.
    pub kind: MavParamType,
}

impl AutopilotReport {
    /// Returns whether the motors are armed.
    #[must_use]
    pub fn is_armed(&self) -> bool {
        self.heartbeat.as_ref().is_some_and(|beat| beat.base_mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED))
    }

    /// Returns whether the autopilot has reported all its parameters.
    #[must_use]
    pub fn has_all_parameters(&self) -> bool {
        self.parameter_count.is_some_and(|count| self.parameters.len() >= usize::from(count))
    }

    /// Reads a frame from the autopilot component.
    pub(super) fn read(&mut self, frame: &ReceivedFrame) {
        match &frame.message {
            Some(MavMessage::HEARTBEAT(beat)) => self.heartbeat = Some(beat.clone()),
            Some(MavMessage::SYS_STATUS(status)) => {
                let check = MavSysStatusSensor::MAV_SYS_STATUS_PREARM_CHECK;
                self.is_ready = status.onboard_control_sensors_health.contains(check);
            }
            Some(MavMessage::EXTENDED_SYS_STATE(state)) => {
                self.is_on_ground = Some(state.landed_state == MavLandedState::MAV_LANDED_STATE_ON_GROUND);
                self.is_flying = state.landed_state == MavLandedState::MAV_LANDED_STATE_IN_AIR;
            }
            Some(MavMessage::AUTOPILOT_VERSION(version)) => self.version = Some(FirmwareVersion::of(version)),
            Some(MavMessage::GIMBAL_MANAGER_STATUS(status)) => {
                self.manages_gimbal = true;
                self.gimbal_control = (status.primary_control_sysid, status.primary_control_compid);
            }
            Some(MavMessage::PARAM_VALUE(value)) => self.record_parameter(value),
            None if frame.message_id == AUTOPILOT_VERSION_DATA::ID => self.version = unknown_capabilities(frame),
            _ => {}
        }
    }

    fn record_parameter(&mut self, value: &PARAM_VALUE_DATA) {
        let Ok(name) = value.param_id.to_str() else { return };
        self.parameter_count = Some(value.param_count);
        if self.parameters.len() < MAX_PARAMETERS || self.parameters.contains_key(name) {
            self.parameters.insert(name.to_owned(), ReportedParam { wire: value.param_value, kind: value.param_type });
        }
    }
}

/// Reads the version from a message with capability bits that the dialect does not know.
fn unknown_capabilities(frame: &ReceivedFrame) -> Option<FirmwareVersion> {
    // Layout: capabilities (8 bytes), uid (8), flight_sw_version (4), three more versions (12), vendor and product ID (4), hash
    // (8).
    let payload = frame.payload(60);
    let [release_type, patch, minor, major] = payload.get(16..20)?.try_into().ok()?;
    let hash = payload.get(36..44)?.try_into().ok()?;
    Some(FirmwareVersion { number: [major, minor, patch], release_type, hash })
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_mavlink::codec::{Decoder, Encoder};

    fn frame(message: &MavMessage) -> ReceivedFrame {
        Decoder::new().datagram(&Encoder::new(1, 1).encode(message)).remove(0)
    }

    #[test]
    fn exact_versions_of_both_autopilots_are_readable() {
        let mut report = AutopilotReport::default();
        // PX4 1.16.0, development: the hash c0de… arrives in reverse order.
        let px4 = AUTOPILOT_VERSION_DATA {
            flight_sw_version: u32::from_le_bytes([0, 0, 16, 1]),
            flight_custom_version: [0x67, 0x45, 0x23, 0x01, 0xad, 0xde, 0xde, 0xc0],
            ..Default::default()
        };
        report.read(&frame(&MavMessage::AUTOPILOT_VERSION(px4)));
        let version = report.version.unwrap();
        assert_eq!((version.number_text(), version.hash_text()), ("1.16.0".into(), "c0dedead01234567".into()));
        let ardupilot = AUTOPILOT_VERSION_DATA {
            flight_sw_version: u32::from_le_bytes([255, 1, 6, 4]),
            flight_custom_version: *b"856c2a19",
            ..Default::default()
        };
        report.read(&frame(&MavMessage::AUTOPILOT_VERSION(ardupilot)));
        let version = report.version.unwrap();
        assert_eq!((version.number_text(), version.hash_text()), ("4.6.1".into(), "856c2a19".into()));
    }
}
