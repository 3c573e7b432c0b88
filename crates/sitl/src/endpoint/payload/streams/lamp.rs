//! Builders for the lamp's messages.

use super::super::snapshot::PayloadSnapshot;
use spandrel_mavlink::dialect::{ILLUMINATOR_STATUS_DATA, IlluminatorErrorFlags, IlluminatorMode, MavMessage, RELAY_STATUS_DATA};

pub(crate) fn status(v: &PayloadSnapshot) -> Option<MavMessage> {
    Some(MavMessage::ILLUMINATOR_STATUS(ILLUMINATOR_STATUS_DATA {
        uptime_ms: v.clock.boot_time_ms(),
        error_status: IlluminatorErrorFlags::empty(),
        brightness: 100.0,
        temp_c: f32::NAN,
        min_strobe_period: f32::NAN,
        max_strobe_period: f32::NAN,
        strobe_period: f32::NAN,
        strobe_duty_cycle: f32::NAN,
        enable: u8::from(v.lamp.on),
        mode_bitmask: IlluminatorMode::ILLUMINATOR_MODE_INTERNAL_CONTROL,
        mode: IlluminatorMode::ILLUMINATOR_MODE_INTERNAL_CONTROL,
    }))
}

pub(crate) fn relay(v: &PayloadSnapshot) -> Option<MavMessage> {
    Some(MavMessage::RELAY_STATUS(RELAY_STATUS_DATA {
        time_boot_ms: v.clock.boot_time_ms(),
        on: u16::from(v.lamp.on),
        present: 1,
    }))
}
