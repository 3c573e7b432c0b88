//! One MAVLink frame -> one [`Sample`], if it says anything that the timeline keeps. The header is looked at first, so that the
//! many frames of no interest cost a few nanoseconds. Wire units (degE7, mm, cm/s, µs, permille) stop here.

use super::hand::Hand;
use crate::dialect::{
    BATTERY_STATUS_DATA, CAMERA_FOV_STATUS_DATA, CAMERA_IMAGE_CAPTURED_DATA, EXTENDED_SYS_STATE_DATA,
    GIMBAL_DEVICE_ATTITUDE_STATUS_DATA, HEARTBEAT_DATA, HIL_STATE_QUATERNION_DATA, ILLUMINATOR_STATUS_DATA, MavLandedState,
    MavMessage, MavModeFlag, NAMED_VALUE_FLOAT_DATA, NAMED_VALUE_INT_DATA, RC_CHANNELS_DATA,
};
use mavlink::{MavlinkVersion, Message, MessageData};
use serde::Serialize;
use spandrel_model::frames::{Enu, Frd, Ned, Rotation, Vec3};
use spandrel_model::geodesy::{Geo, LocalPlane};
use spandrel_model::math;
use spandrel_model::time::SimTime;

/// What the aircraft touches, as the wire's `contact` says it (docs/src/reference/wire.md, "Scoring data").
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Default)]
#[serde(rename_all = "lowercase")]
pub enum Contact {
    /// Nothing.
    #[default]
    None,
    /// A bridge.
    Bridge,
    /// The ground.
    Terrain,
    /// The water.
    Water,
    /// A car or truck.
    Vehicle,
    /// A pedestrian or the crew.
    Person,
    /// Anything else, and whatever number a newer sender may use.
    Other,
}

impl Contact {
    /// From the wire's number.
    #[must_use]
    pub fn from_wire(code: i32) -> Self {
        match code {
            0 => Self::None,
            1 => Self::Bridge,
            2 => Self::Terrain,
            3 => Self::Water,
            4 => Self::Vehicle,
            5 => Self::Person,
            _ => Self::Other,
        }
    }

    /// The word of the export.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Bridge => "bridge",
            Self::Terrain => "terrain",
            Self::Water => "water",
            Self::Vehicle => "vehicle",
            Self::Person => "person",
            Self::Other => "other",
        }
    }

    /// Higher is worse: person, vehicle, bridge, terrain, water, other, none.
    #[must_use]
    pub fn severity(self) -> u8 {
        match self {
            Self::None => 0,
            Self::Other => 1,
            Self::Water => 2,
            Self::Terrain => 3,
            Self::Bridge => 4,
            Self::Vehicle => 5,
            Self::Person => 6,
        }
    }

    /// Counted by the paper's X_o.
    #[must_use]
    pub fn is_other_crash(self) -> bool {
        matches!(self, Self::Bridge | Self::Terrain | Self::Water | Self::Other)
    }
}

/// The simulator's truth at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truth {
    /// Since simulation start.
    pub time: SimTime,
    /// Position, m from the scenario origin.
    pub position_m: Vec3<Enu>,
    /// Velocity, m/s.
    pub velocity_m_s: Vec3<Enu>,
    /// Attitude.
    pub ned_from_frd: Rotation<Frd, Ned>,
}

/// Content of a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Said {
    /// Truth; its clock is the one clock.
    Truth(Truth),
    /// Anything else.
    Value(SampleValue),
}

/// Content of a sample other than truth. A timeline keeps hundreds of thousands of these, so a variant's payload is 8 bytes at most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SampleValue {
    /// Sticks.
    Sticks(Sticks),
    /// Lamp on.
    Light(bool),
    /// Battery, %.
    Battery(f64),
    /// What is touched from now on.
    Contact(Contact),
    /// Onsets of contact since simulation start.
    Hits(i32),
    /// How often the drone was put back.
    Respawns(i32),
    /// When traffic was stopped (negative) or let go, ms since simulation start, as the wire says it.
    Traffic(i32),
    /// The session's seed.
    Seed(u64),
    /// CRC of the scenario that the simulator runs.
    ScenarioCrc(u32),
    /// Nearest surface to the drone's centre, m.
    Clearance(f64),
    /// Gimbal pitch over the horizon, rad, up positive.
    GimbalPitch(f64),
    /// Horizontal field of view of the camera, rad.
    FieldOfView(f64),
    /// Motors are armed.
    Beat {
        /// Motors may turn.
        armed: bool,
        /// Who flies.
        by: Hand,
    },
    /// The autopilot believes that it stands.
    OnGround(bool),
    /// A picture with this running number was taken.
    Snapshot(i32),
}

/// Stick positions in steps of the wire: forward, right, up, clockwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sticks([i16; 4]);

impl Sticks {
    /// Microseconds from center to full travel.
    const TRAVEL_US: i16 = 500;

    /// From the pulse widths of RC_CHANNELS 1 to 4, us: roll, pitch, throttle, yaw. Widths beyond full travel count as full.
    #[must_use]
    pub fn from_us(channels: [u16; 4]) -> Self {
        let [right, forward, up, clockwise] = channels.map(|us| {
            let off_center = i16::try_from(us).unwrap_or(i16::MAX) - 1500;
            off_center.clamp(-Self::TRAVEL_US, Self::TRAVEL_US)
        });
        Self([forward, right, up, clockwise])
    }

    /// Forward, right, up, clockwise, each in [-1, 1].
    #[must_use]
    pub fn axes(self) -> [f64; 4] {
        self.0.map(|step| f64::from(step) / f64::from(Self::TRAVEL_US))
    }
}

/// One message of interest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// System and component id of the sender.
    pub sender: (u8, u8),
    /// Sender's sequence number.
    pub sequence: u8,
    /// The frame's checksum, to tell a duplicate from a later frame with the same number.
    pub checksum: u16,
    /// The time that the message itself carries.
    pub own_time: Option<SimTime>,
    /// What it says.
    pub said: Said,
}

/// The part of a frame's header that routing and reading need.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Header {
    /// Message id.
    pub message_id: u32,
    /// System and component id.
    pub sender: (u8, u8),
    /// Sequence number.
    pub sequence: u8,
    /// Where the payload starts.
    pub payload_at: usize,
    /// Where the payload ends and the checksum starts.
    pub payload_end: usize,
    /// Length of the whole frame.
    pub total: usize,
}

impl Header {
    /// Reads the header of the frame that `bytes` start with; the frame itself may be longer than `bytes`.
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

    /// The frame is of a kind that we can check, and its checksum is right.
    #[must_use]
    pub fn verified(frame: &[u8]) -> bool {
        let Some(header) = Self::peek(frame) else { return false };
        // The dialect answers 0 for a message that it does not know.
        let extra = MavMessage::extra_crc(header.message_id);
        extra != 0 && header.checksum(frame) == frame.get(1..header.payload_end).map(|body| mavlink::calculate_crc(body, extra))
    }

    /// False only when the frame is of a kind that we keep and its checksum is wrong.
    #[must_use]
    pub fn plausible(frame: &[u8]) -> bool {
        match Self::peek(frame) {
            Some(header) => !kept(header.message_id) || Self::verified(frame),
            None => false,
        }
    }
}

/// Messages that the timeline keeps.
fn kept(message_id: u32) -> bool {
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

/// The clock of a truth frame, since simulation start; `None` for other frames.
#[must_use]
pub fn truth_time(frame: &[u8]) -> Option<SimTime> {
    let header = Header::peek(frame)?;
    if header.message_id != HIL_STATE_QUATERNION_DATA::ID {
        return None;
    }
    let payload = frame.get(header.payload_at..header.payload_end)?;
    HIL_STATE_QUATERNION_DATA::deser(MavlinkVersion::V2, payload).ok().map(|truth| clock(truth.time_usec))
}

/// A clock beyond the range of [`SimTime`] (292 years) is a broken frame; saturating keeps it in order instead of wrapping.
fn clock(us: u64) -> SimTime {
    SimTime::from_us(i64::try_from(us).unwrap_or(i64::MAX).min(i64::MAX / 1_000))
}

/// Reads one frame whose checksum has been checked. `None` when it says nothing that the timeline keeps.
#[must_use]
pub fn read(frame: &[u8], plane: &LocalPlane) -> Option<Sample> {
    let header = Header::peek(frame)?;
    if !kept(header.message_id) {
        return None;
    }
    let payload = frame.get(header.payload_at..header.payload_end)?;
    let (own_time, said) = decode(&header, payload, plane)?;
    Some(Sample { sender: header.sender, sequence: header.sequence, checksum: header.checksum(frame)?, own_time, said })
}

fn body<T: MessageData>(payload: &[u8]) -> Option<T> {
    T::deser(MavlinkVersion::V2, payload).ok()
}

fn boot(ms: u32) -> Option<SimTime> {
    Some(SimTime::from_ms(i64::from(ms)))
}

fn decode(header: &Header, payload: &[u8], plane: &LocalPlane) -> Option<(Option<SimTime>, Said)> {
    if header.message_id == HIL_STATE_QUATERNION_DATA::ID {
        let truth = truth(&body(payload)?, plane)?;
        return Some((Some(truth.time), Said::Truth(truth)));
    }
    let (own_time, value) = decode_value(header, payload)?;
    Some((own_time, Said::Value(value)))
}

fn decode_value(header: &Header, payload: &[u8]) -> Option<(Option<SimTime>, SampleValue)> {
    match header.message_id {
        RC_CHANNELS_DATA::ID => {
            let rc: RC_CHANNELS_DATA = body(payload)?;
            let sticks = Sticks::from_us([rc.chan1_raw, rc.chan2_raw, rc.chan3_raw, rc.chan4_raw]);
            Some((boot(rc.time_boot_ms), SampleValue::Sticks(sticks)))
        }
        ILLUMINATOR_STATUS_DATA::ID => {
            let lamp: ILLUMINATOR_STATUS_DATA = body(payload)?;
            Some((boot(lamp.uptime_ms), SampleValue::Light(lamp.enable != 0)))
        }
        BATTERY_STATUS_DATA::ID => {
            let battery: BATTERY_STATUS_DATA = body(payload)?;
            (battery.battery_remaining >= 0 && battery.id == 0)
                .then(|| (None, SampleValue::Battery(f64::from(battery.battery_remaining))))
        }
        HEARTBEAT_DATA::ID => {
            let beat: HEARTBEAT_DATA = body(payload)?;
            let armed = beat.base_mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED);
            (header.sender.1 == 1)
                .then_some((None, SampleValue::Beat { armed, by: Hand::of(beat.autopilot as u8, beat.custom_mode) }))
        }
        EXTENDED_SYS_STATE_DATA::ID => {
            let state: EXTENDED_SYS_STATE_DATA = body(payload)?;
            let on_ground = state.landed_state == MavLandedState::MAV_LANDED_STATE_ON_GROUND;
            Some((None, SampleValue::OnGround(on_ground)))
        }
        GIMBAL_DEVICE_ATTITUDE_STATUS_DATA::ID => {
            let gimbal: GIMBAL_DEVICE_ATTITUDE_STATUS_DATA = body(payload)?;
            let attitude: Rotation<Frd, Ned> = Rotation::from_wxyz(gimbal.q.map(f64::from))?;
            Some((boot(gimbal.time_boot_ms), SampleValue::GimbalPitch(attitude.euler().1)))
        }
        CAMERA_IMAGE_CAPTURED_DATA::ID => {
            let image: CAMERA_IMAGE_CAPTURED_DATA = body(payload)?;
            (image.capture_result.bits() == 1).then(|| (boot(image.time_boot_ms), SampleValue::Snapshot(image.image_index)))
        }
        CAMERA_FOV_STATUS_DATA::ID => {
            let camera: CAMERA_FOV_STATUS_DATA = body(payload)?;
            let hfov_rad = f64::from(camera.hfov).to_radians();
            (hfov_rad > 0.0 && hfov_rad < math::PI).then(|| (boot(camera.time_boot_ms), SampleValue::FieldOfView(hfov_rad)))
        }
        NAMED_VALUE_INT_DATA::ID => named_int(&body(payload)?),
        NAMED_VALUE_FLOAT_DATA::ID => {
            let named: NAMED_VALUE_FLOAT_DATA = body(payload)?;
            let value = f64::from(named.value);
            (named.name.to_str() == Ok("clearance") && value.is_finite())
                .then(|| (boot(named.time_boot_ms), SampleValue::Clearance(value)))
        }
        _ => None,
    }
}

fn named_int(named: &NAMED_VALUE_INT_DATA) -> Option<(Option<SimTime>, SampleValue)> {
    let said = match named.name.to_str().ok()? {
        "contact" => SampleValue::Contact(Contact::from_wire(named.value)),
        "hits" => SampleValue::Hits(named.value),
        "respawns" => SampleValue::Respawns(named.value),
        "traffic" => SampleValue::Traffic(named.value),
        // A 32-bit field carries the seed; as unsigned, so that the upper half survives too.
        "seed" => SampleValue::Seed(u64::from(named.value as u32)),
        "scn_crc" => SampleValue::ScenarioCrc(named.value as u32),
        _ => return None,
    };
    Some((boot(named.time_boot_ms), said))
}

fn truth(wire: &HIL_STATE_QUATERNION_DATA, plane: &LocalPlane) -> Option<Truth> {
    let geo = Geo {
        latitude_deg: f64::from(wire.lat) * 1e-7,
        longitude_deg: f64::from(wire.lon) * 1e-7,
        altitude_m: f64::from(wire.alt) * 1e-3,
    };
    let velocity: Vec3<Ned> = Vec3::new(f64::from(wire.vx) * 0.01, f64::from(wire.vy) * 0.01, f64::from(wire.vz) * 0.01);
    Some(Truth {
        time: clock(wire.time_usec),
        position_m: plane.enu_from_geo(geo),
        velocity_m_s: velocity.enu(),
        ned_from_frd: Rotation::from_wxyz(wire.attitude_quaternion.map(f64::from))?,
    })
}
