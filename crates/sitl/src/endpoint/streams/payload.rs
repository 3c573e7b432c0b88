//! Messages of camera, gimbal and lamp.

use super::super::camera::storage_card::CARD_MIB;
use super::super::camera::stream::{PORT, VideoStream};
use super::super::camera::{CaptureMode, settings, zoom};
use super::super::gimbal::DEVICE;
use super::super::snapshot::VehicleSnapshot;
use spandrel_mavlink::dialect::{
    CAMERA_CAPTURE_STATUS_DATA, CAMERA_FOV_STATUS_DATA, CAMERA_INFORMATION_DATA, CAMERA_SETTINGS_DATA, CameraCapFlags,
    CameraMode, GIMBAL_DEVICE_ATTITUDE_STATUS_DATA, GIMBAL_DEVICE_INFORMATION_DATA, GIMBAL_MANAGER_INFORMATION_DATA,
    GIMBAL_MANAGER_STATUS_DATA, GimbalDeviceCapFlagsU16, GimbalDeviceErrorFlags, GimbalDeviceFlags, GimbalManagerCapFlags,
    GimbalManagerFlags, HEARTBEAT_DATA, ILLUMINATOR_STATUS_DATA, IlluminatorErrorFlags, IlluminatorMode, MavAutopilot,
    MavMessage, MavModeFlag, MavState, MavType, RELAY_STATUS_DATA, STORAGE_INFORMATION_DATA, StorageStatus, StorageType,
    StorageUsageFlag, VIDEO_STREAM_INFORMATION_DATA, VIDEO_STREAM_STATUS_DATA, VideoStreamEncoding, VideoStreamStatusFlags,
    VideoStreamType,
};
use spandrel_mavlink::units::{deg_e7, mm};
use spandrel_model::math;

pub(super) fn camera_heartbeat(v: &VehicleSnapshot) -> Option<MavMessage> {
    let beat = MavMessage::HEARTBEAT(HEARTBEAT_DATA {
        custom_mode: 0,
        mavtype: MavType::MAV_TYPE_CAMERA,
        autopilot: MavAutopilot::MAV_AUTOPILOT_INVALID,
        base_mode: MavModeFlag::empty(),
        system_status: MavState::MAV_STATE_ACTIVE,
        mavlink_version: 3,
    });
    v.camera.announced.then_some(beat)
}

pub(super) fn camera_information(v: &VehicleSnapshot) -> Option<MavMessage> {
    use CameraCapFlags as C;
    let camera = &v.vehicle.camera;
    let mut vendor_name = [0u8; 32];
    vendor_name[..8].copy_from_slice(b"Spandrel");
    let mut model_name = [0u8; 32];
    model_name[..17].copy_from_slice(b"Inspection camera");
    let mut flags = C::CAMERA_CAP_FLAGS_CAPTURE_IMAGE
        | C::CAMERA_CAP_FLAGS_CAPTURE_VIDEO
        | C::CAMERA_CAP_FLAGS_HAS_MODES
        | C::CAMERA_CAP_FLAGS_CAN_CAPTURE_IMAGE_IN_VIDEO_MODE
        | C::CAMERA_CAP_FLAGS_HAS_VIDEO_STREAM;
    flags.set(C::CAMERA_CAP_FLAGS_HAS_BASIC_ZOOM, camera.zoom_max > 1.0);
    Some(MavMessage::CAMERA_INFORMATION(CAMERA_INFORMATION_DATA {
        time_boot_ms: v.sim_ms(),
        firmware_version: 1,
        focal_length: zoom::wide_mm(camera) as f32,
        sensor_size_h: zoom::SENSOR_MM as f32,
        sensor_size_v: (zoom::SENSOR_MM * f64::from(camera.height_px) / f64::from(camera.width_px)) as f32,
        flags,
        resolution_h: camera.width_px as u16,
        resolution_v: camera.height_px as u16,
        vendor_name,
        model_name,
        cam_definition_version: settings::VERSION,
        cam_definition_uri: settings::URI.into(),
        gimbal_device_id: DEVICE,
        ..Default::default()
    }))
}

/// Focus is not reported: the lens is always in focus.
pub(super) fn camera_settings(v: &VehicleSnapshot) -> Option<MavMessage> {
    let zooms = v.vehicle.camera.zoom_max > 1.0;
    Some(MavMessage::CAMERA_SETTINGS(CAMERA_SETTINGS_DATA {
        time_boot_ms: v.sim_ms(),
        mode_id: match v.camera.mode {
            CaptureMode::Photo => CameraMode::CAMERA_MODE_IMAGE,
            CaptureMode::Video => CameraMode::CAMERA_MODE_VIDEO,
        },
        zoomLevel: if zooms { (v.camera.zoom * 100.0) as f32 } else { f32::NAN },
        focusLevel: f32::NAN,
        ..Default::default()
    }))
}

/// Builds the camera's field of view, which the scoring uses to evaluate images. The camera does not know the position of the
/// image center.
pub(in super::super) fn field_of_view(v: &VehicleSnapshot) -> MavMessage {
    let camera = v.camera_now();
    let geo = v.geo();
    MavMessage::CAMERA_FOV_STATUS(CAMERA_FOV_STATUS_DATA {
        time_boot_ms: v.sim_ms(),
        lat_camera: deg_e7(geo.latitude_deg),
        lon_camera: deg_e7(geo.longitude_deg),
        alt_camera: mm(geo.altitude_m),
        lat_image: i32::MAX,
        lon_image: i32::MAX,
        alt_image: i32::MAX,
        q: v.camera_attitude().map(|c| c as f32),
        hfov: camera.hfov_rad.to_degrees() as f32,
        vfov: camera.vfov_rad().to_degrees() as f32,
        ..Default::default()
    })
}

pub(super) fn storage(v: &VehicleSnapshot) -> Option<MavMessage> {
    use StorageUsageFlag as U;
    Some(MavMessage::STORAGE_INFORMATION(STORAGE_INFORMATION_DATA {
        time_boot_ms: v.sim_ms(),
        total_capacity: CARD_MIB as f32,
        used_capacity: v.camera.used_mib as f32,
        available_capacity: (CARD_MIB - v.camera.used_mib) as f32,
        read_speed: 90.0,
        write_speed: 60.0,
        storage_id: 1,
        storage_count: 1,
        status: StorageStatus::STORAGE_STATUS_READY,
        mavtype: StorageType::STORAGE_TYPE_MICROSD,
        name: "Memory card".into(),
        storage_usage: U::STORAGE_USAGE_FLAG_SET | U::STORAGE_USAGE_FLAG_PHOTO | U::STORAGE_USAGE_FLAG_VIDEO,
    }))
}

pub(super) fn capture_status(v: &VehicleSnapshot) -> Option<MavMessage> {
    let busy = v.camera.interval_s.is_some() || v.camera.series;
    Some(MavMessage::CAMERA_CAPTURE_STATUS(CAMERA_CAPTURE_STATUS_DATA {
        time_boot_ms: v.sim_ms(),
        image_interval: v.camera.interval_s.unwrap_or(0.0) as f32,
        recording_time_ms: v.camera.recording.map_or(0, |running| running.ms() as u32),
        available_capacity: (CARD_MIB - v.camera.used_mib) as f32,
        image_status: if busy { 2 } else { 0 },
        video_status: u8::from(v.camera.recording.is_some()),
        image_count: v.camera.pictures as i32,
        ..Default::default()
    }))
}

/// Reported while no stream is running (estimate: within the capacity of wireless networks).
const STREAM: VideoStream = VideoStream { width_px: 1280, height_px: 720, rate_hz: 25.0, bits_s: 3_000_000 };

fn stream_flags(v: &VehicleSnapshot) -> VideoStreamStatusFlags {
    let mut flags = VideoStreamStatusFlags::empty();
    flags.set(VideoStreamStatusFlags::VIDEO_STREAM_STATUS_FLAGS_RUNNING, v.camera.stream.is_some());
    flags
}

pub(super) fn stream_information(v: &VehicleSnapshot) -> Option<MavMessage> {
    let stream = v.camera.stream.unwrap_or(STREAM);
    Some(MavMessage::VIDEO_STREAM_INFORMATION(VIDEO_STREAM_INFORMATION_DATA {
        framerate: stream.rate_hz,
        bitrate: stream.bits_s,
        flags: stream_flags(v),
        resolution_h: stream.width_px,
        resolution_v: stream.height_px,
        rotation: 0,
        hfov: v.camera_now().hfov_rad.to_degrees().round() as u16,
        stream_id: 1,
        count: 1,
        mavtype: VideoStreamType::VIDEO_STREAM_TYPE_RTPUDP,
        name: "Camera".into(),
        uri: PORT.to_string().as_str().into(),
        encoding: VideoStreamEncoding::VIDEO_STREAM_ENCODING_H264,
        ..Default::default()
    }))
}

pub(super) fn stream_status(v: &VehicleSnapshot) -> Option<MavMessage> {
    let stream = v.camera.stream.unwrap_or(STREAM);
    Some(MavMessage::VIDEO_STREAM_STATUS(VIDEO_STREAM_STATUS_DATA {
        framerate: stream.rate_hz,
        bitrate: stream.bits_s,
        flags: stream_flags(v),
        resolution_h: stream.width_px,
        resolution_v: stream.height_px,
        rotation: 0,
        hfov: v.camera_now().hfov_rad.to_degrees().round() as u16,
        stream_id: 1,
        ..Default::default()
    }))
}

pub(super) fn gimbal_manager(v: &VehicleSnapshot) -> Option<MavMessage> {
    use GimbalManagerCapFlags as C;
    let camera = &v.vehicle.camera;
    Some(MavMessage::GIMBAL_MANAGER_INFORMATION(GIMBAL_MANAGER_INFORMATION_DATA {
        time_boot_ms: v.boot_ms(),
        cap_flags: C::GIMBAL_MANAGER_CAP_FLAGS_HAS_NEUTRAL
            | C::GIMBAL_MANAGER_CAP_FLAGS_HAS_ROLL_LOCK
            | C::GIMBAL_MANAGER_CAP_FLAGS_HAS_PITCH_AXIS
            | C::GIMBAL_MANAGER_CAP_FLAGS_HAS_PITCH_LOCK
            | C::GIMBAL_MANAGER_CAP_FLAGS_HAS_YAW_FOLLOW
            | C::GIMBAL_MANAGER_CAP_FLAGS_CAN_POINT_LOCATION_GLOBAL,
        pitch_min: camera.gimbal_pitch_min_rad as f32,
        pitch_max: camera.gimbal_pitch_max_rad as f32,
        gimbal_device_id: DEVICE,
        ..Default::default()
    }))
}

pub(super) fn gimbal_device(v: &VehicleSnapshot) -> Option<MavMessage> {
    use GimbalDeviceCapFlagsU16 as C;
    let camera = &v.vehicle.camera;
    Some(MavMessage::GIMBAL_DEVICE_INFORMATION(GIMBAL_DEVICE_INFORMATION_DATA {
        time_boot_ms: v.boot_ms(),
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
        gimbal_device_id: DEVICE,
        ..Default::default()
    }))
}

pub(super) fn gimbal_manager_status(v: &VehicleSnapshot) -> Option<MavMessage> {
    use GimbalManagerFlags as F;
    let (system, component) = v.gimbal.control;
    let mut flags =
        F::GIMBAL_MANAGER_FLAGS_ROLL_LOCK | F::GIMBAL_MANAGER_FLAGS_PITCH_LOCK | F::GIMBAL_MANAGER_FLAGS_YAW_IN_VEHICLE_FRAME;
    flags.set(F::GIMBAL_MANAGER_FLAGS_NEUTRAL, v.gimbal.is_neutral());
    Some(MavMessage::GIMBAL_MANAGER_STATUS(GIMBAL_MANAGER_STATUS_DATA {
        time_boot_ms: v.boot_ms(),
        flags,
        gimbal_device_id: DEVICE,
        primary_control_sysid: system,
        primary_control_compid: component,
        secondary_control_sysid: v.gimbal.secondary.0,
        secondary_control_compid: v.gimbal.secondary.1,
    }))
}

/// The camera is stabilized to the horizon and follows the heading. Its attitude is relative to the vehicle's heading, which is
/// sent with it.
pub(super) fn gimbal_attitude(v: &VehicleSnapshot) -> Option<MavMessage> {
    use GimbalDeviceFlags as F;
    let (s, c) = math::sin_cos(0.5 * v.gimbal.pitch_rad);
    let mut flags =
        F::GIMBAL_DEVICE_FLAGS_ROLL_LOCK | F::GIMBAL_DEVICE_FLAGS_PITCH_LOCK | F::GIMBAL_DEVICE_FLAGS_YAW_IN_VEHICLE_FRAME;
    flags.set(F::GIMBAL_DEVICE_FLAGS_NEUTRAL, v.gimbal.is_neutral());
    let mut failure_flags = GimbalDeviceErrorFlags::empty();
    failure_flags.set(GimbalDeviceErrorFlags::GIMBAL_DEVICE_ERROR_FLAGS_AT_PITCH_LIMIT, v.gimbal.at_stop);
    Some(MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(GIMBAL_DEVICE_ATTITUDE_STATUS_DATA {
        time_boot_ms: v.boot_ms(),
        q: [c as f32, 0.0, s as f32, 0.0],
        angular_velocity_y: v.gimbal.rate_rad_s as f32,
        failure_flags,
        flags,
        delta_yaw: v.estimate.attitude.yaw_rad() as f32,
        delta_yaw_velocity: f32::NAN,
        gimbal_device_id: DEVICE,
        ..Default::default()
    }))
}

pub(super) fn lamp(v: &VehicleSnapshot) -> Option<MavMessage> {
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

pub(super) fn relay(v: &VehicleSnapshot) -> Option<MavMessage> {
    Some(MavMessage::RELAY_STATUS(RELAY_STATUS_DATA { time_boot_ms: v.boot_ms(), on: u16::from(v.lamp.on), present: 1 }))
}
