//! Camera commands: images, recording, modes, zoom, memory card.

use super::super::Payload;
use super::super::camera::zoom::ZoomCommand;
use super::super::camera::{CameraError, CaptureMode};
use super::super::snapshot::VehicleSnapshot;
use super::super::streams::CAMERA;
use super::VehicleCommand;
use super::payload::{ACCEPTED, DENIED, PayloadCommand, verdict};
use mavlink::MessageData;
use spandrel_mavlink::dialect::{
    CAMERA_CAPTURE_STATUS_DATA, CAMERA_FOV_STATUS_DATA, CAMERA_SETTINGS_DATA, MavCmd, MavResult, STORAGE_INFORMATION_DATA,
    VIDEO_STREAM_STATUS_DATA,
};

const FAILED: MavResult = MavResult::MAV_RESULT_FAILED;
const UNSUPPORTED: MavResult = MavResult::MAV_RESULT_UNSUPPORTED;
/// ID of the only video stream.
const STREAM: f64 = 1.0;
/// ID of the only memory card.
const CARD: f64 = 1.0;

pub(super) const ROWS: &[PayloadCommand] = &[
    (MavCmd::MAV_CMD_IMAGE_START_CAPTURE, start),
    (MavCmd::MAV_CMD_IMAGE_STOP_CAPTURE, |c, _, p| {
        if !targets_this_camera(c, 0) {
            return DENIED;
        }
        p.camera.stop();
        stream_reported(p, &[CAMERA_CAPTURE_STATUS_DATA::ID])
    }),
    (MavCmd::MAV_CMD_DO_DIGICAM_CONTROL, |c, v, p| {
        if c.small_integer(4) == Some(1.0) { outcome(p.camera.start(0.0, 1.0, v.now), &[], p) } else { DENIED }
    }),
    (MavCmd::MAV_CMD_DO_SET_CAM_TRIGG_DIST, |c, v, p| {
        let here = v.estimate.position_m.enu();
        if !targets_this_camera(c, 3) {
            return DENIED;
        }
        outcome(p.camera.start_by_distance(c.p[0], c.is_one(2), here, v.now), &[CAMERA_CAPTURE_STATUS_DATA::ID], p)
    }),
    (MavCmd::MAV_CMD_SET_CAMERA_MODE, mode),
    (MavCmd::MAV_CMD_SET_CAMERA_ZOOM, zoom),
    (MavCmd::MAV_CMD_SET_CAMERA_FOCUS, focus),
    (MavCmd::MAV_CMD_VIDEO_START_CAPTURE, |c, v, p| {
        if !targets_this_camera(c, 2) || !is_one_or_all(c, 0, STREAM) {
            return DENIED;
        }
        outcome(p.camera.start_recording(c.finite_param(1).unwrap_or(0.0), v.now), &[CAMERA_CAPTURE_STATUS_DATA::ID], p)
    }),
    (MavCmd::MAV_CMD_VIDEO_STOP_CAPTURE, |c, v, p| {
        if !targets_this_camera(c, 1) || !is_one_or_all(c, 0, STREAM) {
            return DENIED;
        }
        p.camera.stop_recording(v.now);
        stream_reported(p, &[CAMERA_CAPTURE_STATUS_DATA::ID, STORAGE_INFORMATION_DATA::ID])
    }),
    (MavCmd::MAV_CMD_VIDEO_START_STREAMING, |c, v, p| {
        if !targets_this_camera(c, 1) || !is_one_or_all(c, 0, STREAM) {
            return DENIED;
        }
        if v.camera.stream.is_some() {
            return stream_reported(p, &[VIDEO_STREAM_STATUS_DATA::ID]);
        }
        p.changes.add_warning("Camera: no video stream available");
        FAILED
    }),
    // The video is sent to a fixed destination, so starting and stopping change nothing.
    (MavCmd::MAV_CMD_VIDEO_STOP_STREAMING, |c, _, p| {
        if !targets_this_camera(c, 1) || !is_one_or_all(c, 0, STREAM) {
            return DENIED;
        }
        stream_reported(p, &[VIDEO_STREAM_STATUS_DATA::ID])
    }),
    (MavCmd::MAV_CMD_STORAGE_FORMAT, format),
    (MavCmd::MAV_CMD_RESET_CAMERA_SETTINGS, |c, v, p| {
        if !c.is_one(0) || !targets_this_camera(c, 1) {
            return DENIED;
        }
        outcome(p.camera.reset(&v.vehicle.camera), &[CAMERA_SETTINGS_DATA::ID, CAMERA_FOV_STATUS_DATA::ID], p)
    }),
];

/// Accepts the command and broadcasts the messages.
fn stream_reported(payload: &mut Payload, messages: &[u32]) -> MavResult {
    messages.iter().for_each(|message| payload.changes.add_message(*message));
    ACCEPTED
}

/// Converts the outcome to a result; an error caused by the camera's state is also sent as a text.
fn outcome(done: Result<(), CameraError>, messages: &[u32], payload: &mut Payload) -> MavResult {
    match done.map_err(CameraError::text) {
        Ok(()) => stream_reported(payload, messages),
        Err(None) => DENIED,
        Err(Some(text)) => {
            payload.changes.add_warning(text);
            FAILED
        }
    }
}

/// Checks whether a camera ID parameter means this camera: 0 (all), the component ID, or 1 when addressed to this component.
fn targets_this_camera(c: &VehicleCommand, k: usize) -> bool {
    let first = c.component == CAMERA;
    c.finite_param(k).is_none_or(|id| id == 0.0 || id == f64::from(CAMERA) || (first && id == 1.0))
}

/// Checks whether an ID parameter is 0 (all) or the only valid ID.
fn is_one_or_all(c: &VehicleCommand, k: usize, one: f64) -> bool {
    c.finite_param(k).is_none_or(|id| id == 0.0 || id == one)
}

/// Parameter 2 is the interval, 3 the count and, for single images, 4 a sequence number that identifies repeats.
fn start(c: &VehicleCommand, view: &VehicleSnapshot, payload: &mut Payload) -> MavResult {
    if !targets_this_camera(c, 0) {
        return DENIED;
    }
    let number = c.finite_param(3).filter(|number| (1.0..1e9).contains(number) && c.p[2] == 1.0).map(|number| number as u32);
    if number.is_some_and(|number| payload.camera.is_repeated(c.from, number, view.now)) {
        return ACCEPTED;
    }
    let single = c.p[2] == 1.0;
    let status: &[u32] = if single { &[] } else { &[CAMERA_CAPTURE_STATUS_DATA::ID] };
    let done = outcome(payload.camera.start(c.p[1], c.p[2], view.now), status, payload);
    if let Some(number) = number.filter(|_| done == ACCEPTED) {
        payload.camera.remember(c.from, number, view.now);
    }
    done
}

fn mode(c: &VehicleCommand, _: &VehicleSnapshot, payload: &mut Payload) -> MavResult {
    let mode = match c.p[1] {
        0.0 => CaptureMode::Photo,
        1.0 => CaptureMode::Video,
        _ => return DENIED,
    };
    if !targets_this_camera(c, 0) {
        return DENIED;
    }
    outcome(payload.camera.set_mode(mode), &[CAMERA_SETTINGS_DATA::ID], payload)
}

/// Parameter 1 is the zoom type (CAMERA_ZOOM_TYPE), 2 the value.
fn zoom(c: &VehicleCommand, view: &VehicleSnapshot, payload: &mut Payload) -> MavResult {
    let camera = &view.vehicle.camera;
    if camera.zoom_max <= 1.0 {
        return UNSUPPORTED;
    }
    let wish = match c.p[0] {
        0.0 => ZoomCommand::Step(c.p[1]),
        1.0 => ZoomCommand::Rate(c.p[1]),
        2.0 => ZoomCommand::Level(c.p[1] / 100.0),
        3.0 => ZoomCommand::FocalMm(c.p[1]),
        4.0 => ZoomCommand::FieldOfView(c.p[1].to_radians()),
        _ => return DENIED,
    };
    if !targets_this_camera(c, 2) || !payload.camera.zoom.command(wish, camera) {
        return DENIED;
    }
    stream_reported(payload, &[CAMERA_SETTINGS_DATA::ID, CAMERA_FOV_STATUS_DATA::ID])
}

/// The camera is always in focus: autofocus commands (SET_FOCUS_TYPE 4 to 6) succeed, manual focus is unsupported.
fn focus(c: &VehicleCommand, _: &VehicleSnapshot, payload: &mut Payload) -> MavResult {
    match c.p[0] {
        4.0..=6.0 if targets_this_camera(c, 2) => stream_reported(payload, &[CAMERA_SETTINGS_DATA::ID]),
        4.0..=6.0 => DENIED,
        _ => UNSUPPORTED,
    }
}

/// Parameter 1 is the card; 2 formats it, 3 only resets the image counter.
fn format(c: &VehicleCommand, _: &VehicleSnapshot, payload: &mut Payload) -> MavResult {
    let flag = |k: usize| match c.finite_param(k) {
        None | Some(0.0) => Some(false),
        Some(1.0) => Some(true),
        Some(_) => None,
    };
    let (Some(whole), Some(log), true) = (flag(1), flag(2), c.p[0] == CARD) else { return DENIED };
    if !whole && !log {
        return verdict(true);
    }
    outcome(payload.camera.format(whole), &[STORAGE_INFORMATION_DATA::ID, CAMERA_CAPTURE_STATUS_DATA::ID], payload)
}
