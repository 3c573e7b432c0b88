//! Ground truth for scoring (docs/src/reference/wire.md, "Scoring data"), separate from the estimate, and the stick
//! input as received.

use super::super::snapshot::PayloadSnapshot;
use spandrel_mavlink::contract::sticks;
use spandrel_mavlink::contract::truth::PublishedTruth;
use spandrel_mavlink::dialect::{MavMessage, RC_CHANNELS_DATA};

pub(crate) fn state(v: &PayloadSnapshot) -> Option<MavMessage> {
    let truth = v.input.truth;
    let published = PublishedTruth {
        time_us: v.clock.sim_time_us(),
        place: v.input.true_geo(),
        velocity_m_s: truth.velocity_m_s,
        ned_from_frd: truth.attitude,
        rates_rad_s: truth.rates_rad_s,
        specific_force_m_s2: v.input.specific_force_m_s2,
        airspeed_m_s: (truth.velocity_m_s - v.input.wind_m_s).norm(),
    };
    Some(MavMessage::HIL_STATE_QUATERNION(published.message()))
}

/// Stick input as received, for payload processes: roll, pitch, throttle and yaw as 1500 + 500 x axis microseconds
/// (positive: forward).
pub(crate) fn stick_axes(v: &PayloadSnapshot) -> Option<MavMessage> {
    let [chan1_raw, chan2_raw, chan3_raw, chan4_raw] = sticks::to_us(v.input.sticks?);
    Some(MavMessage::RC_CHANNELS(RC_CHANNELS_DATA {
        time_boot_ms: v.clock.boot_time_ms(),
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
