//! One link: who is behind it, what it is sent and how often, and what waits to go out.

use super::LinkKind;
use super::streams::STREAMS;
use crate::base::time::SimTime;
use crate::mav::codec::{Decoder, Encoder};
use crate::mav::dialect::MavMessage;
use crate::mav::signing::Signing;
use std::collections::{BTreeMap, VecDeque};

/// Frames are packed into datagrams of at most this size, bytes (below the usual path limit).
const DATAGRAM: usize = 1_200;
/// Fastest stream that may be asked for, Hz.
const FASTEST_HZ: f64 = 250.0;

/// One peer.
#[derive(Debug, Clone)]
pub struct Link {
    /// What it is.
    pub kind: LinkKind,
    /// It is kept in step.
    pub lockstep: bool,
    /// Incoming bytes.
    pub decoder: Decoder,
    system_id: u8,
    encoders: BTreeMap<u8, Encoder>,
    next: Vec<SimTime>,
    every: Vec<Option<SimTime>>,
    soonest: SimTime,
    out: VecDeque<Vec<u8>>,
    signing: Option<Signing>,
    /// The signing timestamp of now.
    pub stamp: u64,
}

impl Link {
    /// A link with its kind's usual rates; the first of everything is due at once.
    #[must_use]
    pub fn new(kind: LinkKind, lockstep: bool, system_id: u8, now: SimTime) -> Self {
        let every: Vec<Option<SimTime>> = STREAMS.iter().map(|s| period(s.rate_hz(kind))).collect();
        let next = vec![now; every.len()];
        Self {
            kind,
            lockstep,
            decoder: Decoder::new(),
            system_id,
            encoders: BTreeMap::new(),
            next,
            every,
            soonest: now,
            out: VecDeque::new(),
            signing: None,
            stamp: 0,
        }
    }

    /// Rows of the stream table that are due, each once; their next time is set.
    pub fn due(&mut self, now: SimTime, out: &mut Vec<usize>) {
        out.clear();
        if now < self.soonest {
            return;
        }
        let mut soonest = SimTime::NEVER;
        for (k, every) in self.every.iter().enumerate() {
            let Some(every) = every else { continue };
            if self.next[k] <= now {
                out.push(k);
                self.next[k] += *every;
                if self.next[k] <= now {
                    self.next[k] = now + *every;
                }
            }
            soonest = soonest.min(self.next[k]);
        }
        self.soonest = soonest;
    }

    /// Interval of a row, microseconds; -1 when off.
    #[must_use]
    pub fn interval_us(&self, row: usize) -> i32 {
        self.every.get(row).copied().flatten().map_or(-1, |every| i32::try_from(every.us()).unwrap_or(i32::MAX))
    }

    /// Sets a row's interval, microseconds: 0 the usual, negative off. False for what is no interval.
    pub fn set_interval(&mut self, row: usize, us: f64, now: SimTime) -> bool {
        if !us.is_finite() || row >= STREAMS.len() {
            return false;
        }
        self.every[row] = match us {
            us if us < 0.0 => None,
            0.0 => period(STREAMS[row].rate_hz(self.kind)),
            us => period((1e6 / us).min(FASTEST_HZ)),
        };
        self.next[row] = now;
        self.soonest = now;
        true
    }

    /// Signs what our components say from now on.
    pub fn sign_with(&mut self, signing: Option<Signing>) {
        self.signing = signing;
    }

    /// Queues a message of one of our components.
    pub fn send(&mut self, component: u8, message: &MavMessage) {
        let frame = self.encoder(component).encode(message);
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

    /// Queues a whole frame.
    pub fn queue(&mut self, frame: Vec<u8>) {
        const MOST_WAITING: usize = 4_000;
        let full = self.out.len() >= MOST_WAITING;
        match self.out.back_mut() {
            Some(last) if last.len() + frame.len() <= DATAGRAM => last.extend(frame),
            _ if full => {}
            _ => self.out.push_back(frame),
        }
    }

    /// The next datagram.
    pub fn poll(&mut self) -> Option<Vec<u8>> {
        self.out.pop_front()
    }
}

fn period(rate_hz: f64) -> Option<SimTime> {
    (rate_hz > 0.0).then(|| SimTime::period(rate_hz))
}
