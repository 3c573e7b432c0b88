//! H.264 in RTP packets (RFC 3550, RFC 6184): small units whole, large ones in fragments (FU-A).

use spandrel_model::random::RandomStream;

/// Payload type of the stream: the first dynamic one, which ground stations expect.
pub const PAYLOAD_TYPE: u8 = 96;
/// RTP's clock for video, Hz.
pub const CLOCK_HZ: f64 = 90_000.0;
/// Largest packet, bytes: with IP and UDP below an Ethernet frame of 1500.
const MOST: usize = 1_400;
const HEADER: usize = 12;
/// Type of a fragment (RFC 6184, 5.8).
const FU_A: u8 = 28;

/// A sender's numbering.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RtpPacketizer {
    sequence: u16,
    source: u32,
    /// Time stamp of time zero.
    zero: u32,
}

impl RtpPacketizer {
    /// A stream whose identifier and first numbers come from a seed: another one for each stream, so that a receiver takes none for the
    /// continuation of the one before (RFC 3550, 5.1).
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let mut random = RandomStream::new(seed, "rtp");
        let mut bits = || (random.bits() >> 32) as u32;
        Self { sequence: (bits() >> 16) as u16, source: bits(), zero: bits() }
    }

    /// The packets of a picture that was taken at a time, s; the last one is marked.
    pub fn picture(&mut self, units: &[Vec<u8>], at_s: f64) -> Vec<Vec<u8>> {
        let stamp = self.zero.wrapping_add(((at_s * CLOCK_HZ).round() as i64) as u32);
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

/// A unit as it is, or cut.
fn payloads(unit: &[u8]) -> Vec<Vec<u8>> {
    let Some((head, body)) = unit.split_first() else { return Vec::new() };
    if unit.len() <= MOST - HEADER {
        return vec![unit.to_vec()];
    }
    let pieces = body.chunks(MOST - HEADER - 2);
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
