//! Ground truth for scoring (docs/src/reference/wire.md, "Scoring data"), separate from the estimate, and the sticks as received.

use super::super::LinkKind;
use super::super::snapshot::VehicleSnapshot;
use spandrel_mavlink::contract::sticks;
use spandrel_mavlink::contract::truth::Published;
use spandrel_mavlink::dialect::{MavMessage, RC_CHANNELS_DATA};

pub(super) fn state(v: &VehicleSnapshot) -> Option<MavMessage> {
    let published = Published {
        time_us: v.sim_us(),
        place: v.true_geo(),
        velocity_m_s: v.truth.velocity_m_s,
        ned_from_frd: v.truth.attitude,
        rates_rad_s: v.truth.rates_rad_s,
        specific_force_m_s2: v.specific_force_m_s2,
        airspeed_m_s: (v.truth.velocity_m_s - v.wind_m_s).norm(),
    };
    Some(MavMessage::HIL_STATE_QUATERNION(published.message()))
}

/// Sticks as received: roll, pitch, throttle, yaw, microseconds. Payload processes receive 1500 + 500 x axis, forward positive;
/// others receive the sender's pulses, or their equivalent on a transmitter, where forward is below center.
pub(super) fn sticks(v: &VehicleSnapshot) -> Option<MavMessage> {
    if v.link_kind != LinkKind::Payload && v.flavour.dialect_of_ardupilot {
        return Some(channels(v));
    }
    let held = v.sticks?;
    let [chan1_raw, chan2_raw, chan3_raw, chan4_raw] = match v.link_kind {
        LinkKind::Payload => sticks::to_us([held.forward, held.right, held.up, held.yaw]),
        LinkKind::GroundStation | LinkKind::Sdk | LinkKind::Tcp | LinkKind::Serial => v.pulses_us?,
    };
    Some(MavMessage::RC_CHANNELS(RC_CHANNELS_DATA {
        time_boot_ms: v.boot_ms(),
        chancount: 4,
        chan1_raw,
        chan2_raw,
        chan3_raw,
        chan4_raw,
        chan5_raw: u16::MAX,
        chan6_raw: u16::MAX,
        chan7_raw: u16::MAX,
        chan8_raw: u16::MAX,
        rssi: u8::MAX,
        ..Default::default()
    }))
}

/// Throttle down, other sticks centered: the values of ArduPilot's SITL without a transmitter, microseconds.
const UNTOUCHED_US: [u16; 4] = [1500, 1500, 1000, 1500];

/// Builds all 16 channels, with or without stick input (ArduPilot).
fn channels(v: &VehicleSnapshot) -> MavMessage {
    let [chan1_raw, chan2_raw, chan3_raw, chan4_raw] = v.pulses_us.unwrap_or(UNTOUCHED_US);
    let a = v.aux_us;
    MavMessage::RC_CHANNELS(RC_CHANNELS_DATA {
        time_boot_ms: v.boot_ms(),
        chancount: 16,
        chan1_raw,
        chan2_raw,
        chan3_raw,
        chan4_raw,
        chan5_raw: a[0],
        chan6_raw: a[1],
        chan7_raw: a[2],
        chan8_raw: a[3],
        chan9_raw: a[4],
        chan10_raw: a[5],
        chan11_raw: a[6],
        chan12_raw: a[7],
        chan13_raw: a[8],
        chan14_raw: a[9],
        chan15_raw: a[10],
        chan16_raw: a[11],
        rssi: u8::MAX,
        ..Default::default()
    })
}
