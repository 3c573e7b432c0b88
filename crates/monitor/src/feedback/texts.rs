//! Queue of texts for the pilot: sent one at a time, crashes first. Texts that wait too long are dropped.

use super::pilot_text::PilotText;
use spandrel_mavlink::contract::cue;
use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Minimum interval between texts, except for crashes (estimate: time to read one; docs/src/reference/wire.md, "The
/// monitor").
const MIN_TEXT_INTERVAL: SimTime = SimTime::from_ms(1_000);
/// Maximum time that a text waits in the queue before it is dropped.
const MAX_TEXT_AGE: SimTime = SimTime::from_ms(2_000);
/// Maximum queue length. Crash texts displace others.
const MAX_QUEUE_LEN: usize = 4;

/// Queue of texts to send.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TextQueue {
    queue: VecDeque<(SimTime, PilotText)>,
    last_sent_time: Option<SimTime>,
}

impl TextQueue {
    /// Adds texts, most urgent first. A new text replaces any queued text from the same rule.
    pub fn enqueue(&mut self, now: SimTime, texts: Vec<PilotText>) {
        for text in texts {
            self.queue.retain(|(_, waiting)| waiting.cue != text.cue);
            if text.cue == cue::CRASH {
                self.queue.push_front((now, text));
            } else {
                self.queue.push_back((now, text));
            }
        }
        self.queue.truncate(MAX_QUEUE_LEN);
    }

    /// Returns the next text if it may be sent now.
    pub fn next(&mut self, now: SimTime) -> Option<PilotText> {
        self.queue.retain(|(put, _)| now - *put < MAX_TEXT_AGE);
        let crash = self.queue.front()?.1.cue == cue::CRASH;
        if !crash && self.last_sent_time.is_some_and(|last| now - last < MIN_TEXT_INTERVAL) {
            return None;
        }
        self.last_sent_time = Some(now);
        self.queue.pop_front().map(|(_, text)| text)
    }
}
