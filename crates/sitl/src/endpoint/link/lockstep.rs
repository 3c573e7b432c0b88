//! Lockstep: simulation time waits for responses from the peers in lockstep.

use super::datagram::ReceivedDatagram;
use super::link_id::LinkId;
use super::links::Links;
use super::peer_link::{LockstepState, PeerLink};
use super::signing_policy::FrameAdmission;
use crate::endpoint::clock::VehicleClock;
use crate::endpoint::component_ids::AUTOPILOT;
use spandrel_mavlink::codec::ReceivedFrame;
use spandrel_mavlink::dialect::{MavMessage, TIMESYNC_DATA};
use spandrel_mavlink::router;
use spandrel_model::time::SimTime;

impl Links {
    /// Returns the links that simulation time waits for.
    pub fn lockstep_peers(&self) -> impl Iterator<Item = LinkId> {
        self.peers.iter().filter(|(_, link)| link.blocks_lockstep()).map(|(id, _)| *id)
    }

    /// Returns the links that are in lockstep or about to join, with their state and whether anything has been received
    /// from them.
    pub fn lockstep_states(&self) -> impl Iterator<Item = (LinkId, LockstepState, bool)> {
        self.peers.iter().filter(|(_, link)| link.lockstep).map(|(id, link)| (*id, link.lockstep_state, link.has_received))
    }

    /// Marks a peer as joined: simulation time waits for it from now on.
    pub fn join_lockstep(&mut self, id: LinkId) {
        if let Some(link) = self.peers.get_mut(&id) {
            link.lockstep_state = LockstepState::Joined;
        }
    }

    /// Stops waiting for a peer's first response.
    pub fn serve_in_real_time(&mut self, id: LinkId) {
        if let Some(link) = self.peers.get_mut(&id).filter(|link| link.lockstep_state == LockstepState::Awaited) {
            link.lockstep_state = LockstepState::Late;
        }
    }

    /// Records that something was received from a peer.
    pub fn note_received(&mut self, id: LinkId) {
        if let Some(link) = self.peers.get_mut(&id) {
            link.has_received = true;
        }
    }

    /// Sends a lockstep request to every peer in lockstep.
    pub fn request_lockstep(&mut self, now: SimTime) {
        for link in self.peers.values_mut().filter(|link| link.lockstep) {
            link.lockstep_token = Some(now.ns());
            link.send(AUTOPILOT, &lockstep_request(now.ns()));
        }
    }

    /// Sends the latest lockstep request to a peer again.
    pub fn repeat_lockstep_request(&mut self, id: LinkId) {
        if let Some(link) = self.peers.get_mut(&id)
            && let Some(token) = link.lockstep_token
        {
            link.send(AUTOPILOT, &lockstep_request(token));
        }
    }

    /// Answers the time requests in a datagram at once, and removes them from it. MAVSDK answers lockstep requests only after one
    /// of its own time requests was answered, and no tick processes them while simulation time waits for its first response.
    pub fn answer_time_requests(&mut self, id: LinkId, datagram: &mut ReceivedDatagram, clock: VehicleClock) {
        let mut policy = self.signing.clone();
        let Some(link) = self.peers.get_mut(&id) else { return };
        let requests = datagram.extract_frames(|frame| {
            is_time_request(frame)
                && policy.as_mut().is_none_or(|policy| policy.admit(frame, link.kind) == FrameAdmission::Execute)
        });
        for frame in requests {
            if let Some(MavMessage::TIMESYNC(request)) = frame.message {
                let from = (frame.system_id, frame.component_id);
                link.send(AUTOPILOT, &clock.for_link(link.kind).time_response(&request, from));
            }
        }
    }

    /// Checks whether a datagram that has not been processed yet contains an admitted response to the lockstep request
    /// with this token.
    #[must_use]
    pub fn answers_lockstep(&self, id: LinkId, datagram: &mut ReceivedDatagram, token: i64) -> bool {
        let Some(link) = self.peers.get(&id) else { return false };
        // Use a copy of the signing state: recording the frame here would make it count as a replay when it is
        // processed.
        let mut policy = self.signing.clone();
        let mut is_admitted =
            |frame| policy.as_mut().is_none_or(|policy| policy.admit(frame, link.kind) == FrameAdmission::Execute);
        let mut answers = datagram.frames().iter().filter_map(|frame| Some((frame, self.lockstep_token(link, frame)?)));
        answers.any(|(frame, answered)| is_admitted(frame) && answered == token)
    }

    /// Checks whether a frame answers a lockstep request.
    #[must_use]
    pub fn is_lockstep_answer(&self, id: LinkId, frame: &ReceivedFrame) -> bool {
        self.peers.get(&id).is_some_and(|link| self.lockstep_token(link, frame).is_some())
    }

    /// Returns the token of a frame that answers a lockstep request; responses to other systems are routed normally.
    fn lockstep_token(&self, link: &PeerLink, frame: &ReceivedFrame) -> Option<i64> {
        let Some(MavMessage::TIMESYNC(sync)) = &frame.message else { return None };
        let (system, component) = router::target(frame);
        let ours = system == 0 || (system == self.system_id() && matches!(component, 0 | AUTOPILOT));
        Some(sync.ts1).filter(|token| ours && sync.tc1 != 0 && link.is_answer(*token))
    }
}

/// Checks whether a frame asks for the time, as opposed to a response.
pub fn is_time_request(frame: &ReceivedFrame) -> bool {
    matches!(&frame.message, Some(MavMessage::TIMESYNC(sync)) if sync.tc1 == 0)
}

/// Creates a lockstep request.
fn lockstep_request(token: i64) -> MavMessage {
    MavMessage::TIMESYNC(TIMESYNC_DATA { tc1: 0, ts1: token, target_system: 0, target_component: 0 })
}
