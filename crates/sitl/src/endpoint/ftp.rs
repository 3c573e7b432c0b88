//! MAVLink FTP messages to and from the file servers.

use super::inbound::InboundMessage;
use super::params::packed;
use super::streams::{AUTOPILOT, CAMERA};
use super::{Endpoint, LinkId};
use spandrel_mavlink::dialect::{FILE_TRANSFER_PROTOCOL_DATA, MavMessage};
use spandrel_mavlink::ftp::{FtpPacket, Opcode};

pub(super) fn request(e: &mut Endpoint, request: &FILE_TRANSFER_PROTOCOL_DATA, a: &mut InboundMessage) {
    let (client, packet) = ((a.link, a.from), FtpPacket::read(&request.payload));
    match packed_parameters(e, &packet) {
        Some(content) => e.files.open_generated(client, &packet, content, a.view.now),
        None => e.files.receive(client, &packet, a.view.now),
    }
}

/// Returns the packed parameter file if the flavour supports it and the request opens it.
fn packed_parameters(e: &Endpoint, packet: &FtpPacket) -> Option<Vec<u8>> {
    let opens = e.flavour.params.packed && packet.opcode == Opcode::OpenFileRo as u8;
    packed::file(packet.sized().filter(|_| opens)?, &e.params, e.storage.defaults())
}

/// Handles a request to the camera component, which has its own files.
pub(super) fn request_of_camera(e: &mut Endpoint, request: &FILE_TRANSFER_PROTOCOL_DATA, a: &InboundMessage) {
    e.camera_files.receive((a.link, a.from), &FtpPacket::read(&request.payload), a.view.now);
}

/// Sends the replies of both servers.
pub(super) fn send(e: &mut Endpoint) {
    for component in [AUTOPILOT, CAMERA] {
        let links = &e.links;
        let ready = |link: &LinkId| links.get(link).is_none_or(|link| !link.is_busy());
        let server = if component == CAMERA { &mut e.camera_files } else { &mut e.files };
        for ((link, to), packet) in server.poll(ready) {
            e.answer_as(component, link, &message(to, &packet));
        }
    }
}

fn message(to: (u8, u8), packet: &FtpPacket) -> MavMessage {
    MavMessage::FILE_TRANSFER_PROTOCOL(FILE_TRANSFER_PROTOCOL_DATA {
        target_network: 0,
        target_system: to.0,
        target_component: to.1,
        payload: packet.write(),
    })
}
