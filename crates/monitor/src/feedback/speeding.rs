//! Speeding cue: the drone exceeds the speed limit on any path or near the last task entered. The scorer counts
//! speeding only in task windows, but during the flight, the end of a window is not yet known.

use super::input::FeedbackInput;
use super::pilot_text::{Cooldown, PilotText};
use spandrel_mavlink::contract::cue;
use spandrel_model::math::M_S_PER_MPH;
use spandrel_model::numbers::{format_limit, format_with_limit};
use spandrel_model::scenario::FeedbackThresholds;

/// Speeding rule. To avoid flicker, the cue turns off only after the speed has stayed at or below the limit for
/// `CUE_OFF_DELAY_MS`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpeedingCue {
    over_limit_since: Option<spandrel_model::time::SimTime>,
    cooldown: Cooldown,
}

/// Delay before the cue turns off, ms (estimate: half a second later, the cue still seems current).
const CUE_OFF_DELAY_MS: i64 = 500;

impl SpeedingCue {
    /// Updates the rule and returns the cue bits and any text to send.
    pub fn update(&mut self, input: &FeedbackInput, limit_m_s: f64, limits: &FeedbackThresholds) -> (i32, Option<PilotText>) {
        let near_last = input.last_task.is_some_and(|task| input.tasks[task].distance_m <= limits.off_path_max_m);
        let speeding = input.in_session && input.speed_m_s > limit_m_s && (input.current_task.is_some() || near_last);
        if speeding {
            self.over_limit_since = Some(input.time);
            let message = || {
                let (speed_mph, limit_mph) = (input.speed_m_s / M_S_PER_MPH, limit_m_s / M_S_PER_MPH);
                format!("Too fast: {} mph, limit {} mph", format_with_limit(speed_mph, limit_mph, 0), format_limit(limit_mph))
            };
            return (cue::SPEEDING, self.cooldown.rate_limited_text(input.time, limits.text_interval, cue::SPEEDING, message));
        }
        let fresh = self.over_limit_since.is_some_and(|over| (input.time - over).ms() < CUE_OFF_DELAY_MS);
        (if fresh && input.in_session { cue::SPEEDING } else { 0 }, None)
    }
}
