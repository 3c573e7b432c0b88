//! MAVLink framing: splits bytes into complete frames. Invalid bytes are counted and skipped, so they never stop a link.

use super::checksum::checksum;
use super::dialect::MavMessage;
use mavlink::{MavlinkVersion, Message};

const STX_V1: u8 = 0xFE;
const STX_V2: u8 = 0xFD;
const FLAG_SIGNED: u8 = 0x01;
const SIGNATURE_LEN: usize = 13;
const V2_HEADER_LEN: usize = 10;
const CHECKSUM_LEN: usize = 2;
const MAX_PAYLOAD_LEN: usize = 255;

/// A received frame: its message, its sender and its raw bytes.
#[derive(Debug, Clone, PartialEq)]
pub struct ReceivedFrame {
    /// Sender's system ID (1 to 255).
    pub system_id: u8,
    /// Sender's component ID.
    pub component_id: u8,
    /// Frame sequence number, which wraps at 256.
    pub sequence: u8,
    /// Message ID, set even if the payload could not be decoded.
    pub message_id: u32,
    /// The decoded message; `None` for a valid frame whose message is not in the dialect or whose payload cannot be parsed.
    pub message: Option<MavMessage>,
    /// The frame exactly as received, for routing and logging.
    pub bytes: Vec<u8>,
}

impl ReceivedFrame {
    /// Returns the payload, padded with zeros to `len` bytes (MAVLink 2 truncates trailing zeros).
    #[must_use]
    pub fn payload(&self, len: usize) -> Vec<u8> {
        let start = if self.bytes.first() == Some(&STX_V2) { 10 } else { 6 };
        let used = self.bytes.get(1).copied().unwrap_or(0) as usize;
        let mut out = self.bytes.get(start..start + used).unwrap_or_default().to_vec();
        out.resize(len.max(out.len()), 0);
        out
    }
}

/// Splits a byte stream or a series of datagrams into frames.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Decoder {
    buffer: Vec<u8>,
    bad_bytes: u64,
    known_messages_only: bool,
}

enum ParseStep {
    Frame(usize, Box<ReceivedFrame>),
    Skip(usize),
    NeedMore,
}

impl Decoder {
    /// Creates a decoder with an empty buffer.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Creates a decoder for a peer that waits for a reply to each frame, with an empty buffer. It accepts only messages of the
    /// dialect, whose checksums can be verified, and finds complete frames behind an incomplete one, so that invalid bytes never
    /// hold back a frame.
    #[must_use]
    pub fn for_known_messages() -> Self {
        Self { known_messages_only: true, ..Self::default() }
    }

    /// Returns the number of bytes received so far that did not belong to a valid frame.
    #[must_use]
    pub fn bad_bytes(&self) -> u64 {
        self.bad_bytes
    }

    /// Decodes bytes from a stream. Keeps a trailing incomplete frame for the next call.
    pub fn push(&mut self, bytes: &[u8]) -> Vec<ReceivedFrame> {
        self.buffer.extend_from_slice(bytes);
        let mut frames = Vec::new();
        let mut at = 0;
        loop {
            match self.next_at(at) {
                ParseStep::Frame(len, frame) => {
                    frames.push(*frame);
                    at += len;
                }
                ParseStep::Skip(len) => at += self.count_bad(len),
                ParseStep::NeedMore => match self.complete_frame_after(at).filter(|_| self.known_messages_only) {
                    Some(next) => at += self.count_bad(next - at),
                    None => break,
                },
            }
        }
        self.buffer.drain(..at);
        frames
    }

    /// Parses the first frame at a position of the buffer.
    fn next_at(&self, at: usize) -> ParseStep {
        let step = next(&self.buffer[at..]);
        let is_unknown = matches!(&step, ParseStep::Frame(_, frame) if !known(frame.message_id));
        if self.known_messages_only && is_unknown { ParseStep::Skip(1) } else { step }
    }

    /// Returns the position of the first complete frame after a position.
    fn complete_frame_after(&self, at: usize) -> Option<usize> {
        (at + 1..self.buffer.len())
            .find(|place| matches!(self.buffer[*place], STX_V1 | STX_V2) && matches!(self.next_at(*place), ParseStep::Frame(..)))
    }

    /// Decodes one datagram. A trailing incomplete frame counts as bad and is dropped. Each byte is examined once, and
    /// each possible frame start costs one checksum over at most 267 bytes, so decoding takes linear time for any
    /// input.
    pub fn datagram(&mut self, bytes: &[u8]) -> Vec<ReceivedFrame> {
        self.buffer.clear();
        let mut frames = Vec::new();
        let mut at = 0;
        while at < bytes.len() {
            let step = next(&bytes[at..]);
            at += match step {
                ParseStep::Frame(len, frame) => {
                    frames.push(*frame);
                    len
                }
                ParseStep::Skip(len) => self.count_bad(len),
                // The frame is incomplete, but another frame may start within its bytes.
                ParseStep::NeedMore => self.count_bad(1),
            };
        }
        frames
    }

    fn count_bad(&mut self, len: usize) -> usize {
        self.bad_bytes += len as u64;
        len
    }
}

/// Parses the first frame in `bytes`, or determines the number of bytes to skip.
fn next(bytes: &[u8]) -> ParseStep {
    let Some(start) = bytes.iter().position(|b| *b == STX_V1 || *b == STX_V2) else {
        return if bytes.is_empty() { ParseStep::NeedMore } else { ParseStep::Skip(bytes.len()) };
    };
    if start > 0 {
        return ParseStep::Skip(start);
    }
    if bytes[0] == STX_V2 { next_v2(bytes) } else { next_v1(bytes) }
}

fn next_v2(bytes: &[u8]) -> ParseStep {
    if bytes.len() < 10 {
        return ParseStep::NeedMore;
    }
    let flags = bytes[2];
    // Frames with unknown incompatibility flags must be discarded (MAVLink guide, "Serialization").
    if flags & !FLAG_SIGNED != 0 {
        return ParseStep::Skip(1);
    }
    let body_end = 10 + bytes[1] as usize;
    let total = body_end + 2 + if flags & FLAG_SIGNED != 0 { SIGNATURE_LEN } else { 0 };
    if bytes.len() < total {
        return ParseStep::NeedMore;
    }
    let message_id = u32::from_le_bytes([bytes[7], bytes[8], bytes[9], 0]);
    let crc = u16::from_le_bytes([bytes[body_end], bytes[body_end + 1]]);
    let extra = known(message_id).then(|| MavMessage::extra_crc(message_id));
    // If a message is not in the dialect, its checksum cannot be verified, so the frame is only routed.
    if extra.is_some_and(|extra| checksum(&bytes[1..body_end], extra) != crc) {
        return ParseStep::Skip(1);
    }
    let message = extra.and_then(|_| MavMessage::parse(MavlinkVersion::V2, message_id, &bytes[10..body_end]).ok());
    let frame = ReceivedFrame {
        system_id: bytes[5],
        component_id: bytes[6],
        sequence: bytes[4],
        message_id,
        message,
        bytes: bytes[..total].to_vec(),
    };
    ParseStep::Frame(total, Box::new(frame))
}

fn next_v1(bytes: &[u8]) -> ParseStep {
    if bytes.len() < 8 {
        return ParseStep::NeedMore;
    }
    let body_end = 6 + bytes[1] as usize;
    let total = body_end + 2;
    if bytes.len() < total {
        return ParseStep::NeedMore;
    }
    let message_id = u32::from(bytes[5]);
    let crc = u16::from_le_bytes([bytes[body_end], bytes[body_end + 1]]);
    let extra = known(message_id).then(|| MavMessage::extra_crc(message_id));
    if extra.is_none_or(|extra| checksum(&bytes[1..body_end], extra) != crc) {
        return ParseStep::Skip(1);
    }
    let message = MavMessage::parse(MavlinkVersion::V1, message_id, &bytes[6..body_end]).ok();
    let frame = ReceivedFrame {
        system_id: bytes[3],
        component_id: bytes[4],
        sequence: bytes[2],
        message_id,
        message,
        bytes: bytes[..total].to_vec(),
    };
    ParseStep::Frame(total, Box::new(frame))
}

fn known(message_id: u32) -> bool {
    MavMessage::default_message_from_id(message_id).is_some()
}

/// A message that an [`Encoder`] can frame.
pub trait Encodable {
    /// Returns the complete frame, with the encoder's sender IDs and next sequence number.
    fn frame(&self, encoder: &mut Encoder) -> Vec<u8>;
}

impl Encodable for MavMessage {
    fn frame(&self, encoder: &mut Encoder) -> Vec<u8> {
        encoder.encode(self)
    }
}

/// Encodes frames for one sender and assigns their sequence numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Encoder {
    system_id: u8,
    component_id: u8,
    sequence: u8,
}

impl Encoder {
    /// Creates an encoder for one sender.
    #[must_use]
    pub fn new(system_id: u8, component_id: u8) -> Self {
        Self { system_id, component_id, sequence: 0 }
    }

    /// Returns the sender's system ID.
    #[must_use]
    pub fn system_id(&self) -> u8 {
        self.system_id
    }

    /// Returns the sender's component ID.
    #[must_use]
    pub fn component_id(&self) -> u8 {
        self.component_id
    }

    /// Encodes one MAVLink 2 frame from a raw payload. Needed for values that the dialect's types cannot represent, such as
    /// acknowledgments of unknown commands. Truncates trailing zeros, as the protocol requires.
    pub fn encode_payload(&mut self, message_id: u32, payload: &[u8]) -> Vec<u8> {
        self.encode_foreign(message_id, MavMessage::extra_crc(message_id), payload)
    }

    /// Encodes one frame like [`Self::encode_payload`], but for a message from another dialect with the given
    /// CRC_EXTRA.
    pub fn encode_foreign(&mut self, message_id: u32, crc_extra: u8, payload: &[u8]) -> Vec<u8> {
        let used = payload.iter().rposition(|b| *b != 0).map_or(1, |last| last + 1).min(255).min(payload.len());
        self.frame(message_id, crc_extra, &payload[..used])
    }

    /// Returns a frame with a payload from which the trailing zeros have been truncated.
    fn frame(&mut self, message_id: u32, crc_extra: u8, payload: &[u8]) -> Vec<u8> {
        let id = message_id.to_le_bytes();
        let mut out = Vec::with_capacity(V2_HEADER_LEN + payload.len() + CHECKSUM_LEN);
        out.extend([STX_V2, payload.len() as u8, 0, 0, self.sequence, self.system_id, self.component_id, id[0], id[1], id[2]]);
        out.extend_from_slice(payload);
        let crc = checksum(&out[1..], crc_extra);
        out.extend(crc.to_le_bytes());
        self.sequence = self.sequence.wrapping_add(1);
        out
    }

    /// Encodes one MAVLink 2 frame.
    pub fn encode(&mut self, message: &MavMessage) -> Vec<u8> {
        let mut payload = [0; MAX_PAYLOAD_LEN];
        let used = message.ser(MavlinkVersion::V2, &mut payload);
        let message_id = message.message_id();
        self.frame(message_id, MavMessage::extra_crc(message_id), &payload[..used])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dialect::HEARTBEAT_DATA;

    #[test]
    fn exact_frame_between_invalid_bytes_is_decoded() {
        let message = MavMessage::HEARTBEAT(HEARTBEAT_DATA { custom_mode: 7, ..HEARTBEAT_DATA::default() });
        let mut bytes = vec![1, 0xFD, 3];
        bytes.extend(Encoder::new(1, 191).encode(&message));
        bytes.extend([0xFE, 9, 9]);
        let mut decoder = Decoder::new();
        let frames = decoder.datagram(&bytes);
        assert_eq!(frames.len(), 1);
        assert_eq!((frames[0].system_id, frames[0].component_id), (1, 191));
        assert_eq!(frames[0].message.as_ref(), Some(&message));
        assert_eq!(decoder.bad_bytes(), 6);
    }

    #[test]
    fn exact_frame_after_false_starts_is_decoded_and_other_bytes_are_counted() {
        let message = MavMessage::HEARTBEAT(HEARTBEAT_DATA::default());
        let frame = Encoder::new(1, 191).encode(&message);
        // The datagram contains thousands of false frame starts, each with a length beyond the end of the datagram.
        let mut bytes = [0xFD, 0xFF, 0x00].repeat(20_000);
        bytes.extend(&frame);
        bytes.extend([0xFE, 0xFF]);
        let mut decoder = Decoder::new();
        let frames = decoder.datagram(&bytes);
        assert_eq!(frames.iter().filter(|f| f.message.as_ref() == Some(&message)).count(), 1);
        let good: usize = frames.iter().map(|f| f.bytes.len()).sum();
        assert_eq!(decoder.bad_bytes() as usize + good, bytes.len());
    }

    #[test]
    fn regress_half_and_unknown_frames_do_not_hold_back_a_known_one() {
        let message = MavMessage::HEARTBEAT(HEARTBEAT_DATA { custom_mode: 7, ..HEARTBEAT_DATA::default() });
        let frame = Encoder::new(1, 1).encode(&message);
        // The start of a frame with 255 bytes, and a frame of a message outside the dialect that would contain the real one.
        for noise in [vec![0xFD, 0xFF, 0, 0, 0, 1, 1, 0, 0, 0], vec![0xFD, 20, 0, 0, 0, 1, 1, 0xF0, 0xFF, 0xFF]] {
            let mut decoder = Decoder::for_known_messages();
            assert!(decoder.push(&noise).is_empty());
            let frames = decoder.push(&frame);
            assert_eq!(frames.iter().map(|frame| frame.message.as_ref()).collect::<Vec<_>>(), [Some(&message)], "{noise:?}");
            assert_eq!(decoder.bad_bytes(), noise.len() as u64);
        }
        // A frame in two parts stays one frame.
        let mut decoder = Decoder::for_known_messages();
        assert!(decoder.push(&frame[..12]).is_empty());
        assert_eq!((decoder.push(&frame[12..]).len(), decoder.bad_bytes()), (1, 0));
    }

    #[test]
    fn exact_flipped_bit_loses_only_one_frame() {
        let message = MavMessage::HEARTBEAT(HEARTBEAT_DATA::default());
        let mut encoder = Encoder::new(1, 1);
        let mut bytes = encoder.encode(&message);
        bytes[12] ^= 1;
        bytes.extend(encoder.encode(&message));
        assert_eq!(Decoder::new().datagram(&bytes).len(), 1);
    }
}
