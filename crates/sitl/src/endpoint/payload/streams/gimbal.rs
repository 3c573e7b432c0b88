//! Builders for messages from the gimbal and its manager.

use super::super::snapshot::PayloadSnapshot;
use spandrel_mavlink::dialect::{
    GIMBAL_DEVICE_ATTITUDE_STATUS_DATA, GIMBAL_DEVICE_INFORMATION_DATA, GIMBAL_MANAGER_INFORMATION_DATA,
    GIMBAL_MANAGER_STATUS_DATA, GimbalDeviceCapFlagsU16, GimbalDeviceErrorFlags, GimbalDeviceFlags, GimbalManagerCapFlags,
    GimbalManagerFlags, MavMessage,
};
use spandrel_model::math;

pub(crate) fn manager(v: &PayloadSnapshot) -> Option<MavMessage> {
    use GimbalManagerCapFlags as C;
    let camera = &v.input.vehicle.camera;
    Some(MavMessage::GIMBAL_MANAGER_INFORMATION(GIMBAL_MANAGER_INFORMATION_DATA {
        time_boot_ms: v.clock.boot_time_ms(),
        cap_flags: C::GIMBAL_MANAGER_CAP_FLAGS_HAS_NEUTRAL
            | C::GIMBAL_MANAGER_CAP_FLAGS_HAS_ROLL_LOCK
            | C::GIMBAL_MANAGER_CAP_FLAGS_HAS_PITCH_AXIS
            | C::GIMBAL_MANAGER_CAP_FLAGS_HAS_PITCH_LOCK
            | C::GIMBAL_MANAGER_CAP_FLAGS_HAS_YAW_FOLLOW
            | C::GIMBAL_MANAGER_CAP_FLAGS_CAN_POINT_LOCATION_GLOBAL,
        pitch_min: camera.gimbal_pitch_min_rad as f32,
        pitch_max: camera.gimbal_pitch_max_rad as f32,
        gimbal_device_id: v.input.components.own_gimbal_id(),
        ..Default::default()
    }))
}

pub(crate) fn device(v: &PayloadSnapshot) -> Option<MavMessage> {
    use GimbalDeviceCapFlagsU16 as C;
    let camera = &v.input.vehicle.camera;
    Some(MavMessage::GIMBAL_DEVICE_INFORMATION(GIMBAL_DEVICE_INFORMATION_DATA {
        time_boot_ms: v.clock.boot_time_ms(),
        pitch_min: camera.gimbal_pitch_min_rad as f32,
        pitch_max: camera.gimbal_pitch_max_rad as f32,
        vendor_name: "Spandrel".into(),
        model_name: "Pitch gimbal".into(),
        custom_name: "".into(),
        firmware_version: 1,
        hardware_version: 1,
        cap_flags: C::GIMBAL_DEVICE_CAP_FLAGS_HAS_NEUTRAL
            | C::GIMBAL_DEVICE_CAP_FLAGS_HAS_ROLL_LOCK
            | C::GIMBAL_DEVICE_CAP_FLAGS_HAS_PITCH_AXIS
            | C::GIMBAL_DEVICE_CAP_FLAGS_HAS_PITCH_LOCK
            | C::GIMBAL_DEVICE_CAP_FLAGS_HAS_YAW_FOLLOW,
        gimbal_device_id: v.input.components.own_gimbal_id(),
        ..Default::default()
    }))
}

pub(crate) fn manager_status(v: &PayloadSnapshot) -> Option<MavMessage> {
    use GimbalManagerFlags as F;
    let (system, component) = v.gimbal.control;
    let mut flags =
        F::GIMBAL_MANAGER_FLAGS_ROLL_LOCK | F::GIMBAL_MANAGER_FLAGS_PITCH_LOCK | F::GIMBAL_MANAGER_FLAGS_YAW_IN_VEHICLE_FRAME;
    flags.set(F::GIMBAL_MANAGER_FLAGS_NEUTRAL, v.gimbal.is_neutral());
    Some(MavMessage::GIMBAL_MANAGER_STATUS(GIMBAL_MANAGER_STATUS_DATA {
        time_boot_ms: v.clock.boot_time_ms(),
        flags,
        gimbal_device_id: v.input.components.own_gimbal_id(),
        primary_control_sysid: system,
        primary_control_compid: component,
        secondary_control_sysid: v.gimbal.secondary.0,
        secondary_control_compid: v.gimbal.secondary.1,
    }))
}

/// The camera is stabilized to the horizon and follows the heading. Its attitude is relative to the vehicle's heading,
/// which is sent with it.
pub(crate) fn attitude(v: &PayloadSnapshot) -> Option<MavMessage> {
    use GimbalDeviceFlags as F;
    let (s, c) = math::sin_cos(0.5 * v.gimbal.pitch_rad);
    let mut flags =
        F::GIMBAL_DEVICE_FLAGS_ROLL_LOCK | F::GIMBAL_DEVICE_FLAGS_PITCH_LOCK | F::GIMBAL_DEVICE_FLAGS_YAW_IN_VEHICLE_FRAME;
    flags.set(F::GIMBAL_DEVICE_FLAGS_NEUTRAL, v.gimbal.is_neutral());
    let mut failure_flags = GimbalDeviceErrorFlags::empty();
    failure_flags.set(GimbalDeviceErrorFlags::GIMBAL_DEVICE_ERROR_FLAGS_AT_PITCH_LIMIT, v.gimbal.is_at_limit);
    Some(MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(GIMBAL_DEVICE_ATTITUDE_STATUS_DATA {
        time_boot_ms: v.clock.boot_time_ms(),
        q: [c as f32, 0.0, s as f32, 0.0],
        angular_velocity_y: v.gimbal.rate_rad_s as f32,
        failure_flags,
        flags,
        delta_yaw: v.input.heading_rad() as f32,
        delta_yaw_velocity: f32::NAN,
        gimbal_device_id: v.input.components.own_gimbal_id(),
        ..Default::default()
    }))
}
