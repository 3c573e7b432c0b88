//! File requests to the autopilot.

use super::VehicleLink;
use super::inbound::InboundMessage;
use super::params::packed;
use spandrel_mavlink::dialect::FILE_TRANSFER_PROTOCOL_DATA;
use spandrel_mavlink::ftp::{FtpPacket, Opcode};

pub(super) fn request(v: &mut VehicleLink, request: &FILE_TRANSFER_PROTOCOL_DATA, a: &mut InboundMessage) {
    let (client, packet) = ((a.link, a.from), FtpPacket::read(&request.payload));
    match packed_parameters(v, &packet) {
        Some(content) => v.files.open_generated(client, &packet, content, a.now()),
        None => v.files.receive(client, &packet, a.now()),
    }
}

/// Returns the packed parameter file if the flavor supports it and the request opens it.
fn packed_parameters(v: &VehicleLink, packet: &FtpPacket) -> Option<Vec<u8>> {
    let opens = v.flavor.params.packed && packet.opcode == Opcode::OpenFileRo as u8;
    packed::file(packet.data_in_use().filter(|_| opens)?, &v.params, v.storage.defaults())
}
