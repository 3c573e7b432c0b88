//! Requests for messages and message rates, made with the current commands or with the superseded ones that clients
//! still send.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use super::component_ids::{AUTOPILOT, CAMERA};
use super::inputs::{StreamInputs, payload_input};
use super::link::{LinkId, Links};
use super::payload::PayloadLink;
use super::simulated_aircraft::SimulatedAircraft;
use super::streams::{self, STREAMS};
use super::vehicle_command::VehicleCommand;
use super::vehicle_link::VehicleLink;
use crate::autopilot::Autopilot;
use spandrel_mavlink::dialect::{MESSAGE_INTERVAL_DATA, MavCmd, MavMessage, MavResult};

/// The autopilot and payload interfaces, and the link that the request came from.
pub(super) struct MessageRequest<'a, 'v> {
    pub link: LinkId,
    pub links: &'a mut Links,
    pub vehicle: &'a mut VehicleLink,
    pub payload: &'a mut PayloadLink,
    pub aircraft: &'a SimulatedAircraft<'v>,
    pub autopilot: &'a Autopilot,
}

const AVAILABLE_MODES: u32 = 435;
const IMAGE_CAPTURED: u32 = 263;
const STREAM_INFORMATION: u32 = 269;
const STREAM_STATUS: u32 = 270;
/// Messages that exist once per memory card or video stream and are requested by its number.
const INDEXED_MESSAGES: [u32; 3] = [261, STREAM_INFORMATION, STREAM_STATUS];
const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const DENIED: MavResult = MavResult::MAV_RESULT_DENIED;
const FAILED: MavResult = MavResult::MAV_RESULT_FAILED;
/// MAV_CMD_DO_SEND_BANNER, from ArduPilot's dialect.
const SEND_BANNER: u16 = 42_428;

/// Returns the message that a superseded command requests; `None` for other commands.
pub(super) fn superseded_request(number: u16) -> Option<u32> {
    use MavCmd as M;
    match number {
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
    }
}

pub(super) fn handle(c: &VehicleCommand, x: &mut MessageRequest) -> Option<MavResult> {
    use MavCmd as M;
    let id = |k: usize| c.finite_param(k).filter(|v| (0.0..16_777_216.0).contains(v)).map(|v| v as u32);
    if let Some(message) = superseded_request(c.number) {
        // If the message has an index, the index is the command's first parameter.
        let index = if INDEXED_MESSAGES.contains(&message) || message == IMAGE_CAPTURED { c.p[0] } else { 0.0 };
        return Some(request(message, (index, 0.0), c.component, x));
    }
    match c.number {
        SEND_BANNER if !x.vehicle.flavor().banner.is_empty() => {
            x.vehicle.announce_identity();
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

/// Returns the stream rows for a message from the addressed component.
fn addressed(id: u32, component: u8) -> impl Iterator<Item = usize> {
    let mine =
        move |row: &usize| component == 0 || STREAMS[*row].component == component || !matches!(component, AUTOPILOT | CAMERA);
    streams::rows_of(id).map(|(row, _)| row).filter(mine)
}

/// Sends a message. `index` and `last` are parameters 2 and 3 of the request, whose meaning depends on the message.
fn request(id: u32, (index, last): (f64, f64), component: u8, x: &mut MessageRequest) -> MavResult {
    if id == AVAILABLE_MODES {
        return x.vehicle.send_modes(index, x.link, x.links);
    }
    if id == IMAGE_CAPTURED {
        return x.payload.resend_images((index, last), x.link, x.links);
    }
    // The vehicle has one card and one stream; 0 means all.
    if INDEXED_MESSAGES.contains(&id) && index.is_finite() && !matches!(index, 0.0 | 1.0) {
        return DENIED;
    }
    let flavor = x.vehicle.flavor();
    let Some(link) = x.links.get_mut(x.link) else { return DENIED };
    let input = payload_input(x.vehicle, x.aircraft, x.autopilot);
    let inputs = StreamInputs::new(x.vehicle, x.payload, x.aircraft, x.autopilot, &input).for_link(link.kind);
    let mut is_available = false;
    for row in addressed(id, component).filter(|row| STREAMS[*row].is_sent(flavor)) {
        let Some(message) = STREAMS[row].build(&inputs) else { continue };
        is_available = true;
        if flavor.sends_message_after_ack {
            link.after_acknowledgment.push(row);
        } else {
            link.send(STREAMS[row].component, &message);
        }
    }
    if is_available { ACCEPTED } else { flavor.refusals.message }
}

fn set_interval(id: u32, us: f64, component: u8, x: &mut MessageRequest) -> MavResult {
    let flavor = x.vehicle.flavor();
    let rows: Vec<usize> = addressed(id, component).filter(|row| STREAMS[*row].is_sent(flavor)).collect();
    if rows.is_empty() {
        return flavor.refusals.interval;
    }
    let now = x.aircraft.clock.now;
    let Some(link) = x.links.get_mut(x.link) else { return DENIED };
    if rows.iter().all(|row| link.streams.set_interval(*row, us, now)) { ACCEPTED } else { DENIED }
}

fn get_interval(id: u32, component: u8, x: &mut MessageRequest) -> MavResult {
    let row = addressed(id, component).next();
    let link = x.links.get(x.link);
    let interval_us = row.zip(link).map_or(0, |(row, link)| link.streams.interval_us(row));
    x.links.answer(
        AUTOPILOT,
        x.link,
        &MavMessage::MESSAGE_INTERVAL(MESSAGE_INTERVAL_DATA { interval_us, message_id: id as u16 }),
    );
    if row.is_some() { ACCEPTED } else { FAILED }
}
