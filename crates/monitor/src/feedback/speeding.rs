//! Speeding cue: the drone exceeds the speed limit on any path or near the task that is being flown. The scorer counts
//! speeding only in task windows, but during the flight, the end of a window is not yet known.

use super::input::{FeedbackInput, TaskProximity};
use super::pilot_text::{Cooldown, PilotText};
use spandrel_mavlink::contract::cue;
use spandrel_model::scenario::{FeedbackThresholds, ScoringParams};
use spandrel_model::time::SimTime;

/// Speeding rule. The cue turns on above the limit plus a margin. It turns off after the speed has stayed at or below the
/// limit for `CUE_OFF_DELAY`, but not before its minimum duration.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpeedingCue {
    on_since: Option<SimTime>,
    over_limit_at: Option<SimTime>,
    cooldown: Cooldown,
}

/// Delay before the cue turns off (estimate: half a second later, the cue still seems current).
const CUE_OFF_DELAY: SimTime = SimTime::from_ms(500);

impl SpeedingCue {
    /// Updates the rule and returns the cue bits and any text to send. `task` is the task that is being flown.
    pub fn update(
        &mut self,
        input: &FeedbackInput,
        task: Option<&TaskProximity>,
        scoring: &ScoringParams,
        limits: &FeedbackThresholds,
    ) -> (i32, Option<PilotText>) {
        let now = input.time;
        if !input.in_session {
            (self.on_since, self.over_limit_at) = (None, None);
            return (0, None);
        }
        let counts = input.current_task.is_some() || task.is_some_and(|task| task.distance_m <= limits.off_path_max_m);
        let margin = if self.on_since.is_some() { 0.0 } else { limits.speeding_margin };
        if counts && input.speed_m_s > scoring.speed_limit_m_s * (1.0 + margin) {
            self.on_since = self.on_since.or(Some(now));
            self.over_limit_at = Some(now);
            let message = || speeding_text(input.speed_m_s, scoring);
            return (cue::SPEEDING, self.cooldown.rate_limited_text(now, limits.text_interval, cue::SPEEDING, message));
        }
        let held = self.on_since.is_some_and(|since| now - since < limits.speeding_hold_time);
        let fresh = self.over_limit_at.is_some_and(|over| now - over < CUE_OFF_DELAY);
        self.on_since = self.on_since.filter(|_| held || fresh);
        (if self.on_since.is_some() { cue::SPEEDING } else { 0 }, None)
    }
}

fn speeding_text(speed_m_s: f64, scoring: &ScoringParams) -> String {
    let (unit, limit_m_s) = (scoring.speed_limit_unit, scoring.speed_limit_m_s);
    format!("Too fast: {} {}, limit {}", unit.format_speed(speed_m_s, limit_m_s), unit.symbol(), unit.format_limit(limit_m_s))
}
