//! Requests and their answers.

use super::core::{Autopilot, Severity};
use super::operator_rules::{FenceSwitching, MissionNeeds};
use super::{Landed, MissionStep, Mode, Outcome, Request, Turn};
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::time::SimTime;

/// Heights and distances beyond this are mistakes, m.
const FAR_M: f64 = 20_000.0;

/// Above this stick the thrust is more than half of what hovers (ArduPilot: get_non_takeoff_throttle).
const LEAP: f64 = -0.5;

impl Autopilot {
    /// Asks for something; the answer comes at once.
    pub fn request(&mut self, request: Request, now: SimTime) -> Outcome {
        match request {
            Request::Arm { force } => self.arm(force, now),
            Request::Disarm { force } => self.disarm_on_request(force),
            Request::SetMode(mode) => self.set_mode(mode, now),
            Request::Takeoff { height_m } => self.request_takeoff(height_m, now),
            Request::Land => self.set_mode(Mode::Land, now),
            Request::GoTo { north_east_m, up_m, yaw_rad, speed_m_s } => self.go_to(north_east_m, up_m, yaw_rad, speed_m_s, now),
            Request::Turn(turn) => self.turn_by_command(turn),
            Request::StartMission { first } => self.start_mission(first, now),
            Request::SetSpeed(speed) => self.set_speed(speed),
            Request::SetHome(home) => self.set_home(home),
            Request::EnableFence(on) => self.enable_fence(on),
            Request::Orbit(wish) => self.request_orbit(wish, now),
            Request::CircleAhead => self.request_circle_ahead(now),
            Request::LandingSequence => self.request_landing_sequence(now),
            Request::Pause(pause) => self.pause(pause, now),
            Request::LookAt(place) => {
                self.look_at_m = place;
                Outcome::Accepted
            }
        }
    }

    fn arm(&mut self, force: bool, now: SimTime) -> Outcome {
        if self.status.armed {
            return Outcome::Accepted;
        }
        let reasons = self.arming_reasons(now);
        if !force && !reasons.is_empty() {
            return Outcome::TemporarilyRejected(format!("Arming denied: {}", reasons.join(", ")));
        }
        self.status.armed = true;
        self.mission.begin_anew();
        if self.watch.intended == Mode::Mission {
            self.restart_finished_mission();
        }
        self.watch.armed_yaw_rad = Some(self.estimate.attitude.yaw_rad());
        self.tuning.fence_enabled |= self.tuning.rules.fence.auto == FenceSwitching::AtArming;
        self.status.mission_paused = false;
        self.status.landed = Landed::OnGround;
        self.watch.standing_since = now;
        self.watch.flown = false;
        self.watch.begin_flight();
        self.watch.upset_since = None;
        self.watch.aim_cosine = 1.0;
        self.status.health.obeys = true;
        if self.estimate.position_valid && !self.home_is_set {
            self.move_home(self.estimate.position_m);
        }
        // Nobody at the sticks: what flies by itself flies.
        if self.watch.intended.is_manual() && !self.links.sticks_fresh(self.tuning.manual_patience_s(), now) {
            self.watch.intended = Mode::Hold;
        }
        self.enter(self.watch.intended, now);
        self.say(Severity::Info, "Armed");
        Outcome::Accepted
    }

    fn disarm_on_request(&mut self, force: bool) -> Outcome {
        if self.status.armed && self.status.landed != Landed::OnGround && !force {
            return Outcome::TemporarilyRejected("Disarming denied: not landed".into());
        }
        if self.status.armed {
            self.disarm("Disarmed");
        }
        Outcome::Accepted
    }

    fn set_mode(&mut self, mode: Mode, now: SimTime) -> Outcome {
        if let Some(refusal) = self.refusal(mode, now) {
            return refusal;
        }
        let again = self.watch.intended == mode && self.status.mode == mode;
        if mode == Mode::Mission && !again && self.tuning.rules.mission_restarts {
            self.mission.restart();
        }
        self.watch.intended = mode;
        self.watch.overridden = false;
        if mode == Mode::Mission {
            self.restart_finished_mission();
        }
        if !again {
            self.enter(mode, now);
        } else if mode == Mode::Mission {
            self.resume(now);
        }
        Outcome::Accepted
    }

    fn refusal(&self, mode: Mode, now: SimTime) -> Option<Outcome> {
        let flying = self.status.armed && self.status.landed != Landed::OnGround;
        if mode == Mode::Mission && self.mission.is_empty() {
            return Some(Outcome::Denied("No mission to fly".into()));
        }
        if mode == Mode::Mission
            && let Some(why) = self.mission_leaves_fence().or_else(|| self.mission_lacks())
        {
            return Some(Outcome::Denied(why));
        }
        if self.would_leap(mode, now) {
            return Some(Outcome::Denied("throttle too high".into()));
        }
        if mode == Mode::Orbit && self.orbit.is_none() {
            return Some(Outcome::Denied("Nothing to circle: DO_ORBIT says what".into()));
        }
        if mode == Mode::Offboard && !self.links.offboard_fresh(self.tuning.offboard_patience_s(), now) {
            return Some(Outcome::TemporarilyRejected("Offboard needs external set-points first".into()));
        }
        let counts = flying || self.status.armed && self.tuning.arms_by_mode;
        if counts && mode.needs_position() && !self.estimate.position_valid {
            return Some(Outcome::TemporarilyRejected("No position estimate".into()));
        }
        if mode == Mode::SmartReturn && flying && self.trail.is_empty() {
            return Some(Outcome::Denied("No path recorded since take-off".into()));
        }
        if mode == Mode::Follow && !self.tuning.follow.enabled {
            return Some(Outcome::Denied("Set FOLL_ENABLE = 1".into()));
        }
        if mode == Mode::Return && self.status.home_m.is_none() {
            return Some(Outcome::TemporarilyRejected("No home position".into()));
        }
        None
    }

    /// On the ground the throttle stick is so high that a mode in which it is the thrust would take off at once.
    fn would_leap(&self, mode: Mode, now: SimTime) -> bool {
        let direct = |mode: Mode| matches!(mode, Mode::Stabilized | Mode::Acro);
        let high = self.links.sticks.up > LEAP && self.links.sticks_fresh(self.tuning.manual_patience_s(), now);
        let standing = !self.status.armed || self.status.landed == Landed::OnGround;
        self.tuning.arms_by_mode && standing && high && direct(mode) && !direct(self.watch.intended)
    }

    /// What the mission lacks of what the operator asks of one.
    fn mission_lacks(&self) -> Option<String> {
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
            return Some("Mission has no take-off item".into());
        }
        if needs_landing && !landing {
            return Some("Mission has no landing item".into());
        }
        let home = self.status.home_m?;
        let away_m = (self.mission.first_place()? - home).horizontal_norm();
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

    fn request_takeoff(&mut self, height_m: Option<f64>, now: SimTime) -> Outcome {
        if height_m.is_some_and(|h| !h.is_finite() || h.abs() > FAR_M) {
            return Outcome::Denied("Take-off height out of range".into());
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
        let before = self.course.takeoff_up_m.replace(wanted_up);
        let in_air = self.status.armed && self.status.landed != Landed::OnGround;
        if in_air && self.course.takeoff_up_m.is_some_and(|wanted| up >= wanted) {
            self.say(Severity::Info, "Already higher than takeoff altitude");
            return self.set_mode(Mode::Hold, now);
        }
        let outcome = self.set_mode(Mode::Takeoff, now);
        if outcome != Outcome::Accepted {
            self.course.takeoff_up_m = before;
        }
        if self.status.mode == Mode::Takeoff {
            self.enter(Mode::Takeoff, now);
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
    ) -> Outcome {
        let given = [north_east_m.map(|p| p.0), north_east_m.map(|p| p.1), up_m, yaw_rad, speed_m_s];
        if given.iter().flatten().any(|v| !v.is_finite() || v.abs() > FAR_M) {
            return Outcome::Denied("Target out of range".into());
        }
        if !self.status.armed || self.status.landed == Landed::OnGround {
            return Outcome::TemporarilyRejected("Not flying".into());
        }
        if !self.estimate.position_valid {
            return Outcome::TemporarilyRejected("No position estimate".into());
        }
        let here = self.estimate.position_m;
        let (n, e) = north_east_m.unwrap_or((here.north(), here.east()));
        if north_east_m.is_some() || up_m.is_some() {
            let target = Vec3::new(n, e, up_m.map_or(here.down(), |up| -up));
            if let Some(refusal) = self.fence_refusal(target) {
                return refusal;
            }
        }
        self.watch.intended = Mode::Hold;
        self.watch.overridden = false;
        self.enter(Mode::Hold, now);
        let held = self.course.target_m;
        let (n, e) = north_east_m.unwrap_or((held.north(), held.east()));
        self.course.target_m = Vec3::new(n, e, up_m.map_or(held.down(), |u| -u));
        self.course.target_yaw_rad = yaw_rad;
        self.course.speed_m_s = Some(speed_m_s.filter(|s| *s > 0.0).unwrap_or(self.cruise_m_s()));
        Outcome::Accepted
    }

    /// The mode stays: a mission flies on, a person keeps the sticks.
    fn turn_by_command(&mut self, turn: Turn) -> Outcome {
        let automatic = matches!(self.status.mode, Mode::Hold | Mode::Takeoff | Mode::Land | Mode::Mission | Mode::Offboard);
        if !self.status.armed || self.status.landed == Landed::OnGround || !automatic {
            return Outcome::TemporarilyRejected("Not flying by itself".into());
        }
        self.look_at_m = None;
        self.course.target_yaw_rad = Some(turn.yaw_rad);
        self.course.turn = Some(turn);
        self.course.turned_by_pilot = false;
        Outcome::Accepted
    }

    fn start_mission(&mut self, first: Option<usize>, now: SimTime) -> Outcome {
        if self.mission.is_empty() {
            return Outcome::Denied("Mission start denied: no mission".into());
        }
        if first.is_some_and(|index| !self.set_mission_current(index, false)) {
            return Outcome::Denied("No such mission item".into());
        }
        let outcome = self.set_mode(Mode::Mission, now);
        self.watch.mission_started = outcome == Outcome::Accepted;
        outcome
    }

    /// The landing sequence nearest to here.
    fn request_landing_sequence(&mut self, now: SimTime) -> Outcome {
        let here = self.estimate.position_m;
        let Some(index) = self.mission.landing_sequence(here) else {
            return Outcome::Failed("No return path or landing sequence found".into());
        };
        self.set_mission_current(index, false);
        let outcome = self.set_mode(Mode::Mission, now);
        if outcome == Outcome::Accepted {
            self.enter(Mode::Mission, now);
        }
        outcome
    }

    fn set_speed(&mut self, speed_m_s: Option<f64>) -> Outcome {
        if speed_m_s.is_some_and(|speed| !(speed.is_finite() && speed > 0.0)) {
            return Outcome::Denied("Speed out of range".into());
        }
        self.commanded_m_s = speed_m_s;
        if self.course.speed_m_s.is_some() {
            self.course.speed_m_s = Some(self.cruise_m_s());
        }
        Outcome::Accepted
    }

    fn set_home(&mut self, home_m: Vec3<Ned>) -> Outcome {
        if !home_m.is_finite() || home_m.norm() > FAR_M {
            return Outcome::Denied("Home out of range".into());
        }
        self.move_home(home_m);
        self.home_is_set = true;
        Outcome::Accepted
    }

    pub(super) fn move_home(&mut self, home_m: Vec3<Ned>) {
        let before_down_m = self.status.home_m.map_or(0.0, |h| h.down());
        let up_m = before_down_m - home_m.down();
        self.mission.raise_home(up_m);
        for refuge in self.refuges.iter_mut().filter(|refuge| refuge.over_home) {
            refuge.place_m -= Vec3::new(0.0, 0.0, up_m);
        }
        self.status.home_m = Some(home_m);
    }
}
