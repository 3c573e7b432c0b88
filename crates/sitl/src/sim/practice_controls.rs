//! Freeze, and the earlier states of the aircraft for a rewind, as plain data.

use crate::physics::PhysicsState;
use spandrel_mavlink::contract::practice::MAX_REWIND;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Interval between the states that are kept for a rewind.
pub(super) const KEPT_STATE_INTERVAL: SimTime = SimTime::from_ms(1_000);
/// Number of kept states: enough for the longest rewind, with one more because a request rarely falls on the interval.
const MAX_KEPT_STATES: usize = (MAX_REWIND.ns() / KEPT_STATE_INTERVAL.ns()) as usize + 1;

/// State of the aircraft at an earlier time.
#[derive(Debug, Clone)]
pub(super) struct EarlierState {
    /// Time of the flight, without what was undone by rewinds.
    at: SimTime,
    pub physics: PhysicsState,
    /// Last safe hover: position and heading in rad.
    pub safe_hover: (Vec3<Ned>, f64),
}

/// Whether simulation time is stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Freeze {
    #[default]
    Off,
    /// After a rewind; simulation time stops at `at`.
    Due {
        /// Time of the freeze.
        at: SimTime,
        /// Whether a stick resumes the flight afterwards; otherwise only a request does.
        then_until_stick: bool,
    },
    /// Until it is resumed by a request.
    On,
    /// Until it is resumed by a request, or a stick moves away from its center.
    UntilStick {
        /// Whether all sticks have been centered since the rewind.
        is_centered: bool,
    },
}

/// Freezes, rewinds, and the earlier states of the aircraft.
#[derive(Debug, Clone, Default)]
pub(super) struct PracticeControls {
    /// Whether all requests are refused.
    pub is_forbidden: bool,
    /// Whether simulation time is stopped.
    pub freeze: Freeze,
    /// Oldest first.
    kept: VecDeque<EarlierState>,
    /// Flight time that rewinds have undone.
    undone: SimTime,
}

impl PracticeControls {
    /// Returns whether there is a state to go back to.
    pub fn has_states(&self) -> bool {
        !self.kept.is_empty()
    }

    /// Keeps the state of the aircraft at simulation time `now`.
    pub fn keep(&mut self, now: SimTime, physics: &PhysicsState, safe_hover: (Vec3<Ned>, f64)) {
        if self.kept.len() == MAX_KEPT_STATES {
            self.kept.pop_front();
        }
        self.kept.push_back(EarlierState { at: now - self.undone, physics: physics.clone(), safe_hover });
    }

    /// Goes back by at least `by` or, without a state that old, to the oldest one. Forgets all newer states. Returns the state and
    /// the time of flight that is undone; `None` without a state.
    pub fn take(&mut self, now: SimTime, by: SimTime) -> Option<(EarlierState, SimTime)> {
        let flown = now - self.undone;
        let older = self.kept.partition_point(|state| state.at <= flown - by);
        self.kept.truncate(older.max(1));
        let state = self.kept.back()?.clone();
        let undone = flown - state.at;
        self.undone += undone;
        Some((state, undone))
    }
}
