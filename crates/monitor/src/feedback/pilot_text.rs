//! Texts for the pilot and the per-rule rate limit.

use spandrel_model::time::SimTime;

/// A text for the pilot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PilotText {
    /// Cue bit of the rule that raised the text.
    pub cue: i32,
    /// Text of at most 50 bytes.
    pub text: String,
}

/// Rate limit for one rule's texts: after a text, no further text is sent until the interval has passed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Cooldown {
    last_sent: Option<SimTime>,
}

impl Cooldown {
    pub(super) fn rate_limited_text(
        &mut self,
        now: SimTime,
        interval: SimTime,
        cue: i32,
        message: impl FnOnce() -> String,
    ) -> Option<PilotText> {
        if self.last_sent.is_some_and(|said| now - said < interval) {
            return None;
        }
        self.last_sent = Some(now);
        Some(PilotText { cue, text: message() })
    }
}
