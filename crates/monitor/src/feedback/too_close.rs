//! Too-close cue: the clearance (distance from the drone's center to the nearest surface) is below the limit, with hysteresis.

use super::input::FeedbackInput;
use super::pilot_text::{Cooldown, PilotText};
use spandrel_mavlink::contract::cue;
use spandrel_model::numbers::{format_beyond_limit, format_limit};
use spandrel_model::scenario::FeedbackThresholds;

/// Too-close rule.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TooCloseCue {
    is_on: bool,
    cooldown: Cooldown,
}

impl TooCloseCue {
    /// Updates the rule and returns the cue bits and any text to send.
    pub fn update(&mut self, input: &FeedbackInput, limits: &FeedbackThresholds) -> (i32, Option<PilotText>) {
        let Some(clearance) = input.clearance_m.filter(|_| input.in_session && input.airborne) else {
            self.is_on = false;
            return (0, None);
        };
        // A task's own limit applies on its path, or near it and on no other path. This prevents warnings when the
        // drone enters or leaves a confined space.
        let near = input.tasks.iter().filter(|task| task.distance_m <= limits.off_path_max_m);
        let own = match input.current_task {
            Some(task) => input.tasks[task].too_close_m,
            None => near.filter_map(|task| task.too_close_m).reduce(f64::min),
        };
        let limit = own.unwrap_or(limits.too_close_m);
        let clear = limit + (limits.too_close_clear_m - limits.too_close_m);
        let began = !self.is_on && clearance < limit;
        self.is_on = if self.is_on { clearance < clear } else { began };
        let message = || format!("Too close: {} m, limit {} m", format_beyond_limit(clearance, limit, 1), format_limit(limit));
        let text =
            began.then(|| self.cooldown.rate_limited_text(input.time, limits.text_interval, cue::TOO_CLOSE, message)).flatten();
        (if self.is_on { cue::TOO_CLOSE } else { 0 }, text)
    }
}
