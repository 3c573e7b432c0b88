//! Failsafes, arming checks, battery warnings and stick takeover.

use super::core::{Autopilot, Severity};
use super::operator_rules::{FailsafeResponse, OffboardLoss};
use super::{FlightMode, LandedState, LinkLossAction, OffboardSetpoint};
use spandrel_model::frames::{Frd, Vec3};
use spandrel_model::time::SimTime;

/// Interval of failsafe checks.
const PERIOD: SimTime = SimTime::from_ms(50);
/// Stick deflection that counts as centered for arming.
const CENTRED: f64 = 0.2;
/// Minimum cosine of the tilt for arming (20 degrees).
const LEVEL: f64 = 0.94;
/// Minimum clearance above for arming, m.
const HEADROOM_M: f64 = 1.0;
/// Maximum horizontal position error for arming, m (1 sigma).
const ARMING_ACCURACY_M: f64 = 5.0;
/// Crash detection: attitude error (40 degrees, as a cosine) and its minimum duration at low speed, s.
const UPSET_COSINE: f64 = 0.766;
const UPSET_S: f64 = 2.5;
/// Speed above which crash detection waits for a possible recovery, m/s.
const UPSET_SPEED_M_S: f64 = 1.5;
/// Duration of the same attitude error that counts as loss of control, s (PX4: FD_FAIL_R_TTRI).
const ASTRAY_S: f64 = 0.3;
/// Time without position after which an automatic mode is aborted, s.
const BLIND_S: f64 = 1.0;

/// State of failsafe supervision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FailsafeState {
    /// The requested mode. A failsafe may fly another one.
    pub intended: FlightMode,
    /// Whether a failsafe overrides the requested mode.
    pub overridden: bool,
    /// Start of the time on the ground.
    pub standing_since: SimTime,
    /// Whether the vehicle has flown since arming.
    pub flown: bool,
    /// Cosine of the angle between desired and estimated thrust direction.
    pub attitude_error_cosine: f64,
    /// Start of the upset attitude.
    pub upset_since: Option<SimTime>,
    /// Start of the attitude error.
    off_attitude_since: Option<SimTime>,
    due: SimTime,
    manual_lost: Option<SimTime>,
    no_position_since: Option<SimTime>,
    low_warned: bool,
    critical_warned: bool,
    /// Highest battery level (1 low, 2 critical, 3 emergency) whose failsafe has acted in this flight. Each level acts once, so
    /// the pilot can override it.
    battery_level_handled: usize,
    /// Start of the time below the low and critical voltages.
    low_voltage_since: [Option<SimTime>; 2],
    /// Whether sticks were received since arming. Their loss then counts in automatic modes too.
    pub sticks_seen: bool,
    /// Whether a command started the mission in this flight.
    pub mission_started: bool,
    /// Whether the vehicle has been above the minimum fence height in this flight.
    pub above_floor: bool,
    /// Heading at arming, rad.
    pub armed_yaw_rad: Option<f64>,
}

impl FailsafeState {
    /// Resets the state of the flight at arming.
    pub(super) fn begin_flight(&mut self) {
        (self.sticks_seen, self.mission_started, self.above_floor) = (false, false, false);
    }
}

impl Default for FailsafeState {
    fn default() -> Self {
        Self {
            intended: FlightMode::Position,
            overridden: false,
            standing_since: SimTime::ZERO,
            flown: false,
            attitude_error_cosine: 1.0,
            upset_since: None,
            off_attitude_since: None,
            due: SimTime::ZERO,
            manual_lost: None,
            no_position_since: None,
            low_warned: false,
            critical_warned: false,
            battery_level_handled: 0,
            low_voltage_since: [None; 2],
            sticks_seen: false,
            mission_started: false,
            above_floor: false,
            armed_yaw_rad: None,
        }
    }
}

/// Mode and reason of a failsafe.
type FailsafeAction = Option<(FlightMode, &'static str)>;

impl Autopilot {
    pub(super) fn run_failsafes(&mut self, now: SimTime) {
        if now < self.failsafe.due {
            return;
        }
        self.failsafe.due = now + PERIOD;
        if self.status.home_m.is_none() && self.estimate.position_valid {
            self.move_home(self.estimate.position_m);
        }
        self.warn_of_battery();
        self.update_fence_state();
        if !self.status.armed {
            self.status.arming_reasons = self.prearm_reasons(now);
            self.status.failsafe = None;
            self.failsafe.overridden = false;
            self.failsafe.manual_lost = None;
            self.status.mode = self.failsafe.intended;
            return;
        }
        self.status.arming_reasons.clear();
        self.check_attitude_tracking(now);
        self.check_crash_attitude(now);
        if self.status.armed && self.status.landed != LandedState::OnGround {
            self.enforce_fence(now);
        }
        if self.status.armed && self.status.landed != LandedState::OnGround {
            self.check_failures(now);
        }
    }

    fn check_failures(&mut self, now: SimTime) {
        let action = self.position_lost(now).or_else(|| self.manual_lost(now)).or_else(|| self.link_lost(now));
        match action {
            Some((mode, why)) => {
                if self.status.failsafe.as_deref() != Some(why) {
                    self.status.failsafe = Some(why.into());
                    self.push_event(Severity::Critical, format!("Failsafe: {why}"));
                }
                self.failsafe.overridden = true;
                if self.status.mode != mode {
                    self.enter(mode, now);
                }
            }
            None => {
                if self.status.failsafe.take().is_some() {
                    self.push_event(Severity::Info, "Failsafe cleared");
                }
                if self.failsafe.overridden {
                    self.failsafe.overridden = false;
                    self.enter(self.failsafe.intended, now);
                }
            }
        }
    }

    /// Handles loss of position. The pilot gets altitude mode; automatic modes descend in place.
    fn position_lost(&mut self, now: SimTime) -> FailsafeAction {
        if self.estimate.position_valid || !self.failsafe.intended.needs_position() {
            self.failsafe.no_position_since = None;
            return None;
        }
        let since = *self.failsafe.no_position_since.get_or_insert(now);
        let pilot = self.links.sticks_fresh(self.tuning.manual_timeout_s(), now);
        let lands = self.tuning.rules.responses.blind_lands;
        match (pilot && !lands, self.failsafe.intended) {
            (true, _) if self.failsafe.intended.is_manual() || (now - since).s() > BLIND_S => {
                Some((FlightMode::Altitude, "position lost, holding height only"))
            }
            (false, _) if (now - since).s() > BLIND_S => Some((FlightMode::Land, "position lost, landing")),
            _ => None,
        }
    }

    fn manual_lost(&mut self, now: SimTime) -> FailsafeAction {
        let fresh = self.links.sticks_fresh(self.tuning.manual_timeout_s(), now);
        self.failsafe.sticks_seen |= fresh;
        let intended = self.failsafe.intended;
        let except = self.tuning.rules.responses.manual_loss_except;
        let counts = intended.is_manual() || self.failsafe.sticks_seen && !except.cover(intended);
        if fresh || !counts {
            self.failsafe.manual_lost = None;
            return None;
        }
        let since = *self.failsafe.manual_lost.get_or_insert(now);
        let hold = if self.estimate.position_valid { FlightMode::Hold } else { FlightMode::Land };
        let why = "manual control lost";
        if (now - since).s() < self.tuning.failsafe_delay_s {
            return Some((hold, why));
        }
        self.link_lost_action(self.tuning.manual_loss, hold, why)
    }

    /// Returns the failsafe for a lost link. Disarms if the action is to terminate.
    fn link_lost_action(&mut self, loss: LinkLossAction, hold: FlightMode, why: &'static str) -> FailsafeAction {
        if loss == LinkLossAction::Terminate {
            self.disarm(&format!("Disarmed: {why}"));
            return None;
        }
        Some((self.loss_mode(loss, hold), why))
    }

    fn loss_mode(&self, loss: LinkLossAction, hold: FlightMode) -> FlightMode {
        match loss {
            LinkLossAction::Return if self.estimate.position_valid => FlightMode::Return,
            LinkLossAction::Return | LinkLossAction::Land | LinkLossAction::Terminate => FlightMode::Land,
            LinkLossAction::Ignore | LinkLossAction::Hold => hold,
        }
    }

    fn link_lost(&mut self, now: SimTime) -> FailsafeAction {
        let t = &self.tuning;
        let silent = |at: Option<SimTime>, limit: f64| at.is_some_and(|at| (now - at).s() > limit);
        if self.failsafe.intended == FlightMode::Offboard && !self.links.offboard_fresh(t.offboard_timeout_s(), now) {
            if t.setpoints_end {
                self.end_offboard(now);
                return None;
            }
            return self.offboard_lost(now);
        }
        let counts =
            t.data_link_loss != LinkLossAction::Ignore && !t.rules.responses.data_link_loss_except.cover(self.failsafe.intended);
        if counts && silent(self.links.ground_station, t.data_link_timeout_s()) {
            return self.link_lost_action(t.data_link_loss, FlightMode::Hold, "ground station lost");
        }
        None
    }

    fn offboard_lost(&mut self, now: SimTime) -> FailsafeAction {
        let why = "external setpoints lost";
        let located = self.estimate.position_valid;
        let hold = if located { FlightMode::Hold } else { FlightMode::Land };
        match self.tuning.rules.responses.offboard_loss {
            OffboardLoss::Sticks(mode) => {
                let pilot = self.links.sticks_fresh(self.tuning.manual_timeout_s(), now);
                let flown = pilot && (located || !mode.needs_position());
                if flown { Some((mode, why)) } else { self.link_lost_action(self.tuning.manual_loss, hold, why) }
            }
            OffboardLoss::Fixed(FailsafeResponse::Terminate) => self.link_lost_action(LinkLossAction::Terminate, hold, why),
            OffboardLoss::Fixed(FailsafeResponse::Return) => Some((self.loss_mode(LinkLossAction::Return, hold), why)),
            OffboardLoss::Fixed(FailsafeResponse::Land) => Some((FlightMode::Land, why)),
            OffboardLoss::Fixed(FailsafeResponse::Hold | FailsafeResponse::Warn) => Some((hold, why)),
        }
    }

    /// Continues to the position of the last setpoint if it had one; otherwise stops.
    pub(super) fn end_offboard(&mut self, now: SimTime) {
        self.failsafe.intended = FlightMode::Hold;
        let paused = self.navigator.paused;
        self.enter(FlightMode::Hold, now);
        // A setpoint can time out while it is paused.
        self.navigator.paused = paused;
        if let Some((OffboardSetpoint { position_m: [Some(n), Some(e), Some(d)], yaw_rad, .. }, _)) = self.links.offboard {
            self.navigator.target_m = Vec3::new(n, e, d);
            self.navigator.target_yaw_rad = yaw_rad;
        }
    }

    fn warn_of_battery(&mut self) {
        let Some(left) = self.unfused.battery.map(|b| b.remaining_pct) else { return };
        let (low, critical) = (self.tuning.battery_low_pct, self.tuning.battery_critical_pct);
        if left < low && !self.failsafe.low_warned {
            self.failsafe.low_warned = true;
            self.push_event(Severity::Warning, format!("Low battery: {left:.0} %"));
        }
        if left < critical && !self.failsafe.critical_warned {
            self.failsafe.critical_warned = true;
            self.push_event(Severity::Critical, format!("Critical battery: {left:.0} %"));
        }
        // A battery change on the ground re-enables the warnings.
        if left > low + 5.0 {
            self.failsafe.low_warned = false;
            self.failsafe.critical_warned = false;
        }
        let flying = self.status.armed && self.status.landed != LandedState::OnGround;
        if flying {
            self.check_battery(left);
        } else {
            (self.failsafe.battery_level_handled, self.failsafe.low_voltage_since) = (0, [None; 2]);
        }
    }

    /// Battery level: 0 good, 1 low, 2 critical, 3 emergency.
    fn battery_level(&mut self, left_pct: f64) -> usize {
        let rules = self.tuning.rules.responses;
        let voltage_v = self.unfused.battery.map_or(f64::INFINITY, |b| b.voltage_v);
        let now = self.last_step;
        let mut sagged = [false; 2];
        for (k, limit_v) in rules.battery_low_v.into_iter().enumerate() {
            let since = &mut self.failsafe.low_voltage_since[k];
            *since = if voltage_v < limit_v { since.or(Some(now)) } else { None };
            sagged[k] = since.is_some_and(|since| (now - since).s() >= rules.battery_low_s);
        }
        match left_pct {
            left if left < rules.battery_emergency_pct.min(self.tuning.battery_critical_pct) => 3,
            left if left < self.tuning.battery_critical_pct || sagged[1] => 2,
            left if left < self.tuning.battery_low_pct || sagged[0] => 1,
            _ => 0,
        }
    }

    /// Runs the battery failsafe. It also acts on a flight that started with a low battery, or that had no position when the
    /// level was reached.
    fn check_battery(&mut self, left_pct: f64) {
        const NAMES: [&str; 4] = ["", "low battery", "critical battery", "battery emergency"];
        let level = self.battery_level(left_pct);
        if level <= self.failsafe.battery_level_handled {
            return;
        }
        // The most severe action configured at or below this level.
        let set = self.tuning.rules.responses.battery;
        let Some((level, response)) =
            (self.failsafe.battery_level_handled + 1..=level).rev().find_map(|k| Some((k, set[k - 1]?)))
        else {
            return;
        };
        if response == FailsafeResponse::Return && !self.estimate.position_valid {
            return;
        }
        self.failsafe.battery_level_handled = level;
        self.apply_response(response, NAMES[level], if level == 1 { Severity::Warning } else { Severity::Critical });
    }

    /// Applies a lasting failsafe action. The pilot can override it.
    fn apply_response(&mut self, response: FailsafeResponse, why: &str, severity: Severity) {
        let located = self.estimate.position_valid;
        let (mode, what) = match response {
            FailsafeResponse::Warn => return,
            FailsafeResponse::Hold if located => (FlightMode::Hold, "holding"),
            FailsafeResponse::Return if located => (FlightMode::Return, "returning"),
            FailsafeResponse::Hold | FailsafeResponse::Return | FailsafeResponse::Land => (FlightMode::Land, "landing"),
            FailsafeResponse::Terminate => {
                self.disarm(&format!("Disarmed: {why}"));
                return;
            }
        };
        self.push_event(severity, format!("Failsafe: {why}, {what}"));
        self.failsafe.intended = mode;
        self.enter(mode, self.last_step);
    }

    /// Reports a vehicle in the air that does not follow its attitude setpoint because of a failed motor, failed propeller or
    /// obstruction. Acts once per flight.
    fn check_attitude_tracking(&mut self, now: SimTime) {
        if self.failsafe.attitude_error_cosine > UPSET_COSINE || self.status.landed == LandedState::OnGround {
            self.failsafe.off_attitude_since = None;
            return;
        }
        let since = *self.failsafe.off_attitude_since.get_or_insert(now);
        if self.status.health.tracks_attitude && (now - since).s() > ASTRAY_S {
            self.status.health.tracks_attitude = false;
            self.push_event(Severity::Critical, "Attitude lost: motor or propeller failure?");
            self.apply_response(self.tuning.rules.responses.motor_failure, "motor failure", Severity::Critical);
        }
    }

    /// Stops the motors if the vehicle is stuck in an attitude from which it cannot recover.
    fn check_crash_attitude(&mut self, now: SimTime) {
        let moving = self.estimate.velocity_m_s.norm() > UPSET_SPEED_M_S;
        let checked = self.tuning.rules.responses.crash_check;
        if !checked || self.failsafe.attitude_error_cosine > UPSET_COSINE || moving || self.status.landed == LandedState::OnGround
        {
            self.failsafe.upset_since = None;
            return;
        }
        let since = *self.failsafe.upset_since.get_or_insert(now);
        if (now - since).s() > UPSET_S {
            self.push_event(Severity::Critical, "Crash detected");
            self.disarm("Disarmed: crashed");
        }
    }

    /// Reasons that prevent arming now.
    #[must_use]
    pub fn arming_reasons(&self, now: SimTime) -> Vec<String> {
        let mut out = self.ground_arming_reasons(now);
        out.extend(self.stick_arming_refusal(now).map(str::to_owned));
        out
    }

    /// Reasons for failed pre-arm checks.
    fn prearm_reasons(&self, now: SimTime) -> Vec<String> {
        if self.tuning.arms_by_mode { self.ground_arming_reasons(now) } else { self.arming_reasons(now) }
    }

    fn stick_arming_refusal(&self, now: SimTime) -> Option<&'static str> {
        if !self.links.sticks_fresh(self.tuning.manual_timeout_s(), now) {
            return None;
        }
        if !self.tuning.arms_by_mode {
            return (self.links.deflection() > CENTRED).then_some("Sticks not centered");
        }
        let climbs = self.failsafe.intended.is_manual() && self.links.sticks.up > 0.0;
        if self.links.lateral_deflection() > CENTRED {
            Some("Sticks not centered")
        } else {
            climbs.then_some("Throttle too high")
        }
    }

    /// Returns true if arming needs a position: for the mode, for hold without a pilot, or for the geofence.
    fn needs_position_to_arm(&self, now: SimTime) -> bool {
        let pilot = self.links.sticks_fresh(self.tuning.manual_timeout_s(), now);
        !self.tuning.arms_by_mode || !pilot || self.failsafe.intended.needs_position() || self.status.fence.set
    }

    fn ground_arming_reasons(&self, now: SimTime) -> Vec<String> {
        let mut out: Vec<String> = Vec::new();
        let (e, rules) = (&self.estimate, &self.tuning.rules.responses);
        out.extend(self.missing_sensors());
        if !e.attitude_valid {
            out.push("Attitude not aligned".into());
            return out;
        }
        if !self.needs_position_to_arm(now) {
            // The mode does not need an estimate of position.
        } else if !self.estimator.located() {
            out.push("No GNSS fix".into());
        } else if !e.position_valid || e.horizontal_m > ARMING_ACCURACY_M {
            out.push("Position not accurate enough".into());
        }
        if (e.attitude * Vec3::<Frd>::new(0.0, 0.0, 1.0)).down() < LEVEL {
            out.push("Not level".into());
        }
        match self.unfused.battery {
            None => out.push("No battery measurement".into()),
            Some(b) if b.remaining_pct < self.tuning.battery_critical_pct.max(rules.arm_charge_pct) => {
                out.push("Battery too low".into());
            }
            Some(b) if b.voltage_v < rules.arm_voltage_v => out.push("Battery voltage too low".into()),
            Some(_) => {}
        }
        if rules.arm_needs_mission && self.mission.is_empty() {
            out.push("No mission".into());
        }
        if e.position_valid && self.breach_at(e.position_m).is_some() {
            out.push("Outside the geofence".into());
        }
        if self.unfused.range_up_m.is_some_and(|r| r < HEADROOM_M) {
            out.push("Obstacle above vehicle".into());
        }
        out
    }

    /// Switches to manual control when the sticks move in an automatic mode.
    pub(super) fn check_stick_takeover(&mut self, now: SimTime) {
        let automatic = self.failsafe.intended != FlightMode::Offboard && !self.failsafe.intended.is_manual();
        let rules = &self.tuning.rules.responses;
        let takes =
            automatic && self.tuning.stick_takeover || self.failsafe.intended == FlightMode::Offboard && rules.takeover_offboard;
        let flying = self.status.armed && matches!(self.status.landed, LandedState::InAir | LandedState::Landing);
        if takes && flying && !self.failsafe.overridden && self.links.moved(rules.takeover_share) {
            let mission = self.status.mode == FlightMode::Mission;
            self.push_event(
                Severity::Info,
                if mission { "Mission paused: pilot took over with sticks" } else { "Pilot took over with sticks" },
            );
            self.failsafe.intended = FlightMode::Position;
            self.enter(FlightMode::Position, now);
        }
    }
}
