//! Which frames may act when signatures are demanded.

use super::LinkKind;
use crate::mav::codec::Received;
use crate::mav::router;
use crate::mav::signing::{Key, Signing, Verdict, passes};

/// Verifies what comes in over all links.
#[derive(Debug, Clone)]
pub struct Guard {
    key: Key,
    signing: Signing,
    stamp: u64,
    refused: u64,
    trusted: Vec<LinkKind>,
}

/// What may be done with a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Admitted {
    /// Everything.
    Acts,
    /// It is handed on to others; the vehicle does nothing for it.
    Passes,
    /// Nothing.
    No,
}

impl Guard {
    /// Demands signatures of this key from now (signing timestamp) on, but for unsigned frames on trusted kinds of links. What is signed
    /// must be signed well there, too.
    #[must_use]
    pub fn new(key: Key, stamp: u64, trusted: &[LinkKind]) -> Self {
        Self { signing: Signing::new(key.clone(), 0, stamp), key, stamp, refused: 0, trusted: trusted.to_vec() }
    }

    /// A signer with the same key for one link.
    #[must_use]
    pub fn signer(&self, link_id: u8) -> Signing {
        Signing::new(self.key.clone(), link_id, self.stamp)
    }

    /// The signing timestamp of now.
    pub fn tell(&mut self, stamp: u64) {
        self.stamp = stamp;
    }

    /// Frames that were let do nothing.
    #[must_use]
    pub fn refused(&self) -> u64 {
        self.refused
    }

    /// Judges a frame. A sidecar that knows no key may still speak to everybody; it commands nobody.
    pub fn admit(&mut self, frame: &Received, kind: LinkKind) -> Admitted {
        let verdict = self.signing.verify(frame, self.stamp);
        if passes(frame, verdict) || (verdict == Verdict::Unsigned && self.trusted.contains(&kind)) {
            return Admitted::Acts;
        }
        if verdict == Verdict::Unsigned && kind == LinkKind::Payload && router::target(frame).0 == 0 {
            return Admitted::Passes;
        }
        self.refused += 1;
        Admitted::No
    }
}
