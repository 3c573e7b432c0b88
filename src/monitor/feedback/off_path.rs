//! Off path: beyond the threshold but still within reach of the task last entered, or of the nearest before any was entered.

use super::{CoolDown, Moment, Text, cue};
use crate::base::time::SimTime;
use crate::scenario::Feedback;

/// The rule: shows after the state has lasted, and is held for a while.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OffPath {
    since: Option<SimTime>,
    shown: Option<SimTime>,
    cool_down: CoolDown,
}

impl OffPath {
    /// Cue and text at one instant.
    pub fn see(&mut self, moment: &Moment, limits: &Feedback) -> (i32, Option<Text>) {
        let now = moment.time;
        if !moment.in_session {
            *self = Self { cool_down: self.cool_down, ..Self::default() };
            return (0, None);
        }
        let off = off(moment, limits.off_path_max_m);
        self.since = off.and(self.since.or(Some(now)));
        let due = self.since.is_some_and(|since| now - since >= limits.off_path_after);
        let mut text = None;
        if due && let Some((id, distance_m)) = off {
            if self.shown.is_none() {
                self.shown = Some(now);
            }
            let words = || format!("Off path of task {id}: {distance_m:.1} m away");
            text = self.cool_down.say(now, limits.text_interval, cue::OFF_PATH, words);
        }
        let held = self.shown.is_some_and(|shown| now - shown < limits.off_path_hold);
        if !due && !held {
            self.shown = None;
        }
        (if self.shown.is_some() { cue::OFF_PATH } else { 0 }, text)
    }
}

/// Task and distance when off path.
fn off(moment: &Moment, reach_m: f64) -> Option<(u32, f64)> {
    let nearest = || moment.tasks.iter().min_by(|a, b| a.distance_m.total_cmp(&b.distance_m));
    let task = moment.last.map(|task| &moment.tasks[task]).or_else(nearest)?;
    let off = moment.on.is_none() && task.distance_m > task.threshold_m && task.distance_m <= reach_m;
    off.then_some((task.id, task.distance_m))
}
