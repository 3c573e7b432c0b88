//! Streamed and requestable messages: one row per message, with its rates by kind of link
//! (docs/src/reference/messages.md, which is generated from this table). The autopilot and payload interfaces build the messages.

pub use super::component_ids::{AUTOPILOT, CAMERA};
use super::inputs::StreamInputs;
use super::link::{LinkKind, ScheduledStream, StreamSchedule};
use super::payload::PayloadSnapshot;
use super::payload::streams::{camera, gimbal, lamp, truth};
use super::vehicle_link::flavor::Flavor;
use super::vehicle_link::snapshot::VehicleSnapshot;
use super::vehicle_link::streams::{ardupilot, attitude, channels, position, sensors, system};
use spandrel_mavlink::ardupilotmega;
use spandrel_mavlink::codec::{Encodable, Encoder};
use spandrel_mavlink::dialect::MavMessage;
use spandrel_model::time::SimTime;

/// A message that can be streamed or requested.
#[derive(Clone, Copy)]
pub struct StreamSpec {
    /// ID of the message.
    pub id: u32,
    /// Rates for ground stations, SDKs and payload processes, in Hz.
    rates_hz: [f64; 3],
    /// Component that sends it.
    pub component: u8,
    /// Whether only the ArduPilot flavor sends it, regardless of the dialect that defines it.
    ardupilot_only: bool,
    source: MessageSource,
}

/// Builds a message; `None` if there is no data.
#[derive(Clone, Copy)]
enum MessageSource {
    Payload(fn(&PayloadSnapshot) -> Option<MavMessage>),
    Vehicle(fn(&VehicleSnapshot) -> Option<MavMessage>),
    ArduPilot(fn(&VehicleSnapshot) -> Option<ardupilotmega::DialectMessage>),
    /// RC_CHANNELS: stick positions for payload processes, transmitter pulses for all other peers.
    RcChannels,
}

/// An outgoing message.
#[derive(Debug, Clone, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "the value is short-lived; boxing would allocate for every message")]
pub enum OutgoingMessage {
    /// A message in the common dialect.
    Common(MavMessage),
    /// A message in ArduPilot's dialect.
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
    pub fn build(&self, inputs: &StreamInputs) -> Option<OutgoingMessage> {
        if !self.is_sent(inputs.vehicle.flavor) {
            return None;
        }
        match self.source {
            MessageSource::Payload(make) => make(&inputs.payload).map(OutgoingMessage::Common),
            MessageSource::Vehicle(make) => make(&inputs.vehicle).map(OutgoingMessage::Common),
            MessageSource::ArduPilot(make) => make(&inputs.vehicle).map(OutgoingMessage::ArduPilot),
            MessageSource::RcChannels => match inputs.payload.clock.link_kind {
                LinkKind::Payload => truth::stick_axes(&inputs.payload),
                LinkKind::GroundStation | LinkKind::Sdk | LinkKind::Tcp | LinkKind::Serial => channels::pulses(&inputs.vehicle),
                LinkKind::Autopilot => None,
            }
            .map(OutgoingMessage::Common),
        }
    }

    /// Checks whether a flavor sends this message.
    #[must_use]
    pub fn is_sent(&self, flavor: &Flavor) -> bool {
        flavor.ardupilot_dialect || !self.ardupilot_only
    }

    /// Returns the rate for a kind of link in Hz.
    #[must_use]
    pub fn rate_hz(&self, kind: LinkKind) -> f64 {
        match kind {
            LinkKind::GroundStation | LinkKind::Tcp | LinkKind::Serial => self.rates_hz[0],
            LinkKind::Sdk => self.rates_hz[1],
            LinkKind::Payload => self.rates_hz[2],
            LinkKind::Autopilot => 0.0,
        }
    }
}

const fn row(id: u32, rates_hz: [f64; 3], source: MessageSource) -> StreamSpec {
    StreamSpec { id, rates_hz, component: AUTOPILOT, ardupilot_only: false, source }
}

const fn camera_row(id: u32, rates_hz: [f64; 3], source: MessageSource) -> StreamSpec {
    StreamSpec { id, rates_hz, component: CAMERA, ardupilot_only: false, source }
}

const fn ardupilot_row(id: u32, source: MessageSource) -> StreamSpec {
    StreamSpec { id, rates_hz: [0.0; 3], component: AUTOPILOT, ardupilot_only: true, source }
}

/// All streams. HIL_STATE_QUATERNION comes first, so that later messages in the same datagram belong to the same
/// instant.
pub const STREAMS: &[StreamSpec] = &[
    row(115, [50.0, 50.0, 50.0], MessageSource::Payload(truth::state)),
    row(0, [1.0, 1.0, 1.0], MessageSource::Vehicle(system::heartbeat)),
    // Sent after the autopilot's heartbeat, so that a client that uses the first heartbeat detects the vehicle; sent
    // once per second if the camera is used (`PeerLink`).
    camera_row(0, [0.25, 0.25, 1.0], MessageSource::Payload(camera::heartbeat)),
    row(1, [2.0, 2.0, 2.0], MessageSource::Vehicle(system::sys_status)),
    row(2, [1.0, 1.0, 1.0], MessageSource::Vehicle(system::system_time)),
    row(24, [5.0, 5.0, 1.0], MessageSource::Vehicle(sensors::gps_raw)),
    row(29, [1.0, 1.0, 0.0], MessageSource::Vehicle(sensors::pressure)),
    row(105, [0.0, 50.0, 0.0], MessageSource::Vehicle(sensors::highres_imu)),
    row(26, [0.0, 0.0, 0.0], MessageSource::Vehicle(sensors::scaled_imu)),
    row(30, [50.0, 50.0, 10.0], MessageSource::Vehicle(attitude::attitude)),
    row(31, [50.0, 50.0, 0.0], MessageSource::Vehicle(attitude::quaternion)),
    row(83, [10.0, 10.0, 0.0], MessageSource::Vehicle(attitude::target)),
    row(32, [50.0, 50.0, 10.0], MessageSource::Vehicle(position::local)),
    row(33, [50.0, 50.0, 10.0], MessageSource::Vehicle(position::global)),
    row(85, [10.0, 10.0, 0.0], MessageSource::Vehicle(position::local_target)),
    row(87, [0.0, 0.0, 0.0], MessageSource::Vehicle(position::global_target)),
    row(141, [5.0, 10.0, 0.0], MessageSource::Vehicle(position::altitude)),
    row(242, [0.5, 1.0, 1.0], MessageSource::Vehicle(position::home)),
    row(49, [0.5, 1.0, 0.0], MessageSource::Vehicle(position::origin)),
    row(331, [0.0, 30.0, 0.0], MessageSource::Vehicle(position::odometry)),
    row(74, [10.0, 10.0, 2.0], MessageSource::Vehicle(position::hud)),
    row(36, [10.0, 10.0, 0.0], MessageSource::Vehicle(system::servos)),
    row(375, [0.0, 0.0, 0.0], MessageSource::Vehicle(system::outputs)),
    row(147, [2.0, 2.0, 2.0], MessageSource::Vehicle(system::battery)),
    row(230, [0.5, 1.0, 0.0], MessageSource::Vehicle(system::estimator)),
    row(231, [1.0, 1.0, 1.0], MessageSource::Vehicle(system::wind)),
    row(241, [0.2, 0.2, 0.0], MessageSource::Vehicle(system::vibration)),
    row(245, [5.0, 5.0, 5.0], MessageSource::Vehicle(system::extended_state)),
    row(42, [1.0, 1.0, 1.0], MessageSource::Vehicle(system::mission_current)),
    row(436, [1.0, 1.0, 0.5], MessageSource::Vehicle(system::current_mode)),
    row(360, [2.0, 2.0, 0.0], MessageSource::Vehicle(position::orbit)),
    row(162, [1.0, 1.0, 0.0], MessageSource::Vehicle(system::fence)),
    row(65, [50.0, 50.0, 50.0], MessageSource::RcChannels),
    row(330, [5.0, 5.0, 0.0], MessageSource::Vehicle(sensors::obstacles)),
    row(132, [5.0, 5.0, 0.0], MessageSource::Vehicle(sensors::range_down)),
    row(132, [5.0, 5.0, 0.0], MessageSource::Vehicle(sensors::range_up)),
    row(132, [5.0, 5.0, 0.0], MessageSource::Vehicle(sensors::range_ahead)),
    row(132, [2.0, 2.0, 0.0], MessageSource::Vehicle(|v| sensors::range_beside(v, 1))),
    row(132, [2.0, 2.0, 0.0], MessageSource::Vehicle(|v| sensors::range_beside(v, 2))),
    row(132, [2.0, 2.0, 0.0], MessageSource::Vehicle(|v| sensors::range_beside(v, 3))),
    row(132, [2.0, 2.0, 0.0], MessageSource::Vehicle(|v| sensors::range_beside(v, 4))),
    row(132, [2.0, 2.0, 0.0], MessageSource::Vehicle(|v| sensors::range_beside(v, 5))),
    row(132, [2.0, 2.0, 0.0], MessageSource::Vehicle(|v| sensors::range_beside(v, 6))),
    row(132, [2.0, 2.0, 0.0], MessageSource::Vehicle(|v| sensors::range_beside(v, 7))),
    row(281, [0.5, 1.0, 0.0], MessageSource::Payload(gimbal::manager_status)),
    row(285, [10.0, 10.0, 25.0], MessageSource::Payload(gimbal::attitude)),
    row(440, [2.0, 2.0, 10.0], MessageSource::Payload(lamp::status)),
    row(376, [1.0, 1.0, 0.0], MessageSource::Payload(lamp::relay)),
    camera_row(262, [0.2, 0.2, 0.0], MessageSource::Payload(camera::capture_status)),
    row(148, [0.0, 0.0, 0.0], MessageSource::Vehicle(system::version)),
    row(397, [0.0, 0.0, 0.0], MessageSource::Vehicle(system::metadata)),
    row(395, [0.0, 0.0, 0.0], MessageSource::Vehicle(system::information)),
    row(300, [0.0, 0.0, 0.0], MessageSource::Vehicle(system::protocol)),
    row(264, [0.0, 0.0, 0.0], MessageSource::Vehicle(system::flight)),
    row(280, [0.0, 0.0, 0.0], MessageSource::Payload(gimbal::manager)),
    row(283, [0.0, 0.0, 0.0], MessageSource::Payload(gimbal::device)),
    camera_row(259, [0.0, 0.0, 0.0], MessageSource::Payload(camera::information)),
    camera_row(260, [0.0, 0.0, 0.0], MessageSource::Payload(camera::settings_status)),
    camera_row(261, [0.0, 0.0, 0.0], MessageSource::Payload(camera::storage)),
    camera_row(269, [0.0, 0.0, 0.0], MessageSource::Payload(camera::stream_information)),
    camera_row(270, [0.0, 0.0, 0.0], MessageSource::Payload(camera::stream_status)),
    camera_row(271, [0.0, 0.0, 5.0], MessageSource::Payload(|v| Some(camera::field_of_view(v)))),
    row(27, [0.0, 0.0, 0.0], MessageSource::Vehicle(sensors::raw_imu)),
    row(62, [0.0, 0.0, 0.0], MessageSource::Vehicle(position::navigation)),
    ardupilot_row(108, MessageSource::Vehicle(ardupilot::sim_state)),
    ardupilot_row(125, MessageSource::Vehicle(ardupilot::power)),
    ardupilot_row(152, MessageSource::ArduPilot(ardupilot::memory)),
    ardupilot_row(163, MessageSource::ArduPilot(ardupilot::ahrs)),
    ardupilot_row(164, MessageSource::ArduPilot(ardupilot::simulation)),
    ardupilot_row(168, MessageSource::ArduPilot(ardupilot::wind)),
    ardupilot_row(193, MessageSource::ArduPilot(ardupilot::estimator)),
];

/// Returns the stream rows for a message ID.
pub fn rows_of(id: u32) -> impl Iterator<Item = (usize, &'static StreamSpec)> {
    STREAMS.iter().enumerate().filter(move |(_, s)| s.id == id)
}

/// Returns the default schedule for a kind of link, or heartbeats only if the peer must request its streams.
#[must_use]
pub fn schedule(kind: LinkKind, must_request_streams: bool, now: SimTime) -> StreamSchedule {
    let scheduled = |row: &StreamSpec| {
        let stream = ScheduledStream::new(row.id, row.component, row.rate_hz(kind), now);
        if must_request_streams { stream.only_on_request() } else { stream }
    };
    StreamSchedule::new(STREAMS.iter().map(scheduled).collect(), now)
}
