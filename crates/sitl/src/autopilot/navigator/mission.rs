//! Mission items and progress; `mission_executor.rs` flies them.

use super::mission_step::MissionStep;
use super::return_state::ReturnPhase;
use super::trajectory::Waypoint;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::time::SimTime;

/// Maximum number of consecutive non-flight items processed per tick. The rest follow in the next tick.
const MAX_STEPS_PER_TICK: usize = 64;
/// Planning horizon of a trajectory, m (longer than any stopping distance), and its maximum number of waypoints.
const PLANNING_HORIZON_M: f64 = 80.0;
const PLANNING_MAX_WAYPOINTS: usize = 24;

/// Saved state of an interrupted item. Takeoff, landing and return items continue from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SuspendedStep {
    /// Target, m.
    pub target_m: Vec3<Ned>,
    /// Phase of a return.
    pub phase: ReturnPhase,
    /// Destination of a return, m.
    pub return_target_m: Option<Vec3<Ned>>,
}

/// Fields that an item takes from the vehicle position when it starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DeferredFields {
    /// Horizontal position.
    pub place: bool,
    /// Height.
    pub height: bool,
}

impl DeferredFields {
    /// Replaces the deferred components of a position with those of `from_m`, m.
    #[must_use]
    pub fn resolve_deferred(self, position_m: Vec3<Ned>, from_m: Vec3<Ned>) -> Vec3<Ned> {
        let over = if self.place { from_m } else { position_m };
        Vec3::new(over.north(), over.east(), if self.height { from_m.down() } else { position_m.down() })
    }
}

/// Mission items and progress.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mission {
    steps: Vec<MissionStep>,
    /// Items whose heights are relative to home; the others are relative to the origin.
    home_relative: Vec<bool>,
    /// Deferred fields of each item.
    deferred: Vec<DeferredFields>,
    /// Vehicle position at the start of the current item with deferred fields, m.
    item_start_position_m: Option<Vec3<Ned>>,
    /// Increase in home height since the mission was set, m.
    home_rise_m: f64,
    jumps_done: Vec<u32>,
    /// Current item, zero-based.
    pub current: usize,
    /// End time of the current item's wait.
    pub wait_until: Option<SimTime>,
    /// Cruise speed that the mission set, m/s.
    pub speed_m_s: Option<f64>,
    /// Items that were reached but not yet reported.
    pub reached: Vec<usize>,
    /// Whether the current item has started.
    pub item_started: bool,
    /// Commands from passed items that have not been carried out yet.
    pub pending_commands: Vec<MissionStep>,
    /// Target of the initial climb of a mission without a takeoff item, m.
    pub initial_climb_target_m: Option<Vec3<Ned>>,
    /// Interruption point, m. The mission continues from there.
    pub interruption_point_m: Option<Vec3<Ned>>,
    /// Remaining wait of the interrupted item.
    pub suspended_wait: Option<SimTime>,
    /// Remaining arc of the interrupted circle, rad.
    pub suspended_arc_rad: Option<f64>,
    /// Saved state of the interrupted item.
    pub suspended_step: Option<SuspendedStep>,
}

impl Mission {
    /// Creates a mission from its items.
    #[must_use]
    pub fn new(steps: Vec<MissionStep>) -> Self {
        Self { jumps_done: vec![0; steps.len()], steps, ..Self::default() }
    }

    /// Marks the items whose heights are relative to home and move with it.
    pub fn set_home_relative_items(&mut self, home_relative: Vec<bool>) {
        self.home_relative = home_relative;
    }

    /// Sets the fields that items take from the vehicle position when they start.
    pub fn set_deferred(&mut self, deferred: Vec<DeferredFields>) {
        self.deferred = deferred;
    }

    /// Records the vehicle position at the start of the current item, m.
    pub fn begin_at(&mut self, here_m: Vec3<Ned>) {
        self.item_start_position_m.get_or_insert(here_m);
    }

    /// Accounts for an increase in home height, m.
    pub fn raise_home(&mut self, up_m: f64) {
        self.home_rise_m += up_m;
    }

    /// Returns true if there are no items.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// Records an interruption of the current item at a position from which the mission can continue.
    pub fn suspend_at(&mut self, position_m: Vec3<Ned>, step: SuspendedStep, arc_rad: Option<f64>, now: SimTime) {
        self.interruption_point_m = Some(position_m);
        self.suspended_step = Some(step);
        self.suspended_wait = self.wait_until.map(|until| until.saturating_sub(now));
        self.suspended_arc_rad = arc_rad;
    }

    /// Clears the saved state of an interrupted item.
    pub fn reset(&mut self) {
        (self.interruption_point_m, self.suspended_wait, self.suspended_arc_rad, self.suspended_step) = (None, None, None, None);
        self.initial_climb_target_m = None;
    }

    /// Landing position of the mission, m: the last landing item with a position.
    #[must_use]
    pub fn landing(&self) -> Option<Vec3<Ned>> {
        let lands = |k: &usize| matches!(self.step_at(*k), Some(MissionStep::Land { position_m: Some(_) }));
        (0..self.steps.len()).rev().find(lands).and_then(|k| self.position_at(k))
    }

    /// First position of the mission, m.
    #[must_use]
    pub fn first_position(&self) -> Option<Vec3<Ned>> {
        (0..self.steps.len()).find_map(|k| self.position_at(k))
    }

    fn position_at(&self, index: usize) -> Option<Vec3<Ned>> {
        match self.step_at(index)? {
            MissionStep::Waypoint { position_m, .. } => Some(position_m),
            MissionStep::Circle { center_m, .. } => Some(center_m),
            MissionStep::Land { position_m } => position_m,
            MissionStep::Takeoff { .. }
            | MissionStep::Return
            | MissionStep::Speed(_)
            | MissionStep::Delay(_)
            | MissionStep::DelayUntil(_)
            | MissionStep::Jump { .. }
            | MissionStep::LookAt(_)
            | MissionStep::Turn { .. }
            | MissionStep::Near(_)
            | MissionStep::Home(_)
            | MissionStep::Fence(_)
            | MissionStep::LandingSequence
            | MissionStep::Payload => None,
        }
    }

    /// Next position after the current item, m.
    #[must_use]
    pub fn next_position(&self) -> Option<Vec3<Ned>> {
        (self.current + 1..self.steps.len()).find_map(|k| self.position_at(k))
    }

    /// Waypoints from the current item up to the first at which the vehicle stops. `acceptance_radius_m` is the default acceptance
    /// radius.
    #[must_use]
    pub fn ahead(&self, acceptance_radius_m: f64) -> Vec<Waypoint> {
        let (mut at, mut jumps, mut speed) = (self.current, self.jumps_done.clone(), self.speed_m_s);
        // Items after a distance condition run en route, so the leg starts at the previous speed.
        let mut leg_speed: Option<Option<f64>> = None;
        let (mut ahead, mut length_m): (Vec<Waypoint>, f64) = (Vec::new(), 0.0);
        for _ in 0..MAX_STEPS_PER_TICK {
            let here = at;
            at += 1;
            match self.step_at(here) {
                Some(MissionStep::Waypoint { position_m, acceptance_radius_m: own_m, hold_s, .. }) => {
                    length_m += ahead.last().map_or(0.0, |last: &Waypoint| (position_m - last.position_m).norm());
                    let accept_m = if own_m > 0.0 { own_m } else { acceptance_radius_m };
                    ahead.push(Waypoint {
                        position_m,
                        speed_m_s: leg_speed.take().unwrap_or(speed),
                        acceptance_radius_m: accept_m,
                    });
                    if hold_s > 0.0 || ahead.len() >= PLANNING_MAX_WAYPOINTS || length_m > PLANNING_HORIZON_M {
                        break;
                    }
                }
                Some(MissionStep::Speed(other)) => speed = other,
                Some(MissionStep::Jump { to, times }) if jumps[here] < times && to < self.steps.len() => {
                    jumps[here] += 1;
                    at = to;
                }
                Some(MissionStep::Jump { .. }) => jumps[here] = 0,
                Some(MissionStep::Near(_)) => leg_speed = leg_speed.or(Some(speed)),
                Some(MissionStep::Payload | MissionStep::LookAt(_) | MissionStep::Fence(_)) => {}
                _ => break,
            }
        }
        ahead
    }

    /// Index of the landing sequence whose first position is nearest to `here_m`.
    #[must_use]
    pub fn landing_sequence(&self, here_m: Vec3<Ned>) -> Option<usize> {
        let away = |start: &usize| {
            let first = (*start + 1..self.steps.len()).find_map(|k| self.position_at(k));
            first.map_or(f64::INFINITY, |place| (place - here_m).horizontal_norm())
        };
        let starts = (0..self.steps.len()).filter(|k| self.steps[*k] == MissionStep::LandingSequence);
        starts.min_by(|a, b| away(a).total_cmp(&away(b)))
    }

    /// All items with their indices.
    pub fn all(&self) -> impl Iterator<Item = (usize, MissionStep)> {
        (0..self.steps.len()).filter_map(|k| Some((k, self.step_at(k)?)))
    }

    /// Restarts the mission as if it had never been flown.
    pub fn restart(&mut self) {
        self.reset_counters();
        self.jump(0);
    }

    /// Resets jump counters and mission speed.
    pub fn reset_counters(&mut self) {
        self.jumps_done.fill(0);
        self.speed_m_s = None;
    }

    /// The current item; `None` at the end.
    #[must_use]
    pub fn step(&self) -> Option<MissionStep> {
        self.step_at(self.current)
    }

    fn step_at(&self, index: usize) -> Option<MissionStep> {
        let hangs = self.home_relative.get(index).copied().unwrap_or(false);
        let rise_m = if hangs { self.home_rise_m } else { 0.0 };
        let mut step = match *self.steps.get(index)? {
            MissionStep::Waypoint { position_m, acceptance_radius_m: accept_m, hold_s, yaw_rad } => MissionStep::Waypoint {
                position_m: position_m - Vec3::new(0.0, 0.0, rise_m),
                acceptance_radius_m: accept_m,
                hold_s,
                yaw_rad,
            },
            MissionStep::Takeoff { up_m } => MissionStep::Takeoff { up_m: up_m.map(|up_m| up_m + rise_m) },
            MissionStep::Circle { center_m, radius_m, turns } => {
                MissionStep::Circle { center_m: center_m - Vec3::new(0.0, 0.0, rise_m), radius_m, turns }
            }
            MissionStep::Land { position_m: Some(place) } => {
                MissionStep::Land { position_m: Some(place - Vec3::new(0.0, 0.0, rise_m)) }
            }
            unchanged @ (MissionStep::Land { position_m: None }
            | MissionStep::Return
            | MissionStep::Speed(_)
            | MissionStep::Delay(_)
            | MissionStep::DelayUntil(_)
            | MissionStep::Jump { .. }
            | MissionStep::LookAt(_)
            | MissionStep::Turn { .. }
            | MissionStep::Near(_)
            | MissionStep::Home(_)
            | MissionStep::Fence(_)
            | MissionStep::LandingSequence
            | MissionStep::Payload) => unchanged,
        };
        let open = self.deferred.get(index).copied().unwrap_or_default();
        if let (Some(place_m), Some(began_m)) =
            (step.position_mut(), self.item_start_position_m.filter(|_| index == self.current))
        {
            *place_m = open.resolve_deferred(*place_m, began_m);
        }
        Some(step)
    }

    /// Jumps to an item. Returns false if it does not exist.
    pub fn jump(&mut self, index: usize) -> bool {
        let known = index < self.steps.len();
        if known {
            self.current = index;
            self.item_start_position_m = None;
            self.wait_until = None;
            self.item_started = false;
            self.reset();
        }
        known
    }

    /// Completes the current item, reports it and advances to the next item that involves flight or a wait. Returns
    /// false at the end.
    pub fn advance(&mut self, now: SimTime) -> bool {
        self.next();
        self.skip(now)
    }

    /// Processes and skips items that involve neither flight nor a wait. Returns false at the end.
    pub fn skip(&mut self, now: SimTime) -> bool {
        for _ in 0..MAX_STEPS_PER_TICK {
            match self.step() {
                None => return false,
                Some(MissionStep::Speed(speed)) => {
                    self.speed_m_s = speed;
                    self.next();
                }
                Some(command @ (MissionStep::LookAt(_) | MissionStep::Home(_) | MissionStep::Fence(_))) => {
                    self.pending_commands.push(command);
                    self.next();
                }
                Some(MissionStep::Payload | MissionStep::LandingSequence) => self.next(),
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
        self.item_start_position_m = None;
        self.wait_until = None;
        self.item_started = false;
        self.reset();
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
    fn exact_jump_repeats_specified_number_of_times() {
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
    fn exact_jump_loops_do_not_block_tick() {
        let mut mission = Mission::new(vec![MissionStep::Jump { to: 0, times: u32::MAX }]);
        // A tick processes a limited number of items, so this endless loop does not block it. The endpoint rejects such
        // a mission.
        assert!(mission.skip(SimTime::ZERO));
        assert_eq!(mission.reached.len(), MAX_STEPS_PER_TICK);
    }

    #[test]
    fn exact_non_flight_items_spread_over_ticks_and_can_restart() {
        let mut steps = vec![MissionStep::Payload; 3 * MAX_STEPS_PER_TICK];
        steps[5] = MissionStep::Speed(Some(7.0));
        steps.push(MissionStep::Delay(1.0));
        let mut mission = Mission::new(steps);
        for tick in 1..=4 {
            assert!(mission.skip(SimTime::ZERO));
            assert_eq!(mission.current, (tick * MAX_STEPS_PER_TICK).min(3 * MAX_STEPS_PER_TICK));
        }
        assert_eq!(mission.speed_m_s, Some(7.0));
        mission.restart();
        assert_eq!((mission.current, mission.speed_m_s), (0, None));
    }
}
