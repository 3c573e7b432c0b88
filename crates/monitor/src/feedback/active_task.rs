//! The task that is being flown. The off-path, stand-off and speeding cues apply only to it, so that they are off between
//! tasks (docs/src/reference/assessment.md, "Feedback during the flight").

use super::input::{FeedbackInput, TaskProximity};
use spandrel_model::scenario::FeedbackThresholds;
use spandrel_model::time::SimTime;

/// Minimum change in distance that counts as movement, m (estimate: half the slowest inspection speed; MAVLink rounds to 1 cm).
/// A change no longer counts once it is older than `MAX_MOVEMENT_AGE`.
const MIN_MOVEMENT_M: f64 = 0.15;
const MAX_MOVEMENT_AGE: SimTime = SimTime::from_ms(600);
/// Share of a path after which a pilot who moves away from its end is on the way to another task (estimate).
const MIN_SHARE_TO_LEAVE_AT_ONCE: f64 = 0.5;

/// Determines which task is being flown.
///
/// A visit to a task begins when the drone enters its path. If the task is already done, or if another task is being flown,
/// it begins only after the drone has stayed on the path for `visit_delay`, so that crossing a path doesn't begin a visit.
/// A visit ends when the drone moves away for `leave_delay` from an end of the path or, once the task is done, from any part
/// of it. At an end of a path of which at least half has been flown, a pilot who moves away counts as leaving at once, so that
/// there is no cue. Elsewhere, it is more likely a deviation, so that the cues stay on during that time. After the whole path
/// has been flown, the visit ends as soon as the drone is off the path.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ActiveTask {
    visited: Option<usize>,
    /// Whether the visit began after the whole path had been flown.
    revisit: bool,
    /// Task whose path the drone is on, and the time since when it has been there.
    on_path: Option<(usize, SimTime)>,
    departure: DepartureDetector,
}

impl ActiveTask {
    /// Updates the visit. Returns the task that is being flown; `None` between tasks and while the drone is leaving.
    pub fn update(&mut self, input: &FeedbackInput, limits: &FeedbackThresholds) -> Option<usize> {
        if !input.in_session {
            *self = Self::default();
            return None;
        }
        self.on_path = input.current_task.map(|task| (task, self.entered(task).unwrap_or(input.time)));
        if let Some((task, since)) = self.on_path {
            let at_once = self.visited == Some(task) || (self.visited.is_none() && !input.tasks[task].done);
            if at_once || input.time - since >= limits.visit_delay {
                self.revisit = if self.visited == Some(task) { self.revisit } else { input.tasks[task].finished };
                self.visited = Some(task);
                self.departure = DepartureDetector::default();
            }
        }
        let visited = self.visited?;
        if input.current_task == Some(visited) {
            return Some(visited);
        }
        // A pilot who has flown the whole path is on the way to another one, also while looking around near its end.
        if input.tasks[visited].finished && !self.revisit {
            self.visited = None;
            return None;
        }
        let away = self.departure.update(input.time, &input.tasks[visited], limits.leave_delay);
        if self.departure.has_left {
            self.visited = None;
        }
        (!away).then_some(visited)
    }

    /// Returns the time when the drone entered the path that it is on, if it is the path of this task.
    fn entered(&self, task: usize) -> Option<SimTime> {
        self.on_path.filter(|(before, _)| *before == task).map(|(_, since)| since)
    }
}

/// Detects when the drone moves away from a task.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct DepartureDetector {
    /// Distance (m), time of the last change, and whether the distance increased.
    last_distance_change: Option<(f64, SimTime, bool)>,
    /// The movement away from the task; `None` if there is none.
    departure: Option<Departure>,
    /// Whether the drone has left the task.
    has_left: bool,
}

/// A movement away from a place where a task may be left.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Departure {
    since: SimTime,
    /// Whether the pilot counts as leaving from the beginning.
    at_once: bool,
}

impl DepartureDetector {
    /// Returns whether the drone has left the task, or counts as leaving it.
    fn update(&mut self, now: SimTime, task: &TaskProximity, leave_delay: SimTime) -> bool {
        let known = self.last_distance_change;
        let (before_m, since, grows) = known.unwrap_or((task.distance_m, now, false));
        let by_m = task.distance_m - before_m;
        let moved = by_m.abs() >= MIN_MOVEMENT_M;
        if moved || known.is_none() {
            self.last_distance_change = Some((task.distance_m, now, by_m > 0.0));
        }
        let away = if moved { by_m > 0.0 } else { grows && now - since < MAX_MOVEMENT_AGE };
        let may_leave = task.at_path_end || task.done || self.departure.is_some();
        let at_once = task.at_path_end && task.flown_share >= MIN_SHARE_TO_LEAVE_AT_ONCE;
        self.departure = (away && may_leave).then(|| self.departure.unwrap_or(Departure { since: now, at_once }));
        self.has_left |= self.departure.is_some_and(|departure| now - departure.since >= leave_delay);
        self.has_left || self.departure.is_some_and(|departure| departure.at_once)
    }
}
