//! One link: who is behind it, what it is sent and how often, and what waits to go out.

use super::LinkKind;
use super::budget::LinkBudget;
use super::streams::{AUTOPILOT, CAMERA, STREAMS};
use spandrel_mavlink::codec::{Decoder, Encodable, Encoder};
use spandrel_mavlink::signing::Signing;
use spandrel_model::time::SimTime;
use std::collections::{BTreeMap, VecDeque};

/// Frames are packed into datagrams of at most this size, bytes (below the usual path limit).
const DATAGRAM: usize = 1_200;
/// Datagrams of a link that carries fewer bytes a second, bytes: one frame soon rather than many later.
const SMALL_DATAGRAM: usize = 280;
/// Fastest stream that may be asked for, Hz: the control loop's rate.
const FASTEST_HZ: f64 = 400.0;
/// Waiting bytes of a link without a limit; the shell empties it at every turn.
const MOST_WAITING: usize = 4_194_304;
/// Frames of one link that are handed on to others in one tick.
const HANDED_ON_A_TICK: usize = 16;
/// Heartbeats are never slowed: clients tell by them that we are there.
const HEARTBEAT: u32 = 0;
/// Between heartbeats of a component (MAVLink: 1 Hz).
const BEAT: SimTime = SimTime::from_ms(1_000);
/// HIL_STATE_QUATERNION.
const TRUTH: u32 = 115;

/// How far a peer is that is to be kept in step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LockstepState {
    /// Time waits for its first answer.
    Awaited,
    /// It has not answered yet, and is served in real time until it does.
    Late,
    /// It answers, and time waits for it.
    Joined,
}

/// One peer.
#[derive(Debug, Clone)]
pub struct PeerLink {
    /// What it is.
    pub kind: LinkKind,
    /// It is kept in step.
    pub lockstep: bool,
    /// Only answers go out: no heartbeat has come in yet.
    pub answers_only: bool,
    /// How far it is with that.
    pub lockstep_state: LockstepState,
    /// Something has come from it.
    pub has_received: bool,
    /// The token of its last question for step.
    pub lockstep_token: Option<i64>,
    /// Incoming bytes.
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
    /// The signing timestamp of now.
    pub stamp: u64,
    /// Numbers of pictures that are to be told again.
    pub pictures: std::ops::Range<usize>,
    /// Streams whose messages were asked for and follow the acknowledgement.
    pub after_acknowledgement: Vec<usize>,
    /// Nothing but heartbeats until it asks.
    must_ask: bool,
    /// Somebody behind it has spoken to the camera.
    uses_camera: bool,
}

impl PeerLink {
    /// A link with its kind's usual rates, which are none but heartbeats' where it must ask; the first of everything is due at once.
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

    /// The link carries no more than so many bytes a second.
    pub fn limit(&mut self, bytes_s: f64, now: SimTime) {
        let frames_s = self.intervals.iter().flatten().map(|every| 1.0 / every.s()).sum();
        self.budget = Some(LinkBudget::new(bytes_s, frames_s, now));
    }

    /// Whether time waits for it.
    #[must_use]
    pub fn blocks_lockstep(&self) -> bool {
        self.lockstep && self.lockstep_state != LockstepState::Late
    }

    /// Whether this token answers a question of ours: the last one, or any before it of a peer that time does not wait for.
    #[must_use]
    pub fn is_answer(&self, token: i64) -> bool {
        match self.lockstep_state {
            LockstepState::Late => self.lockstep && self.lockstep_token.is_some_and(|asked| (1..=asked).contains(&token)),
            LockstepState::Awaited | LockstepState::Joined => self.lockstep_token == Some(token),
        }
    }

    /// It has a limit.
    #[must_use]
    pub fn is_limited(&self) -> bool {
        self.budget.is_some()
    }

    /// As much waits as should: lists and files wait, streams and forwarded frames are left out.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.budget.as_ref().is_some_and(|budget| budget.is_saturated(self.waiting))
    }

    /// Frames that found no room.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    /// Rows of the stream table that are due, each once; their next time is set, later on a link whose capacity they would exceed.
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

    /// Interval of a row, microseconds; -1 when off.
    #[must_use]
    pub fn interval_us(&self, row: usize) -> i32 {
        self.intervals.get(row).copied().flatten().map_or(-1, |every| i32::try_from(every.us()).unwrap_or(i32::MAX))
    }

    /// Sets a row's interval, microseconds: 0 the usual, negative off. False for what is no interval.
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

    /// It wants the values for the scoring: without asking, or with the truth that it has asked for.
    #[must_use]
    pub fn wants_truth(&self) -> bool {
        !self.must_ask || STREAMS.iter().zip(&self.intervals).any(|(stream, every)| stream.id == TRUTH && every.is_some())
    }

    /// Every stream at its kind's usual rate again.
    pub fn reset_rates(&mut self, now: SimTime) {
        self.intervals = (0..STREAMS.len()).map(|row| default_interval(row, self.kind, self.must_ask)).collect();
        self.next.fill(now);
        self.next_due = now;
        if std::mem::take(&mut self.uses_camera) {
            self.use_camera();
        }
    }

    /// Somebody behind the link speaks to the camera: he hears it as often as MAVLink asks of a component, in step with the autopilot.
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

    /// Somebody behind the link has spoken to the camera.
    #[must_use]
    pub fn uses_camera(&self) -> bool {
        self.uses_camera
    }

    /// Its first heartbeat has come in: streams begin now.
    pub fn wake(&mut self, now: SimTime) {
        if std::mem::take(&mut self.answers_only) {
            self.next.fill(now);
            self.next_due = now;
        }
    }

    /// Signs what our components say from now on.
    pub fn sign_with(&mut self, signing: Option<Signing>) {
        self.signing = signing;
    }

    /// Queues a message of a stream.
    pub fn stream(&mut self, component: u8, message: &impl Encodable) {
        let before = self.waiting;
        self.send(component, message);
        if let Some(budget) = &mut self.budget {
            budget.note_streamed(self.waiting - before);
        }
    }

    /// Counts a frame of this link that is handed on to others; false when it has sent too many in this tick.
    pub fn may_forward(&mut self, now: SimTime) -> bool {
        if self.forwarded.0 != now {
            self.forwarded = (now, 0);
        }
        self.forwarded.1 += 1;
        let may = self.forwarded.1 <= HANDED_ON_A_TICK;
        self.dropped += u64::from(!may);
        may
    }

    /// Queues a frame that somebody else sent.
    pub fn forward(&mut self, frame: Vec<u8>) {
        if self.is_busy() {
            self.dropped += 1;
        } else {
            self.queue(frame);
        }
    }

    /// Queues a message of one of our components.
    pub fn send(&mut self, component: u8, message: &impl Encodable) {
        let frame = message.frame(self.encoder(component));
        self.queue_own(frame);
    }

    /// Queues a raw payload of one of our components.
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

    /// The next datagram that the link can carry now.
    pub fn poll(&mut self) -> Option<Vec<u8>> {
        let len = self.out.front()?.len();
        if self.budget.as_mut().is_some_and(|budget| !budget.take(len)) {
            return None;
        }
        self.waiting -= len;
        self.out.pop_front()
    }
}

/// A row's usual interval.
fn default_interval(row: usize, kind: LinkKind, must_ask: bool) -> Option<SimTime> {
    let silent = must_ask && STREAMS[row].id != HEARTBEAT;
    if silent { None } else { period(STREAMS[row].rate_hz(kind)) }
}

fn period(rate_hz: f64) -> Option<SimTime> {
    (rate_hz > 0.0).then(|| SimTime::period(rate_hz))
}
