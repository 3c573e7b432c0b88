//! Which frames may act when signatures are demanded.

use super::{Endpoint, LinkKind};
use spandrel_mavlink::codec::ReceivedFrame;
use spandrel_mavlink::router;
use spandrel_mavlink::signing::{SignatureVerdict, Signing, SigningKey, is_newer};

/// Verifies what comes in over all links.
#[derive(Debug, Clone)]
pub struct SigningPolicy {
    key: SigningKey,
    signing: Signing,
    stamp: u64,
    refused: u64,
    trusted: Vec<LinkKind>,
}

/// What may be done with a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameAdmission {
    /// Everything.
    Execute,
    /// It is handed on to others; the vehicle does nothing for it.
    ForwardOnly,
    /// Nothing.
    Reject,
}

impl SigningPolicy {
    /// Demands signatures of this key from now (signing timestamp) on, but for unsigned frames on trusted kinds of links. What is signed
    /// must be signed well there, too.
    #[must_use]
    pub fn new(key: SigningKey, stamp: u64, trusted: &[LinkKind]) -> Self {
        Self { signing: Signing::new(key.clone(), 0, stamp), key, stamp, refused: 0, trusted: trusted.to_vec() }
    }

    /// A signer with the same key for one link.
    #[must_use]
    pub fn signer(&self, link_id: u8) -> Signing {
        Signing::new(self.key.clone(), link_id, self.stamp.max(self.signing.newest()))
    }

    /// What the next start with this key must know.
    #[must_use]
    pub fn memory(&self) -> String {
        self.signing.save()
    }

    /// Takes up what the last start knew.
    ///
    /// # Errors
    /// The number of the first line that is wrong, from 1.
    pub fn restore(&mut self, memory: &str) -> Result<(), usize> {
        self.signing.restore(memory)
    }

    /// The signing timestamp of now.
    pub fn set_time(&mut self, stamp: u64) {
        self.stamp = stamp;
    }

    /// Frames that were let do nothing.
    #[must_use]
    pub fn rejected(&self) -> u64 {
        self.refused
    }

    /// Judges a frame. A sidecar that knows no key may still speak to everybody; it commands nobody.
    pub fn admit(&mut self, frame: &ReceivedFrame, kind: LinkKind) -> FrameAdmission {
        let verdict = self.signing.verify(frame, self.stamp);
        if is_newer(frame, verdict) || (verdict == SignatureVerdict::Unsigned && self.trusted.contains(&kind)) {
            return FrameAdmission::Execute;
        }
        if verdict == SignatureVerdict::Unsigned && kind == LinkKind::Payload && router::target(frame).0 == 0 {
            return FrameAdmission::ForwardOnly;
        }
        self.refused += 1;
        FrameAdmission::Reject
    }
}

impl Endpoint {
    /// Signs everything and lets nothing act that is not signed with this key, but for unsigned frames on kinds of links that are
    /// trusted; `stamp` is the signing timestamp of now.
    pub fn demand_signatures(&mut self, key: SigningKey, stamp: u64, trusted: &[LinkKind]) {
        self.guard = Some(SigningPolicy::new(key, stamp, trusted));
        self.sign_links();
    }

    fn sign_links(&mut self) {
        let Some(guard) = &self.guard else { return };
        for (id, link) in &mut self.links {
            link.sign_with(Some(guard.signer(id.0 as u8)));
        }
    }

    /// What the next start with the same key must know; `None` without one.
    #[must_use]
    pub fn signing_memory(&self) -> Option<String> {
        self.guard.as_ref().map(SigningPolicy::memory)
    }

    /// Takes up what the last start knew.
    ///
    /// # Errors
    /// The number of the first line that is wrong, from 1.
    pub fn restore_signing(&mut self, memory: &str) -> Result<(), usize> {
        let done = self.guard.as_mut().map_or(Ok(()), |guard| guard.restore(memory));
        self.sign_links();
        done
    }

    /// The signing timestamp of now.
    pub fn set_signing_time(&mut self, stamp: u64) {
        if let Some(guard) = &mut self.guard {
            guard.set_time(stamp);
            self.links.values_mut().for_each(|link| link.stamp = stamp);
        }
    }

    /// Frames that did nothing because they bore no good signature.
    #[must_use]
    pub fn rejected_frames(&self) -> u64 {
        self.guard.as_ref().map_or(0, SigningPolicy::rejected)
    }
}
