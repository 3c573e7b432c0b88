//! Camera commands: images, recording, modes, zoom, memory card.

use super::super::camera::zoom::ZoomCommand;
use super::super::camera::{CameraError, CaptureMode};
use super::super::equipment::Payload;
use super::super::input::PayloadInput;
use super::handler::{ACCEPTED, DENIED, PayloadCommand, accepted_if};
use crate::endpoint::component_ids::CAMERA;
use crate::endpoint::vehicle_command::VehicleCommand;
use mavlink::MessageData;
use spandrel_mavlink::dialect::{
    CAMERA_CAPTURE_STATUS_DATA, CAMERA_FOV_STATUS_DATA, CAMERA_SETTINGS_DATA, MavCmd, MavResult, STORAGE_INFORMATION_DATA,
    VIDEO_STREAM_STATUS_DATA,
};

const FAILED: MavResult = MavResult::MAV_RESULT_FAILED;
const UNSUPPORTED: MavResult = MavResult::MAV_RESULT_UNSUPPORTED;
/// ID of the only video stream.
const STREAM_ID: f64 = 1.0;
/// ID of the only memory card.
const CARD_ID: f64 = 1.0;

pub(super) const ROWS: &[PayloadCommand] = &[
    (MavCmd::MAV_CMD_IMAGE_START_CAPTURE, start),
    (MavCmd::MAV_CMD_IMAGE_STOP_CAPTURE, |c, _, p| {
        if !targets_this_camera(c, 0) {
            return DENIED;
        }
        p.camera.stop();
        report(p, &[CAMERA_CAPTURE_STATUS_DATA::ID])
    }),
    (MavCmd::MAV_CMD_DO_DIGICAM_CONTROL, |c, i, p| {
        if c.small_integer(4) == Some(1.0) { outcome(p.camera.start(0.0, 1.0, i.clock.now), &[], p) } else { DENIED }
    }),
    (MavCmd::MAV_CMD_DO_SET_CAM_TRIGG_DIST, |c, i, p| {
        let here = i.position_m.enu();
        if !targets_this_camera(c, 3) {
            return DENIED;
        }
        outcome(
            p.camera.start_distance_triggered_series(c.p[0], c.is_one(2), here, i.clock.now),
            &[CAMERA_CAPTURE_STATUS_DATA::ID],
            p,
        )
    }),
    (MavCmd::MAV_CMD_SET_CAMERA_MODE, mode),
    (MavCmd::MAV_CMD_SET_CAMERA_ZOOM, zoom),
    (MavCmd::MAV_CMD_SET_CAMERA_FOCUS, focus),
    (MavCmd::MAV_CMD_VIDEO_START_CAPTURE, |c, i, p| {
        if !targets_this_camera(c, 2) || !is_one_or_all(c, 0, STREAM_ID) {
            return DENIED;
        }
        outcome(p.camera.start_recording(c.finite_param(1).unwrap_or(0.0), i.clock.now), &[CAMERA_CAPTURE_STATUS_DATA::ID], p)
    }),
    (MavCmd::MAV_CMD_VIDEO_STOP_CAPTURE, |c, i, p| {
        if !targets_this_camera(c, 1) || !is_one_or_all(c, 0, STREAM_ID) {
            return DENIED;
        }
        p.camera.stop_recording(i.clock.now);
        report(p, &[CAMERA_CAPTURE_STATUS_DATA::ID, STORAGE_INFORMATION_DATA::ID])
    }),
    (MavCmd::MAV_CMD_VIDEO_START_STREAMING, |c, i, p| {
        if !targets_this_camera(c, 1) || !is_one_or_all(c, 0, STREAM_ID) {
            return DENIED;
        }
        if p.camera.stream.running(i.clock.now).is_some() {
            return report(p, &[VIDEO_STREAM_STATUS_DATA::ID]);
        }
        p.changes.add_warning("Camera: no video stream available");
        FAILED
    }),
    // The video is sent to a fixed destination, so starting and stopping the stream have no effect.
    (MavCmd::MAV_CMD_VIDEO_STOP_STREAMING, |c, _, p| {
        if !targets_this_camera(c, 1) || !is_one_or_all(c, 0, STREAM_ID) {
            return DENIED;
        }
        report(p, &[VIDEO_STREAM_STATUS_DATA::ID])
    }),
    (MavCmd::MAV_CMD_STORAGE_FORMAT, format),
    (MavCmd::MAV_CMD_RESET_CAMERA_SETTINGS, |c, i, p| {
        if !c.is_one(0) || !targets_this_camera(c, 1) {
            return DENIED;
        }
        outcome(p.camera.reset(&i.vehicle.camera), &[CAMERA_SETTINGS_DATA::ID, CAMERA_FOV_STATUS_DATA::ID], p)
    }),
];

/// Accepts the command and broadcasts the messages.
fn report(payload: &mut Payload, messages: &[u32]) -> MavResult {
    messages.iter().for_each(|message| payload.changes.add_message(*message));
    ACCEPTED
}

/// Converts the outcome to a result. An error caused by the camera's state is also sent as a text.
fn outcome(done: Result<(), CameraError>, messages: &[u32], payload: &mut Payload) -> MavResult {
    match done.map_err(CameraError::text) {
        Ok(()) => report(payload, messages),
        Err(None) => DENIED,
        Err(Some(text)) => {
            payload.changes.add_warning(text);
            FAILED
        }
    }
}

/// Checks whether a camera ID parameter refers to this camera: 0 (all), the component ID, or 1 when addressed to this
/// component.
fn targets_this_camera(c: &VehicleCommand, k: usize) -> bool {
    let first = c.component == CAMERA;
    c.finite_param(k).is_none_or(|id| id == 0.0 || id == f64::from(CAMERA) || (first && id == 1.0))
}

/// Checks whether an ID parameter is 0 (all) or the only valid ID.
fn is_one_or_all(c: &VehicleCommand, k: usize, one: f64) -> bool {
    c.finite_param(k).is_none_or(|id| id == 0.0 || id == one)
}

/// Parameter 2 is the interval and 3 the count. For single images, 4 is a sequence number that identifies repeats.
fn start(c: &VehicleCommand, input: &PayloadInput, payload: &mut Payload) -> MavResult {
    if !targets_this_camera(c, 0) {
        return DENIED;
    }
    let number = c.finite_param(3).filter(|number| (1.0..1e9).contains(number) && c.p[2] == 1.0).map(|number| number as u32);
    if number.is_some_and(|number| payload.camera.is_repeated(c.from, number, input.clock.now)) {
        return ACCEPTED;
    }
    let single = c.p[2] == 1.0;
    let status: &[u32] = if single { &[] } else { &[CAMERA_CAPTURE_STATUS_DATA::ID] };
    let done = outcome(payload.camera.start(c.p[1], c.p[2], input.clock.now), status, payload);
    if let Some(number) = number.filter(|_| done == ACCEPTED) {
        payload.camera.record_capture_command(c.from, number, input.clock.now);
    }
    done
}

fn mode(c: &VehicleCommand, _: &PayloadInput, payload: &mut Payload) -> MavResult {
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

/// Parameter 1 is the zoom type (CAMERA_ZOOM_TYPE), and 2 is the value.
fn zoom(c: &VehicleCommand, input: &PayloadInput, payload: &mut Payload) -> MavResult {
    let camera = &input.vehicle.camera;
    if camera.zoom_max <= 1.0 {
        return UNSUPPORTED;
    }
    let request = match c.p[0] {
        0.0 => ZoomCommand::Step(c.p[1]),
        1.0 => ZoomCommand::Rate(c.p[1]),
        2.0 => ZoomCommand::Level(c.p[1] / 100.0),
        3.0 => ZoomCommand::FocalMm(c.p[1]),
        4.0 => ZoomCommand::FieldOfView(c.p[1].to_radians()),
        _ => return DENIED,
    };
    if !targets_this_camera(c, 2) || !payload.camera.zoom.command(request, camera) {
        return DENIED;
    }
    report(payload, &[CAMERA_SETTINGS_DATA::ID, CAMERA_FOV_STATUS_DATA::ID])
}

/// The camera is always in focus: autofocus commands (SET_FOCUS_TYPE 4 to 6) succeed, and manual focus is unsupported.
fn focus(c: &VehicleCommand, _: &PayloadInput, payload: &mut Payload) -> MavResult {
    match c.p[0] {
        4.0..=6.0 if targets_this_camera(c, 2) => report(payload, &[CAMERA_SETTINGS_DATA::ID]),
        4.0..=6.0 => DENIED,
        _ => UNSUPPORTED,
    }
}

/// Parameter 1 is the card; 2 formats it, and 3 only resets the image counter.
fn format(c: &VehicleCommand, _: &PayloadInput, payload: &mut Payload) -> MavResult {
    let flag = |k: usize| match c.finite_param(k) {
        None | Some(0.0) => Some(false),
        Some(1.0) => Some(true),
        Some(_) => None,
    };
    let (Some(whole), Some(log), true) = (flag(1), flag(2), c.p[0] == CARD_ID) else { return DENIED };
    if !whole && !log {
        return accepted_if(true);
    }
    outcome(payload.camera.format(whole), &[STORAGE_INFORMATION_DATA::ID, CAMERA_CAPTURE_STATUS_DATA::ID], payload)
}
