//! Converts a MAVLink frame to a [`Sample`] if the timeline stores messages of its type. The header is checked first,
//! so skipping any other frame takes only a few nanoseconds. MAVLink units (degE7, mm, cm/s, µs, permille) are
//! converted here.

use crate::checksum::checksum;
use crate::contract::contact::ContactKind;
use crate::contract::modes::{ControlSource, is_return};
use crate::contract::named_values::NamedValue;
use crate::contract::sticks::Sticks;
use crate::contract::truth::{self, Truth, clock};
use crate::dialect::{
    BATTERY_STATUS_DATA, CAMERA_FOV_STATUS_DATA, CAMERA_IMAGE_CAPTURED_DATA, EXTENDED_SYS_STATE_DATA,
    GIMBAL_DEVICE_ATTITUDE_STATUS_DATA, HEARTBEAT_DATA, HIL_STATE_QUATERNION_DATA, ILLUMINATOR_STATUS_DATA, MavLandedState,
    MavMessage, MavModeFlag, NAMED_VALUE_FLOAT_DATA, NAMED_VALUE_INT_DATA, RC_CHANNELS_DATA,
};
use mavlink::{MavlinkVersion, Message, MessageData};
use spandrel_model::frames::{Frd, Ned, Rotation};
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::math;
use spandrel_model::time::SimTime;

/// Value of a sample, or ground truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SampleContent {
    /// Ground truth, whose timestamp is the reference clock.
    Truth(Truth),
    /// A value other than ground truth.
    Value(SampleValue),
}

/// A value other than ground truth. A timeline stores hundreds of thousands of them, so their data is limited to 8 bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SampleValue {
    /// Stick positions.
    Sticks(Sticks),
    /// Lamp state: true if the lamp is on.
    Light(bool),
    /// Remaining battery charge, 0 to 100%.
    Battery(f64),
    /// Kind of the current contact.
    Contact(ContactKind),
    /// Number of contacts since simulation start.
    Hits(i32),
    /// Number of respawns since simulation start.
    Respawns(i32),
    /// Number of freezes since simulation start, without those after a rewind.
    Freezes(i32),
    /// Number of rewinds since simulation start.
    Rewinds(i32),
    /// Whether the flight is frozen.
    Frozen(bool),
    /// Time at which the bridges were closed to traffic (negative) or reopened, ms since simulation start.
    Traffic(i32),
    /// Code of a walk of the inspector.
    Walk(i32),
    /// Session seed.
    Seed(u64),
    /// CRC-32 of the active scenario.
    ScenarioCrc(u32),
    /// Distance from the drone's center to the nearest surface, m.
    Clearance(f64),
    /// Gimbal pitch relative to the horizon, rad, up positive.
    GimbalPitch(f64),
    /// The camera's horizontal field of view, rad.
    FieldOfView(f64),
    /// Autopilot heartbeat.
    Heartbeat {
        /// Whether the motors are armed.
        armed: bool,
        /// Source of the commands that fly the aircraft.
        by: ControlSource,
        /// Whether the aircraft flies home or lands by itself.
        is_return: bool,
    },
    /// Whether the autopilot reports that the aircraft is on the ground.
    OnGround(bool),
    /// Index of a photo that was taken.
    Snapshot(i32),
}

/// A decoded message that the timeline stores.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Sender's system and component ID.
    pub sender: (u8, u8),
    /// Sequence number assigned by the sender.
    pub sequence: u8,
    /// Frame checksum. It distinguishes a duplicate from a later frame with the same sequence number.
    pub checksum: u16,
    /// Timestamp in the message, if it has one.
    pub message_time: Option<SimTime>,
    /// Decoded value or ground truth.
    pub content: SampleContent,
}

/// The parts of a frame header that are needed for routing and decoding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrameHeader {
    /// MAVLink message ID (24 bits in MAVLink 2).
    pub message_id: u32,
    /// Sender's system and component ID.
    pub sender: (u8, u8),
    /// Frame sequence number, which wraps at 256.
    pub sequence: u8,
    /// Payload offset in the frame, bytes.
    pub payload_at: usize,
    /// Offset of the payload end, where the checksum starts, bytes.
    pub payload_end: usize,
    /// Total frame length, bytes.
    pub total: usize,
}

impl FrameHeader {
    /// Parses the header of the frame at the start of `bytes`. The frame may be longer than `bytes`.
    #[must_use]
    pub fn peek(bytes: &[u8]) -> Option<Self> {
        match bytes {
            [0xFD, len, flags, _, seq, sys, comp, a, b, c, ..] => {
                let end = 10 + usize::from(*len);
                let total = end + 2 + if flags & 1 != 0 { 13 } else { 0 };
                let message_id = u32::from_le_bytes([*a, *b, *c, 0]);
                Some(Self { message_id, sender: (*sys, *comp), sequence: *seq, payload_at: 10, payload_end: end, total })
            }
            [0xFE, len, seq, sys, comp, id, ..] => {
                let end = 6 + usize::from(*len);
                let message_id = u32::from(*id);
                let sender = (*sys, *comp);
                Some(Self { message_id, sender, sequence: *seq, payload_at: 6, payload_end: end, total: end + 2 })
            }
            _ => None,
        }
    }

    fn checksum(&self, frame: &[u8]) -> Option<u16> {
        let tail = frame.get(self.payload_end..self.payload_end + 2)?;
        Some(u16::from_le_bytes([tail[0], tail[1]]))
    }

    /// Returns whether the message is known and its checksum is valid.
    #[must_use]
    pub fn has_valid_checksum(frame: &[u8]) -> bool {
        let Some(header) = Self::peek(frame) else { return false };
        // The dialect returns 0 for unknown messages.
        let extra = MavMessage::extra_crc(header.message_id);
        extra != 0 && header.checksum(frame) == frame.get(1..header.payload_end).map(|body| checksum(body, extra))
    }

    /// Returns whether the frame could be valid: its checksum is correct, or the timeline does not store messages of its type.
    #[must_use]
    pub fn is_plausible(frame: &[u8]) -> bool {
        match Self::peek(frame) {
            Some(header) => !is_stored(header.message_id) || Self::has_valid_checksum(frame),
            None => false,
        }
    }
}

/// Returns whether the timeline stores messages of this type.
fn is_stored(message_id: u32) -> bool {
    matches!(
        message_id,
        HEARTBEAT_DATA::ID
            | HIL_STATE_QUATERNION_DATA::ID
            | RC_CHANNELS_DATA::ID
            | ILLUMINATOR_STATUS_DATA::ID
            | BATTERY_STATUS_DATA::ID
            | NAMED_VALUE_INT_DATA::ID
            | NAMED_VALUE_FLOAT_DATA::ID
            | GIMBAL_DEVICE_ATTITUDE_STATUS_DATA::ID
            | EXTENDED_SYS_STATE_DATA::ID
            | CAMERA_IMAGE_CAPTURED_DATA::ID
            | CAMERA_FOV_STATUS_DATA::ID
    )
}

/// Returns the timestamp of a truth message (time since simulation start); `None` for other frames.
#[must_use]
pub fn truth_time(frame: &[u8]) -> Option<SimTime> {
    let header = FrameHeader::peek(frame)?;
    if header.message_id != HIL_STATE_QUATERNION_DATA::ID {
        return None;
    }
    let payload = frame.get(header.payload_at..header.payload_end)?;
    HIL_STATE_QUATERNION_DATA::deser(MavlinkVersion::V2, payload).ok().map(|truth| clock(truth.time_usec))
}

/// Decodes a frame whose checksum has been verified; `None` if the timeline does not store its message.
#[must_use]
pub fn read(frame: &[u8], plane: &LocalPlane) -> Option<Sample> {
    let header = FrameHeader::peek(frame)?;
    if !is_stored(header.message_id) {
        return None;
    }
    let payload = frame.get(header.payload_at..header.payload_end)?;
    let (own_time, said) = decode(&header, payload, plane)?;
    Some(Sample {
        sender: header.sender,
        sequence: header.sequence,
        checksum: header.checksum(frame)?,
        message_time: own_time,
        content: said,
    })
}

fn body<T: MessageData>(payload: &[u8]) -> Option<T> {
    T::deser(MavlinkVersion::V2, payload).ok()
}

fn time_since_boot(ms: u32) -> Option<SimTime> {
    Some(SimTime::from_ms(i64::from(ms)))
}

fn decode(header: &FrameHeader, payload: &[u8], plane: &LocalPlane) -> Option<(Option<SimTime>, SampleContent)> {
    if header.message_id == HIL_STATE_QUATERNION_DATA::ID {
        let truth = truth::read(&body(payload)?, plane)?;
        return Some((Some(truth.time), SampleContent::Truth(truth)));
    }
    let (own_time, value) = decode_value(header, payload)?;
    Some((own_time, SampleContent::Value(value)))
}

fn decode_value(header: &FrameHeader, payload: &[u8]) -> Option<(Option<SimTime>, SampleValue)> {
    match header.message_id {
        RC_CHANNELS_DATA::ID => {
            let rc: RC_CHANNELS_DATA = body(payload)?;
            let sticks = Sticks::from_us([rc.chan1_raw, rc.chan2_raw, rc.chan3_raw, rc.chan4_raw]);
            Some((time_since_boot(rc.time_boot_ms), SampleValue::Sticks(sticks)))
        }
        ILLUMINATOR_STATUS_DATA::ID => {
            let lamp: ILLUMINATOR_STATUS_DATA = body(payload)?;
            Some((time_since_boot(lamp.uptime_ms), SampleValue::Light(lamp.enable != 0)))
        }
        BATTERY_STATUS_DATA::ID => {
            let battery: BATTERY_STATUS_DATA = body(payload)?;
            (battery.battery_remaining >= 0 && battery.id == 0)
                .then(|| (None, SampleValue::Battery(f64::from(battery.battery_remaining))))
        }
        HEARTBEAT_DATA::ID => {
            let beat: HEARTBEAT_DATA = body(payload)?;
            let armed = beat.base_mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED);
            let (autopilot, mode) = (beat.autopilot as u8, beat.custom_mode);
            let (by, is_return) = (ControlSource::of(autopilot, mode), is_return(autopilot, mode));
            (header.sender.1 == 1).then_some((None, SampleValue::Heartbeat { armed, by, is_return }))
        }
        EXTENDED_SYS_STATE_DATA::ID => {
            let state: EXTENDED_SYS_STATE_DATA = body(payload)?;
            let on_ground = state.landed_state == MavLandedState::MAV_LANDED_STATE_ON_GROUND;
            Some((None, SampleValue::OnGround(on_ground)))
        }
        GIMBAL_DEVICE_ATTITUDE_STATUS_DATA::ID => {
            let gimbal: GIMBAL_DEVICE_ATTITUDE_STATUS_DATA = body(payload)?;
            let attitude: Rotation<Frd, Ned> = Rotation::from_wxyz(gimbal.q.map(f64::from))?;
            Some((time_since_boot(gimbal.time_boot_ms), SampleValue::GimbalPitch(attitude.euler().1)))
        }
        CAMERA_IMAGE_CAPTURED_DATA::ID => {
            let image: CAMERA_IMAGE_CAPTURED_DATA = body(payload)?;
            (image.capture_result.bits() == 1)
                .then(|| (time_since_boot(image.time_boot_ms), SampleValue::Snapshot(image.image_index)))
        }
        CAMERA_FOV_STATUS_DATA::ID => {
            let camera: CAMERA_FOV_STATUS_DATA = body(payload)?;
            let hfov_rad = f64::from(camera.hfov).to_radians();
            (hfov_rad > 0.0 && hfov_rad < math::PI)
                .then(|| (time_since_boot(camera.time_boot_ms), SampleValue::FieldOfView(hfov_rad)))
        }
        NAMED_VALUE_INT_DATA::ID => {
            let named: NAMED_VALUE_INT_DATA = body(payload)?;
            Some((time_since_boot(named.time_boot_ms), stored_value(NamedValue::from_int(&named)?)?))
        }
        NAMED_VALUE_FLOAT_DATA::ID => {
            let named: NAMED_VALUE_FLOAT_DATA = body(payload)?;
            Some((time_since_boot(named.time_boot_ms), stored_value(NamedValue::from_float(&named)?)?))
        }
        _ => None,
    }
}

/// Returns the sample of a named value; `None` if the timeline does not store it.
fn stored_value(named: NamedValue) -> Option<SampleValue> {
    Some(match named {
        NamedValue::Contact(contact) => SampleValue::Contact(contact),
        NamedValue::Hits(count) => SampleValue::Hits(count),
        NamedValue::Respawns(count) => SampleValue::Respawns(count),
        NamedValue::Freezes(count) => SampleValue::Freezes(count),
        NamedValue::Rewinds(count) => SampleValue::Rewinds(count),
        NamedValue::Frozen(on) => SampleValue::Frozen(on),
        NamedValue::Traffic(code) => SampleValue::Traffic(code),
        NamedValue::Walk(code) => SampleValue::Walk(code),
        NamedValue::Seed(seed) => SampleValue::Seed(u64::from(seed)),
        NamedValue::ScenarioCrc(crc) => SampleValue::ScenarioCrc(crc),
        NamedValue::ClearanceM(meters) => SampleValue::Clearance(meters),
        NamedValue::Lux(_) | NamedValue::Pace(_) | NamedValue::Cues(_) => return None,
    })
}
