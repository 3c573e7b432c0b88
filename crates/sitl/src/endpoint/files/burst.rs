//! Streams of packets that answer one burst request each.

use super::super::LinkId;
use super::FileClient;
use spandrel_mavlink::ftp::FtpPacket;
use std::collections::VecDeque;

/// Burst packets a tick, all clients together: at 1000 ticks a second some 240 kB/s, less than a local link takes.
const PACKETS_A_TICK: usize = 1;

#[derive(Debug, Clone)]
struct BurstRead {
    client: FileClient,
    request: FtpPacket,
    packets: VecDeque<FtpPacket>,
}

/// All bursts that are under way; clients take turns.
#[derive(Debug, Clone, Default)]
pub(super) struct BurstReads(VecDeque<BurstRead>);

impl BurstReads {
    /// Begins one; it replaces what is left of the session's last.
    pub fn begin(&mut self, client: FileClient, request: &FtpPacket, packets: VecDeque<FtpPacket>) {
        self.end(client, request.session);
        self.0.push_back(BurstRead { client, request: request.clone(), packets });
    }

    /// The packets that this very request asked for are still going out: the network has doubled it.
    pub fn is_under_way(&self, client: FileClient, request: &FtpPacket) -> bool {
        self.0.iter().any(|burst| burst.client == client && burst.request == *request)
    }

    /// Ends a session's.
    pub fn end(&mut self, client: FileClient, session: u8) {
        self.0.retain(|burst| burst.client != client || burst.request.session != session);
    }

    /// Ends those of the clients that fit.
    pub fn end_matching(&mut self, fits: impl Fn(FileClient) -> bool) {
        self.0.retain(|burst| !fits(burst.client));
    }

    /// What may go out in this tick, on links that are ready.
    pub fn poll(&mut self, ready: impl Fn(&LinkId) -> bool) -> Vec<(FileClient, FtpPacket)> {
        let mut out = Vec::new();
        for _ in 0..PACKETS_A_TICK {
            let place = self.0.iter().position(|burst| ready(&burst.client.0));
            let Some(mut burst) = place.and_then(|place| self.0.remove(place)) else { break };
            out.extend(burst.packets.pop_front().map(|packet| (burst.client, packet)));
            if !burst.packets.is_empty() {
                self.0.push_back(burst);
            }
        }
        out
    }

    /// Nothing is under way.
    #[cfg(test)]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}
