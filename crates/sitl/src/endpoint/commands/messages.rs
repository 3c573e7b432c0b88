//! Requests for messages and message rates, by the current commands and by the superseded ones that clients still send.
#![allow(deprecated, reason = "clients still send the superseded commands")]

use super::super::streams::{self, AUTOPILOT, CAMERA, STREAMS};
use super::VehicleCommand;
use crate::endpoint::CommandContext;
use spandrel_mavlink::dialect::{AVAILABLE_MODES_DATA, MESSAGE_INTERVAL_DATA, MavCmd, MavMessage, MavModeProperty, MavResult};

const AVAILABLE_MODES: u32 = 435;
const IMAGE_CAPTURED: u32 = 263;
const STREAM_INFORMATION: u32 = 269;
const STREAM_STATUS: u32 = 270;
/// Messages sent once for each card or stream, requested by its number.
const COUNTED: [u32; 3] = [261, STREAM_INFORMATION, STREAM_STATUS];
const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const DENIED: MavResult = MavResult::MAV_RESULT_DENIED;
const FAILED: MavResult = MavResult::MAV_RESULT_FAILED;
/// MAV_CMD_DO_SEND_BANNER of ArduPilot's dialect.
const SEND_BANNER: u16 = 42_428;

pub(super) fn handle(c: &VehicleCommand, x: &mut CommandContext) -> Option<MavResult> {
    use MavCmd as M;
    let id = |k: usize| c.finite_param(k).filter(|v| (0.0..16_777_216.0).contains(v)).map(|v| v as u32);
    // Superseded commands that request one message each.
    let legacy = match c.number {
        n if n == M::MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES as u16 => Some(148),
        n if n == M::MAV_CMD_REQUEST_PROTOCOL_VERSION as u16 => Some(300),
        n if n == M::MAV_CMD_REQUEST_CAMERA_INFORMATION as u16 => Some(259),
        n if n == M::MAV_CMD_REQUEST_CAMERA_SETTINGS as u16 => Some(260),
        n if n == M::MAV_CMD_REQUEST_STORAGE_INFORMATION as u16 => Some(261),
        n if n == M::MAV_CMD_REQUEST_CAMERA_CAPTURE_STATUS as u16 => Some(262),
        n if n == M::MAV_CMD_REQUEST_FLIGHT_INFORMATION as u16 => Some(264),
        n if n == M::MAV_CMD_GET_HOME_POSITION as u16 => Some(242),
        n if n == M::MAV_CMD_REQUEST_VIDEO_STREAM_INFORMATION as u16 => Some(STREAM_INFORMATION),
        n if n == M::MAV_CMD_REQUEST_VIDEO_STREAM_STATUS as u16 => Some(STREAM_STATUS),
        n if n == M::MAV_CMD_REQUEST_CAMERA_IMAGE_CAPTURE as u16 => Some(IMAGE_CAPTURED),
        _ => None,
    };
    if let Some(message) = legacy {
        // If the message has an index, it is the command's first parameter.
        let index = if COUNTED.contains(&message) || message == IMAGE_CAPTURED { c.p[0] } else { 0.0 };
        return Some(request(message, (index, 0.0), c.component, x));
    }
    match c.number {
        SEND_BANNER if !x.view.flavour.banner.is_empty() => {
            x.announce_identity();
            Some(ACCEPTED)
        }
        n if n == M::MAV_CMD_REQUEST_MESSAGE as u16 => {
            Some(id(0).map_or(DENIED, |m| request(m, (c.p[1], c.p[2]), c.component, x)))
        }
        n if n == M::MAV_CMD_SET_MESSAGE_INTERVAL as u16 => {
            Some(id(0).map_or(DENIED, |m| set_interval(m, c.p[1], c.component, x)))
        }
        n if n == M::MAV_CMD_GET_MESSAGE_INTERVAL as u16 => Some(id(0).map_or(DENIED, |m| get_interval(m, c.component, x))),
        _ => None,
    }
}

/// Returns the stream rows of a message sent by the addressed component.
fn addressed(id: u32, component: u8) -> impl Iterator<Item = usize> {
    let mine =
        move |row: &usize| component == 0 || STREAMS[*row].component == component || !matches!(component, AUTOPILOT | CAMERA);
    streams::rows_of(id).map(|(row, _)| row).filter(mine)
}

/// Sends a message. `index` and `last` are parameters 2 and 3 of the request; their meaning depends on the message.
fn request(id: u32, (index, last): (f64, f64), component: u8, x: &mut CommandContext) -> MavResult {
    if id == AVAILABLE_MODES {
        return modes(index, x);
    }
    if id == IMAGE_CAPTURED {
        return pictures(index, last, x);
    }
    // There is one card and one stream; 0 means all.
    if COUNTED.contains(&id) && index.is_finite() && !matches!(index, 0.0 | 1.0) {
        return DENIED;
    }
    let rows: Vec<usize> = addressed(id, component).filter(|row| STREAMS[*row].is_sent(x.view.flavour)).collect();
    let mut said = false;
    for row in rows {
        let Some(message) = STREAMS[row].build(&x.view) else { continue };
        said = true;
        if x.view.flavour.answers_after_acknowledgement {
            x.link.after_acknowledgement.push(row);
        } else {
            x.answer(STREAMS[row].component, &message);
        }
    }
    if said { ACCEPTED } else { x.view.flavour.refusals.message }
}

/// Resends image records `first` (-1: all) to `last` (0: only `first`, -1: to the newest). The first is sent immediately, the
/// others as link capacity permits.
fn pictures(first: f64, last: f64, x: &mut CommandContext) -> MavResult {
    let count = x.view.camera.pictures;
    let (first, last) = match (first, last) {
        (-1.0, _) => (0.0, -1.0),
        (first, last) => (first, if last.is_finite() { last } else { 0.0 }),
    };
    if !(first >= 0.0 && first < count as f64) || last < -1.0 {
        return DENIED;
    }
    let first = first as usize;
    let end = match last {
        -1.0 => count,
        0.0 => first + 1,
        last => count.min(last as usize + 1),
    };
    let Some(message) = x.payload.camera.recorded_capture(first) else { return DENIED };
    if end > first + 1 {
        x.link.pictures = first + 1..end;
    }
    x.answer(CAMERA, &message)
}

/// Sends one mode, or all modes if `index` is 0.
fn modes(index: f64, x: &mut CommandContext) -> MavResult {
    let modes = x.view.flavour.modes;
    let count = modes.len();
    let wanted = if index.is_finite() && index >= 0.0 { index as usize } else { return DENIED };
    if wanted > count {
        return DENIED;
    }
    for (k, row) in modes.iter().enumerate().filter(|(k, _)| wanted == 0 || wanted == k + 1) {
        let mut properties = MavModeProperty::empty();
        properties.set(MavModeProperty::MAV_MODE_PROPERTY_NOT_USER_SELECTABLE, !row.selectable);
        properties.set(MavModeProperty::MAV_MODE_PROPERTY_AUTO_MODE, row.auto);
        let message = MavMessage::AVAILABLE_MODES(AVAILABLE_MODES_DATA {
            custom_mode: row.number,
            properties,
            number_modes: count as u8,
            mode_index: (k + 1) as u8,
            standard_mode: row.standard,
            mode_name: row.name.into(),
        });
        x.answer(AUTOPILOT, &message);
    }
    ACCEPTED
}

fn set_interval(id: u32, us: f64, component: u8, x: &mut CommandContext) -> MavResult {
    let rows: Vec<usize> = addressed(id, component).filter(|row| STREAMS[*row].is_sent(x.view.flavour)).collect();
    if rows.is_empty() {
        return x.view.flavour.refusals.interval;
    }
    let now = x.view.now;
    if rows.iter().all(|row| x.link.set_interval(*row, us, now)) { ACCEPTED } else { DENIED }
}

fn get_interval(id: u32, component: u8, x: &mut CommandContext) -> MavResult {
    let row = addressed(id, component).next();
    let interval_us = row.map_or(0, |row| x.link.interval_us(row));
    x.answer(AUTOPILOT, &MavMessage::MESSAGE_INTERVAL(MESSAGE_INTERVAL_DATA { interval_us, message_id: id as u16 }));
    if row.is_some() { ACCEPTED } else { FAILED }
}
