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

/// Splits a text into chunks of at most 50 bytes, at character boundaries, as STATUSTEXT requires.
pub fn chunks(text: &str) -> Vec<String> {
    const MAX_CHUNK_BYTES: usize = 50;
    let mut out = vec![String::new()];
    for character in text.chars() {
        let last = out.len() - 1;
        if out[last].len() + character.len_utf8() > MAX_CHUNK_BYTES {
            out.push(String::new());
        }
        let last = out.len() - 1;
        out[last].push(character);
    }
    // A full chunk means that another one follows, so the last of several chunks must not be full.
    if out.len() > 1 && out.last().is_some_and(|last| last.len() == MAX_CHUNK_BYTES) {
        out.push(String::new());
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_last_of_several_chunks_is_never_full() {
        for (long, count) in [(0, 1), (49, 1), (50, 1), (51, 2), (99, 2), (100, 3), (150, 4)] {
            let text = "x".repeat(long);
            let pieces = chunks(&text);
            assert_eq!((pieces.len(), pieces.concat()), (count, text), "{long}");
            assert!(count == 1 || pieces[count - 1].len() < 50, "{long}");
        }
    }
}
