//! Radio impairment set by an instructor: delay and packet loss for datagrams to and from ground stations and SDKs.

use crate::endpoint::{LinkId, Transmit};
use spandrel_model::random::RandomStream;
use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Maximum datagrams in flight per direction: one second of traffic on fifty busy links.
const MAX_DATAGRAMS_IN_FLIGHT: usize = 16_384;

/// Datagrams in flight, packet loss and delay.
#[derive(Debug, Clone)]
pub struct RadioLink {
    loss: f64,
    delay: SimTime,
    stream: RandomStream,
    outgoing: VecDeque<(SimTime, Transmit)>,
    incoming: VecDeque<(SimTime, LinkId, Vec<u8>)>,
}

impl RadioLink {
    /// Creates a radio link without loss or delay.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let stream = RandomStream::new(seed, "radio");
        Self { loss: 0.0, delay: SimTime::ZERO, stream, outgoing: VecDeque::new(), incoming: VecDeque::new() }
    }

    /// Sets the packet loss, 0 to 1, and the delay of the remaining datagrams.
    pub fn set(&mut self, loss: f64, delay: SimTime) {
        (self.loss, self.delay) = (loss.clamp(0.0, 1.0), delay);
    }

    /// Returns true if there is no loss and no delay.
    #[must_use]
    pub fn is_lossless(&self) -> bool {
        self.loss == 0.0 && self.delay == SimTime::ZERO
    }

    fn is_lost(&mut self) -> bool {
        self.loss > 0.0 && self.stream.uniform() < self.loss
    }

    /// Queues an outgoing datagram unless it is lost.
    pub fn send(&mut self, transmit: Transmit, now: SimTime) {
        if !self.is_lost() && self.outgoing.len() < MAX_DATAGRAMS_IN_FLIGHT {
            self.outgoing.push_back((now + self.delay, transmit));
        }
    }

    /// Returns the next outgoing datagram whose delay has passed.
    pub fn sent(&mut self, now: SimTime) -> Option<Transmit> {
        let due = self.outgoing.front().is_some_and(|(at, _)| *at <= now);
        if due { self.outgoing.pop_front().map(|(_, transmit)| transmit) } else { None }
    }

    /// Queues an incoming datagram unless it is lost.
    pub fn receive(&mut self, link: LinkId, bytes: &[u8], now: SimTime) {
        if !self.is_lost() && self.incoming.len() < MAX_DATAGRAMS_IN_FLIGHT {
            self.incoming.push_back((now + self.delay, link, bytes.to_vec()));
        }
    }

    /// Returns the next incoming datagram whose delay has passed.
    pub fn received(&mut self, now: SimTime) -> Option<(LinkId, Vec<u8>)> {
        let due = self.incoming.front().is_some_and(|(at, ..)| *at <= now);
        if due { self.incoming.pop_front().map(|(_, link, bytes)| (link, bytes)) } else { None }
    }
}
