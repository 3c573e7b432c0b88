//! FILE_TRANSFER_PROTOCOL messages that contain a file server's replies.

use super::FileServer;
use crate::endpoint::link::Links;
use spandrel_mavlink::dialect::{FILE_TRANSFER_PROTOCOL_DATA, MavMessage};

/// Sends a component's file server replies. Burst packets wait until the link has capacity.
pub(crate) fn send_replies(server: &mut FileServer, component: u8, links: &mut Links) {
    for ((link, to), packet) in server.poll(|link| links.has_capacity(*link)) {
        let message = MavMessage::FILE_TRANSFER_PROTOCOL(FILE_TRANSFER_PROTOCOL_DATA {
            target_network: 0,
            target_system: to.0,
            target_component: to.1,
            payload: packet.write(),
        });
        links.answer(component, link, &message);
    }
}
