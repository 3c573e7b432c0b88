//! Off-path cue: the drone is beyond the path threshold but within the maximum distance of the last task entered. The
//! cue is off in transit: before the first task, and after the drone leaves a task at an end of its path or after
//! flying its path (docs/src/reference/assessment.md, "Feedback during the flight").

use super::input::{FeedbackInput, TaskProximity};
use super::pilot_text::{Cooldown, PilotText};
use spandrel_mavlink::contract::cue;
use spandrel_model::scenario::FeedbackThresholds;
use spandrel_model::time::SimTime;

/// Time that the drone must move away from a task before it counts as having left (docs/src/reference/assessment.md,
/// "Feedback during the flight").
const LEAVE_CONFIRM_TIME: SimTime = SimTime::from_ms(2_000);
/// Minimum change in distance that counts as movement, m (estimate: half the slowest inspection speed; MAVLink rounds to 1 cm).
/// A change no longer counts once it is older than `MAX_MOVEMENT_AGE`.
const MIN_MOVEMENT_M: f64 = 0.15;
const MAX_MOVEMENT_AGE: SimTime = SimTime::from_ms(600);

/// Off-path rule. The cue turns on after a delay and then stays on for a minimum time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OffPathCue {
    off_path_since: Option<SimTime>,
    cue_on_since: Option<SimTime>,
    cooldown: Cooldown,
    transit: TransitDetector,
}

/// Detects when the drone leaves a task.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct TransitDetector {
    /// Task ID, distance (m), time of the last change, and whether the distance increased.
    last_distance_change: Option<(u32, f64, SimTime, bool)>,
    /// Time when the drone started to leave the task; `None` if it is not leaving.
    leaving_since: Option<SimTime>,
    /// Whether the drone has left the task.
    has_left: bool,
}

impl TransitDetector {
    /// Returns whether the drone is leaving or has left the task.
    fn update(&mut self, now: SimTime, task: &TaskProximity) -> bool {
        let kept = self.last_distance_change.filter(|(id, ..)| *id == task.id);
        if kept.is_none() || task.distance_m <= task.threshold_m {
            *self = Self::default();
        }
        let (_, before_m, since, grows) = kept.unwrap_or((task.id, task.distance_m, now, false));
        let by_m = task.distance_m - before_m;
        let moved = by_m.abs() >= MIN_MOVEMENT_M;
        self.last_distance_change = Some(if moved || kept.is_none() {
            (task.id, task.distance_m, now, by_m > 0.0)
        } else {
            (task.id, before_m, since, grows)
        });
        let (grows, fresh) = if moved { (by_m > 0.0, true) } else { (grows, now - since < MAX_MOVEMENT_AGE) };
        let away = fresh && grows;
        self.leaving_since =
            (away && (task.may_leave_task || self.leaving_since.is_some())).then(|| self.leaving_since.unwrap_or(now));
        self.has_left |= self.leaving_since.is_some_and(|since| now - since >= LEAVE_CONFIRM_TIME);
        self.has_left || self.leaving_since.is_some()
    }
}

impl OffPathCue {
    /// Updates the rule and returns the cue bits and any text to send.
    pub fn update(&mut self, input: &FeedbackInput, limits: &FeedbackThresholds) -> (i32, Option<PilotText>) {
        let now = input.time;
        if !input.in_session {
            *self = Self { cooldown: self.cooldown, ..Self::default() };
            return (0, None);
        }
        let off = self.off_path_distance(input, limits.off_path_max_m);
        self.off_path_since = off.and(self.off_path_since.or(Some(now)));
        let due = self.off_path_since.is_some_and(|since| now - since >= limits.off_path_delay);
        let mut text = None;
        if due && let Some((id, distance_m)) = off {
            if self.cue_on_since.is_none() {
                self.cue_on_since = Some(now);
            }
            let message = || format!("Task {id}: {distance_m:.1} m off path");
            text = self.cooldown.rate_limited_text(now, limits.text_interval, cue::OFF_PATH, message);
        }
        let held = self.cue_on_since.is_some_and(|shown| now - shown < limits.off_path_hold_time);
        if !due && !held {
            self.cue_on_since = None;
        }
        (if self.cue_on_since.is_some() { cue::OFF_PATH } else { 0 }, text)
    }

    /// Returns the task ID and the distance in meters if the drone is off the path.
    fn off_path_distance(&mut self, input: &FeedbackInput, reach_m: f64) -> Option<(u32, f64)> {
        let task = &input.tasks[input.last_task?];
        let between = self.transit.update(input.time, task);
        let off = input.current_task.is_none() && task.distance_m > task.threshold_m && task.distance_m <= reach_m;
        (off && !between).then_some((task.id, task.distance_m))
    }
}
