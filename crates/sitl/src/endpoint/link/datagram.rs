//! A received datagram. It is decoded only once: when it is processed, or earlier to look for a lockstep response.

use spandrel_mavlink::codec::{Decoder, ReceivedFrame};

/// A received datagram.
#[derive(Debug, Clone, PartialEq)]
pub struct ReceivedDatagram {
    bytes: Vec<u8>,
    decoded: Option<(Vec<ReceivedFrame>, u64)>,
}

impl ReceivedDatagram {
    /// Creates a datagram that has not been decoded yet.
    #[must_use]
    pub fn new(bytes: &[u8]) -> Self {
        Self { bytes: bytes.to_vec(), decoded: None }
    }

    /// Returns the length in bytes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.bytes.len()
    }

    /// Checks whether the datagram is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// Returns the datagram's frames.
    pub fn frames(&mut self) -> &[ReceivedFrame] {
        &self.decoded.get_or_insert_with(|| decode(&self.bytes)).0
    }

    /// Removes the frames that match, and returns them.
    pub fn extract_frames(&mut self, matches: impl FnMut(&mut ReceivedFrame) -> bool) -> Vec<ReceivedFrame> {
        self.decoded.get_or_insert_with(|| decode(&self.bytes)).0.extract_if(.., matches).collect()
    }

    /// Returns the frames and the number of bytes outside them.
    #[must_use]
    pub fn into_frames(self) -> (Vec<ReceivedFrame>, u64) {
        self.decoded.unwrap_or_else(|| decode(&self.bytes))
    }
}

fn decode(bytes: &[u8]) -> (Vec<ReceivedFrame>, u64) {
    let mut decoder = Decoder::new();
    let frames = decoder.datagram(bytes);
    (frames, decoder.bad_bytes())
}
