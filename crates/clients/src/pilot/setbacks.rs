//! What the pilot remembers of contacts and of getting stuck, and when they give a place or a task up.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::time::SimTime;

/// Radius of a place, m (estimate: a drone's width on either side of a bay).
const PLACE_RADIUS_M: f64 = 5.0;
/// Failed tries after which the pilot gives a place up (estimate).
const MAX_TRIES_PER_PLACE: u32 = 2;
/// Setbacks in one task after which the pilot gives the rest of the task up (estimate).
const MAX_SETBACKS_PER_TASK: u32 = 10;
/// Contacts within this time belong to the same setback, s (estimate: a bouncing drone).
const SAME_SETBACK_S: f64 = 3.0;

/// The pilot's decision after a setback.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SetbackDecision {
    /// Back off and try again.
    TryAgain,
    /// Leave out this place and continue behind it.
    LeaveOutPlace,
    /// Give the rest of the task up.
    GiveTaskUp,
}

/// Memory of setbacks.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Setbacks {
    places: Vec<(Vec3<Enu>, u32)>,
    in_task: u32,
    last: Option<SimTime>,
}

impl Setbacks {
    /// Notes a setback at a position and returns the decision; `None` if it belongs to the one before.
    pub fn note(&mut self, position_m: Vec3<Enu>, now: SimTime) -> Option<SetbackDecision> {
        let same = self.last.is_some_and(|last| (now - last).s() < SAME_SETBACK_S);
        self.last = Some(now);
        if same {
            return None;
        }
        self.in_task += 1;
        let near = |place: &&mut (Vec3<Enu>, u32)| (place.0 - position_m).norm() < PLACE_RADIUS_M;
        let tries = match self.places.iter_mut().find(near) {
            Some((_, tries)) => {
                *tries += 1;
                *tries
            }
            None => {
                self.places.push((position_m, 1));
                1
            }
        };
        Some(if self.in_task >= MAX_SETBACKS_PER_TASK {
            SetbackDecision::GiveTaskUp
        } else if tries >= MAX_TRIES_PER_PLACE {
            SetbackDecision::LeaveOutPlace
        } else {
            SetbackDecision::TryAgain
        })
    }

    /// Starts a new task: resets the count but remembers the places.
    pub fn begin_task(&mut self) {
        self.in_task = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(east_m: f64) -> Vec3<Enu> {
        Vec3::new(east_m, 0.0, 20.0)
    }

    #[test]
    fn exact_second_failure_at_a_place_gives_it_up() {
        let mut memory = Setbacks::default();
        assert_eq!(memory.note(at(0.0), SimTime::from_s(10.0)), Some(SetbackDecision::TryAgain));
        assert_eq!(memory.note(at(0.5), SimTime::from_s(11.0)), None, "a bounce");
        assert_eq!(memory.note(at(20.0), SimTime::from_s(30.0)), Some(SetbackDecision::TryAgain));
        assert_eq!(memory.note(at(1.0), SimTime::from_s(60.0)), Some(SetbackDecision::LeaveOutPlace));
    }

    #[test]
    fn exact_many_setbacks_end_the_task() {
        let mut memory = Setbacks::default();
        let decisions: Vec<Option<SetbackDecision>> = (1..=MAX_SETBACKS_PER_TASK)
            .map(|k| memory.note(at(20.0 * f64::from(k)), SimTime::from_s(10.0 * f64::from(k))))
            .collect();
        let (last, before) = decisions.split_last().expect("one for each setback");
        assert!(before.iter().all(|d| *d == Some(SetbackDecision::TryAgain)), "{decisions:?}");
        assert_eq!(*last, Some(SetbackDecision::GiveTaskUp));
        memory.begin_task();
        assert_eq!(memory.note(at(500.0), SimTime::from_s(500.0)), Some(SetbackDecision::TryAgain));
    }
}
