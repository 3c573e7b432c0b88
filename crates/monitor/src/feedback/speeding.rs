//! Speeding cue: over the limit while on any path or near the last one entered. (Unlike the scorer, the live rule does not know
//! where a task window ends.)

use super::input::FeedbackInput;
use super::pilot_text::{CoolDown, PilotText};
use spandrel_mavlink::contract::cue;
use spandrel_model::math::M_S_PER_MPH;
use spandrel_model::numbers::{format_beside_limit, limit};
use spandrel_model::scenario::FeedbackThresholds;

/// The speeding rule. The cue clears only after the speed has stayed at or below the limit for `CLEAR_MS`, to avoid flicker.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpeedingCue {
    over_limit_since: Option<spandrel_model::time::SimTime>,
    cool_down: CoolDown,
}

/// Delay before the cue clears, ms (estimate: half a second still reads as "now").
const CLEAR_MS: i64 = 500;

impl SpeedingCue {
    /// Updates the rule and returns the cue bits and a text, if one is due.
    pub fn update(&mut self, moment: &FeedbackInput, limit_m_s: f64, limits: &FeedbackThresholds) -> (i32, Option<PilotText>) {
        let near_last = moment.last.is_some_and(|task| moment.tasks[task].distance_m <= limits.off_path_max_m);
        let speeding = moment.in_session && moment.speed_m_s > limit_m_s && (moment.current_task.is_some() || near_last);
        if speeding {
            self.over_limit_since = Some(moment.time);
            let words = || {
                let (speed_mph, limit_mph) = (moment.speed_m_s / M_S_PER_MPH, limit_m_s / M_S_PER_MPH);
                format!("Too fast: {} mph, limit {} mph", format_beside_limit(speed_mph, limit_mph, 0), limit(limit_mph))
            };
            return (cue::SPEEDING, self.cool_down.cue_text(moment.time, limits.text_interval, cue::SPEEDING, words));
        }
        let fresh = self.over_limit_since.is_some_and(|over| (moment.time - over).ms() < CLEAR_MS);
        (if fresh && moment.in_session { cue::SPEEDING } else { 0 }, None)
    }
}
