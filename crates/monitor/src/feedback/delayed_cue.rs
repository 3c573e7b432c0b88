//! A cue that turns on after a delay and then stays on for a minimum time.

use spandrel_model::time::SimTime;

/// State of a delayed cue.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct DelayedCue {
    wrong_since: Option<SimTime>,
    on_since: Option<SimTime>,
}

impl DelayedCue {
    /// Updates the cue and returns whether its condition has been met for at least `delay`.
    pub(super) fn update(&mut self, now: SimTime, wrong: bool, delay: SimTime, hold_time: SimTime) -> bool {
        self.wrong_since = wrong.then(|| self.wrong_since.unwrap_or(now));
        let due = self.wrong_since.is_some_and(|since| now - since >= delay);
        let held = self.on_since.is_some_and(|shown| now - shown < hold_time);
        self.on_since = if due { self.on_since.or(Some(now)) } else { self.on_since.filter(|_| held) };
        due
    }

    /// Returns whether the cue is on.
    pub(super) fn is_on(&self) -> bool {
        self.on_since.is_some()
    }
}
