//! The mission's list and where it stands; `modes.rs` flies the steps.

use super::MissionStep;
use super::modes::ReturnPhase;
use crate::base::frames::{Ned, Vec3};
use crate::base::time::SimTime;

/// Steps without flight that follow each other in one tick; more of them go on in the next.
const GO_ON_MAX: usize = 64;

/// The course of a step that was left: take-off, landing and return go on with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeftCourse {
    /// Where it flew to, m.
    pub target_m: Vec3<Ned>,
    /// How far it had come.
    pub phase: ReturnPhase,
    /// Where a return went, m.
    pub refuge_m: Option<Vec3<Ned>>,
}

/// The list and its progress.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mission {
    steps: Vec<MissionStep>,
    /// Steps whose heights count from home; the others' from the origin.
    over_home: Vec<bool>,
    /// Home has risen by this much since the list came, m.
    home_rise_m: f64,
    jumps_done: Vec<u32>,
    /// Current step.
    pub current: usize,
    /// The current step's waiting ends at this time.
    pub wait_until: Option<SimTime>,
    /// Cruise speed set by the mission, m/s.
    pub speed_m_s: Option<f64>,
    /// Steps reached and not yet reported.
    pub reached: Vec<usize>,
    /// The current step has been begun.
    pub begun: bool,
    /// Steps that were passed and order something of the autopilot, not yet carried out.
    pub orders: Vec<MissionStep>,
    /// Where it was left on its way, m: it goes on from there.
    pub left_at: Option<Vec3<Ned>>,
    /// What was left then of the current step's waiting.
    pub left_wait: Option<SimTime>,
    /// What was left then of the current step's circle, rad.
    pub left_rad: Option<f64>,
    /// The course of the current step then.
    pub left_course: Option<LeftCourse>,
}

impl MissionStep {
    /// It takes its time: left in the middle it goes on there.
    pub(super) fn goes_on(&self) -> bool {
        use MissionStep as S;
        match self {
            S::Waypoint { .. } | S::Takeoff { .. } | S::Land { .. } | S::Return | S::Delay(_) => true,
            S::Circle { .. } | S::Turn { .. } | S::Near(_) => true,
            S::Speed(_) | S::Jump { .. } | S::LookAt(_) | S::Home(_) | S::Fence(_) | S::Payload => false,
        }
    }
}

impl Mission {
    /// From a list.
    #[must_use]
    pub fn new(steps: Vec<MissionStep>) -> Self {
        Self { jumps_done: vec![0; steps.len()], steps, ..Self::default() }
    }

    /// Names the steps whose heights count from home: they rise and sink with it.
    pub fn hang_on_home(&mut self, over_home: Vec<bool>) {
        self.over_home = over_home;
    }

    /// Home has moved up by so much, m.
    pub fn raise_home(&mut self, up_m: f64) {
        self.home_rise_m += up_m;
    }

    /// Nothing to fly.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// It is left in the middle of a step, and will go on here.
    pub fn leave(&mut self, place_m: Vec3<Ned>, course: LeftCourse, left_rad: Option<f64>, now: SimTime) {
        self.left_at = Some(place_m);
        self.left_course = Some(course);
        self.left_wait = self.wait_until.map(|until| until.saturating_sub(now));
        self.left_rad = left_rad;
    }

    /// What was left of the current step counts no more.
    pub fn begin_anew(&mut self) {
        (self.left_at, self.left_wait, self.left_rad, self.left_course) = (None, None, None, None);
    }

    fn place_at(&self, index: usize) -> Option<Vec3<Ned>> {
        match self.step_at(index)? {
            MissionStep::Waypoint { position_m, .. } => Some(position_m),
            MissionStep::Circle { centre_m, .. } => Some(centre_m),
            MissionStep::Land { position_m } => position_m,
            _ => None,
        }
    }

    /// The next place behind the current step, m.
    #[must_use]
    pub fn next_place(&self) -> Option<Vec3<Ned>> {
        (self.current + 1..self.steps.len()).find_map(|k| self.place_at(k))
    }

    /// All steps with their numbers.
    pub fn all(&self) -> impl Iterator<Item = (usize, MissionStep)> {
        (0..self.steps.len()).filter_map(|k| Some((k, self.step_at(k)?)))
    }

    /// From the beginning, as if it had never been flown.
    pub fn restart(&mut self) {
        self.forget();
        self.jump(0);
    }

    /// Nothing has been flown yet: jumps count from the beginning, the speed is the usual one.
    pub fn forget(&mut self) {
        self.jumps_done.fill(0);
        self.speed_m_s = None;
    }

    /// The step to fly now; `None` at the end.
    #[must_use]
    pub fn step(&self) -> Option<MissionStep> {
        self.step_at(self.current)
    }

    fn step_at(&self, index: usize) -> Option<MissionStep> {
        let hangs = self.over_home.get(index).copied().unwrap_or(false);
        let rise_m = if hangs { self.home_rise_m } else { 0.0 };
        Some(match *self.steps.get(index)? {
            MissionStep::Waypoint { position_m, accept_m, hold_s, yaw_rad } => {
                MissionStep::Waypoint { position_m: position_m - Vec3::new(0.0, 0.0, rise_m), accept_m, hold_s, yaw_rad }
            }
            MissionStep::Takeoff { up_m } => MissionStep::Takeoff { up_m: up_m.map(|up_m| up_m + rise_m) },
            MissionStep::Circle { centre_m, radius_m, turns } => {
                MissionStep::Circle { centre_m: centre_m - Vec3::new(0.0, 0.0, rise_m), radius_m, turns }
            }
            MissionStep::Land { position_m: Some(place) } => {
                MissionStep::Land { position_m: Some(place - Vec3::new(0.0, 0.0, rise_m)) }
            }
            other => other,
        })
    }

    /// Goes to a step; false when there is none.
    pub fn jump(&mut self, index: usize) -> bool {
        let known = index < self.steps.len();
        if known {
            self.current = index;
            self.wait_until = None;
            self.begun = false;
            self.begin_anew();
        }
        known
    }

    /// The current step is done: reports it and takes the next that flies or waits. False at the end.
    pub fn advance(&mut self, now: SimTime) -> bool {
        self.next();
        self.skip(now)
    }

    /// Passes over steps that neither fly nor wait. False at the end.
    pub fn skip(&mut self, now: SimTime) -> bool {
        for _ in 0..GO_ON_MAX {
            match self.step() {
                None => return false,
                Some(MissionStep::Speed(speed)) => {
                    self.speed_m_s = speed;
                    self.next();
                }
                Some(order @ (MissionStep::LookAt(_) | MissionStep::Home(_) | MissionStep::Fence(_))) => {
                    self.orders.push(order);
                    self.next();
                }
                Some(MissionStep::Payload) => self.next(),
                Some(MissionStep::Jump { to, times }) => self.repeat(to, times),
                Some(MissionStep::Delay(s)) => {
                    self.wait_until = self.wait_until.or(Some(now + SimTime::from_s(s.clamp(0.0, 86_400.0))));
                    return true;
                }
                Some(_) => return true,
            }
        }
        true
    }

    fn next(&mut self) {
        self.reached.push(self.current);
        self.current += 1;
        self.wait_until = None;
        self.begun = false;
        self.begin_anew();
    }

    fn repeat(&mut self, to: usize, times: u32) {
        let here = self.current;
        if self.jumps_done[here] < times && to < self.steps.len() {
            self.jumps_done[here] += 1;
            self.reached.push(here);
            self.jump(to);
        } else {
            self.jumps_done[here] = 0;
            self.next();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_jump_repeats_as_often_as_it_says() {
        let wait = MissionStep::Delay(1.0);
        let mut mission = Mission::new(vec![wait, MissionStep::Jump { to: 0, times: 2 }, wait]);
        let mut visits = Vec::new();
        let mut going = mission.skip(SimTime::ZERO);
        while going {
            visits.push(mission.current);
            going = mission.advance(SimTime::ZERO);
        }
        assert_eq!(visits, [0, 0, 0, 2]);
    }

    #[test]
    fn exact_jumps_in_a_ring_stop_no_tick() {
        let mut mission = Mission::new(vec![MissionStep::Jump { to: 0, times: u32::MAX }]);
        // Only so many in one tick; the endpoint refuses such a list.
        assert!(mission.skip(SimTime::ZERO));
        assert_eq!(mission.reached.len(), GO_ON_MAX);
    }

    #[test]
    fn exact_a_long_row_of_steps_without_flight_is_passed_in_several_ticks_and_started_anew_as_it_was() {
        let mut steps = vec![MissionStep::Payload; 3 * GO_ON_MAX];
        steps[5] = MissionStep::Speed(Some(7.0));
        steps.push(MissionStep::Delay(1.0));
        let mut mission = Mission::new(steps);
        for tick in 1..=4 {
            assert!(mission.skip(SimTime::ZERO));
            assert_eq!(mission.current, (tick * GO_ON_MAX).min(3 * GO_ON_MAX));
        }
        assert_eq!(mission.speed_m_s, Some(7.0));
        mission.restart();
        assert_eq!((mission.current, mission.speed_m_s), (0, None));
    }
}
