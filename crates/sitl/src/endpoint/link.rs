//! A link: its peer, stream rates and outgoing queue.

use super::LinkKind;
use super::budget::LinkBudget;
use super::streams::{AUTOPILOT, CAMERA, STREAMS};
use spandrel_mavlink::codec::{Decoder, Encodable, Encoder};
use spandrel_mavlink::signing::Signing;
use spandrel_model::time::SimTime;
use std::collections::{BTreeMap, VecDeque};

/// Maximum size of a datagram into which frames are packed, bytes (below the usual path MTU).
const DATAGRAM: usize = 1_200;
/// Datagram size on a rate-limited link, bytes: small, to keep the latency low.
const SMALL_DATAGRAM: usize = 280;
/// Maximum stream rate that can be requested, Hz: the rate of the control loop.
const FASTEST_HZ: f64 = 400.0;
/// Maximum backlog of an unlimited link, bytes; the host empties it in every iteration.
const MOST_WAITING: usize = 4_194_304;
/// Maximum number of frames of one link forwarded to others per tick.
const HANDED_ON_A_TICK: usize = 16;
/// Message ID of the heartbeat, which is never slowed down because clients detect the vehicle by it.
const HEARTBEAT: u32 = 0;
/// Interval between heartbeats of a component (MAVLink: 1 Hz).
const BEAT: SimTime = SimTime::from_ms(1_000);
/// HIL_STATE_QUATERNION.
const TRUTH: u32 = 115;

/// Lockstep state of a peer.
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
    /// Whether only responses are sent, because no heartbeat was received yet.
    pub answers_only: bool,
    /// Lockstep progress.
    pub lockstep_state: LockstepState,
    /// Whether anything was received.
    pub has_received: bool,
    /// Token of the last lockstep request.
    pub lockstep_token: Option<i64>,
    /// Decoder of the received bytes.
    pub decoder: Decoder,
    system_id: u8,
    encoders: BTreeMap<u8, Encoder>,
    next: Vec<SimTime>,
    intervals: Vec<Option<SimTime>>,
    next_due: SimTime,
    out: VecDeque<Vec<u8>>,
    waiting: usize,
    dropped: u64,
    forwarded: (SimTime, usize),
    budget: Option<LinkBudget>,
    signing: Option<Signing>,
    /// Current signing timestamp.
    pub stamp: u64,
    /// Indices of the image records still to resend.
    pub pictures: std::ops::Range<usize>,
    /// Stream rows requested by REQUEST_MESSAGE, sent after the acknowledgment.
    pub after_acknowledgement: Vec<usize>,
    /// Whether only heartbeats are sent until streams are requested.
    must_ask: bool,
    /// Whether the peer has addressed the camera.
    uses_camera: bool,
}

impl PeerLink {
    /// Creates a link with the default rates of its kind, or heartbeats only if streams must be requested. All streams are due
    /// immediately.
    #[must_use]
    pub fn new(kind: LinkKind, lockstep: bool, system_id: u8, must_ask: bool, now: SimTime) -> Self {
        let every: Vec<Option<SimTime>> = (0..STREAMS.len()).map(|row| default_interval(row, kind, must_ask)).collect();
        let next = vec![now; every.len()];
        Self {
            kind,
            lockstep,
            answers_only: false,
            lockstep_state: LockstepState::Awaited,
            has_received: false,
            lockstep_token: None,
            decoder: Decoder::new(),
            system_id,
            encoders: BTreeMap::new(),
            next,
            intervals: every,
            next_due: now,
            out: VecDeque::new(),
            waiting: 0,
            dropped: 0,
            forwarded: (now, 0),
            budget: None,
            signing: None,
            stamp: 0,
            pictures: 0..0,
            after_acknowledgement: Vec::new(),
            must_ask,
            uses_camera: false,
        }
    }

    /// Limits the link's capacity to `bytes_s`, bytes/s.
    pub fn limit(&mut self, bytes_s: f64, now: SimTime) {
        let frames_s = self.intervals.iter().flatten().map(|every| 1.0 / every.s()).sum();
        self.budget = Some(LinkBudget::new(bytes_s, frames_s, now));
    }

    /// Checks whether simulation time waits for this peer.
    #[must_use]
    pub fn blocks_lockstep(&self) -> bool {
        self.lockstep && self.lockstep_state != LockstepState::Late
    }

    /// Checks whether a token answers a lockstep request: the last one, or any earlier one for a late peer.
    #[must_use]
    pub fn is_answer(&self, token: i64) -> bool {
        match self.lockstep_state {
            LockstepState::Late => self.lockstep && self.lockstep_token.is_some_and(|asked| (1..=asked).contains(&token)),
            LockstepState::Awaited | LockstepState::Joined => self.lockstep_token == Some(token),
        }
    }

    /// Checks whether the link has a capacity limit.
    #[must_use]
    pub fn is_limited(&self) -> bool {
        self.budget.is_some()
    }

    /// Checks whether the backlog is saturated: lists and files then wait, and streams and forwarded frames are skipped.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.budget.as_ref().is_some_and(|budget| budget.is_saturated(self.waiting))
    }

    /// Returns the number of dropped frames.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    /// Returns the due rows of the stream table, each once, and schedules them again, with longer intervals if they exceed the
    /// link's capacity.
    pub fn due(&mut self, now: SimTime, out: &mut Vec<usize>) {
        out.clear();
        if let Some(budget) = &mut self.budget {
            budget.advance(now);
        }
        if now < self.next_due {
            return;
        }
        let stretch = self.budget.as_ref().map_or(1.0, LinkBudget::interval_factor);
        let busy = self.is_busy();
        let mut soonest = SimTime::NEVER;
        for (k, every) in self.intervals.iter().enumerate() {
            let Some(every) = every else { continue };
            let steady = STREAMS[k].id == HEARTBEAT;
            if self.next[k] <= now {
                if steady || !busy {
                    out.push(k);
                }
                let every = if steady || stretch <= 1.0 { *every } else { SimTime::from_s(every.s() * stretch) };
                self.next[k] += every;
                if self.next[k] <= now {
                    self.next[k] = now + every;
                }
            }
            soonest = soonest.min(self.next[k]);
        }
        self.next_due = soonest;
    }

    /// Returns the interval of a row, microseconds; -1 if it is off.
    #[must_use]
    pub fn interval_us(&self, row: usize) -> i32 {
        self.intervals.get(row).copied().flatten().map_or(-1, |every| i32::try_from(every.us()).unwrap_or(i32::MAX))
    }

    /// Sets the interval of a row, microseconds: 0 restores the default, negative values turn it off. Returns false if the value
    /// is invalid.
    pub fn set_interval(&mut self, row: usize, us: f64, now: SimTime) -> bool {
        if !us.is_finite() || row >= STREAMS.len() {
            return false;
        }
        self.intervals[row] = match us {
            us if us < 0.0 => None,
            0.0 => default_interval(row, self.kind, self.must_ask),
            us => period((1e6 / us).min(FASTEST_HZ)),
        };
        self.next[row] = now;
        self.next_due = now;
        true
    }

    /// Checks whether the peer receives the scoring data: either by default, or because it requested the ground truth.
    #[must_use]
    pub fn wants_truth(&self) -> bool {
        !self.must_ask || STREAMS.iter().zip(&self.intervals).any(|(stream, every)| stream.id == TRUTH && every.is_some())
    }

    /// Restores the default rates of all streams.
    pub fn reset_rates(&mut self, now: SimTime) {
        self.intervals = (0..STREAMS.len()).map(|row| default_interval(row, self.kind, self.must_ask)).collect();
        self.next.fill(now);
        self.next_due = now;
        if std::mem::take(&mut self.uses_camera) {
            self.use_camera();
        }
    }

    /// Records that the peer addresses the camera: it then receives the camera's heartbeats at MAVLink's rate for components,
    /// aligned with the autopilot's.
    pub fn use_camera(&mut self) {
        if self.uses_camera {
            return;
        }
        self.uses_camera = true;
        let row_of = |component| STREAMS.iter().position(|row| row.id == HEARTBEAT && row.component == component);
        if let (Some(camera), Some(autopilot)) = (row_of(CAMERA), row_of(AUTOPILOT))
            && self.intervals[camera].is_some_and(|every| every > BEAT)
        {
            self.intervals[camera] = Some(BEAT);
            self.next[camera] = self.next[autopilot];
            self.next_due = self.next_due.min(self.next[camera]);
        }
    }

    /// Checks whether the peer has addressed the camera.
    #[must_use]
    pub fn uses_camera(&self) -> bool {
        self.uses_camera
    }

    /// Handles the first heartbeat: starts the streams.
    pub fn wake(&mut self, now: SimTime) {
        if std::mem::take(&mut self.answers_only) {
            self.next.fill(now);
            self.next_due = now;
        }
    }

    /// Sets or removes the signing of outgoing messages.
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

    /// Counts a frame to be forwarded to other links. Returns false if this link exceeded its limit in this tick.
    pub fn may_forward(&mut self, now: SimTime) -> bool {
        if self.forwarded.0 != now {
            self.forwarded = (now, 0);
        }
        self.forwarded.1 += 1;
        let may = self.forwarded.1 <= HANDED_ON_A_TICK;
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
        let stamp = self.stamp;
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
            Some(budget) => (budget.most_waiting(), SMALL_DATAGRAM),
            None => (MOST_WAITING, DATAGRAM),
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

    /// Returns the next datagram that the link can carry now.
    pub fn poll(&mut self) -> Option<Vec<u8>> {
        let len = self.out.front()?.len();
        if self.budget.as_mut().is_some_and(|budget| !budget.take(len)) {
            return None;
        }
        self.waiting -= len;
        self.out.pop_front()
    }
}

/// Returns the default interval of a row.
fn default_interval(row: usize, kind: LinkKind, must_ask: bool) -> Option<SimTime> {
    let silent = must_ask && STREAMS[row].id != HEARTBEAT;
    if silent { None } else { period(STREAMS[row].rate_hz(kind)) }
}

fn period(rate_hz: f64) -> Option<SimTime> {
    (rate_hz > 0.0).then(|| SimTime::period(rate_hz))
}
