//! Packet streams that answer burst read requests.

use super::client::FileClient;
use crate::endpoint::link::LinkId;
use spandrel_mavlink::ftp::FtpPacket;
use std::collections::VecDeque;

/// Burst packets per tick for all clients combined: about 240 kB/s at 1000 ticks/s, which is below the capacity of a
/// local link.
const PACKETS_PER_TICK: usize = 1;

#[derive(Debug, Clone)]
struct BurstRead {
    client: FileClient,
    request: FtpPacket,
    packets: VecDeque<FtpPacket>,
}

/// All active burst reads, served in turn.
#[derive(Debug, Clone, Default)]
pub(super) struct BurstReads(VecDeque<BurstRead>);

impl BurstReads {
    /// Starts a burst read. It replaces what remains of the session's previous burst.
    pub fn begin(&mut self, client: FileClient, request: &FtpPacket, packets: VecDeque<FtpPacket>) {
        self.end(client, request.session);
        self.0.push_back(BurstRead { client, request: request.clone(), packets });
    }

    /// Checks whether this exact request is still being answered. If so, the network has duplicated it.
    pub fn is_active(&self, client: FileClient, request: &FtpPacket) -> bool {
        self.0.iter().any(|burst| burst.client == client && burst.request == *request)
    }

    /// Ends a session's burst read.
    pub fn end(&mut self, client: FileClient, session: u8) {
        self.0.retain(|burst| burst.client != client || burst.request.session != session);
    }

    /// Ends the burst reads of all matching clients.
    pub fn end_matching(&mut self, fits: impl Fn(FileClient) -> bool) {
        self.0.retain(|burst| !fits(burst.client));
    }

    /// Returns the packets to send in this tick on links that are ready.
    pub fn poll(&mut self, ready: impl Fn(&LinkId) -> bool) -> Vec<(FileClient, FtpPacket)> {
        let mut out = Vec::new();
        for _ in 0..PACKETS_PER_TICK {
            let place = self.0.iter().position(|burst| ready(&burst.client.0));
            let Some(mut burst) = place.and_then(|place| self.0.remove(place)) else { break };
            out.extend(burst.packets.pop_front().map(|packet| (burst.client, packet)));
            if !burst.packets.is_empty() {
                self.0.push_back(burst);
            }
        }
        out
    }

    /// Returns true if no burst read is active.
    #[cfg(test)]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}
