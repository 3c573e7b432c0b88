//! Builders for the camera's messages.

use super::super::camera::storage_card::CARD_CAPACITY_MIB;
use super::super::camera::stream::{PORT, VideoStream};
use super::super::camera::{CaptureMode, CaptureRecord, settings, zoom};
use super::super::snapshot::PayloadSnapshot;
use spandrel_mavlink::dialect::{
    CAMERA_CAPTURE_STATUS_DATA, CAMERA_FOV_STATUS_DATA, CAMERA_IMAGE_CAPTURED_DATA, CAMERA_INFORMATION_DATA,
    CAMERA_SETTINGS_DATA, CameraCapFlags, CameraMode, HEARTBEAT_DATA, MavAutopilot, MavBool, MavMessage, MavModeFlag, MavState,
    MavType, STORAGE_INFORMATION_DATA, StorageStatus, StorageType, StorageUsageFlag, VIDEO_STREAM_INFORMATION_DATA,
    VIDEO_STREAM_STATUS_DATA, VideoStreamEncoding, VideoStreamStatusFlags, VideoStreamType,
};
use spandrel_mavlink::units::{deg_e7, mm};

pub(crate) fn heartbeat(v: &PayloadSnapshot) -> Option<MavMessage> {
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

pub(crate) fn information(v: &PayloadSnapshot) -> Option<MavMessage> {
    use CameraCapFlags as C;
    let camera = &v.input.vehicle.camera;
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
        time_boot_ms: v.clock.sim_time_ms(),
        firmware_version: 1,
        focal_length: zoom::wide_focal_length_mm(camera) as f32,
        sensor_size_h: zoom::SENSOR_WIDTH_MM as f32,
        sensor_size_v: (zoom::SENSOR_WIDTH_MM * f64::from(camera.height_px) / f64::from(camera.width_px)) as f32,
        flags,
        resolution_h: camera.width_px as u16,
        resolution_v: camera.height_px as u16,
        vendor_name,
        model_name,
        cam_definition_version: settings::DEFINITION_VERSION,
        cam_definition_uri: settings::DEFINITION_URI.into(),
        gimbal_device_id: v.input.components.gimbal_id(),
        ..Default::default()
    }))
}

/// Focus is not reported: the lens is always in focus.
pub(crate) fn settings_status(v: &PayloadSnapshot) -> Option<MavMessage> {
    let zooms = v.input.vehicle.camera.zoom_max > 1.0;
    Some(MavMessage::CAMERA_SETTINGS(CAMERA_SETTINGS_DATA {
        time_boot_ms: v.clock.sim_time_ms(),
        mode_id: match v.camera.mode {
            CaptureMode::Photo => CameraMode::CAMERA_MODE_IMAGE,
            CaptureMode::Video => CameraMode::CAMERA_MODE_VIDEO,
        },
        zoomLevel: if zooms { (v.camera.zoom * 100.0) as f32 } else { f32::NAN },
        focusLevel: f32::NAN,
        ..Default::default()
    }))
}

/// Builds the camera's field of view, which scoring uses to evaluate images. The position of the image center is not
/// reported.
pub(crate) fn field_of_view(v: &PayloadSnapshot) -> MavMessage {
    let camera = v.camera_now();
    let geo = v.input.geo();
    MavMessage::CAMERA_FOV_STATUS(CAMERA_FOV_STATUS_DATA {
        time_boot_ms: v.clock.sim_time_ms(),
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

pub(crate) fn storage(v: &PayloadSnapshot) -> Option<MavMessage> {
    use StorageUsageFlag as U;
    Some(MavMessage::STORAGE_INFORMATION(STORAGE_INFORMATION_DATA {
        time_boot_ms: v.clock.sim_time_ms(),
        total_capacity: CARD_CAPACITY_MIB as f32,
        used_capacity: v.camera.used_mib as f32,
        available_capacity: (CARD_CAPACITY_MIB - v.camera.used_mib) as f32,
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

pub(crate) fn capture_status(v: &PayloadSnapshot) -> Option<MavMessage> {
    let busy = v.camera.interval_s.is_some() || v.camera.series;
    Some(MavMessage::CAMERA_CAPTURE_STATUS(CAMERA_CAPTURE_STATUS_DATA {
        time_boot_ms: v.clock.sim_time_ms(),
        image_interval: v.camera.interval_s.unwrap_or(0.0) as f32,
        recording_time_ms: v.camera.recording.map_or(0, |running| running.ms() as u32),
        available_capacity: (CARD_CAPACITY_MIB - v.camera.used_mib) as f32,
        image_status: if busy { 2 } else { 0 },
        video_status: u8::from(v.camera.recording.is_some()),
        image_count: v.camera.pictures as i32,
        ..Default::default()
    }))
}

/// Reported while no stream is running (estimate: within the capacity of wireless networks).
const DEFAULT_STREAM: VideoStream = VideoStream { width_px: 1280, height_px: 720, rate_hz: 25.0, bit_rate_bits_s: 3_000_000 };

fn stream_flags(v: &PayloadSnapshot) -> VideoStreamStatusFlags {
    let mut flags = VideoStreamStatusFlags::empty();
    flags.set(VideoStreamStatusFlags::VIDEO_STREAM_STATUS_FLAGS_RUNNING, v.camera.stream.is_some());
    flags
}

pub(crate) fn stream_information(v: &PayloadSnapshot) -> Option<MavMessage> {
    let stream = v.camera.stream.unwrap_or(DEFAULT_STREAM);
    Some(MavMessage::VIDEO_STREAM_INFORMATION(VIDEO_STREAM_INFORMATION_DATA {
        framerate: stream.rate_hz,
        bitrate: stream.bit_rate_bits_s,
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

pub(crate) fn stream_status(v: &PayloadSnapshot) -> Option<MavMessage> {
    let stream = v.camera.stream.unwrap_or(DEFAULT_STREAM);
    Some(MavMessage::VIDEO_STREAM_STATUS(VIDEO_STREAM_STATUS_DATA {
        framerate: stream.rate_hz,
        bitrate: stream.bit_rate_bits_s,
        flags: stream_flags(v),
        resolution_h: stream.width_px,
        resolution_v: stream.height_px,
        rotation: 0,
        hfov: v.camera_now().hfov_rad.to_degrees().round() as u16,
        stream_id: 1,
        ..Default::default()
    }))
}

/// Creates the record for an image taken now.
pub(crate) fn capture_record(v: &PayloadSnapshot) -> CaptureRecord {
    let geo = v.input.geo();
    CaptureRecord::new(CAMERA_IMAGE_CAPTURED_DATA {
        time_utc: v.clock.unix_time_us(),
        time_boot_ms: v.clock.sim_time_ms(),
        lat: deg_e7(geo.latitude_deg),
        lon: deg_e7(geo.longitude_deg),
        alt: mm(geo.altitude_m),
        relative_alt: mm(v.input.height_above_home_m()),
        q: v.camera_attitude().map(|c| c as f32),
        image_index: v.camera.pictures as i32,
        camera_id: 0,
        capture_result: MavBool::MAV_BOOL_TRUE,
        file_url: "".into(),
    })
}
