//! What has arrived and waits for its tick: bounded for each link, so that a peer that floods costs the others neither time nor memory.

use crate::endpoint::LinkId;
use spandrel_model::time::SimTime;
use std::collections::{BTreeMap, VecDeque};

/// Datagrams of one link that act in one tick; at 1,000 ticks a second more than any client sends (estimate).
pub const DATAGRAMS_A_TICK: usize = 8;
/// Bytes of one link that act in one tick, and the longest datagram that is read; a frame has 280 at most, clients send one or a few.
pub const BYTES_A_TICK: usize = 4_096;
/// Datagrams of one link that may wait: with the two above at most some 130 ms.
const WAITING: usize = 1_024;
/// Bytes of one link that may wait.
const WAITING_BYTES: usize = 131_072;

/// The queues of all links.
#[derive(Debug, Clone, Default)]
pub struct Inbox {
    links: BTreeMap<LinkId, LinkQueue>,
    waiting: usize,
    tick: SimTime,
    dropped: u64,
}

#[derive(Debug, Clone, Default)]
struct LinkQueue {
    datagrams: VecDeque<Vec<u8>>,
    bytes: usize,
    spent: (usize, usize),
}

impl LinkQueue {
    fn has_room_for(&self, len: usize) -> bool {
        len <= BYTES_A_TICK && self.datagrams.len() < WAITING && self.bytes + len <= WAITING_BYTES
    }

    /// The next datagram, if this tick's share covers it.
    fn next(&mut self) -> Option<Vec<u8>> {
        let len = self.datagrams.front()?.len();
        let (count, bytes) = self.spent;
        if count >= DATAGRAMS_A_TICK || bytes + len > BYTES_A_TICK {
            return None;
        }
        self.spent = (count + 1, bytes + len);
        self.bytes -= len;
        self.datagrams.pop_front()
    }
}

impl Inbox {
    /// Takes a datagram in, or counts it as dropped when its link has too much waiting.
    pub fn push(&mut self, link: LinkId, datagram: &[u8]) {
        let queue = self.links.entry(link).or_default();
        if !queue.has_room_for(datagram.len()) {
            self.dropped += 1;
            return;
        }
        queue.bytes += datagram.len();
        queue.datagrams.push_back(datagram.to_vec());
        self.waiting += 1;
    }

    /// A link is gone; what it sent before acts no more.
    pub fn close(&mut self, link: LinkId) {
        if let Some(queue) = self.links.remove(&link) {
            self.waiting -= queue.datagrams.len();
        }
    }

    /// What may act in the tick at `now`: link by link, and within a link in the order of arrival. Asked again in the same tick it goes
    /// on with what is left of each link's share.
    pub fn take(&mut self, now: SimTime) -> Vec<(LinkId, Vec<u8>)> {
        if self.waiting == 0 {
            return Vec::new();
        }
        if self.tick != now {
            self.tick = now;
            self.links.values_mut().for_each(|queue| queue.spent = (0, 0));
        }
        let mut out = Vec::new();
        for (link, queue) in &mut self.links {
            out.extend(std::iter::from_fn(|| queue.next()).map(|datagram| (*link, datagram)));
        }
        self.waiting -= out.len();
        out
    }

    /// Datagrams that were not taken in.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLOOD: LinkId = LinkId(1);
    const CALM: LinkId = LinkId(2);

    #[test]
    fn exact_a_flood_gets_its_share_of_a_tick_and_a_calm_link_all_of_its_own() {
        let mut inbox = Inbox::default();
        (0..50).for_each(|k| inbox.push(FLOOD, &[k; 20]));
        inbox.push(CALM, &[99]);
        let taken = inbox.take(SimTime::from_ms(1));
        assert_eq!(taken.iter().filter(|(link, _)| *link == FLOOD).count(), DATAGRAMS_A_TICK);
        assert_eq!(taken.last(), Some(&(CALM, vec![99])));
        assert!(inbox.take(SimTime::from_ms(1)).is_empty(), "the same tick again");
        assert_eq!(inbox.take(SimTime::from_ms(2))[0], (FLOOD, vec![8; 20]), "in order");
    }

    #[test]
    fn exact_what_waits_is_bounded_by_count_and_by_bytes_and_the_rest_is_counted() {
        let mut inbox = Inbox::default();
        (0..WAITING + 7).for_each(|_| inbox.push(FLOOD, &[0]));
        assert_eq!(inbox.dropped(), 7);
        (0..WAITING_BYTES / BYTES_A_TICK + 3).for_each(|_| inbox.push(CALM, &[0; BYTES_A_TICK]));
        assert_eq!(inbox.dropped(), 7 + 3);
        inbox.push(LinkId(3), &[0; BYTES_A_TICK + 1]);
        assert_eq!(inbox.dropped(), 7 + 3 + 1, "longer than any client's");
        inbox.close(FLOOD);
        assert!(inbox.take(SimTime::from_ms(1)).iter().all(|(link, _)| *link == CALM));
    }

    #[test]
    fn exact_large_datagrams_act_one_a_tick() {
        let mut inbox = Inbox::default();
        (0..3).for_each(|_| inbox.push(FLOOD, &[0; BYTES_A_TICK]));
        let each: Vec<usize> = (1..=4).map(|ms| inbox.take(SimTime::from_ms(ms)).len()).collect();
        assert_eq!(each, [1, 1, 1, 0]);
    }
}
