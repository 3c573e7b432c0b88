//! The way of texts to the wire: one at a time, a crash before all else, nothing stale.

use super::PilotText;
use spandrel_mavlink::contract::cue;
use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Shortest time between two texts that are no crash (estimate: one can be read; docs/src/reference/wire.md, "The monitor", has
/// the reason).
const APART: SimTime = SimTime::from_ms(1_000);
/// A text that has waited this long is dropped: it would speak of the past.
const STALE: SimTime = SimTime::from_ms(2_000);
/// Texts that wait at most; a crash drives out the others.
const WAITING: usize = 4;

/// Texts that wait.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TextQueue {
    waiting: VecDeque<(SimTime, PilotText)>,
    last: Option<SimTime>,
}

impl TextQueue {
    /// Takes texts in order of urgency; a newer one of the same rule replaces the older.
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

    /// The next text that is due.
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
