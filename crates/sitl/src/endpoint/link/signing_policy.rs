//! Frame admission when signing is required.

use super::link_id::LinkKind;
use spandrel_mavlink::codec::ReceivedFrame;
use spandrel_mavlink::router;
use spandrel_mavlink::signing::{SignatureVerdict, Signing, SigningKey, is_accepted};

/// Verifies frames received on all links.
#[derive(Debug, Clone)]
pub struct SigningPolicy {
    key: SigningKey,
    signing: Signing,
    timestamp: u64,
    rejected_frames: u64,
    trusted: Vec<LinkKind>,
}

/// How a frame may be handled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameAdmission {
    /// Execute and forward it.
    Execute,
    /// Forward it without executing it.
    ForwardOnly,
    /// Drop it.
    Reject,
}

impl SigningPolicy {
    /// Requires signatures with this key, starting at `timestamp` (signing timestamp), except for unsigned frames on
    /// trusted kinds of links. Signed frames must be valid there, too.
    #[must_use]
    pub fn new(key: SigningKey, timestamp: u64, trusted: &[LinkKind]) -> Self {
        Self { signing: Signing::new(key.clone(), 0, timestamp), key, timestamp, rejected_frames: 0, trusted: trusted.to_vec() }
    }

    /// Creates a signer with the same key for a link.
    #[must_use]
    pub fn signer(&self, link_id: u8) -> Signing {
        Signing::new(self.key.clone(), link_id, self.timestamp.max(self.signing.newest()))
    }

    /// Returns the signing state to save for the next start.
    #[must_use]
    pub fn saved_state(&self) -> String {
        self.signing.save()
    }

    /// Restores the signing state of the previous run.
    ///
    /// # Errors
    /// Returns the number of the first invalid line, counting from 1.
    pub fn restore(&mut self, memory: &str) -> Result<(), usize> {
        self.signing.restore(memory)
    }

    /// Sets the current signing timestamp.
    pub fn set_time(&mut self, timestamp: u64) {
        self.timestamp = timestamp;
    }

    /// Returns the number of frames rejected so far.
    #[must_use]
    pub fn rejected(&self) -> u64 {
        self.rejected_frames
    }

    /// Returns how a frame may be handled. A payload process without a key may broadcast but not send commands.
    pub fn admit(&mut self, frame: &ReceivedFrame, kind: LinkKind) -> FrameAdmission {
        let verdict = self.signing.verify(frame, self.timestamp);
        if is_accepted(frame, verdict) || (verdict == SignatureVerdict::Unsigned && self.trusted.contains(&kind)) {
            return FrameAdmission::Execute;
        }
        if verdict == SignatureVerdict::Unsigned && kind == LinkKind::Payload && router::target(frame).0 == 0 {
            return FrameAdmission::ForwardOnly;
        }
        self.rejected_frames += 1;
        FrameAdmission::Reject
    }
}
