//! Builders for messages with the estimated and target attitude.

use super::super::snapshot::VehicleSnapshot;
use spandrel_mavlink::dialect::{
    ATTITUDE_DATA, ATTITUDE_QUATERNION_DATA, ATTITUDE_TARGET_DATA, AttitudeTargetTypemask, MavMessage,
};

pub(crate) fn attitude(v: &VehicleSnapshot) -> Option<MavMessage> {
    let (roll, pitch, yaw) = v.estimate.attitude.euler();
    let w = v.estimate.rates_rad_s;
    Some(MavMessage::ATTITUDE(ATTITUDE_DATA {
        time_boot_ms: v.clock.boot_time_ms(),
        roll: roll as f32,
        pitch: pitch as f32,
        yaw: yaw as f32,
        rollspeed: w.forward() as f32,
        pitchspeed: w.right() as f32,
        yawspeed: w.down() as f32,
    }))
}

pub(crate) fn quaternion(v: &VehicleSnapshot) -> Option<MavMessage> {
    let q = v.estimate.attitude.wxyz();
    let w = v.estimate.rates_rad_s;
    Some(MavMessage::ATTITUDE_QUATERNION(ATTITUDE_QUATERNION_DATA {
        time_boot_ms: v.clock.boot_time_ms(),
        q1: q[0] as f32,
        q2: q[1] as f32,
        q3: q[2] as f32,
        q4: q[3] as f32,
        rollspeed: w.forward() as f32,
        pitchspeed: w.right() as f32,
        yawspeed: w.down() as f32,
        ..Default::default()
    }))
}

pub(crate) fn target(v: &VehicleSnapshot) -> Option<MavMessage> {
    let rates = AttitudeTargetTypemask::ATTITUDE_TARGET_TYPEMASK_BODY_ROLL_RATE_IGNORE
        | AttitudeTargetTypemask::ATTITUDE_TARGET_TYPEMASK_BODY_PITCH_RATE_IGNORE
        | AttitudeTargetTypemask::ATTITUDE_TARGET_TYPEMASK_BODY_YAW_RATE_IGNORE;
    Some(MavMessage::ATTITUDE_TARGET(ATTITUDE_TARGET_DATA {
        time_boot_ms: v.clock.boot_time_ms(),
        q: v.status.attitude_target.wxyz().map(|c| c as f32),
        thrust: v.status.thrust as f32,
        type_mask: rates,
        ..Default::default()
    }))
}
