//! Which links a frame goes on to (MAVLink guide, routing): broadcasts to all others, addressed frames to where their target was heard,
//! never back where they came from, key exchange to nobody.

use super::codec::Received;
use mavlink::Message;
use std::collections::BTreeMap;

/// SETUP_SIGNING carries a key and is never passed on.
const SETUP_SIGNING: u32 = 256;

/// Who has been heard on which link. `L` names a link.
#[derive(Debug, Clone, PartialEq)]
pub struct Router<L> {
    heard: BTreeMap<(u8, u8), Vec<L>>,
}

impl<L: Copy + Ord> Router<L> {
    /// Nobody heard yet.
    #[must_use]
    pub fn new() -> Self {
        Self { heard: BTreeMap::new() }
    }

    /// Notes the sender of a frame.
    pub fn note(&mut self, link: L, frame: &Received) {
        let links = self.heard.entry((frame.system_id, frame.component_id)).or_default();
        if !links.contains(&link) {
            links.push(link);
        }
    }

    /// True when a system's component has been heard on a link.
    #[must_use]
    pub fn heard_on(&self, peer: (u8, u8), link: L) -> bool {
        self.heard.get(&peer).is_some_and(|links| links.contains(&link))
    }

    /// Forgets a link.
    pub fn close(&mut self, link: L) {
        self.heard.values_mut().for_each(|links| links.retain(|l| *l != link));
        self.heard.retain(|_, links| !links.is_empty());
    }

    /// Links among `all` that the frame goes on to.
    #[must_use]
    pub fn onward(&self, from: L, frame: &Received, all: &[L]) -> Vec<L> {
        if frame.message_id == SETUP_SIGNING {
            return Vec::new();
        }
        let (system, component) = target(frame);
        let reaches = |link: &L| {
            system == 0
                || self
                    .heard
                    .iter()
                    .any(|((s, c), links)| *s == system && (component == 0 || *c == component) && links.contains(link))
        };
        all.iter().copied().filter(|l| *l != from).filter(reaches).collect()
    }
}

impl<L: Copy + Ord> Default for Router<L> {
    fn default() -> Self {
        Self::new()
    }
}

/// Target system and component of a frame; 0 for everybody. A frame whose body is unknown counts as a broadcast.
#[must_use]
pub fn target(frame: &Received) -> (u8, u8) {
    if let Some(message) = &frame.message {
        let system = message.target_system_id().unwrap_or(0);
        return (system, message.target_component_id().unwrap_or(0));
    }
    // Bodies that the dialect's enumerations cannot hold still name their target at a fixed place.
    match frame.message_id {
        75 | 76 => {
            let payload = frame.payload(35);
            (payload[30], payload[31])
        }
        11 => (frame.payload(6)[4], 0),
        73 => {
            let payload = frame.payload(38);
            (payload[32], payload[33])
        }
        _ => (0, 0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mav::codec::{Decoder, Encoder};
    use crate::mav::dialect::{COMMAND_ACK_DATA, HEARTBEAT_DATA, MavMessage};

    fn frame(system: u8, component: u8, message: &MavMessage) -> Received {
        Decoder::new().datagram(&Encoder::new(system, component).encode(message)).remove(0)
    }

    #[test]
    fn wire_broadcasts_go_everywhere_but_back_and_addressed_frames_to_their_target() {
        let mut router = Router::new();
        let beat = MavMessage::HEARTBEAT(HEARTBEAT_DATA::default());
        router.note(1, &frame(255, 190, &beat));
        router.note(2, &frame(254, 190, &beat));
        assert_eq!(router.onward(3, &frame(1, 191, &beat), &[1, 2, 3]), [1, 2]);
        let ack = MavMessage::COMMAND_ACK(COMMAND_ACK_DATA { target_system: 254, target_component: 190, ..Default::default() });
        assert_eq!(router.onward(3, &frame(1, 191, &ack), &[1, 2, 3]), [2]);
        router.close(2);
        assert!(router.onward(3, &frame(1, 191, &ack), &[1, 3]).is_empty());
    }
}
