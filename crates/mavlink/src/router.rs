//! Frame routing (MAVLink guide, "Routing"): broadcasts are forwarded to all other links, and addressed frames to the
//! links where their target was seen. A frame never returns to its source link. Key exchange messages are never
//! forwarded.

use super::codec::ReceivedFrame;
use super::dialect::MavMessage;
use mavlink::{MavlinkVersion, Message};
use std::collections::BTreeMap;

/// Message ID of SETUP_SIGNING, which contains a key and is therefore never forwarded.
const SETUP_SIGNING_MESSAGE_ID: u32 = 256;
/// Maximum number of senders stored, so that a link with thousands of spoofed senders cannot exhaust memory.
const MAX_SENDERS: usize = 1_024;

/// Routing table: the links where each sender was seen. `L` identifies a link.
#[derive(Debug, Clone, PartialEq)]
pub struct Router<L> {
    links_by_sender: BTreeMap<(u8, u8), Vec<L>>,
}

impl<L: Copy + Ord> Router<L> {
    /// Creates an empty routing table.
    #[must_use]
    pub fn new() -> Self {
        Self { links_by_sender: BTreeMap::new() }
    }

    /// Records the link where the sender of a frame was seen.
    pub fn note(&mut self, link: L, frame: &ReceivedFrame) {
        let sender = (frame.system_id, frame.component_id);
        if self.links_by_sender.len() >= MAX_SENDERS && !self.links_by_sender.contains_key(&sender) {
            return;
        }
        let links = self.links_by_sender.entry(sender).or_default();
        if !links.contains(&link) {
            links.push(link);
        }
    }

    /// Returns whether a component was seen on a link.
    #[must_use]
    pub fn has_seen(&self, peer: (u8, u8), link: L) -> bool {
        self.links_by_sender.get(&peer).is_some_and(|links| links.contains(&link))
    }

    /// Removes a link from the table.
    pub fn remove_link(&mut self, link: L) {
        self.links_by_sender.values_mut().for_each(|links| links.retain(|l| *l != link));
        self.links_by_sender.retain(|_, links| !links.is_empty());
    }

    /// Returns the links in `all` that should receive a frame from link `from`.
    #[must_use]
    pub fn targets_of(&self, from: L, frame: &ReceivedFrame, all: &[L]) -> Vec<L> {
        if frame.message_id == SETUP_SIGNING_MESSAGE_ID {
            return Vec::new();
        }
        let (system, component) = target(frame);
        let components = if component == 0 { (system, 0)..=(system, u8::MAX) } else { (system, component)..=(system, component) };
        let reaches =
            |link: &L| system == 0 || self.links_by_sender.range(components.clone()).any(|(_, links)| links.contains(link));
        all.iter().copied().filter(|l| *l != from).filter(reaches).collect()
    }
}

impl<L: Copy + Ord> Default for Router<L> {
    fn default() -> Self {
        Self::new()
    }
}

/// Returns a frame's target system and component; 0 means broadcast. Frames with unknown messages count as broadcasts.
#[must_use]
pub fn target(frame: &ReceivedFrame) -> (u8, u8) {
    if let Some(message) = &frame.message {
        let system = message.target_system_id().unwrap_or(0);
        return (system, message.target_component_id().unwrap_or(0));
    }
    // A message with invalid enum values cannot be parsed, but its target is still at the offset where the codec would write it.
    let [system, component] = target_offsets(frame.message_id);
    let payload = frame.payload(255);
    let byte = |place: Option<usize>| place.and_then(|at| payload.get(at)).copied().unwrap_or(0);
    (byte(system), byte(component))
}

/// Returns the payload offsets of the target system and target component. Determines them by encoding a message with
/// different targets.
fn target_offsets(message_id: u32) -> [Option<usize>; 2] {
    let place = |field: fn(&mut MavMessage) -> Option<&mut u8>| {
        let mut message = MavMessage::default_message_from_id(message_id)?;
        let mut written = |value: u8| {
            let mut payload = [0; 255];
            *field(&mut message)? = value;
            message.ser(MavlinkVersion::V2, &mut payload);
            Some(payload)
        };
        let (zero, full) = (written(0)?, written(u8::MAX)?);
        zero.iter().zip(full).position(|(a, b)| *a != b)
    };
    [place(MavMessage::target_system_id_mut), place(MavMessage::target_component_id_mut)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codec::{Decoder, Encoder};
    use crate::dialect::{COMMAND_ACK_DATA, HEARTBEAT_DATA, MavMessage};

    fn frame(system: u8, component: u8, message: &MavMessage) -> ReceivedFrame {
        Decoder::new().datagram(&Encoder::new(system, component).encode(message)).remove(0)
    }

    #[test]
    fn wire_broadcasts_and_addressed_frames_reach_the_correct_links() {
        let mut router = Router::new();
        let beat = MavMessage::HEARTBEAT(HEARTBEAT_DATA::default());
        router.note(1, &frame(255, 190, &beat));
        router.note(2, &frame(254, 190, &beat));
        assert_eq!(router.targets_of(3, &frame(1, 191, &beat), &[1, 2, 3]), [1, 2]);
        let ack = MavMessage::COMMAND_ACK(COMMAND_ACK_DATA { target_system: 254, target_component: 190, ..Default::default() });
        assert_eq!(router.targets_of(3, &frame(1, 191, &ack), &[1, 2, 3]), [2]);
        router.remove_link(2);
        assert!(router.targets_of(3, &frame(1, 191, &ack), &[1, 3]).is_empty());
    }

    #[test]
    fn wire_sticks_and_unparsable_payloads_reach_only_their_target() {
        use crate::dialect::{MANUAL_CONTROL_DATA, SET_POSITION_TARGET_LOCAL_NED_DATA};
        let sticks = MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA { target: 7, ..Default::default() });
        assert_eq!(target(&frame(255, 190, &sticks)), (7, 0));
        let aim = SET_POSITION_TARGET_LOCAL_NED_DATA { target_system: 7, target_component: 9, ..Default::default() };
        assert_eq!(target_offsets(84), [Some(50), Some(51)]);
        let mut unreadable = frame(255, 190, &MavMessage::SET_POSITION_TARGET_LOCAL_NED(aim));
        unreadable.message = None;
        assert_eq!(target(&unreadable), (7, 9));
    }

    #[test]
    fn prop_routing_table_is_bounded_for_spoofed_senders() {
        let mut router = Router::new();
        let mut beat = frame(1, 1, &MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
        for k in 0..=u16::MAX {
            [beat.system_id, beat.component_id] = k.to_be_bytes();
            router.note(1, &beat);
        }
        assert_eq!(router.links_by_sender.len(), MAX_SENDERS);
    }
}
