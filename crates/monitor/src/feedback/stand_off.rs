//! Stand-off cue: the distance from the inspected surface differs too much from the recommended one. The text states both.

use super::delayed_cue::DelayedCue;
use super::input::{FeedbackInput, SurfaceDistance, TaskProximity};
use super::pilot_text::{Cooldown, PilotText};
use spandrel_mavlink::contract::cue;
use spandrel_model::numbers::{format_beyond_limit, format_limit};
use spandrel_model::scenario::FeedbackThresholds;

/// Stand-off rule. The cue has the same delay and minimum duration as the off-path cue.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StandOffCue {
    cue: DelayedCue,
    cooldown: Cooldown,
}

impl StandOffCue {
    /// Updates the rule and returns the cue bits and any text to send. `task` is the task that is being flown.
    pub fn update(
        &mut self,
        input: &FeedbackInput,
        task: Option<&TaskProximity>,
        limits: &FeedbackThresholds,
    ) -> (i32, Option<PilotText>) {
        if !input.in_session {
            self.cue = DelayedCue::default();
            return (0, None);
        }
        let near = task.filter(|task| task.distance_m <= limits.off_path_max_m && explains_distance(task));
        let wrong = near.and_then(|task| task.surface);
        let due = self.cue.update(input.time, wrong.is_some(), limits.off_path_delay, limits.off_path_hold_time);
        let text = wrong.filter(|_| due).and_then(|surface| {
            let message = || stand_off_text(&surface);
            self.cooldown.rate_limited_text(input.time, limits.text_interval, cue::STAND_OFF, message)
        });
        (if self.cue.is_on() { cue::STAND_OFF } else { 0 }, text)
    }
}

/// Returns whether the stand-off is wrong, and correcting it would bring the drone onto the path.
pub(super) fn explains_distance(task: &TaskProximity) -> bool {
    task.surface.is_some_and(|surface| {
        (surface.actual_m - surface.recommended_m).abs() > surface.tolerance_m && surface.sideways_m <= task.threshold_m
    })
}

fn stand_off_text(surface: &SurfaceDistance) -> String {
    let too_large = surface.actual_m > surface.recommended_m;
    let (word, sign) = if too_large { ("large", 1.0) } else { ("small", -1.0) };
    let limit_m = surface.recommended_m + sign * surface.tolerance_m;
    let actual = format_beyond_limit(surface.actual_m.max(0.0), limit_m, 1);
    format!("Stand-off too {word}: {actual} m, recommended {} m", format_limit(surface.recommended_m))
}
