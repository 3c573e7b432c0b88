//! Status texts to send with the next tick.

use spandrel_mavlink::dialect::MavSeverity;

/// Maximum number of queued texts; further ones are dropped.
const MAX_TEXTS: usize = 32;

/// The queued texts, and the ID of the last text that was sent in several messages.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TextQueue {
    texts: Vec<(MavSeverity, String)>,
    last_id: u16,
}

impl TextQueue {
    /// Adds a text unless the queue is full.
    pub fn push(&mut self, severity: MavSeverity, text: &str) {
        if self.texts.len() < MAX_TEXTS {
            self.texts.push((severity, text.to_string()));
        }
    }

    /// Adds a text from the autopilot, even if the queue is full.
    pub fn push_always(&mut self, severity: MavSeverity, text: String) {
        self.texts.push((severity, text));
    }

    /// Removes and returns all texts.
    pub fn take(&mut self) -> Vec<(MavSeverity, String)> {
        std::mem::take(&mut self.texts)
    }

    /// Returns an ID that clients use to reassemble a text from several messages; never 0.
    pub fn next_id(&mut self) -> u16 {
        self.last_id = self.last_id.wrapping_add(1).max(1);
        self.last_id
    }
}
