//! Requests to the navigator and their outcomes.

use super::Navigator;
use super::input::NavigatorInput;
use super::mission_step::MissionStep;
use crate::autopilot::events::Severity;
use crate::autopilot::failsafe::fence_check::FenceCheck;
use crate::autopilot::failsafe::operator_rules::MissionRequirement;
use crate::autopilot::flight_state::FlightMode;
use crate::autopilot::request::{AutopilotRequest, RequestOutcome, TurnCommand};
use spandrel_model::frames::{Ned, Vec3};

/// Largest height or distance that a request may contain, m.
const MAX_DISTANCE_M: f64 = 20_000.0;
/// Throttle stick position above which thrust exceeds half of the hover thrust (ArduPilot: get_non_takeoff_throttle).
const HALF_HOVER_THROTTLE_POSITION: f64 = -0.5;

impl Navigator {
    /// Handles a request and returns its outcome.
    pub fn request(&mut self, request: AutopilotRequest, input: &NavigatorInput) -> RequestOutcome {
        match request {
            AutopilotRequest::SetMode(mode) => self.set_mode(mode, input),
            AutopilotRequest::Takeoff { height_m } => self.request_takeoff(height_m, input),
            AutopilotRequest::Land => self.set_mode(FlightMode::Land, input),
            AutopilotRequest::GoTo { north_east_m, up_m, yaw_rad, speed_m_s } => {
                self.go_to(north_east_m, up_m, yaw_rad, speed_m_s, input)
            }
            AutopilotRequest::Turn(turn) => self.turn_by_command(turn, input),
            AutopilotRequest::StartMission { first } => self.start_mission(first, input),
            AutopilotRequest::SetSpeed(speed) => self.set_speed(speed, input),
            AutopilotRequest::SetHome(home) => self.set_home(home),
            AutopilotRequest::EnableFence(enabled) => {
                self.switch_fence(enabled);
                RequestOutcome::Accepted
            }
            // The autopilot object handles arming and disarming.
            AutopilotRequest::Arm { .. } | AutopilotRequest::Disarm { .. } => RequestOutcome::Unsupported,
            AutopilotRequest::Orbit(request) => self.request_orbit(request, input),
            AutopilotRequest::CircleAhead => self.request_circle_ahead(input),
            AutopilotRequest::LandingSequence => self.request_landing_sequence(input),
            AutopilotRequest::Pause(pause) => self.pause(pause, input),
            AutopilotRequest::LookAt(place) => {
                self.commanded.look_at_m = place;
                RequestOutcome::Accepted
            }
        }
    }

    fn set_mode(&mut self, mode: FlightMode, input: &NavigatorInput) -> RequestOutcome {
        if let Some(refusal) = self.refusal(mode, input) {
            return refusal;
        }
        let again = self.modes.intended == mode && self.modes.active == mode;
        if mode == FlightMode::Mission && !again && input.tuning.rules.mission_restarts {
            self.mission.restart();
        }
        self.modes.intended = mode;
        self.modes.overridden = false;
        if mode == FlightMode::Mission {
            self.restart_finished_mission();
        }
        if !again {
            self.enter(mode, input);
        } else if mode == FlightMode::Mission {
            self.resume(input);
        }
        RequestOutcome::Accepted
    }

    fn refusal(&self, mode: FlightMode, input: &NavigatorInput) -> Option<RequestOutcome> {
        let flying = input.is_flying();
        if mode == FlightMode::Mission && self.mission.is_empty() {
            return Some(RequestOutcome::Denied("No mission to fly".into()));
        }
        if mode == FlightMode::Mission
            && let Some(why) = self.mission_leaves_fence(input).or_else(|| self.missing_mission_parts(input))
        {
            return Some(RequestOutcome::Denied(why));
        }
        if self.throttle_too_high(mode, input) {
            return Some(RequestOutcome::Denied("throttle too high".into()));
        }
        if mode == FlightMode::Orbit && self.orbit.is_none() {
            return Some(RequestOutcome::Denied("No orbit defined: send DO_ORBIT first".into()));
        }
        if mode == FlightMode::Offboard && !input.has_recent_offboard() {
            return Some(RequestOutcome::TemporarilyRejected("Offboard rejected: no external setpoints".into()));
        }
        let counts = flying || input.armed && input.tuning.arming_depends_on_mode;
        if counts && mode.needs_position() && !input.estimate.position_valid {
            return Some(RequestOutcome::TemporarilyRejected("No position estimate".into()));
        }
        if mode == FlightMode::SmartReturn && flying && self.flown_path.is_empty() {
            return Some(RequestOutcome::Denied("No path recorded since takeoff".into()));
        }
        if mode == FlightMode::Follow && !input.tuning.follow.enabled {
            return Some(RequestOutcome::Denied("Set FOLL_ENABLE = 1".into()));
        }
        if mode == FlightMode::Return && self.home.position_m.is_none() {
            return Some(RequestOutcome::TemporarilyRejected("No home position".into()));
        }
        None
    }

    /// Returns true on the ground if the throttle stick is so high that the vehicle would take off immediately in a
    /// mode with direct throttle.
    fn throttle_too_high(&self, mode: FlightMode, input: &NavigatorInput) -> bool {
        let direct = |mode: FlightMode| matches!(mode, FlightMode::Stabilized | FlightMode::Acro);
        let high = input.links.sticks.up > HALF_HOVER_THROTTLE_POSITION && input.has_recent_sticks();
        let standing = !input.is_flying();
        input.tuning.arming_depends_on_mode && standing && high && direct(mode) && !direct(self.modes.intended)
    }

    /// Returns the reason why the mission does not meet the operator's requirements, or `None`.
    fn missing_mission_parts(&self, input: &NavigatorInput) -> Option<String> {
        let rules = &input.tuning.rules;
        let takeoff = self.mission.all().any(|(_, step)| matches!(step, MissionStep::Takeoff { .. }));
        let landing = self.mission.all().any(|(_, step)| matches!(step, MissionStep::Land { .. } | MissionStep::Return));
        let (needs_takeoff, needs_landing) = match rules.mission_requirement {
            MissionRequirement::Nothing => (false, false),
            MissionRequirement::Takeoff => (true, false),
            MissionRequirement::Landing => (false, true),
            MissionRequirement::Both => (true, true),
            MissionRequirement::BothOrNeither => (landing, takeoff),
        };
        if needs_takeoff && !takeoff {
            return Some("Mission has no takeoff item".into());
        }
        if needs_landing && !landing {
            return Some("Mission has no landing item".into());
        }
        let home = self.home.position_m?;
        let away_m = (self.mission.first_position()? - home).horizontal_norm();
        let too_far = rules.max_first_waypoint_distance_m > 0.0 && away_m > rules.max_first_waypoint_distance_m;
        too_far.then(|| {
            format!("First waypoint too far from home: {away_m:.0} m, limit {:.0} m", rules.max_first_waypoint_distance_m)
        })
    }

    pub(super) fn restart_finished_mission(&mut self) {
        if self.mission.step().is_none() {
            self.mission.restart();
        }
        self.mission_status.finished = false;
        self.mission_status.current = self.mission.current;
    }

    fn request_takeoff(&mut self, height_m: Option<f64>, input: &NavigatorInput) -> RequestOutcome {
        if height_m.is_some_and(|h| !h.is_finite() || h.abs() > MAX_DISTANCE_M) {
            return RequestOutcome::Denied("Takeoff altitude out of range".into());
        }
        let here = input.here();
        let home_up = self.home.up_m();
        let wanted_up = home_up + height_m.unwrap_or(input.tuning.takeoff_height_m);
        let up = -here.down();
        if wanted_up > up
            && let Some(refusal) = self.target_refusal(Vec3::new(here.north(), here.east(), -wanted_up), input)
        {
            return refusal;
        }
        let before = self.commanded.takeoff_target_height_m.replace(wanted_up);
        if input.is_flying() && self.commanded.takeoff_target_height_m.is_some_and(|wanted| up >= wanted) {
            self.events.push(Severity::Info, "Already above takeoff altitude");
            return self.set_mode(FlightMode::Hold, input);
        }
        let outcome = self.set_mode(FlightMode::Takeoff, input);
        if outcome != RequestOutcome::Accepted {
            self.commanded.takeoff_target_height_m = before;
        }
        if self.modes.active == FlightMode::Takeoff {
            self.enter(FlightMode::Takeoff, input);
        }
        outcome
    }

    fn go_to(
        &mut self,
        north_east_m: Option<(f64, f64)>,
        up_m: Option<f64>,
        yaw_rad: Option<f64>,
        speed_m_s: Option<f64>,
        input: &NavigatorInput,
    ) -> RequestOutcome {
        let given = [north_east_m.map(|p| p.0), north_east_m.map(|p| p.1), up_m, yaw_rad, speed_m_s];
        if given.iter().flatten().any(|v| !v.is_finite() || v.abs() > MAX_DISTANCE_M) {
            return RequestOutcome::Denied("Target out of range".into());
        }
        if !input.is_flying() {
            return RequestOutcome::TemporarilyRejected("Not flying".into());
        }
        if !input.estimate.position_valid {
            return RequestOutcome::TemporarilyRejected("No position estimate".into());
        }
        let here = input.here();
        let (n, e) = north_east_m.unwrap_or((here.north(), here.east()));
        if north_east_m.is_some() || up_m.is_some() {
            let target = Vec3::new(n, e, up_m.map_or(here.down(), |up| -up));
            if let Some(refusal) = self.target_refusal(target, input) {
                return refusal;
            }
        }
        self.modes.intended = FlightMode::Hold;
        self.modes.overridden = false;
        self.enter(FlightMode::Hold, input);
        let held = self.target_m;
        let (n, e) = north_east_m.unwrap_or((held.north(), held.east()));
        self.target_m = Vec3::new(n, e, up_m.map_or(held.down(), |u| -u));
        self.heading.target_rad = yaw_rad;
        self.speed_m_s = Some(speed_m_s.filter(|s| *s > 0.0).unwrap_or(self.cruise_m_s(input)));
        RequestOutcome::Accepted
    }

    /// Turns without a mode change: a mission continues, and a pilot keeps control.
    fn turn_by_command(&mut self, turn: TurnCommand, input: &NavigatorInput) -> RequestOutcome {
        let automatic = matches!(
            self.modes.active,
            FlightMode::Hold | FlightMode::Takeoff | FlightMode::Land | FlightMode::Mission | FlightMode::Offboard
        );
        if !input.is_flying() || !automatic {
            return RequestOutcome::TemporarilyRejected("Not in an automatic mode".into());
        }
        self.commanded.look_at_m = None;
        self.heading.command(turn);
        self.heading.end_pilot_turn();
        RequestOutcome::Accepted
    }

    fn start_mission(&mut self, first: Option<usize>, input: &NavigatorInput) -> RequestOutcome {
        if self.mission.is_empty() {
            return RequestOutcome::Denied("Mission start denied: no mission".into());
        }
        if first.is_some_and(|index| !self.set_mission_current(index, false)) {
            return RequestOutcome::Denied("No such mission item".into());
        }
        let outcome = self.set_mode(FlightMode::Mission, input);
        self.mission_status.started = outcome == RequestOutcome::Accepted;
        outcome
    }

    /// Flies the landing sequence nearest to the current position.
    fn request_landing_sequence(&mut self, input: &NavigatorInput) -> RequestOutcome {
        let here = input.here();
        let Some(index) = self.mission.landing_sequence(here) else {
            return RequestOutcome::Failed("No return path or landing sequence found".into());
        };
        self.set_mission_current(index, false);
        let outcome = self.set_mode(FlightMode::Mission, input);
        if outcome == RequestOutcome::Accepted {
            self.enter(FlightMode::Mission, input);
        }
        outcome
    }

    fn set_speed(&mut self, speed_m_s: Option<f64>, input: &NavigatorInput) -> RequestOutcome {
        if speed_m_s.is_some_and(|speed| !(speed.is_finite() && speed > 0.0)) {
            return RequestOutcome::Denied("Speed out of range".into());
        }
        self.commanded.speed_m_s = speed_m_s;
        if self.speed_m_s.is_some() {
            self.speed_m_s = Some(self.cruise_m_s(input));
        }
        RequestOutcome::Accepted
    }

    fn set_home(&mut self, home_m: Vec3<Ned>) -> RequestOutcome {
        if !home_m.is_finite() || home_m.norm() > MAX_DISTANCE_M {
            return RequestOutcome::Denied("Home position out of range".into());
        }
        self.move_home(home_m);
        self.home.set_by_command = true;
        RequestOutcome::Accepted
    }

    /// Moves home, along with the heights that are relative to it.
    pub(super) fn move_home(&mut self, home_m: Vec3<Ned>) {
        let rise_m = self.home.move_to(home_m);
        self.mission.raise_home(rise_m);
    }

    /// Requests that the geofence be enabled or disabled, and reports the change.
    pub(super) fn switch_fence(&mut self, enabled: bool) {
        self.fence_switch = Some(enabled);
        self.events.push(Severity::Info, if enabled { "Geofence enabled" } else { "Geofence disabled" });
    }

    /// Returns the geofence check with the current settings.
    pub(super) fn fence_check<'a>(&self, input: &NavigatorInput<'a>) -> FenceCheck<'a> {
        FenceCheck::new(input.fence, input.tuning, self.home.position_m)
    }

    /// Returns the rejection if a target is outside the fence, or `None` if the target is allowed.
    fn target_refusal(&self, target_m: Vec3<Ned>, input: &NavigatorInput) -> Option<RequestOutcome> {
        let from = input.estimate.position_valid.then_some(input.here());
        self.fence_check(input).target_refusal(from, target_m).map(|why| RequestOutcome::Denied(why.into()))
    }

    /// Returns the reason to reject the mission: the first item that is outside the fence or whose straight approach
    /// leaves the fence.
    fn mission_leaves_fence(&self, input: &NavigatorInput) -> Option<String> {
        let (fence, flying, here) = (self.fence_check(input), input.is_flying(), input.here());
        let home = self.home.position_m.unwrap_or_default();
        let start = if flying { here } else { home };
        let mut from = (self.mission.current == 0 && fence.breach_at(start).is_none()).then_some(start);
        for (index, step) in self.mission.all() {
            let number = index + input.tuning.first_item;
            let outside = format!("Mission item {number} outside geofence");
            let to = match step {
                MissionStep::Waypoint { position_m, .. } | MissionStep::Land { position_m: Some(position_m) } => position_m,
                MissionStep::Circle { center_m, radius_m, .. } if fence.circle_leaves_fence(center_m, radius_m.abs()) => {
                    return Some(outside);
                }
                MissionStep::Circle { center_m, .. } => center_m,
                MissionStep::Takeoff { up_m } => {
                    let over = from.unwrap_or(home);
                    Vec3::new(over.north(), over.east(), -up_m.unwrap_or_else(|| self.default_takeoff_height_m(input)))
                }
                MissionStep::Land { position_m: None }
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
                | MissionStep::Payload => continue,
            };
            if fence.breach_at(to).is_some() {
                return Some(outside);
            }
            if from.is_some_and(|from| fence.path_leaves_fence(from, to)) {
                return Some(format!("Path to mission item {number} leaves geofence"));
            }
            from = Some(to);
        }
        let back = self.mission.interruption_point_m.filter(|_| flying && fence.breach_at(here).is_none());
        let cut_off = back.is_some_and(|place| fence.path_leaves_fence(here, place));
        cut_off.then(|| "Return path to mission leaves geofence".into())
    }
}
