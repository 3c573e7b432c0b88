//! A link: its peer, stream rates and outgoing queue.

use super::budget::LinkBudget;
use super::link_id::LinkKind;
use super::stream_schedule::StreamSchedule;
use crate::endpoint::component_ids::{AUTOPILOT, CAMERA};
use spandrel_mavlink::codec::{Encodable, Encoder};
use spandrel_mavlink::signing::Signing;
use spandrel_model::time::SimTime;
use std::collections::{BTreeMap, VecDeque};

/// Maximum size of a datagram that packs several frames, bytes (below the usual path MTU).
const MAX_DATAGRAM_BYTES: usize = 1_200;
/// Datagram size on a rate-limited link, bytes: small, to keep latency low.
const RATE_LIMITED_DATAGRAM_BYTES: usize = 280;
/// Maximum backlog of an unlimited link, bytes; the host empties it in every iteration.
const MAX_BACKLOG_BYTES: usize = 4_194_304;
/// Maximum number of frames per tick forwarded from one link to other links.
const MAX_FORWARDED_FRAMES_PER_TICK: usize = 16;
/// Interval between a component's heartbeats (MAVLink: 1 Hz).
const HEARTBEAT_INTERVAL: SimTime = SimTime::from_ms(1_000);
/// Message ID of HIL_STATE_QUATERNION, the ground truth.
const GROUND_TRUTH_ID: u32 = 115;

/// A peer's lockstep state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LockstepState {
    /// Simulation time waits for its first response.
    Awaited,
    /// No response yet; the peer is served in real time until it responds.
    Late,
    /// The peer responds, and simulation time waits for it.
    Joined,
}

/// A connected peer.
#[derive(Debug, Clone)]
pub struct PeerLink {
    /// Kind of link.
    pub kind: LinkKind,
    /// Whether the peer runs in lockstep.
    pub lockstep: bool,
    /// Whether only responses are sent because no heartbeat has been received yet.
    pub sends_only_responses: bool,
    /// The peer's lockstep state.
    pub lockstep_state: LockstepState,
    /// Whether anything has been received from the peer.
    pub has_received: bool,
    /// Token of the last lockstep request.
    pub lockstep_token: Option<i64>,
    system_id: u8,
    encoders: BTreeMap<u8, Encoder>,
    /// Stream intervals.
    pub streams: StreamSchedule,
    out: VecDeque<Vec<u8>>,
    waiting: usize,
    dropped: u64,
    forwarded: (SimTime, usize),
    budget: Option<LinkBudget>,
    signing: Option<Signing>,
    /// Current signing timestamp.
    pub timestamp: u64,
    /// Stream rows requested with REQUEST_MESSAGE, to be sent after the acknowledgment.
    pub after_acknowledgment: Vec<usize>,
    /// Whether the peer must request its streams.
    must_request_streams: bool,
    /// Whether the peer has addressed the camera.
    uses_camera: bool,
}

impl PeerLink {
    /// Creates a link and its streams. If `must_request_streams` is set, the peer receives the scoring data only if it
    /// requests the ground truth.
    #[must_use]
    pub fn new(
        kind: LinkKind,
        lockstep: bool,
        system_id: u8,
        must_request_streams: bool,
        streams: StreamSchedule,
        now: SimTime,
    ) -> Self {
        Self {
            kind,
            lockstep,
            sends_only_responses: false,
            lockstep_state: LockstepState::Awaited,
            has_received: false,
            lockstep_token: None,
            system_id,
            encoders: BTreeMap::new(),
            streams,
            out: VecDeque::new(),
            waiting: 0,
            dropped: 0,
            forwarded: (now, 0),
            budget: None,
            signing: None,
            timestamp: 0,
            after_acknowledgment: Vec::new(),
            must_request_streams,
            uses_camera: false,
        }
    }

    /// Limits the link's capacity to `capacity_bytes_s` bytes/s.
    pub fn limit(&mut self, capacity_bytes_s: f64, now: SimTime) {
        self.budget = Some(LinkBudget::new(capacity_bytes_s, self.streams.total_hz(), now));
    }

    /// Checks whether simulation time waits for this peer.
    #[must_use]
    pub fn blocks_lockstep(&self) -> bool {
        self.lockstep && self.lockstep_state != LockstepState::Late
    }

    /// Checks whether a token answers a lockstep request: either the last one or, for a late peer, any earlier one.
    #[must_use]
    pub fn is_answer(&self, token: i64) -> bool {
        match self.lockstep_state {
            LockstepState::Late => self.lockstep && self.lockstep_token.is_some_and(|requested| (1..=requested).contains(&token)),
            LockstepState::Awaited | LockstepState::Joined => self.lockstep_token == Some(token),
        }
    }

    /// Checks whether the link has a capacity limit.
    #[must_use]
    pub fn is_limited(&self) -> bool {
        self.budget.is_some()
    }

    /// Checks whether the link is saturated. Lists and files then wait, and streams and forwarded frames are skipped.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.budget.as_ref().is_some_and(|budget| budget.is_saturated(self.waiting))
    }

    /// Returns the number of frames dropped so far.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    /// Returns each due row of the stream table once and schedules it again, with longer intervals if the streams
    /// exceed the link's capacity.
    pub fn due(&mut self, now: SimTime, out: &mut Vec<usize>) {
        out.clear();
        if let Some(budget) = &mut self.budget {
            budget.advance(now);
        }
        if !self.streams.is_due(now) {
            return;
        }
        let stretch = self.budget.as_ref().map_or(1.0, LinkBudget::interval_factor);
        let is_saturated = self.is_busy();
        self.streams.take_due(now, stretch, is_saturated, out);
    }

    /// Checks whether the peer receives the scoring data: either by default, or because it requested the ground truth.
    #[must_use]
    pub fn receives_truth(&self) -> bool {
        !self.must_request_streams || self.streams.is_on(GROUND_TRUTH_ID)
    }

    /// Restores the default rate of every stream.
    pub fn reset_rates(&mut self, now: SimTime) {
        self.streams.reset(now);
        if std::mem::take(&mut self.uses_camera) {
            self.use_camera();
        }
    }

    /// Records that the peer has addressed the camera. It then receives the camera's heartbeats at MAVLink's component
    /// rate, aligned with the autopilot's heartbeats.
    pub fn use_camera(&mut self) {
        if !std::mem::replace(&mut self.uses_camera, true) {
            self.streams.align_heartbeat(CAMERA, AUTOPILOT, HEARTBEAT_INTERVAL);
        }
    }

    /// Checks whether the peer has addressed the camera.
    #[must_use]
    pub fn uses_camera(&self) -> bool {
        self.uses_camera
    }

    /// Handles the first heartbeat: starts the streams.
    pub fn start_streams(&mut self, now: SimTime) {
        if std::mem::take(&mut self.sends_only_responses) {
            self.streams.restart(now);
        }
    }

    /// Enables or disables signing of outgoing messages.
    pub fn sign_with(&mut self, signing: Option<Signing>) {
        self.signing = signing;
    }

    /// Queues a stream message.
    pub fn stream(&mut self, component: u8, message: &impl Encodable) {
        let before = self.waiting;
        self.send(component, message);
        if let Some(budget) = &mut self.budget {
            budget.note_streamed(self.waiting - before);
        }
    }

    /// Counts a frame to be forwarded to other links. Returns false if this link has exceeded its limit for this tick.
    pub fn may_forward(&mut self, now: SimTime) -> bool {
        if self.forwarded.0 != now {
            self.forwarded = (now, 0);
        }
        self.forwarded.1 += 1;
        let may = self.forwarded.1 <= MAX_FORWARDED_FRAMES_PER_TICK;
        self.dropped += u64::from(!may);
        may
    }

    /// Queues a frame forwarded from another link.
    pub fn forward(&mut self, frame: Vec<u8>) {
        if self.is_busy() {
            self.dropped += 1;
        } else {
            self.queue(frame);
        }
    }

    /// Queues a message from one of the vehicle's components.
    pub fn send(&mut self, component: u8, message: &impl Encodable) {
        let frame = message.frame(self.encoder(component));
        self.queue_own(frame);
    }

    /// Queues a raw payload from one of the vehicle's components.
    pub fn send_payload(&mut self, component: u8, id: u32, payload: &[u8]) {
        let frame = self.encoder(component).encode_payload(id, payload);
        self.queue_own(frame);
    }

    fn queue_own(&mut self, frame: Vec<u8>) {
        let stamp = self.timestamp;
        let frame = match &mut self.signing {
            Some(signing) => signing.sign(frame, stamp),
            None => frame,
        };
        self.queue(frame);
    }

    fn encoder(&mut self, component: u8) -> &mut Encoder {
        let system = self.system_id;
        self.encoders.entry(component).or_insert_with(|| Encoder::new(system, component))
    }

    fn queue(&mut self, frame: Vec<u8>) {
        let (most, datagram) = match &self.budget {
            Some(budget) => (budget.max_backlog(), RATE_LIMITED_DATAGRAM_BYTES),
            None => (MAX_BACKLOG_BYTES, MAX_DATAGRAM_BYTES),
        };
        if self.waiting + frame.len() > most {
            self.dropped += 1;
            return;
        }
        self.waiting += frame.len();
        match self.out.back_mut() {
            Some(last) if last.len() + frame.len() <= datagram => last.extend(frame),
            _ => self.out.push_back(frame),
        }
    }

    /// Returns the next datagram that the link has capacity for.
    pub fn poll(&mut self) -> Option<Vec<u8>> {
        let len = self.out.front()?.len();
        if self.budget.as_mut().is_some_and(|budget| !budget.take(len)) {
            return None;
        }
        self.waiting -= len;
        self.out.pop_front()
    }
}
