//! Flying an uploaded mission step by step.

use super::{Estimate, MissionStep, Ned, Vec3};
use crate::base::time::SimTime;

/// A mission and how far it has been flown.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MissionRun {
    steps: Vec<MissionStep>,
    current: usize,
    reached: Option<usize>,
    since: Option<SimTime>,
    jumps_left: Vec<u32>,
    finished: bool,
}

/// What the present step wants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wanted {
    /// Fly there.
    Point {
        /// Where, m.
        position_m: Vec3<Ned>,
        /// Heading, rad; `None`: towards it.
        yaw_rad: Option<f64>,
    },
    /// Climb here.
    Climb {
        /// Height, m up about the origin.
        up_m: f64,
    },
    /// A new cruise speed, m/s.
    Speed(f64),
    /// Land here.
    Land,
    /// Return home.
    Return,
    /// Wait.
    Stay,
    /// The end.
    Done,
}

/// A take-off counts as reached within this, m.
const CLIMB_M: f64 = 0.5;

impl MissionRun {
    /// From its steps, at the first.
    #[must_use]
    pub fn new(steps: Vec<MissionStep>) -> Self {
        let jumps_left = steps.iter().map(|s| if let MissionStep::Jump { times, .. } = s { *times } else { 0 }).collect();
        Self { steps, jumps_left, ..Self::default() }
    }

    /// Nothing uploaded.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// Present item.
    #[must_use]
    pub fn current(&self) -> usize {
        self.current
    }

    /// Flown to its end.
    #[must_use]
    pub fn finished(&self) -> bool {
        self.finished
    }

    /// The item reached since the last call.
    pub fn take_reached(&mut self) -> Option<usize> {
        self.reached.take()
    }

    /// Goes to an item; false when there is none.
    pub fn jump(&mut self, index: usize) -> bool {
        let there = index < self.steps.len();
        if there {
            self.current = index;
            self.since = None;
            self.finished = false;
        }
        there
    }

    /// Goes on; a finished mission starts again.
    pub fn resume(&mut self) {
        if self.finished {
            self.jump(0);
        }
        self.since = None;
    }

    fn next(&mut self) {
        self.reached = Some(self.current);
        self.current += 1;
        self.since = None;
        if self.current >= self.steps.len() {
            self.finished = true;
            self.current = self.steps.len().saturating_sub(1);
        }
    }

    /// What is wanted now; several steps that take no time may pass at once.
    pub fn step(&mut self, e: &Estimate, now: SimTime) -> Wanted {
        if self.finished {
            return Wanted::Done;
        }
        match self.steps.get(self.current).copied() {
            None => Wanted::Done,
            Some(MissionStep::Waypoint { position_m, accept_m, hold_s, yaw_rad }) => {
                self.wait_at(position_m, accept_m, hold_s, e, now);
                Wanted::Point { position_m, yaw_rad }
            }
            Some(MissionStep::Takeoff { up_m }) => {
                if -e.position_m.down() > up_m - CLIMB_M {
                    self.next();
                }
                Wanted::Climb { up_m }
            }
            Some(MissionStep::Land { position_m: Some(place) }) => {
                let over = Vec3::<Ned>::new(place.north(), place.east(), e.position_m.down());
                if (e.position_m - over).norm() < 0.7 {
                    self.next();
                    return Wanted::Land;
                }
                Wanted::Point { position_m: over, yaw_rad: None }
            }
            Some(MissionStep::Land { position_m: None }) => {
                self.next();
                Wanted::Land
            }
            Some(MissionStep::Return) => {
                self.next();
                Wanted::Return
            }
            Some(MissionStep::Speed(speed)) => {
                self.next();
                Wanted::Speed(speed)
            }
            Some(MissionStep::Delay(seconds)) => {
                if (now - *self.since.get_or_insert(now)).s() >= seconds {
                    self.next();
                }
                Wanted::Stay
            }
            Some(MissionStep::Jump { to, .. }) => {
                self.take_jump(to);
                Wanted::Stay
            }
            Some(MissionStep::Payload) => {
                self.next();
                Wanted::Stay
            }
        }
    }

    fn wait_at(&mut self, position_m: Vec3<Ned>, accept_m: f64, hold_s: f64, e: &Estimate, now: SimTime) {
        if self.since.is_none() && (e.position_m - position_m).norm() <= accept_m {
            self.since = Some(now);
        }
        if self.since.is_some_and(|since| (now - since).s() >= hold_s) {
            self.next();
        }
    }

    fn take_jump(&mut self, to: usize) {
        let at = self.current;
        if self.jumps_left[at] > 0 && to < self.steps.len() {
            self.jumps_left[at] -= 1;
            self.current = to;
            self.since = None;
        } else {
            self.next();
        }
    }
}
