//! H.264 in RTP packets (RFC 3550, RFC 6184): small units in single packets, large ones fragmented (FU-A).

use spandrel_model::random::RandomStream;

/// Payload type of the stream: the first dynamic type, as ground stations expect.
pub const PAYLOAD_TYPE: u8 = 96;
/// RTP clock rate for video, Hz.
pub const CLOCK_RATE_HZ: f64 = 90_000.0;
/// Maximum packet size, bytes. With IP and UDP headers, it stays below an Ethernet MTU of 1500.
const MAX_PACKET_BYTES: usize = 1_400;
const HEADER_BYTES: usize = 12;
/// NAL unit type of a fragment (RFC 6184, 5.8).
const FU_A: u8 = 28;

/// RTP sender state.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RtpPacketizer {
    sequence: u16,
    source: u32,
    /// Timestamp at the start of the stream.
    start_timestamp: u32,
}

impl RtpPacketizer {
    /// Creates a stream whose identifier and initial values come from a seed. Use a different seed for each stream;
    /// otherwise, receivers mistake it for a continuation of the previous one (RFC 3550, 5.1).
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let mut random = RandomStream::new(seed, "rtp");
        let mut bits = || (random.bits() >> 32) as u32;
        Self { sequence: (bits() >> 16) as u16, source: bits(), start_timestamp: bits() }
    }

    /// Returns the packets for a picture taken at `at_s` (in seconds); the last packet has the marker bit set.
    pub fn picture(&mut self, units: &[Vec<u8>], at_s: f64) -> Vec<Vec<u8>> {
        let stamp = self.start_timestamp.wrapping_add(((at_s * CLOCK_RATE_HZ).round() as i64) as u32);
        let payloads: Vec<Vec<u8>> = units.iter().flat_map(|unit| payloads(unit)).collect();
        let last = payloads.len().saturating_sub(1);
        payloads.into_iter().enumerate().map(|(k, payload)| self.packet(&payload, stamp, k == last)).collect()
    }

    fn packet(&mut self, payload: &[u8], stamp: u32, last: bool) -> Vec<u8> {
        let mut out = vec![0x80, PAYLOAD_TYPE | if last { 0x80 } else { 0 }];
        out.extend(self.sequence.to_be_bytes());
        out.extend(stamp.to_be_bytes());
        out.extend(self.source.to_be_bytes());
        out.extend(payload);
        self.sequence = self.sequence.wrapping_add(1);
        out
    }
}

/// Returns a unit as one payload, or as fragments.
fn payloads(unit: &[u8]) -> Vec<Vec<u8>> {
    let Some((head, body)) = unit.split_first() else { return Vec::new() };
    if unit.len() <= MAX_PACKET_BYTES - HEADER_BYTES {
        return vec![unit.to_vec()];
    }
    let pieces = body.chunks(MAX_PACKET_BYTES - HEADER_BYTES - 2);
    let count = pieces.len();
    let indicator = (head & 0xE0) | FU_A;
    pieces
        .enumerate()
        .map(|(k, piece)| {
            let start = if k == 0 { 0x80 } else { 0 };
            let end = if k + 1 == count { 0x40 } else { 0 };
            [&[indicator, start | end | (head & 0x1F)], piece].concat()
        })
        .collect()
}
