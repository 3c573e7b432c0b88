//! Files over MAVLink: the message around the packets of the file server.

use super::arrival::Arrival;
use super::params::packed;
use super::streams::AUTOPILOT;
use super::{Endpoint, LinkId};
use crate::mav::dialect::{FILE_TRANSFER_PROTOCOL_DATA, MavMessage};
use crate::mav::ftp::{Opcode, Packet, Refusal};

pub(super) fn request(e: &mut Endpoint, request: &FILE_TRANSFER_PROTOCOL_DATA, a: &mut Arrival) {
    let (client, packet) = ((a.link, a.from), Packet::read(&request.payload));
    match packed_parameters(e, &packet) {
        Some(content) => e.files.open_made(client, &packet, content, a.view.now),
        None => e.files.receive(client, &packet, a.view.now),
    }
}

/// The parameters as a file, where the flavour has it and this opens it.
fn packed_parameters(e: &Endpoint, packet: &Packet) -> Option<Vec<u8>> {
    let opens = e.flavour.params.packed && packet.opcode == Opcode::OpenFileRo as u8;
    packed::file(packet.sized().filter(|_| opens)?, &e.params, e.storage.defaults())
}

/// No files in a component's name: the autopilot's component has them.
pub(super) fn refuse(e: &mut Endpoint, component: u8, request: &FILE_TRANSFER_PROTOCOL_DATA, a: &Arrival) {
    let answer = Packet::read(&request.payload).refuse(Refusal::FileNotFound);
    e.answer_as(component, a.link, &message(a.from, &answer));
}

/// What the server has to say goes out.
pub(super) fn speak(e: &mut Endpoint) {
    let links = &e.links;
    let ready = |link: &LinkId| links.get(link).is_none_or(|link| !link.is_busy());
    for ((link, to), packet) in e.files.poll(ready) {
        e.answer_as(AUTOPILOT, link, &message(to, &packet));
    }
}

fn message(to: (u8, u8), packet: &Packet) -> MavMessage {
    MavMessage::FILE_TRANSFER_PROTOCOL(FILE_TRANSFER_PROTOCOL_DATA {
        target_network: 0,
        target_system: to.0,
        target_component: to.1,
        payload: packet.write(),
    })
}
