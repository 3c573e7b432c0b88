//! Queue of pilot texts: sent one at a time, crashes first, stale ones dropped.

use super::pilot_text::PilotText;
use spandrel_mavlink::contract::cue;
use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Minimum interval between two texts other than crashes (estimate: time to read one; docs/src/reference/wire.md, "The monitor",
/// gives the reason).
const APART: SimTime = SimTime::from_ms(1_000);
/// Texts that have waited this long are stale and dropped.
const STALE: SimTime = SimTime::from_ms(2_000);
/// Maximum queue length; a crash displaces other texts.
const WAITING: usize = 4;

/// Queue of texts to send.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TextQueue {
    waiting: VecDeque<(SimTime, PilotText)>,
    last: Option<SimTime>,
}

impl TextQueue {
    /// Enqueues texts, most urgent first. A new text replaces a queued one from the same rule.
    pub fn put(&mut self, now: SimTime, texts: Vec<PilotText>) {
        for text in texts {
            self.waiting.retain(|(_, waiting)| waiting.cue != text.cue);
            if text.cue == cue::CRASH {
                self.waiting.push_front((now, text));
            } else {
                self.waiting.push_back((now, text));
            }
        }
        self.waiting.truncate(WAITING);
    }

    /// Returns the next text that is due.
    pub fn next(&mut self, now: SimTime) -> Option<PilotText> {
        self.waiting.retain(|(put, _)| now - *put < STALE);
        let crash = self.waiting.front()?.1.cue == cue::CRASH;
        if !crash && self.last.is_some_and(|last| now - last < APART) {
            return None;
        }
        self.last = Some(now);
        self.waiting.pop_front().map(|(_, text)| text)
    }
}
