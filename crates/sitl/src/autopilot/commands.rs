//! Requests and their outcomes.

use super::core::{Autopilot, Severity};
use super::operator_rules::{FenceSwitching, MissionNeeds};
use super::{AutopilotRequest, FlightMode, LandedState, MissionStep, RequestOutcome, TurnCommand};
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::time::SimTime;

/// Limit beyond which heights and distances are rejected as errors, m.
const FAR_M: f64 = 20_000.0;

/// Throttle stick position above which thrust exceeds half of the hover thrust (ArduPilot: get_non_takeoff_throttle).
const LEAP: f64 = -0.5;

impl Autopilot {
    /// Handles a request and returns its outcome.
    pub fn request(&mut self, request: AutopilotRequest, now: SimTime) -> RequestOutcome {
        match request {
            AutopilotRequest::Arm { force } => self.arm(force, now),
            AutopilotRequest::Disarm { force } => self.disarm_on_request(force),
            AutopilotRequest::SetMode(mode) => self.set_mode(mode, now),
            AutopilotRequest::Takeoff { height_m } => self.request_takeoff(height_m, now),
            AutopilotRequest::Land => self.set_mode(FlightMode::Land, now),
            AutopilotRequest::GoTo { north_east_m, up_m, yaw_rad, speed_m_s } => {
                self.go_to(north_east_m, up_m, yaw_rad, speed_m_s, now)
            }
            AutopilotRequest::Turn(turn) => self.turn_by_command(turn),
            AutopilotRequest::StartMission { first } => self.start_mission(first, now),
            AutopilotRequest::SetSpeed(speed) => self.set_speed(speed),
            AutopilotRequest::SetHome(home) => self.set_home(home),
            AutopilotRequest::EnableFence(on) => self.enable_fence(on),
            AutopilotRequest::Orbit(wish) => self.request_orbit(wish, now),
            AutopilotRequest::CircleAhead => self.request_circle_ahead(now),
            AutopilotRequest::LandingSequence => self.request_landing_sequence(now),
            AutopilotRequest::Pause(pause) => self.pause(pause, now),
            AutopilotRequest::LookAt(place) => {
                self.look_at_m = place;
                RequestOutcome::Accepted
            }
        }
    }

    fn arm(&mut self, force: bool, now: SimTime) -> RequestOutcome {
        if self.status.armed {
            return RequestOutcome::Accepted;
        }
        let reasons = self.arming_reasons(now);
        if !force && !reasons.is_empty() {
            return RequestOutcome::TemporarilyRejected(format!("Arming denied: {}", reasons.join(", ")));
        }
        self.status.armed = true;
        self.mission.reset();
        if self.failsafe.intended == FlightMode::Mission {
            self.restart_finished_mission();
        }
        self.failsafe.armed_yaw_rad = Some(self.estimate.attitude.yaw_rad());
        self.tuning.fence_enabled |= self.tuning.rules.fence.auto == FenceSwitching::AtArming;
        self.status.mission_paused = false;
        self.status.landed = LandedState::OnGround;
        self.failsafe.standing_since = now;
        self.failsafe.flown = false;
        self.failsafe.begin_flight();
        self.failsafe.upset_since = None;
        self.failsafe.attitude_error_cosine = 1.0;
        self.status.health.tracks_attitude = true;
        if self.estimate.position_valid && !self.home_is_set {
            self.move_home(self.estimate.position_m);
        }
        // Without a pilot at the sticks, automatic modes stay active.
        if self.failsafe.intended.is_manual() && !self.links.sticks_fresh(self.tuning.manual_timeout_s(), now) {
            self.failsafe.intended = FlightMode::Hold;
        }
        self.enter(self.failsafe.intended, now);
        self.push_event(Severity::Info, "Armed");
        RequestOutcome::Accepted
    }

    fn disarm_on_request(&mut self, force: bool) -> RequestOutcome {
        if self.status.armed && self.status.landed != LandedState::OnGround && !force {
            return RequestOutcome::TemporarilyRejected("Disarming denied: not landed".into());
        }
        if self.status.armed {
            self.disarm("Disarmed");
        }
        RequestOutcome::Accepted
    }

    fn set_mode(&mut self, mode: FlightMode, now: SimTime) -> RequestOutcome {
        if let Some(refusal) = self.refusal(mode, now) {
            return refusal;
        }
        let again = self.failsafe.intended == mode && self.status.mode == mode;
        if mode == FlightMode::Mission && !again && self.tuning.rules.mission_restarts {
            self.mission.restart();
        }
        self.failsafe.intended = mode;
        self.failsafe.overridden = false;
        if mode == FlightMode::Mission {
            self.restart_finished_mission();
        }
        if !again {
            self.enter(mode, now);
        } else if mode == FlightMode::Mission {
            self.resume(now);
        }
        RequestOutcome::Accepted
    }

    fn refusal(&self, mode: FlightMode, now: SimTime) -> Option<RequestOutcome> {
        let flying = self.status.armed && self.status.landed != LandedState::OnGround;
        if mode == FlightMode::Mission && self.mission.is_empty() {
            return Some(RequestOutcome::Denied("No mission to fly".into()));
        }
        if mode == FlightMode::Mission
            && let Some(why) = self.mission_leaves_fence().or_else(|| self.missing_mission_parts())
        {
            return Some(RequestOutcome::Denied(why));
        }
        if self.throttle_too_high(mode, now) {
            return Some(RequestOutcome::Denied("throttle too high".into()));
        }
        if mode == FlightMode::Orbit && self.orbit.is_none() {
            return Some(RequestOutcome::Denied("No orbit defined: send DO_ORBIT first".into()));
        }
        if mode == FlightMode::Offboard && !self.links.offboard_fresh(self.tuning.offboard_timeout_s(), now) {
            return Some(RequestOutcome::TemporarilyRejected("Offboard rejected: no external setpoints".into()));
        }
        let counts = flying || self.status.armed && self.tuning.arms_by_mode;
        if counts && mode.needs_position() && !self.estimate.position_valid {
            return Some(RequestOutcome::TemporarilyRejected("No position estimate".into()));
        }
        if mode == FlightMode::SmartReturn && flying && self.flown_path.is_empty() {
            return Some(RequestOutcome::Denied("No path recorded since takeoff".into()));
        }
        if mode == FlightMode::Follow && !self.tuning.follow.enabled {
            return Some(RequestOutcome::Denied("Set FOLL_ENABLE = 1".into()));
        }
        if mode == FlightMode::Return && self.status.home_m.is_none() {
            return Some(RequestOutcome::TemporarilyRejected("No home position".into()));
        }
        None
    }

    /// Returns true on the ground if the throttle stick is so high that a mode with direct throttle would take off at once.
    fn throttle_too_high(&self, mode: FlightMode, now: SimTime) -> bool {
        let direct = |mode: FlightMode| matches!(mode, FlightMode::Stabilized | FlightMode::Acro);
        let high = self.links.sticks.up > LEAP && self.links.sticks_fresh(self.tuning.manual_timeout_s(), now);
        let standing = !self.status.armed || self.status.landed == LandedState::OnGround;
        self.tuning.arms_by_mode && standing && high && direct(mode) && !direct(self.failsafe.intended)
    }

    /// Returns the reason the mission does not meet the operator's requirements, or `None`.
    fn missing_mission_parts(&self) -> Option<String> {
        let rules = &self.tuning.rules;
        let takeoff = self.mission.all().any(|(_, step)| matches!(step, MissionStep::Takeoff { .. }));
        let landing = self.mission.all().any(|(_, step)| matches!(step, MissionStep::Land { .. } | MissionStep::Return));
        let (needs_takeoff, needs_landing) = match rules.mission_needs {
            MissionNeeds::Nothing => (false, false),
            MissionNeeds::Takeoff => (true, false),
            MissionNeeds::Landing => (false, true),
            MissionNeeds::Both => (true, true),
            MissionNeeds::BothOrNeither => (landing, takeoff),
        };
        if needs_takeoff && !takeoff {
            return Some("Mission has no takeoff item".into());
        }
        if needs_landing && !landing {
            return Some("Mission has no landing item".into());
        }
        let home = self.status.home_m?;
        let away_m = (self.mission.first_position()? - home).horizontal_norm();
        let too_far = rules.first_waypoint_m > 0.0 && away_m > rules.first_waypoint_m;
        too_far.then(|| format!("First waypoint too far from home: {away_m:.0} m, limit {:.0} m", rules.first_waypoint_m))
    }

    fn restart_finished_mission(&mut self) {
        if self.mission.step().is_none() {
            self.mission.restart();
        }
        self.status.mission_finished = false;
        self.status.mission_current = self.mission.current;
    }

    fn request_takeoff(&mut self, height_m: Option<f64>, now: SimTime) -> RequestOutcome {
        if height_m.is_some_and(|h| !h.is_finite() || h.abs() > FAR_M) {
            return RequestOutcome::Denied("Takeoff height out of range".into());
        }
        let here = self.estimate.position_m;
        let home_up = self.status.home_m.map_or(0.0, |h| -h.down());
        let wanted_up = home_up + height_m.unwrap_or(self.tuning.takeoff_height_m);
        let up = -here.down();
        if wanted_up > up
            && let Some(refusal) = self.fence_refusal(Vec3::new(here.north(), here.east(), -wanted_up))
        {
            return refusal;
        }
        let before = self.navigator.takeoff_up_m.replace(wanted_up);
        let in_air = self.status.armed && self.status.landed != LandedState::OnGround;
        if in_air && self.navigator.takeoff_up_m.is_some_and(|wanted| up >= wanted) {
            self.push_event(Severity::Info, "Already higher than takeoff altitude");
            return self.set_mode(FlightMode::Hold, now);
        }
        let outcome = self.set_mode(FlightMode::Takeoff, now);
        if outcome != RequestOutcome::Accepted {
            self.navigator.takeoff_up_m = before;
        }
        if self.status.mode == FlightMode::Takeoff {
            self.enter(FlightMode::Takeoff, now);
        }
        outcome
    }

    fn go_to(
        &mut self,
        north_east_m: Option<(f64, f64)>,
        up_m: Option<f64>,
        yaw_rad: Option<f64>,
        speed_m_s: Option<f64>,
        now: SimTime,
    ) -> RequestOutcome {
        let given = [north_east_m.map(|p| p.0), north_east_m.map(|p| p.1), up_m, yaw_rad, speed_m_s];
        if given.iter().flatten().any(|v| !v.is_finite() || v.abs() > FAR_M) {
            return RequestOutcome::Denied("Target out of range".into());
        }
        if !self.status.armed || self.status.landed == LandedState::OnGround {
            return RequestOutcome::TemporarilyRejected("Not flying".into());
        }
        if !self.estimate.position_valid {
            return RequestOutcome::TemporarilyRejected("No position estimate".into());
        }
        let here = self.estimate.position_m;
        let (n, e) = north_east_m.unwrap_or((here.north(), here.east()));
        if north_east_m.is_some() || up_m.is_some() {
            let target = Vec3::new(n, e, up_m.map_or(here.down(), |up| -up));
            if let Some(refusal) = self.fence_refusal(target) {
                return refusal;
            }
        }
        self.failsafe.intended = FlightMode::Hold;
        self.failsafe.overridden = false;
        self.enter(FlightMode::Hold, now);
        let held = self.navigator.target_m;
        let (n, e) = north_east_m.unwrap_or((held.north(), held.east()));
        self.navigator.target_m = Vec3::new(n, e, up_m.map_or(held.down(), |u| -u));
        self.navigator.target_yaw_rad = yaw_rad;
        self.navigator.speed_m_s = Some(speed_m_s.filter(|s| *s > 0.0).unwrap_or(self.cruise_m_s()));
        RequestOutcome::Accepted
    }

    /// Turns without a mode change: a mission continues, and a pilot keeps control.
    fn turn_by_command(&mut self, turn: TurnCommand) -> RequestOutcome {
        let automatic = matches!(
            self.status.mode,
            FlightMode::Hold | FlightMode::Takeoff | FlightMode::Land | FlightMode::Mission | FlightMode::Offboard
        );
        if !self.status.armed || self.status.landed == LandedState::OnGround || !automatic {
            return RequestOutcome::TemporarilyRejected("Not in an automatic mode".into());
        }
        self.look_at_m = None;
        self.navigator.target_yaw_rad = Some(turn.yaw_rad);
        self.navigator.turn = Some(turn);
        self.navigator.turned_by_pilot = false;
        RequestOutcome::Accepted
    }

    fn start_mission(&mut self, first: Option<usize>, now: SimTime) -> RequestOutcome {
        if self.mission.is_empty() {
            return RequestOutcome::Denied("Mission start denied: no mission".into());
        }
        if first.is_some_and(|index| !self.set_mission_current(index, false)) {
            return RequestOutcome::Denied("No such mission item".into());
        }
        let outcome = self.set_mode(FlightMode::Mission, now);
        self.failsafe.mission_started = outcome == RequestOutcome::Accepted;
        outcome
    }

    /// Flies the landing sequence nearest to the current position.
    fn request_landing_sequence(&mut self, now: SimTime) -> RequestOutcome {
        let here = self.estimate.position_m;
        let Some(index) = self.mission.landing_sequence(here) else {
            return RequestOutcome::Failed("No return path or landing sequence found".into());
        };
        self.set_mission_current(index, false);
        let outcome = self.set_mode(FlightMode::Mission, now);
        if outcome == RequestOutcome::Accepted {
            self.enter(FlightMode::Mission, now);
        }
        outcome
    }

    fn set_speed(&mut self, speed_m_s: Option<f64>) -> RequestOutcome {
        if speed_m_s.is_some_and(|speed| !(speed.is_finite() && speed > 0.0)) {
            return RequestOutcome::Denied("Speed out of range".into());
        }
        self.commanded_m_s = speed_m_s;
        if self.navigator.speed_m_s.is_some() {
            self.navigator.speed_m_s = Some(self.cruise_m_s());
        }
        RequestOutcome::Accepted
    }

    fn set_home(&mut self, home_m: Vec3<Ned>) -> RequestOutcome {
        if !home_m.is_finite() || home_m.norm() > FAR_M {
            return RequestOutcome::Denied("Home out of range".into());
        }
        self.move_home(home_m);
        self.home_is_set = true;
        RequestOutcome::Accepted
    }

    pub(super) fn move_home(&mut self, home_m: Vec3<Ned>) {
        let before_down_m = self.status.home_m.map_or(0.0, |h| h.down());
        let up_m = before_down_m - home_m.down();
        self.mission.raise_home(up_m);
        for refuge in self.rally_points.iter_mut().filter(|refuge| refuge.over_home) {
            refuge.place_m -= Vec3::new(0.0, 0.0, up_m);
        }
        self.status.home_m = Some(home_m);
    }
}
