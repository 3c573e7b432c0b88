//! Holding position: a very short path is held for a while instead of flown. The pilot trusts the display, which shows whether
//! the aircraft is on the path, more than their own judgment.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::{HOLD_DURATION, Task};
use spandrel_model::time::SimTime;

/// Time after which the pilot goes on in any case, s (estimate).
const MAX_HOLD_DURATION_S: f64 = 60.0;

/// Progress of holding position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hold {
    since: SimTime,
    on_path_since: Option<SimTime>,
}

impl Hold {
    /// Starts to hold position.
    #[must_use]
    pub fn new(now: SimTime) -> Self {
        Self { since: now, on_path_since: None }
    }

    /// Updates with what the display shows, and returns whether the pilot goes on.
    pub fn step(&mut self, on_path: bool, now: SimTime) -> bool {
        self.on_path_since = on_path.then(|| self.on_path_since.unwrap_or(now));
        let held = self.on_path_since.is_some_and(|since| now - since >= HOLD_DURATION);
        held || (now - self.since).s() >= MAX_HOLD_DURATION_S
    }
}

/// Returns the distance to a task's path that the display shows, m.
#[must_use]
pub fn distance_to_path_m(task: &Task, position_m: Vec3<Enu>) -> f64 {
    task.path_m.iter().map(|p| (*p - position_m).norm()).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::{scenario, shipped};

    #[test]
    fn exact_hold_counts_uninterrupted_time_on_the_path() {
        let mut hold = Hold::new(SimTime::ZERO);
        let at = SimTime::from_s;
        assert!(!hold.step(true, at(1.0)));
        assert!(!hold.step(false, at(5.0)), "a gust");
        assert!(!hold.step(true, at(6.0)));
        assert!(!hold.step(true, at(6.0 + 0.99 * HOLD_DURATION.s())));
        assert!(hold.step(true, at(6.0 + HOLD_DURATION.s())));
    }

    #[test]
    fn exact_pilot_who_never_gets_on_the_path_gives_up() {
        let mut hold = Hold::new(SimTime::ZERO);
        assert!(!hold.step(false, SimTime::from_s(0.99 * MAX_HOLD_DURATION_S)));
        assert!(hold.step(false, SimTime::from_s(MAX_HOLD_DURATION_S)));
    }

    #[test]
    fn exact_only_the_hover_drill_is_held() {
        let no_files = |name: &str| Err(format!("{name}: not found"));
        for (file, text) in shipped::SCENARIOS {
            let job = scenario::read(file, text, &no_files).expect("valid");
            for task in &job.tasks {
                assert_eq!(task.is_hold_position(), job.name == "drill-hover", "{file}, task {}", task.id);
            }
        }
    }
}
