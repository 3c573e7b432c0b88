//! Builders for the transmitter channels as the autopilot reports them.

use super::super::snapshot::VehicleSnapshot;
use spandrel_mavlink::dialect::{MavMessage, RC_CHANNELS_DATA};

/// Throttle down, other sticks centered: the values of ArduPilot's SITL without a transmitter, microseconds.
const NO_TRANSMITTER_PULSES_US: [u16; 4] = [1500, 1500, 1000, 1500];

/// Builds the sender's pulses, or their equivalent on a transmitter, where forward is below center. ArduPilot sends all
/// 16 channels, with or without stick input.
pub(crate) fn pulses(v: &VehicleSnapshot) -> Option<MavMessage> {
    if v.flavor.ardupilot_dialect {
        return Some(all_channels(v));
    }
    let [chan1_raw, chan2_raw, chan3_raw, chan4_raw] = v.pulses_us?;
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

fn all_channels(v: &VehicleSnapshot) -> MavMessage {
    let [chan1_raw, chan2_raw, chan3_raw, chan4_raw] = v.pulses_us.unwrap_or(NO_TRANSMITTER_PULSES_US);
    let a = v.aux_pulses_us;
    MavMessage::RC_CHANNELS(RC_CHANNELS_DATA {
        time_boot_ms: v.clock.boot_time_ms(),
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
