//! Signing of outgoing frames.

use super::link_id::LinkKind;
use super::links::Links;
use super::signing_policy::SigningPolicy;
use spandrel_mavlink::signing::SigningKey;

impl Links {
    /// Signs all outgoing frames and requires signatures with this key, except for unsigned frames on trusted kinds of
    /// links. `timestamp` is the current signing timestamp.
    pub fn require_signatures(&mut self, key: SigningKey, timestamp: u64, trusted: &[LinkKind]) {
        self.signing = Some(SigningPolicy::new(key, timestamp, trusted));
        self.sign_links();
    }

    fn sign_links(&mut self) {
        let Some(policy) = &self.signing else { return };
        for (id, link) in &mut self.peers {
            link.sign_with(Some(policy.signer(id.0 as u8)));
        }
    }

    /// Returns the signing state to save for the next start; `None` if signing is off.
    #[must_use]
    pub fn signing_state(&self) -> Option<String> {
        self.signing.as_ref().map(SigningPolicy::saved_state)
    }

    /// Restores the signing state of the previous run.
    ///
    /// # Errors
    /// Returns the number of the first invalid line, counting from 1.
    pub fn restore_signing(&mut self, memory: &str) -> Result<(), usize> {
        let done = self.signing.as_mut().map_or(Ok(()), |policy| policy.restore(memory));
        self.sign_links();
        done
    }

    /// Sets the current signing timestamp.
    pub fn set_signing_time(&mut self, timestamp: u64) {
        if let Some(policy) = &mut self.signing {
            policy.set_time(timestamp);
            self.peers.values_mut().for_each(|link| link.timestamp = timestamp);
        }
    }

    /// Returns the number of frames rejected because of a missing or invalid signature.
    #[must_use]
    pub fn rejected_frames(&self) -> u64 {
        self.signing.as_ref().map_or(0, SigningPolicy::rejected)
    }
}
