//! Messages of the simulator's components beside an external autopilot: one row per message, with its component and its rates by
//! kind of link.

use crate::endpoint::component_ids::{BATTERY, CAMERA, GIMBAL, LAMP, SIMULATOR};
use crate::endpoint::link::{LinkKind, ScheduledStream, StreamSchedule};
use crate::endpoint::payload::PayloadSnapshot;
use crate::endpoint::payload::streams::{battery, camera, gimbal, lamp, truth};
use spandrel_mavlink::dialect::{HEARTBEAT_DATA, MavAutopilot, MavMessage, MavModeFlag, MavState, MavType, WIND_COV_DATA};
use spandrel_model::time::SimTime;

/// A message of the simulator's components.
#[derive(Clone, Copy)]
pub(super) struct EquipmentStream {
    /// ID of the message.
    pub id: u32,
    /// Component that sends it.
    pub component: u8,
    /// Rates for ground stations, SDKs, payload processes and the autopilot, in Hz.
    rates_hz: [f64; 4],
    /// Builds the message; `None` if there is no data.
    pub build: fn(&PayloadSnapshot) -> Option<MavMessage>,
}

impl EquipmentStream {
    fn rate_hz(&self, kind: LinkKind) -> f64 {
        match kind {
            LinkKind::GroundStation | LinkKind::Tcp | LinkKind::Serial => self.rates_hz[0],
            LinkKind::Sdk => self.rates_hz[1],
            LinkKind::Payload => self.rates_hz[2],
            LinkKind::Autopilot => self.rates_hz[3],
        }
    }
}

const fn row(id: u32, component: u8, rates_hz: [f64; 4], build: fn(&PayloadSnapshot) -> Option<MavMessage>) -> EquipmentStream {
    EquipmentStream { id, component, rates_hz, build }
}

/// All messages. HIL_STATE_QUATERNION comes first, so that later messages in the same datagram belong to the same instant.
pub(super) const EQUIPMENT_STREAMS: &[EquipmentStream] = &[
    row(115, SIMULATOR, [50.0, 50.0, 50.0, 0.0], truth::state),
    row(0, CAMERA, [1.0, 1.0, 1.0, 1.0], camera::heartbeat),
    row(0, GIMBAL, [1.0, 1.0, 1.0, 1.0], |_| Some(heartbeat(MavType::MAV_TYPE_GIMBAL))),
    row(0, LAMP, [1.0, 1.0, 1.0, 0.0], |v| {
        (v.input.vehicle.lamp.luminous_flux_lm > 0.0).then(|| heartbeat(MavType::MAV_TYPE_ILLUMINATOR))
    }),
    row(147, SIMULATOR, [0.0, 0.0, 2.0, 0.0], battery::power_module),
    row(147, BATTERY, [0.0, 0.0, 0.0, 5.0], battery::power_module),
    row(65, SIMULATOR, [0.0, 0.0, 50.0, 0.0], truth::stick_axes),
    row(231, SIMULATOR, [0.0, 0.0, 1.0, 0.0], |v| Some(wind(v))),
    row(285, GIMBAL, [10.0, 10.0, 25.0, 25.0], gimbal::attitude),
    row(440, LAMP, [2.0, 2.0, 10.0, 0.0], lamp::status),
    row(262, CAMERA, [0.2, 0.2, 0.0, 0.0], camera::capture_status),
    row(271, CAMERA, [0.0, 0.0, 5.0, 0.0], |v| Some(camera::field_of_view(v))),
    row(376, LAMP, [0.0; 4], lamp::relay),
    row(283, GIMBAL, [0.0; 4], gimbal::device),
    row(259, CAMERA, [0.0; 4], camera::information),
    row(260, CAMERA, [0.0; 4], camera::settings_status),
    row(261, CAMERA, [0.0; 4], camera::storage),
    row(269, CAMERA, [0.0; 4], camera::stream_information),
    row(270, CAMERA, [0.0; 4], camera::stream_status),
];

/// Returns the rows for a message that a component sends; component 0 or 1 stands for all.
pub(super) fn rows_of(id: u32, component: u8) -> impl Iterator<Item = (usize, &'static EquipmentStream)> {
    EQUIPMENT_STREAMS.iter().enumerate().filter(move |(_, row)| row.id == id && (component < 2 || row.component == component))
}

/// Returns the default schedule for a kind of link.
pub(super) fn schedule(kind: LinkKind, now: SimTime) -> StreamSchedule {
    let scheduled = |row: &EquipmentStream| ScheduledStream::new(row.id, row.component, row.rate_hz(kind), now);
    StreamSchedule::new(EQUIPMENT_STREAMS.iter().map(scheduled).collect(), now)
}

fn heartbeat(mavtype: MavType) -> MavMessage {
    MavMessage::HEARTBEAT(HEARTBEAT_DATA {
        custom_mode: 0,
        mavtype,
        autopilot: MavAutopilot::MAV_AUTOPILOT_INVALID,
        base_mode: MavModeFlag::empty(),
        system_status: MavState::MAV_STATE_ACTIVE,
        mavlink_version: 3,
    })
}

/// Builds the true wind at the aircraft.
fn wind(v: &PayloadSnapshot) -> MavMessage {
    let [wind_x, wind_y, wind_z] = v.input.wind_m_s.array().map(|c| c as f32);
    MavMessage::WIND_COV(WIND_COV_DATA {
        time_usec: v.clock.sim_time_us(),
        wind_x,
        wind_y,
        wind_z,
        wind_alt: v.input.true_geo().altitude_m as f32,
        ..Default::default()
    })
}
