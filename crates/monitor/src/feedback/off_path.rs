//! Off-path cue: the drone is beyond the path threshold, but within the maximum distance of the task that is being flown.
//! The text states the distance and the direction of the path.

use super::delayed_cue::DelayedCue;
use super::direction::direction_words;
use super::input::{FeedbackInput, TaskProximity};
use super::pilot_text::{Cooldown, PilotText};
use super::stand_off::explains_distance;
use spandrel_mavlink::contract::cue;
use spandrel_model::numbers::format_beyond_limit;
use spandrel_model::scenario::FeedbackThresholds;

/// Off-path rule. The cue turns on after a delay and then stays on for a minimum time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OffPathCue {
    cue: DelayedCue,
    cooldown: Cooldown,
}

impl OffPathCue {
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
        let is_off = |task: &&TaskProximity| {
            input.current_task.is_none() && task.distance_m > task.threshold_m && task.distance_m <= limits.off_path_max_m
        };
        let off = task.filter(is_off);
        let due = self.cue.update(input.time, off.is_some(), limits.off_path_delay, limits.off_path_hold_time);
        // The stand-off cue has its own text.
        let text = off.filter(|task| due && !explains_distance(task)).and_then(|task| {
            let message = || off_path_text(task);
            self.cooldown.rate_limited_text(input.time, limits.text_interval, cue::OFF_PATH, message)
        });
        (if self.cue.is_on() { cue::OFF_PATH } else { 0 }, text)
    }
}

fn off_path_text(task: &TaskProximity) -> String {
    let distance = format_beyond_limit(task.distance_m, task.threshold_m, 1);
    format!("Off path {distance} m: {}", direction_words(task.way_back))
}
