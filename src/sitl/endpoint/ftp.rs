//! Files over MAVLink: none are served yet, and every request is refused at once, so that clients go on.

use super::Endpoint;
use super::receive::Arrival;
use super::streams::AUTOPILOT;
use crate::mav::dialect::{FILE_TRANSFER_PROTOCOL_DATA, MavMessage};

/// Operations and errors of the MAVLink FTP service.
const NONE: u8 = 0;
const TERMINATE: u8 = 1;
const RESET: u8 = 2;
const LIST: u8 = 3;
const LAST_KNOWN: u8 = 15;
const ACK: u8 = 128;
const NAK: u8 = 129;
const END_OF_FILE: u8 = 6;
const UNKNOWN_COMMAND: u8 = 7;
const FILE_NOT_FOUND: u8 = 10;

/// The longest data of a request, bytes.
const DATA: usize = 239;

pub(super) fn request(e: &mut Endpoint, request: &FILE_TRANSFER_PROTOCOL_DATA, a: &mut Arrival) {
    refuse(e, AUTOPILOT, request, a);
}

/// Answers in the name of a component.
pub(super) fn refuse(e: &mut Endpoint, component: u8, request: &FILE_TRANSFER_PROTOCOL_DATA, a: &Arrival) {
    let asked = &request.payload;
    let mut payload = [0u8; 251];
    let sequence = u16::from_le_bytes([asked[0], asked[1]]).wrapping_add(1).to_le_bytes();
    payload[..2].copy_from_slice(&sequence);
    payload[2] = asked[2];
    payload[5] = asked[3];
    match refusal(asked) {
        None => payload[3] = ACK,
        Some(error) => (payload[3], payload[4], payload[12]) = (NAK, 1, error),
    }
    let answer = FILE_TRANSFER_PROTOCOL_DATA { target_network: 0, target_system: a.from.0, target_component: a.from.1, payload };
    e.answer_as(component, a.link, &MavMessage::FILE_TRANSFER_PROTOCOL(answer));
}

/// Ending sessions is always granted, the root folder is empty, everything else is not there.
fn refusal(asked: &[u8; 251]) -> Option<u8> {
    let data = &asked[12..12 + usize::from(asked[4]).min(DATA)];
    let path = data.split(|byte| *byte == 0).next().unwrap_or_default();
    match asked[3] {
        NONE | TERMINATE | RESET => None,
        LIST if path.is_empty() || path == b"/" => Some(END_OF_FILE),
        LIST..=LAST_KNOWN => Some(FILE_NOT_FOUND),
        _ => Some(UNKNOWN_COMMAND),
    }
}
