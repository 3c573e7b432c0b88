//! The truth for the scoring (docs/src/reference/wire.md, "Scoring data"), apart from the estimate, and the sticks as received.

use super::super::LinkKind;
use super::super::view::View;
use spandrel_mavlink::dialect::{
    HIL_STATE_QUATERNION_DATA, MavMessage, NAMED_VALUE_FLOAT_DATA, NAMED_VALUE_INT_DATA, RC_CHANNELS_DATA,
};
use spandrel_mavlink::units::{cm, deg_e7, milli_g, mm};

pub(super) fn state(v: &View) -> Option<MavMessage> {
    let geo = v.true_geo();
    let w = v.truth.rates_rad_s;
    let velocity = v.truth.velocity_m_s;
    let force = v.specific_force_m_s2;
    let air = (velocity - v.wind_m_s).norm();
    Some(MavMessage::HIL_STATE_QUATERNION(HIL_STATE_QUATERNION_DATA {
        time_usec: v.sim_us(),
        attitude_quaternion: v.truth.attitude.wxyz().map(|c| c as f32),
        rollspeed: w.forward() as f32,
        pitchspeed: w.right() as f32,
        yawspeed: w.down() as f32,
        lat: deg_e7(geo.latitude_deg),
        lon: deg_e7(geo.longitude_deg),
        alt: mm(geo.altitude_m),
        vx: cm(velocity.north()),
        vy: cm(velocity.east()),
        vz: cm(velocity.down()),
        ind_airspeed: cm(air).unsigned_abs(),
        true_airspeed: cm(air).unsigned_abs(),
        xacc: milli_g(force.forward()),
        yacc: milli_g(force.right()),
        zacc: milli_g(force.down()),
    }))
}

/// Sticks as received: roll, pitch, throttle, yaw in microseconds. A sidecar gets 1500 + 500 x axis, forward positive; everybody else
/// what the sender sent, or would have on a transmitter, where forward is below the middle.
pub(super) fn sticks(v: &View) -> Option<MavMessage> {
    if v.to != LinkKind::Payload && v.flavour.dialect_of_ardupilot {
        return Some(channels(v));
    }
    let sticks = v.sticks?;
    let us = |axis: f64| (1500.0 + 500.0 * axis).round() as u16;
    let [chan1_raw, chan2_raw, chan3_raw, chan4_raw] = match v.to {
        LinkKind::Payload => [us(sticks.right), us(sticks.forward), us(sticks.up), us(sticks.yaw)],
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

/// Throttle down, the other sticks centered: what ArduPilot's SITL shows without a transmitter, microseconds.
const UNTOUCHED_US: [u16; 4] = [1500, 1500, 1000, 1500];

/// All 16 channels, with or without sticks (ArduPilot).
fn channels(v: &View) -> MavMessage {
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

/// A named whole number.
#[must_use]
pub fn named_int(v: &View, name: &str, value: i32) -> MavMessage {
    MavMessage::NAMED_VALUE_INT(NAMED_VALUE_INT_DATA { time_boot_ms: v.sim_ms(), value, name: name.into() })
}

/// A named number.
#[must_use]
pub fn named_float(v: &View, name: &str, value: f64) -> MavMessage {
    MavMessage::NAMED_VALUE_FLOAT(NAMED_VALUE_FLOAT_DATA { time_boot_ms: v.sim_ms(), value: value as f32, name: name.into() })
}
