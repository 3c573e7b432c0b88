//! Camera, gimbal and lamp.

use super::super::camera::{CARD_MIB, PICTURE_MIB};
use super::super::gimbal::DEVICE;
use super::super::view::View;
use crate::base::math;
use crate::mav::dialect::{
    CAMERA_CAPTURE_STATUS_DATA, CAMERA_INFORMATION_DATA, CAMERA_SETTINGS_DATA, CameraCapFlags, CameraMode,
    GIMBAL_DEVICE_ATTITUDE_STATUS_DATA, GIMBAL_DEVICE_INFORMATION_DATA, GIMBAL_MANAGER_INFORMATION_DATA,
    GIMBAL_MANAGER_STATUS_DATA, GimbalDeviceErrorFlags, GimbalDeviceFlags, GimbalManagerCapFlags, GimbalManagerFlags,
    HEARTBEAT_DATA, ILLUMINATOR_STATUS_DATA, IlluminatorErrorFlags, IlluminatorMode, MavAutopilot, MavMessage, MavModeFlag,
    MavState, MavType, RELAY_STATUS_DATA, STORAGE_INFORMATION_DATA, StorageStatus, StorageType,
};

pub(super) fn camera_heartbeat(_: &View) -> Option<MavMessage> {
    Some(MavMessage::HEARTBEAT(HEARTBEAT_DATA {
        custom_mode: 0,
        mavtype: MavType::MAV_TYPE_CAMERA,
        autopilot: MavAutopilot::MAV_AUTOPILOT_INVALID,
        base_mode: MavModeFlag::empty(),
        system_status: MavState::MAV_STATE_ACTIVE,
        mavlink_version: 3,
    }))
}

pub(super) fn camera_information(v: &View) -> Option<MavMessage> {
    let camera = &v.vehicle.camera;
    // A 1/2.3 inch sensor, 6.17 mm wide (estimate): the focal length follows from the field of view.
    const SENSOR_MM: f64 = 6.17;
    let focal_mm = 0.5 * SENSOR_MM / math::tan(0.5 * camera.hfov_rad);
    let mut vendor_name = [0u8; 32];
    vendor_name[..8].copy_from_slice(b"Spandrel");
    let mut model_name = [0u8; 32];
    model_name[..17].copy_from_slice(b"Inspection camera");
    Some(MavMessage::CAMERA_INFORMATION(CAMERA_INFORMATION_DATA {
        time_boot_ms: v.boot_ms(),
        firmware_version: 1,
        focal_length: focal_mm as f32,
        sensor_size_h: SENSOR_MM as f32,
        sensor_size_v: (SENSOR_MM * f64::from(camera.height_px) / f64::from(camera.width_px)) as f32,
        flags: CameraCapFlags::CAMERA_CAP_FLAGS_CAPTURE_IMAGE,
        resolution_h: camera.width_px as u16,
        resolution_v: camera.height_px as u16,
        vendor_name,
        model_name,
        gimbal_device_id: DEVICE,
        ..Default::default()
    }))
}

pub(super) fn camera_settings(v: &View) -> Option<MavMessage> {
    Some(MavMessage::CAMERA_SETTINGS(CAMERA_SETTINGS_DATA {
        time_boot_ms: v.boot_ms(),
        mode_id: CameraMode::CAMERA_MODE_IMAGE,
        zoomLevel: f32::NAN,
        focusLevel: f32::NAN,
        ..Default::default()
    }))
}

pub(super) fn storage(v: &View) -> Option<MavMessage> {
    let used = v.camera.pictures as f32 * PICTURE_MIB;
    Some(MavMessage::STORAGE_INFORMATION(STORAGE_INFORMATION_DATA {
        time_boot_ms: v.boot_ms(),
        total_capacity: CARD_MIB,
        used_capacity: used,
        available_capacity: CARD_MIB - used,
        read_speed: 90.0,
        write_speed: 60.0,
        storage_id: 1,
        storage_count: 1,
        status: StorageStatus::STORAGE_STATUS_READY,
        mavtype: StorageType::STORAGE_TYPE_MICROSD,
        ..Default::default()
    }))
}

pub(super) fn capture_status(v: &View) -> Option<MavMessage> {
    let busy = v.camera.interval_s.is_some() || v.camera.series;
    Some(MavMessage::CAMERA_CAPTURE_STATUS(CAMERA_CAPTURE_STATUS_DATA {
        time_boot_ms: v.boot_ms(),
        image_interval: v.camera.interval_s.unwrap_or(0.0) as f32,
        available_capacity: CARD_MIB - v.camera.pictures as f32 * PICTURE_MIB,
        image_status: if busy { 2 } else { 0 },
        image_count: v.camera.pictures as i32,
        ..Default::default()
    }))
}

pub(super) fn gimbal_manager(v: &View) -> Option<MavMessage> {
    use GimbalManagerCapFlags as C;
    let camera = &v.vehicle.camera;
    Some(MavMessage::GIMBAL_MANAGER_INFORMATION(GIMBAL_MANAGER_INFORMATION_DATA {
        time_boot_ms: v.boot_ms(),
        cap_flags: C::GIMBAL_MANAGER_CAP_FLAGS_HAS_NEUTRAL
            | C::GIMBAL_MANAGER_CAP_FLAGS_HAS_ROLL_LOCK
            | C::GIMBAL_MANAGER_CAP_FLAGS_HAS_PITCH_AXIS
            | C::GIMBAL_MANAGER_CAP_FLAGS_HAS_PITCH_LOCK
            | C::GIMBAL_MANAGER_CAP_FLAGS_HAS_YAW_FOLLOW,
        pitch_min: camera.gimbal_pitch_min_rad as f32,
        pitch_max: camera.gimbal_pitch_max_rad as f32,
        gimbal_device_id: DEVICE,
        ..Default::default()
    }))
}

pub(super) fn gimbal_device(v: &View) -> Option<MavMessage> {
    let camera = &v.vehicle.camera;
    Some(MavMessage::GIMBAL_DEVICE_INFORMATION(GIMBAL_DEVICE_INFORMATION_DATA {
        time_boot_ms: v.boot_ms(),
        pitch_min: camera.gimbal_pitch_min_rad as f32,
        pitch_max: camera.gimbal_pitch_max_rad as f32,
        vendor_name: "Spandrel".into(),
        model_name: "Pitch gimbal".into(),
        custom_name: "".into(),
        gimbal_device_id: DEVICE,
        ..Default::default()
    }))
}

pub(super) fn gimbal_manager_status(v: &View) -> Option<MavMessage> {
    let (system, component) = v.gimbal.control;
    Some(MavMessage::GIMBAL_MANAGER_STATUS(GIMBAL_MANAGER_STATUS_DATA {
        time_boot_ms: v.boot_ms(),
        flags: GimbalManagerFlags::GIMBAL_MANAGER_FLAGS_ROLL_LOCK | GimbalManagerFlags::GIMBAL_MANAGER_FLAGS_PITCH_LOCK,
        gimbal_device_id: DEVICE,
        primary_control_sysid: system,
        primary_control_compid: component,
        secondary_control_sysid: v.gimbal.secondary.0,
        secondary_control_compid: v.gimbal.secondary.1,
    }))
}

/// The camera keeps the horizon and follows the heading; its attitude is given in the vehicle's heading frame.
pub(super) fn gimbal_attitude(v: &View) -> Option<MavMessage> {
    let (s, c) = math::sin_cos(0.5 * v.gimbal.pitch_rad);
    Some(MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(GIMBAL_DEVICE_ATTITUDE_STATUS_DATA {
        time_boot_ms: v.boot_ms(),
        q: [c as f32, 0.0, s as f32, 0.0],
        angular_velocity_y: v.gimbal.rate_rad_s as f32,
        failure_flags: GimbalDeviceErrorFlags::empty(),
        flags: GimbalDeviceFlags::GIMBAL_DEVICE_FLAGS_ROLL_LOCK
            | GimbalDeviceFlags::GIMBAL_DEVICE_FLAGS_PITCH_LOCK
            | GimbalDeviceFlags::GIMBAL_DEVICE_FLAGS_YAW_IN_VEHICLE_FRAME,
        delta_yaw: f32::NAN,
        delta_yaw_velocity: f32::NAN,
        gimbal_device_id: DEVICE,
        ..Default::default()
    }))
}

pub(super) fn lamp(v: &View) -> Option<MavMessage> {
    Some(MavMessage::ILLUMINATOR_STATUS(ILLUMINATOR_STATUS_DATA {
        uptime_ms: v.boot_ms(),
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

pub(super) fn relay(v: &View) -> Option<MavMessage> {
    Some(MavMessage::RELAY_STATUS(RELAY_STATUS_DATA { time_boot_ms: v.boot_ms(), on: u16::from(v.lamp.on), present: 1 }))
}
