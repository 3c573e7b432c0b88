//! Receive queues, bounded per link so that a flooding peer cannot use up the processing time or memory of other links.

use crate::endpoint::{LinkId, ReceivedDatagram};
use spandrel_model::time::SimTime;
use std::collections::{BTreeMap, VecDeque};

/// Maximum datagrams processed per link and tick. At 1,000 ticks/s this exceeds what any client sends (estimate).
pub const MAX_DATAGRAMS_PER_TICK: usize = 8;
/// Maximum bytes processed per link and tick, and the maximum datagram length. A frame has at most 280 bytes, and
/// clients send only a few per datagram.
pub const MAX_BYTES_PER_TICK: usize = 4_096;
/// Maximum queued datagrams per link. With the limits above, the queue drains within about 130 ms.
const MAX_QUEUED_DATAGRAMS: usize = 1_024;
/// Maximum queued bytes per link.
const MAX_QUEUED_BYTES: usize = 131_072;

/// The receive queues of all links.
#[derive(Debug, Clone, Default)]
pub struct Inbox {
    links: BTreeMap<LinkId, LinkQueue>,
    waiting: usize,
    tick: SimTime,
    dropped: u64,
}

#[derive(Debug, Clone, Default)]
struct LinkQueue {
    datagrams: VecDeque<ReceivedDatagram>,
    bytes: usize,
    processed_this_tick: (usize, usize),
}

impl LinkQueue {
    fn has_room_for(&self, len: usize) -> bool {
        len <= MAX_BYTES_PER_TICK && self.datagrams.len() < MAX_QUEUED_DATAGRAMS && self.bytes + len <= MAX_QUEUED_BYTES
    }

    /// Returns the next datagram if it fits in the limits of this tick.
    fn next(&mut self) -> Option<ReceivedDatagram> {
        let len = self.datagrams.front()?.len();
        let (count, bytes) = self.processed_this_tick;
        if count >= MAX_DATAGRAMS_PER_TICK || bytes + len > MAX_BYTES_PER_TICK {
            return None;
        }
        self.processed_this_tick = (count + 1, bytes + len);
        self.bytes -= len;
        self.datagrams.pop_front()
    }
}

impl Inbox {
    /// Queues a datagram, or drops and counts it if the link's queue is full.
    pub fn push(&mut self, link: LinkId, datagram: ReceivedDatagram) {
        let queue = self.links.entry(link).or_default();
        if !queue.has_room_for(datagram.len()) {
            self.dropped += 1;
            return;
        }
        queue.bytes += datagram.len();
        queue.datagrams.push_back(datagram);
        self.waiting += 1;
    }

    /// Removes a link and discards its queued datagrams.
    pub fn close(&mut self, link: LinkId) {
        if let Some(queue) = self.links.remove(&link) {
            self.waiting -= queue.datagrams.len();
        }
    }

    /// Returns the datagrams to process at `now`, ordered by link and then by arrival. Further calls in the same tick
    /// share the remaining limits.
    pub fn take(&mut self, now: SimTime) -> Vec<(LinkId, ReceivedDatagram)> {
        if self.waiting == 0 {
            return Vec::new();
        }
        if self.tick != now {
            self.tick = now;
            self.renew_limits();
        }
        let mut out = Vec::new();
        for (link, queue) in &mut self.links {
            out.extend(std::iter::from_fn(|| queue.next()).map(|datagram| (*link, datagram)));
        }
        self.waiting -= out.len();
        out
    }

    /// Starts the limits anew, as for a new tick.
    pub fn renew_limits(&mut self) {
        self.links.values_mut().for_each(|queue| queue.processed_this_tick = (0, 0));
    }

    /// Number of dropped datagrams.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLOODING_LINK: LinkId = LinkId(1);
    const QUIET_LINK: LinkId = LinkId(2);

    fn datagram(bytes: &[u8]) -> ReceivedDatagram {
        ReceivedDatagram::new(bytes)
    }

    #[test]
    fn exact_flooding_link_does_not_delay_other_links() {
        let mut inbox = Inbox::default();
        (0..50).for_each(|k| inbox.push(FLOODING_LINK, datagram(&[k; 20])));
        inbox.push(QUIET_LINK, datagram(&[99]));
        let taken = inbox.take(SimTime::from_ms(1));
        assert_eq!(taken.iter().filter(|(link, _)| *link == FLOODING_LINK).count(), MAX_DATAGRAMS_PER_TICK);
        assert_eq!(taken.last(), Some(&(QUIET_LINK, datagram(&[99]))));
        assert!(inbox.take(SimTime::from_ms(1)).is_empty(), "second call in the same tick");
        assert_eq!(inbox.take(SimTime::from_ms(2))[0], (FLOODING_LINK, datagram(&[8; 20])), "datagrams must keep their order");
    }

    #[test]
    fn exact_queue_is_bounded_and_drops_are_counted() {
        let mut inbox = Inbox::default();
        (0..MAX_QUEUED_DATAGRAMS + 7).for_each(|_| inbox.push(FLOODING_LINK, datagram(&[0])));
        assert_eq!(inbox.dropped(), 7);
        (0..MAX_QUEUED_BYTES / MAX_BYTES_PER_TICK + 3).for_each(|_| inbox.push(QUIET_LINK, datagram(&[0; MAX_BYTES_PER_TICK])));
        assert_eq!(inbox.dropped(), 7 + 3);
        inbox.push(LinkId(3), datagram(&[0; MAX_BYTES_PER_TICK + 1]));
        assert_eq!(inbox.dropped(), 7 + 3 + 1, "datagrams longer than any client sends");
        inbox.close(FLOODING_LINK);
        assert!(inbox.take(SimTime::from_ms(1)).iter().all(|(link, _)| *link == QUIET_LINK));
    }

    #[test]
    fn exact_large_datagrams_are_processed_one_per_tick() {
        let mut inbox = Inbox::default();
        (0..3).for_each(|_| inbox.push(FLOODING_LINK, datagram(&[0; MAX_BYTES_PER_TICK])));
        let each: Vec<usize> = (1..=4).map(|ms| inbox.take(SimTime::from_ms(ms)).len()).collect();
        assert_eq!(each, [1, 1, 1, 0]);
    }
}
