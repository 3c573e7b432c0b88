//! Forwarding between the autopilot and the clients.

use super::RelayEndpoint;
use crate::endpoint::component_ids::AUTOPILOT;
use crate::endpoint::link::{LinkId, LinkKind, PeerLink, is_time_request};
use mavlink::{Message, MessageData};
use spandrel_mavlink::codec::{Encodable, ReceivedFrame};
use spandrel_mavlink::dialect::{
    BATTERY_STATUS_DATA, HIL_STATE_QUATERNION_DATA, MavMessage, RC_CHANNELS_DATA, TIMESYNC_DATA, WIND_COV_DATA,
};
use spandrel_mavlink::router;
use spandrel_model::time::SimTime;

/// Messages that payload processes receive from the simulator and not from the autopilot: the scores use the true state of the
/// battery and the wind, the sticks as received, and the ground truth.
const SENT_BY_SIMULATOR: [u32; 5] =
    [HIL_STATE_QUATERNION_DATA::ID, RC_CHANNELS_DATA::ID, BATTERY_STATUS_DATA::ID, WIND_COV_DATA::ID, TIMESYNC_DATA::ID];

impl RelayEndpoint {
    /// Forwards a frame from the autopilot to the clients.
    pub(super) fn forward_from_autopilot(&mut self, from: LinkId, frame: &ReceivedFrame) {
        let to_all = router::target(frame).0 == 0;
        for target in self.links.targets(from, frame) {
            let Some(link) = self.links.get_mut(target).filter(|link| !(link.sends_only_responses && to_all)) else { continue };
            // In lockstep, a peer answers each TIMESYNC request as the end of a step. Only the simulator may ask.
            let is_misleading = link.lockstep && is_time_request(frame);
            if link.kind == LinkKind::Payload {
                forward_to_payload_process(link, frame);
            } else if !is_misleading {
                link.forward(frame.bytes.clone());
            }
        }
    }

    /// Forwards a frame from a client to the autopilot and to other clients.
    pub(super) fn forward_from_client(&mut self, from: LinkId, frame: &ReceivedFrame, link_now: SimTime) {
        let targets = self.links.targets(from, frame);
        let Some(sender) = self.links.get_mut(from) else { return };
        let kind = sender.kind;
        if targets.is_empty() || !sender.may_forward(link_now) {
            return;
        }
        let to_all = router::target(frame).0 == 0;
        for target in targets {
            let Some(link) = self.links.get_mut(target).filter(|link| !(link.sends_only_responses && to_all)) else { continue };
            // Broadcasts of the monitor and of views would make the autopilot expect a companion computer.
            if link.kind == LinkKind::Autopilot && kind == LinkKind::Payload && to_all {
                continue;
            }
            link.forward(frame.bytes.clone());
        }
    }

    /// Forwards stick input under the only sender that the autopilot accepts. Returns false if the frame is no stick input or the
    /// autopilot accepts any sender.
    pub(super) fn forward_sticks(&mut self, frame: &ReceivedFrame) -> bool {
        let Some(message @ (MavMessage::MANUAL_CONTROL(_) | MavMessage::RC_CHANNELS_OVERRIDE(_))) = &frame.message else {
            return false;
        };
        let Some(encoder) = &mut self.stick_encoder else { return false };
        let bytes = encoder.encode(message);
        if let Some(link) = self.autopilot_link.and_then(|id| self.links.get_mut(id)) {
            link.forward(bytes);
        }
        true
    }

    /// Sends a message from a component to all clients that receive unsolicited messages, but not to the autopilot.
    pub(super) fn broadcast_to_clients(&mut self, component: u8, message: &impl Encodable) {
        for link in self.links.listeners().filter(|link| link.kind != LinkKind::Autopilot) {
            link.send(component, message);
        }
    }
}

/// Forwards a frame with a new sequence number, because some of the autopilot's messages are left out and the monitor counts gaps
/// as losses. Messages outside the dialect, whose checksums cannot be computed, are left out too.
fn forward_to_payload_process(link: &mut PeerLink, frame: &ReceivedFrame) {
    let known = MavMessage::extra_crc(frame.message_id) != 0;
    if known && !SENT_BY_SIMULATOR.contains(&frame.message_id) && frame.component_id == AUTOPILOT {
        link.send_payload(AUTOPILOT, frame.message_id, &frame.payload(0));
    }
}
