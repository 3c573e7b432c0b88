//! The autopilot as a whole: requests, sticks and readings in, motor commands and events out.

use super::control::Control;
use super::estimator::Estimator;
use super::guidance::{Guidance, Reach};
use super::mission::MissionRun;
use super::tuning::Tuning;
use super::{Estimate, Landed, MissionStep, Mode, Ned, OffboardSetpoint, Outcome, Request, Status, Sticks, Vec3};
use crate::base::frames::Rotation;
use crate::base::geodesy::Geo;
use crate::base::math;
use crate::base::time::{Schedule, SimTime};
use crate::scenario::Rules;
use crate::sitl::physics::Actuators;
use crate::sitl::sensors::Readings;
use crate::vehicle::Vehicle;

/// Rate of the control loops, Hz.
pub const CONTROL_HZ: f64 = 400.0;
/// A stick farther from its centre forbids arming.
const ARM_STICK: f64 = 0.1;
/// More tilt than this forbids arming, rad (about 25 degrees).
const ARM_TILT_RAD: f64 = 0.44;
/// Set-points older than this end offboard flight, s (PX4: 1 s).
const OFFBOARD_LOSS_S: f64 = 1.0;
/// The throttle stick must rise this far to leave the ground.
const LIFT_STICK: f64 = 0.12;
/// Lying upset for this long ends the flight, s.
const UPSET_S: f64 = 1.5;

/// How grave an event's text is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// As MAV_SEVERITY_CRITICAL.
    Critical,
    /// As MAV_SEVERITY_WARNING.
    Warning,
    /// As MAV_SEVERITY_INFO.
    Info,
}

/// Something that people should read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Event {
    /// Gravity.
    pub severity: Severity,
    /// Words, at most 50 bytes (one STATUSTEXT).
    pub text: String,
}

/// The built-in autopilot.
#[derive(Debug, Clone, PartialEq)]
pub struct Autopilot {
    pub(super) vehicle: Vehicle,
    pub(super) rules: Rules,
    /// Settings that ground stations may change.
    pub tuning: Tuning,
    pub(super) estimator: Estimator,
    pub(super) control: Control,
    pub(super) guidance: Guidance,
    pub(super) mode: Mode,
    pub(super) armed: bool,
    pub(super) landed: Landed,
    pub(super) home_m: Option<Vec3<Ned>>,
    pub(super) target_m: Option<Vec3<Ned>>,
    pub(super) yaw_rad: f64,
    pub(super) speed_m_s: f64,
    pub(super) sticks: Option<(Sticks, SimTime)>,
    pub(super) offboard: Option<(OffboardSetpoint, SimTime)>,
    pub(super) mission: MissionRun,
    pub(super) battery_pct: f64,
    pub(super) link_heard: Option<SimTime>,
    pub(super) failsafe: Option<String>,
    pub(super) low_battery_told: u8,
    pub(super) attitude_target: Rotation<super::Frd, Ned>,
    events: Vec<Event>,
    estimate: Estimate,
    status: Status,
    reasons_due: Schedule,
    reached: Vec<usize>,
    still_since: Option<SimTime>,
    ground_since: SimTime,
    upset_since: Option<SimTime>,
    gnss_fix: bool,
}

impl Autopilot {
    /// Boots on the ground. `origin` is where the local frame lies (for the magnetic model).
    #[must_use]
    pub fn new(vehicle: &Vehicle, rules: &Rules, origin: Geo, tuning: Tuning) -> Self {
        let estimator = Estimator::new(vehicle.sensors, origin);
        Self {
            estimate: estimator.estimate(),
            status: Status {
                armed: false,
                mode: Mode::Hold,
                landed: Landed::OnGround,
                arming_reasons: vec!["starting".into()],
                failsafe: None,
                home_m: None,
                target_m: None,
                attitude_target: Rotation::identity(),
                thrust: 0.0,
                mission_current: 0,
                mission_reached: None,
                mission_finished: false,
            },
            reasons_due: Schedule::new(SimTime::ZERO, 10.0),
            reached: Vec::new(),
            estimator,
            control: Control::new(vehicle),
            vehicle: vehicle.clone(),
            rules: rules.clone(),
            guidance: Guidance::default(),
            mode: Mode::Hold,
            armed: false,
            landed: Landed::OnGround,
            home_m: None,
            target_m: None,
            yaw_rad: 0.0,
            speed_m_s: tuning.cruise_m_s,
            sticks: None,
            offboard: None,
            mission: MissionRun::default(),
            battery_pct: 100.0,
            link_heard: None,
            failsafe: None,
            low_battery_told: 0,
            attitude_target: Rotation::identity(),
            events: Vec::new(),
            still_since: None,
            ground_since: SimTime::ZERO,
            upset_since: None,
            gnss_fix: false,
            tuning,
        }
    }

    /// What the estimator believes.
    #[must_use]
    pub fn estimate(&self) -> &Estimate {
        &self.estimate
    }

    /// The estimator, for tests of its consistency.
    #[must_use]
    pub fn estimator(&self) -> &Estimator {
        &self.estimator
    }

    /// Events since the last call.
    pub fn drain_events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }

    /// Mission items reached since the last call, in order.
    pub fn drain_reached(&mut self) -> Vec<usize> {
        std::mem::take(&mut self.reached)
    }

    pub(super) fn tell(&mut self, severity: Severity, text: impl Into<String>) {
        self.events.push(Event { severity, text: text.into() });
    }

    /// Stick input.
    pub fn sticks(&mut self, sticks: Sticks, now: SimTime) {
        self.sticks = Some((sticks, now));
    }

    /// An offboard set-point.
    pub fn offboard(&mut self, setpoint: OffboardSetpoint, now: SimTime) {
        self.offboard = Some((setpoint, now));
    }

    /// A ground station has been heard.
    pub fn ground_station_alive(&mut self, now: SimTime) {
        self.link_heard = Some(now);
    }

    /// The steps of an uploaded mission.
    pub fn set_mission(&mut self, steps: Vec<MissionStep>) {
        self.mission = MissionRun::new(steps);
    }

    /// Continues a mission at an item; false when there is no such item.
    pub fn set_mission_current(&mut self, index: usize) -> bool {
        self.mission.jump(index)
    }

    /// What the autopilot tells the world.
    #[must_use]
    pub fn status(&self) -> &Status {
        &self.status
    }

    fn refresh_status(&mut self, now: SimTime) {
        if self.reasons_due.fire(now) {
            self.status.arming_reasons = if self.armed { Vec::new() } else { self.arming_reasons(now) };
        }
        self.reached.extend(self.mission.take_reached());
        let s = &mut self.status;
        (s.armed, s.mode, s.landed) = (self.armed, self.mode, self.landed);
        s.failsafe.clone_from(&self.failsafe);
        (s.home_m, s.target_m) = (self.home_m, self.target_m);
        (s.attitude_target, s.thrust) = (self.attitude_target, self.control.thrust_share);
        (s.mission_current, s.mission_finished) = (self.mission.current(), self.mission.finished());
    }

    /// Why arming would be refused now.
    #[must_use]
    pub fn arming_reasons(&self, now: SimTime) -> Vec<String> {
        let e = *self.estimate();
        let mut reasons = Vec::new();
        let mut need = |ok: bool, reason: &str| {
            if !ok {
                reasons.push(reason.to_string());
            }
        };
        need(e.attitude_valid, "attitude not aligned yet");
        need(self.gnss_fix, "no GNSS fix");
        need(e.position_valid, "position estimate not good enough");
        need(self.battery_pct > 5.0, "battery too low");
        let (roll, pitch, _) = e.attitude.euler();
        need(roll.abs() < ARM_TILT_RAD && pitch.abs() < ARM_TILT_RAD, "aircraft is tilted");
        let centred = self.fresh_sticks(now).is_none_or(|s| {
            // The throttle stick may also lie at its bottom.
            [s.forward, s.right, s.yaw].iter().all(|a| a.abs() < ARM_STICK) && s.up < ARM_STICK
        });
        need(centred, "a stick is off its centre");
        reasons
    }

    pub(super) fn fresh_sticks(&self, now: SimTime) -> Option<Sticks> {
        self.sticks.filter(|(_, at)| (now - *at).s() <= self.tuning.manual_loss_s).map(|(s, _)| s)
    }

    pub(super) fn fresh_offboard(&self, now: SimTime) -> Option<OffboardSetpoint> {
        self.offboard.filter(|(_, at)| (now - *at).s() <= OFFBOARD_LOSS_S).map(|(s, _)| s)
    }

    /// Asks for something; the answer comes at once.
    pub fn request(&mut self, request: Request, now: SimTime) -> Outcome {
        let outcome = self.answer(request, now);
        self.refresh_status(now);
        outcome
    }

    fn answer(&mut self, request: Request, now: SimTime) -> Outcome {
        match request {
            Request::Arm { force } => self.arm(force, now),
            Request::Disarm { force } => self.disarm(force),
            Request::SetMode(mode) => self.set_mode(mode, now),
            Request::Takeoff { height_m } => self.take_off(height_m, now),
            Request::Land => self.set_mode(Mode::Land, now),
            Request::GoTo { north_east_m, up_m, yaw_rad, speed_m_s } => self.go_to(north_east_m, up_m, yaw_rad, speed_m_s, now),
            Request::StartMission { first } => self.start_mission(first, now),
            Request::SetSpeed(speed) => self.set_speed(speed),
            Request::SetHome(home) => {
                self.home_m = Some(home);
                Outcome::Accepted
            }
        }
    }

    fn arm(&mut self, force: bool, now: SimTime) -> Outcome {
        if self.armed {
            return Outcome::Accepted;
        }
        let reasons = self.arming_reasons(now);
        if !force && !reasons.is_empty() {
            let text = format!("Arming denied: {}", reasons.join(", "));
            self.tell(Severity::Critical, text.clone());
            return Outcome::TemporarilyRejected(text);
        }
        self.armed = true;
        self.control.reset();
        self.ground_since = now;
        self.upset_since = None;
        self.home_m = Some(self.estimate().position_m);
        self.yaw_rad = self.estimate().attitude.yaw_rad();
        self.tell(Severity::Info, "Armed");
        Outcome::Accepted
    }

    fn disarm(&mut self, force: bool) -> Outcome {
        if self.armed && self.landed != Landed::OnGround && !force {
            let text = "Disarming denied: not landed".to_string();
            self.tell(Severity::Critical, text.clone());
            return Outcome::TemporarilyRejected(text);
        }
        if self.armed {
            self.stop_motors("Disarmed");
        }
        Outcome::Accepted
    }

    pub(super) fn stop_motors(&mut self, why: &str) {
        self.armed = false;
        self.landed = Landed::OnGround;
        self.failsafe = None;
        self.mode = if matches!(self.mode, Mode::Stabilized | Mode::Altitude | Mode::Position) { self.mode } else { Mode::Hold };
        self.tell(Severity::Info, why);
    }

    /// Changes the mode, or says why not.
    pub(super) fn set_mode(&mut self, mode: Mode, now: SimTime) -> Outcome {
        let e = *self.estimate();
        if mode == Mode::Offboard && self.fresh_offboard(now).is_none() {
            return Outcome::TemporarilyRejected("Offboard needs a stream of set-points".into());
        }
        if mode == Mode::Mission && self.mission.is_empty() {
            return Outcome::Denied("No mission uploaded".into());
        }
        let needs_position = !matches!(mode, Mode::Stabilized | Mode::Altitude | Mode::Land);
        if needs_position && self.armed && !e.position_valid {
            return Outcome::TemporarilyRejected("Position estimate not good enough".into());
        }
        self.failsafe = None;
        self.enter(mode);
        Outcome::Accepted
    }

    pub(super) fn enter(&mut self, mode: Mode) {
        let e = *self.estimate();
        if mode != self.mode {
            self.guidance = Guidance::starting(&e);
            self.yaw_rad = e.attitude.yaw_rad();
        }
        self.mode = mode;
        let in_air = self.landed != Landed::OnGround;
        self.target_m = match mode {
            Mode::Hold if in_air => Some(stop_point(&e, self.control.lateral_limit_m_s2())),
            Mode::Return | Mode::Mission | Mode::Takeoff => self.target_m,
            _ => None,
        };
        if mode == Mode::Mission {
            self.mission.resume();
        }
        if mode == Mode::Return {
            let home = self.home_m.unwrap_or(e.position_m);
            let down = (home.down() - self.tuning.return_height_m).min(e.position_m.down());
            self.target_m = Some(Vec3::new(home.north(), home.east(), down));
        }
        if mode == Mode::Land && in_air {
            self.landed = Landed::Landing;
        }
    }

    fn take_off(&mut self, height_m: Option<f64>, now: SimTime) -> Outcome {
        let e = *self.estimate();
        let home = self.home_m.unwrap_or(e.position_m);
        let height = height_m.unwrap_or(self.tuning.takeoff_height_m);
        let down = home.down() - height;
        if self.landed != Landed::OnGround && e.position_m.down() <= down {
            self.tell(Severity::Info, "Already higher than takeoff altitude");
            return Outcome::Accepted;
        }
        if !e.position_valid {
            return Outcome::TemporarilyRejected("Position estimate not good enough".into());
        }
        self.ground_since = now;
        self.target_m = Some(Vec3::new(e.position_m.north(), e.position_m.east(), down));
        self.enter(Mode::Takeoff);
        Outcome::Accepted
    }

    fn go_to(
        &mut self,
        level: Option<(f64, f64)>,
        up_m: Option<f64>,
        yaw: Option<f64>,
        speed: Option<f64>,
        now: SimTime,
    ) -> Outcome {
        if !self.armed || self.landed == Landed::OnGround {
            return Outcome::TemporarilyRejected("Not flying".into());
        }
        let outcome = self.set_mode(Mode::Hold, now);
        if outcome != Outcome::Accepted {
            return outcome;
        }
        let here = self.target_m.unwrap_or(self.estimate.position_m);
        let (north, east) = level.unwrap_or((here.north(), here.east()));
        self.target_m = Some(Vec3::new(north, east, up_m.map_or(here.down(), |up| -up)));
        if let Some(yaw) = yaw {
            self.yaw_rad = math::wrap_pi(yaw);
        }
        speed.map_or(Outcome::Accepted, |speed| self.set_speed(speed))
    }

    fn start_mission(&mut self, first: Option<usize>, now: SimTime) -> Outcome {
        if let Some(first) = first
            && !self.mission.jump(first)
        {
            return Outcome::Denied("No such mission item".into());
        }
        self.set_mode(Mode::Mission, now)
    }

    fn set_speed(&mut self, speed_m_s: f64) -> Outcome {
        if !(0.1..=self.vehicle.limits.forward_m_s).contains(&speed_m_s) {
            return Outcome::Denied(format!("Speed must be 0.1 to {} m/s", self.vehicle.limits.forward_m_s));
        }
        self.speed_m_s = speed_m_s;
        Outcome::Accepted
    }

    /// The vehicle was put back in the air by hand: estimator and controllers start there, armed, holding.
    pub fn respawn(&mut self, position_m: Vec3<Ned>, velocity_m_s: Vec3<Ned>, attitude: Rotation<super::Frd, Ned>, now: SimTime) {
        self.estimator.reinitialise(position_m, velocity_m_s, attitude);
        self.estimate = self.estimator.estimate();
        self.control.reset();
        self.armed = true;
        self.landed = Landed::InAir;
        self.upset_since = None;
        self.yaw_rad = attitude.yaw_rad();
        self.guidance = Guidance::default();
        if !matches!(self.mode, Mode::Stabilized | Mode::Altitude | Mode::Position) {
            self.mode = Mode::Hold;
            self.target_m = Some(position_m);
        }
        self.tell(Severity::Warning, "Put back at the last safe hover");
        self.refresh_status(now);
    }

    pub(super) fn reach(&self) -> Reach {
        let stop = self.vehicle.limits.forward_m_s / self.vehicle.limits.slow_down_time_s;
        Reach {
            level_m_s2: stop.min(0.75 * self.control.lateral_limit_m_s2()),
            vertical_m_s2: math::GRAVITY_M_S2 / 3.0,
            position_gain: self.control.position_gain,
        }
    }

    fn sense(&mut self, readings: &Readings, now: SimTime) {
        self.estimator.update(readings, now);
        self.estimate = self.estimator.estimate();
        if let Some(gnss) = &readings.gnss {
            self.gnss_fix = gnss.fix >= 3;
            if self.home_m.is_none() && self.estimate.position_valid {
                self.home_m = Some(self.estimate.position_m);
            }
        }
        if let Some(battery) = &readings.battery {
            self.battery_pct = battery.remaining_pct;
        }
    }

    /// One step at the control rate (400 Hz), with what the sensors gave since the last.
    pub fn step(&mut self, readings: &Readings, now: SimTime) -> Actuators {
        self.sense(readings, now);
        let actuators = self.command(now);
        self.refresh_status(now);
        actuators
    }

    fn command(&mut self, now: SimTime) -> Actuators {
        let dt_s = 1.0 / CONTROL_HZ;
        if !self.armed {
            return Actuators::default();
        }
        let e = *self.estimate();
        self.failsafes(now);
        self.upset(&e, now);
        self.ground_logic(&e, now);
        if !self.armed {
            return Actuators::default();
        }
        if self.landed == Landed::OnGround {
            return self.idle();
        }
        let target = self.steer(&e, now, dt_s);
        self.attitude_target = target.attitude;
        self.control.attitude(&e, &target, dt_s)
    }

    fn idle(&mut self) -> Actuators {
        self.control.reset();
        self.yaw_rad = self.estimate().attitude.yaw_rad();
        Actuators { armed: true, ..Actuators::default() }
    }

    /// Lying on its side or back without motion: motors off.
    fn upset(&mut self, e: &Estimate, now: SimTime) {
        let down = e.attitude * Vec3::<super::Frd>::new(0.0, 0.0, 1.0);
        if down.down() > 0.3 || e.velocity_m_s.norm() > 1.0 {
            self.upset_since = None;
            return;
        }
        if (now - *self.upset_since.get_or_insert(now)).s() > UPSET_S {
            self.upset_since = None;
            self.stop_motors("Disarmed: lying upset");
        }
    }

    /// Leaving the ground, standing on it, disarming on it.
    fn ground_logic(&mut self, e: &Estimate, now: SimTime) {
        match self.landed {
            Landed::OnGround => self.leave_ground(now),
            Landed::TakingOff if self.mode != Mode::Takeoff || self.reached_height(e) => {
                self.landed = Landed::InAir;
                if self.mode == Mode::Takeoff {
                    self.enter(Mode::Hold);
                }
            }
            _ => self.find_ground(e, now),
        }
    }

    fn reached_height(&self, e: &Estimate) -> bool {
        self.target_m.is_none_or(|t| e.position_m.down() < t.down() + 0.4)
    }

    fn leave_ground(&mut self, now: SimTime) {
        let by_stick = matches!(self.mode, Mode::Stabilized | Mode::Altitude | Mode::Position)
            && self.fresh_sticks(now).is_some_and(|s| s.up > LIFT_STICK);
        let by_mode = match self.mode {
            Mode::Takeoff | Mode::Mission => true,
            Mode::Offboard => self.fresh_offboard(now).is_some(),
            _ => false,
        };
        if by_stick || by_mode {
            self.landed = if self.mode == Mode::Takeoff { Landed::TakingOff } else { Landed::InAir };
            self.guidance = Guidance::default();
            self.still_since = None;
            self.ground_since = now;
            self.tell(Severity::Info, "Takeoff detected");
            return;
        }
        let limit = if self.mode == Mode::Land { self.tuning.disarm_after_landing_s } else { self.tuning.disarm_before_flight_s };
        if limit > 0.0 && (now - self.ground_since).s() > limit {
            self.stop_motors(if self.mode == Mode::Land { "Disarmed by landing" } else { "Disarmed: no take-off" });
        }
    }

    /// Asked to sink but not sinking: it stands on something.
    fn find_ground(&mut self, e: &Estimate, now: SimTime) {
        const STANDING_S: f64 = 0.8;
        let sinking_wish = self.guidance.velocity_m_s.down() > 0.3;
        let still = e.velocity_m_s.down().abs() < 0.15 && e.velocity_m_s.horizontal_norm() < 0.4 && e.rates_rad_s.norm() < 0.5;
        let level = (e.attitude * Vec3::<super::Frd>::new(0.0, 0.0, 1.0)).down() > 0.9;
        if !(sinking_wish && still && level) {
            self.still_since = None;
            return;
        }
        if (now - *self.still_since.get_or_insert(now)).s() > STANDING_S {
            self.still_since = None;
            self.landed = Landed::OnGround;
            self.ground_since = now;
            self.tell(Severity::Info, "Landing detected");
        }
    }
}

/// Where the aircraft comes to rest when it brakes now.
fn stop_point(e: &Estimate, brake_m_s2: f64) -> Vec3<Ned> {
    let v = e.velocity_m_s;
    let level = Vec3::<Ned>::new(v.north(), v.east(), 0.0);
    e.position_m + level.unit() * (0.7 * level.norm_squared() / brake_m_s2) + level * 0.3
}
