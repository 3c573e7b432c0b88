//! All links, the router between them, and frame signing.

use super::datagram::ReceivedDatagram;
use super::link_id::{LinkId, LinkKind, Transmit};
use super::peer_link::PeerLink;
use super::signing_policy::{FrameAdmission, SigningPolicy};
use spandrel_mavlink::codec::{Encodable, ReceivedFrame};
use spandrel_mavlink::router::{self, Router};
use spandrel_model::time::SimTime;
use std::collections::BTreeMap;

/// A vehicle's links.
#[derive(Debug, Clone)]
pub struct Links {
    system_id: u8,
    /// Component IDs that no peer may use.
    own_components: &'static [u8],
    pub(super) peers: BTreeMap<LinkId, PeerLink>,
    router: Router<LinkId>,
    pub(super) signing: Option<SigningPolicy>,
    bad_bytes: u64,
    /// Number of frames dropped by links that have been closed since.
    dropped_by_closed: u64,
}

impl Links {
    /// Creates a vehicle's link table without any links. `own_components` are the IDs of the components that send through it.
    #[must_use]
    pub fn new(system_id: u8, own_components: &'static [u8]) -> Self {
        Self {
            system_id,
            own_components,
            peers: BTreeMap::new(),
            router: Router::new(),
            signing: None,
            bad_bytes: 0,
            dropped_by_closed: 0,
        }
    }

    /// Returns the MAVLink system ID.
    #[must_use]
    pub fn system_id(&self) -> u8 {
        self.system_id
    }

    /// Adds a link to a peer.
    pub fn open(&mut self, id: LinkId, mut link: PeerLink) {
        link.sign_with(self.signing.as_ref().map(|policy| policy.signer(id.0 as u8)));
        self.peers.insert(id, link);
    }

    /// Removes a link.
    pub fn close(&mut self, id: LinkId) {
        self.dropped_by_closed += self.peers.remove(&id).map_or(0, |link| link.dropped());
        self.router.remove_link(id);
    }

    /// Sends only responses on a link until a heartbeat is received. The sender's address may be forged, and streams
    /// would amplify every datagram.
    pub fn await_heartbeat(&mut self, id: LinkId) {
        if let Some(link) = self.peers.get_mut(&id) {
            link.sends_only_responses = true;
        }
    }

    /// Limits a link's capacity to `capacity_bytes_s` bytes/s: streams slow down, lists wait, and scoring data is omitted.
    pub fn limit(&mut self, id: LinkId, capacity_bytes_s: f64, now: SimTime) {
        if let Some(link) = self.peers.get_mut(&id) {
            link.limit(capacity_bytes_s, now);
        }
    }

    /// Returns a link by its ID.
    #[must_use]
    pub fn get(&self, id: LinkId) -> Option<&PeerLink> {
        self.peers.get(&id)
    }

    /// Returns a mutable reference to a link.
    pub fn get_mut(&mut self, id: LinkId) -> Option<&mut PeerLink> {
        self.peers.get_mut(&id)
    }

    /// Returns the IDs of all links.
    pub fn ids(&self) -> impl Iterator<Item = LinkId> {
        self.peers.keys().copied()
    }

    /// Returns all links with their IDs.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = (LinkId, &mut PeerLink)> {
        self.peers.iter_mut().map(|(id, link)| (*id, link))
    }

    /// Returns the links that receive unsolicited messages.
    pub fn listeners(&mut self) -> impl Iterator<Item = &mut PeerLink> {
        self.peers.values_mut().filter(|link| !link.sends_only_responses)
    }

    /// Returns a link's kind and whether the link runs in lockstep.
    #[must_use]
    pub fn kind(&self, id: LinkId) -> Option<(LinkKind, bool)> {
        self.peers.get(&id).map(|link| (link.kind, link.lockstep))
    }

    /// Checks whether lists and files may be sent on a link, which is the case unless the link is saturated.
    #[must_use]
    pub fn has_capacity(&self, id: LinkId) -> bool {
        self.peers.get(&id).is_none_or(|link| !link.is_busy())
    }

    /// Sends a message from a component to a link.
    pub fn answer(&mut self, component: u8, id: LinkId, message: &impl Encodable) {
        if let Some(link) = self.peers.get_mut(&id) {
            link.send(component, message);
        }
    }

    /// Sends a message from a component to all links that receive unsolicited messages.
    pub fn broadcast(&mut self, component: u8, message: &impl Encodable) {
        for link in self.listeners() {
            link.send(component, message);
        }
    }

    /// Sends a message from a component on every link where the peer (system and component ID) has been seen.
    pub fn send_to(&mut self, component: u8, peer: (u8, u8), message: &impl Encodable) {
        for (id, link) in &mut self.peers {
            if self.router.has_seen(peer, *id) {
                link.send(component, message);
            }
        }
    }

    /// Returns the next datagram to send.
    pub fn poll(&mut self) -> Option<Transmit> {
        self.peers.iter_mut().find_map(|(id, link)| link.poll().map(|bytes| Transmit { link: *id, bytes }))
    }

    /// Returns the number of frames dropped because a link was saturated or a peer exceeded its forwarding limit.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped_by_closed + self.peers.values().map(PeerLink::dropped).sum::<u64>()
    }

    /// Returns the number of bytes outside valid frames on all links.
    #[must_use]
    pub fn bad_bytes(&self) -> u64 {
        self.bad_bytes
    }

    /// Returns a datagram's frames and counts the bytes outside them.
    pub fn take_frames(&mut self, datagram: ReceivedDatagram) -> Vec<ReceivedFrame> {
        let (frames, bad_bytes) = datagram.into_frames();
        self.bad_bytes += bad_bytes;
        frames
    }

    /// Returns how a frame received on a link may be handled.
    pub fn admit(&mut self, id: LinkId, frame: &ReceivedFrame) -> FrameAdmission {
        let Some(link) = self.peers.get(&id) else { return FrameAdmission::Reject };
        self.signing.as_mut().map_or(FrameAdmission::Execute, |policy| policy.admit(frame, link.kind))
    }

    /// Starts a link's streams when a heartbeat arrives on it.
    pub fn start_streams(&mut self, id: LinkId, now: SimTime) {
        if let Some(link) = self.peers.get_mut(&id) {
            link.start_streams(now);
        }
    }

    /// Returns whether a component of this system sends through these links, so that no peer may use its ID.
    #[must_use]
    pub fn is_own(&self, component: u8) -> bool {
        self.own_components.contains(&component)
    }

    /// Records a frame's sender and returns the links to which the frame should be forwarded: none if the sender impersonates one
    /// of the vehicle's own components.
    pub fn targets(&mut self, from: LinkId, frame: &ReceivedFrame) -> Vec<LinkId> {
        if frame.system_id == self.system_id && self.is_own(frame.component_id) {
            return Vec::new();
        }
        self.router.note(from, frame);
        let all: Vec<LinkId> = self.peers.keys().copied().collect();
        self.router.targets_of(from, frame, &all)
    }

    /// Forwards a frame to its target links.
    pub fn route(&mut self, from: LinkId, frame: &ReceivedFrame, now: SimTime) {
        let targets = self.targets(from, frame);
        if targets.is_empty() || !self.peers.get_mut(&from).is_some_and(|link| link.may_forward(now)) {
            return;
        }
        let to_all = router::target(frame).0 == 0;
        for target in targets {
            if let Some(link) = self.peers.get_mut(&target).filter(|link| !(link.sends_only_responses && to_all)) {
                link.forward(frame.bytes.clone());
            }
        }
    }
}
