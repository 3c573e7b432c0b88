//! A bad radio, as an instructor wishes it: datagrams of ground stations and SDKs are late, and some are lost, both ways.

use crate::endpoint::{LinkId, Transmit};
use spandrel_model::random::RandomStream;
use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Datagrams that are under way at most, each way: a second of fifty busy links.
const UNDER_WAY: usize = 16_384;

/// What is under way, and how bad it is.
#[derive(Debug, Clone)]
pub struct RadioLink {
    loss: f64,
    delay: SimTime,
    stream: RandomStream,
    out: VecDeque<(SimTime, Transmit)>,
    inward: VecDeque<(SimTime, LinkId, Vec<u8>)>,
}

impl RadioLink {
    /// A good one.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let stream = RandomStream::new(seed, "radio");
        Self { loss: 0.0, delay: SimTime::ZERO, stream, out: VecDeque::new(), inward: VecDeque::new() }
    }

    /// Share that is lost, and how late the rest is.
    pub fn set(&mut self, loss: f64, delay: SimTime) {
        (self.loss, self.delay) = (loss.clamp(0.0, 1.0), delay);
    }

    /// Nothing is lost and nothing late.
    #[must_use]
    pub fn is_lossless(&self) -> bool {
        self.loss == 0.0 && self.delay == SimTime::ZERO
    }

    fn loses(&mut self) -> bool {
        self.loss > 0.0 && self.stream.uniform() < self.loss
    }

    /// A datagram sets out.
    pub fn send(&mut self, transmit: Transmit, now: SimTime) {
        if !self.loses() && self.out.len() < UNDER_WAY {
            self.out.push_back((now + self.delay, transmit));
        }
    }

    /// The next datagram that has come through.
    pub fn sent(&mut self, now: SimTime) -> Option<Transmit> {
        let due = self.out.front().is_some_and(|(at, _)| *at <= now);
        if due { self.out.pop_front().map(|(_, transmit)| transmit) } else { None }
    }

    /// A datagram is on its way to the vehicle.
    pub fn receive(&mut self, link: LinkId, bytes: &[u8], now: SimTime) {
        if !self.loses() && self.inward.len() < UNDER_WAY {
            self.inward.push_back((now + self.delay, link, bytes.to_vec()));
        }
    }

    /// The next datagram that has arrived.
    pub fn received(&mut self, now: SimTime) -> Option<(LinkId, Vec<u8>)> {
        let due = self.inward.front().is_some_and(|(at, ..)| *at <= now);
        if due { self.inward.pop_front().map(|(_, link, bytes)| (link, bytes)) } else { None }
    }
}
