//! Streamed and requestable messages: one row per message, with its rates by kind of link (docs/src/reference/wire.md,
//! "Streams").

mod ardupilot;
mod attitude;
mod payload;
mod position;
mod sensors;
mod system;
pub mod truth;

pub(super) use payload::field_of_view;

use super::LinkKind;
use super::flavour::Flavour;
use super::snapshot::VehicleSnapshot;
use spandrel_mavlink::ardupilotmega;
use spandrel_mavlink::codec::{Encodable, Encoder};
use spandrel_mavlink::dialect::MavMessage;

/// Component ID of the autopilot.
pub const AUTOPILOT: u8 = 1;
/// Component ID of the camera.
pub const CAMERA: u8 = 100;

/// A message that can be streamed or requested.
#[derive(Clone, Copy)]
pub struct StreamSpec {
    /// Message ID.
    pub id: u32,
    /// Rates for ground stations, SDKs and payload processes, Hz.
    rates_hz: [f64; 3],
    /// Component that sends it.
    pub component: u8,
    /// Whether only the ArduPilot flavour sends it, regardless of the dialect that defines it.
    of_ardupilot: bool,
    source: MessageSource,
}

/// Builds a message; `None` if there is no data.
#[derive(Clone, Copy)]
enum MessageSource {
    Common(fn(&VehicleSnapshot) -> Option<MavMessage>),
    ArduPilot(fn(&VehicleSnapshot) -> Option<ardupilotmega::DialectMessage>),
}

/// An outgoing message.
#[derive(Debug, Clone, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "it lives for one call; a box would cost an allocation for each message")]
pub enum OutgoingMessage {
    /// A message of the common dialect.
    Common(MavMessage),
    /// A message of ArduPilot's dialect.
    ArduPilot(ardupilotmega::DialectMessage),
}

impl Encodable for OutgoingMessage {
    fn frame(&self, encoder: &mut Encoder) -> Vec<u8> {
        match self {
            Self::Common(message) => message.frame(encoder),
            Self::ArduPilot(message) => message.frame(encoder),
        }
    }
}

impl StreamSpec {
    /// Builds the message; `None` if there is no data.
    #[must_use]
    pub fn build(&self, view: &VehicleSnapshot) -> Option<OutgoingMessage> {
        if !self.is_sent(view.flavour) {
            return None;
        }
        match self.source {
            MessageSource::Common(make) => make(view).map(OutgoingMessage::Common),
            MessageSource::ArduPilot(make) => make(view).map(OutgoingMessage::ArduPilot),
        }
    }

    /// Checks whether a flavour sends this message.
    #[must_use]
    pub fn is_sent(&self, flavour: &Flavour) -> bool {
        flavour.dialect_of_ardupilot || !self.of_ardupilot
    }

    /// Returns the rate for a kind of link, Hz.
    #[must_use]
    pub fn rate_hz(&self, kind: LinkKind) -> f64 {
        match kind {
            LinkKind::GroundStation | LinkKind::Tcp | LinkKind::Serial => self.rates_hz[0],
            LinkKind::Sdk => self.rates_hz[1],
            LinkKind::Payload => self.rates_hz[2],
        }
    }
}

const fn row(id: u32, rates_hz: [f64; 3], build: fn(&VehicleSnapshot) -> Option<MavMessage>) -> StreamSpec {
    StreamSpec { id, rates_hz, component: AUTOPILOT, of_ardupilot: false, source: MessageSource::Common(build) }
}

const fn camera(id: u32, rates_hz: [f64; 3], build: fn(&VehicleSnapshot) -> Option<MavMessage>) -> StreamSpec {
    StreamSpec { id, rates_hz, component: CAMERA, of_ardupilot: false, source: MessageSource::Common(build) }
}

const fn of_ardupilot(id: u32, make: MessageSource) -> StreamSpec {
    StreamSpec { id, rates_hz: [0.0; 3], component: AUTOPILOT, of_ardupilot: true, source: make }
}

/// All streams. HIL_STATE_QUATERNION comes first, so that the messages after it in the same datagram belong to the same instant.
pub const STREAMS: &[StreamSpec] = &[
    row(115, [50.0, 50.0, 50.0], truth::state),
    row(0, [1.0, 1.0, 1.0], system::heartbeat),
    // Sent after the autopilot's, so that a client that uses the first heartbeat gets the vehicle; sent once a second if the
    // camera is used (`PeerLink`).
    camera(0, [0.25, 0.25, 1.0], payload::camera_heartbeat),
    row(1, [2.0, 2.0, 2.0], system::sys_status),
    row(2, [1.0, 1.0, 1.0], system::system_time),
    row(24, [5.0, 5.0, 1.0], sensors::gps_raw),
    row(29, [1.0, 1.0, 0.0], sensors::pressure),
    row(105, [0.0, 50.0, 0.0], sensors::highres_imu),
    row(26, [0.0, 0.0, 0.0], sensors::scaled_imu),
    row(30, [50.0, 50.0, 10.0], attitude::attitude),
    row(31, [50.0, 50.0, 0.0], attitude::quaternion),
    row(83, [10.0, 10.0, 0.0], attitude::target),
    row(32, [50.0, 50.0, 10.0], position::local),
    row(33, [50.0, 50.0, 10.0], position::global),
    row(85, [10.0, 10.0, 0.0], position::local_target),
    row(87, [0.0, 0.0, 0.0], position::global_target),
    row(141, [5.0, 10.0, 0.0], position::altitude),
    row(242, [0.5, 1.0, 1.0], position::home),
    row(49, [0.5, 1.0, 0.0], position::origin),
    row(331, [0.0, 30.0, 0.0], position::odometry),
    row(74, [10.0, 10.0, 2.0], position::hud),
    row(36, [10.0, 10.0, 0.0], system::servos),
    row(375, [0.0, 0.0, 0.0], system::outputs),
    row(147, [2.0, 2.0, 2.0], system::battery),
    row(230, [0.5, 1.0, 0.0], system::estimator),
    row(231, [1.0, 1.0, 1.0], system::wind),
    row(241, [0.2, 0.2, 0.0], system::vibration),
    row(245, [5.0, 5.0, 5.0], system::extended_state),
    row(42, [1.0, 1.0, 1.0], system::mission_current),
    row(436, [1.0, 1.0, 0.5], system::current_mode),
    row(360, [2.0, 2.0, 0.0], position::orbit),
    row(162, [1.0, 1.0, 0.0], system::fence),
    row(65, [50.0, 50.0, 50.0], truth::sticks),
    row(330, [5.0, 5.0, 0.0], sensors::obstacles),
    row(132, [5.0, 5.0, 0.0], sensors::range_down),
    row(132, [5.0, 5.0, 0.0], sensors::range_up),
    row(132, [5.0, 5.0, 0.0], sensors::range_ahead),
    row(132, [2.0, 2.0, 0.0], |v| sensors::range_beside(v, 1)),
    row(132, [2.0, 2.0, 0.0], |v| sensors::range_beside(v, 2)),
    row(132, [2.0, 2.0, 0.0], |v| sensors::range_beside(v, 3)),
    row(132, [2.0, 2.0, 0.0], |v| sensors::range_beside(v, 4)),
    row(132, [2.0, 2.0, 0.0], |v| sensors::range_beside(v, 5)),
    row(132, [2.0, 2.0, 0.0], |v| sensors::range_beside(v, 6)),
    row(132, [2.0, 2.0, 0.0], |v| sensors::range_beside(v, 7)),
    row(281, [0.5, 1.0, 0.0], payload::gimbal_manager_status),
    row(285, [10.0, 10.0, 25.0], payload::gimbal_attitude),
    row(440, [2.0, 2.0, 10.0], payload::lamp),
    row(376, [1.0, 1.0, 0.0], payload::relay),
    camera(262, [0.2, 0.2, 0.0], payload::capture_status),
    row(148, [0.0, 0.0, 0.0], system::version),
    row(397, [0.0, 0.0, 0.0], system::metadata),
    row(395, [0.0, 0.0, 0.0], system::information),
    row(300, [0.0, 0.0, 0.0], system::protocol),
    row(264, [0.0, 0.0, 0.0], system::flight),
    row(280, [0.0, 0.0, 0.0], payload::gimbal_manager),
    row(283, [0.0, 0.0, 0.0], payload::gimbal_device),
    camera(259, [0.0, 0.0, 0.0], payload::camera_information),
    camera(260, [0.0, 0.0, 0.0], payload::camera_settings),
    camera(261, [0.0, 0.0, 0.0], payload::storage),
    camera(269, [0.0, 0.0, 0.0], payload::stream_information),
    camera(270, [0.0, 0.0, 0.0], payload::stream_status),
    camera(271, [0.0, 0.0, 5.0], |v| Some(field_of_view(v))),
    row(27, [0.0, 0.0, 0.0], sensors::raw_imu),
    row(62, [0.0, 0.0, 0.0], position::way),
    of_ardupilot(108, MessageSource::Common(ardupilot::simulated)),
    of_ardupilot(125, MessageSource::Common(ardupilot::power)),
    of_ardupilot(152, MessageSource::ArduPilot(ardupilot::memory)),
    of_ardupilot(163, MessageSource::ArduPilot(ardupilot::ahrs)),
    of_ardupilot(164, MessageSource::ArduPilot(ardupilot::simulation)),
    of_ardupilot(168, MessageSource::ArduPilot(ardupilot::wind)),
    of_ardupilot(193, MessageSource::ArduPilot(ardupilot::estimator)),
];

/// Returns the rows of a message ID.
pub fn rows_of(id: u32) -> impl Iterator<Item = (usize, &'static StreamSpec)> {
    STREAMS.iter().enumerate().filter(move |(_, s)| s.id == id)
}
