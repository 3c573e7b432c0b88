//! Failsafes, arming checks, battery warnings, and the pilot's hand on the sticks.

use super::core::{Autopilot, Severity};
use super::operator_rules::{FailsafeResponse, OffboardLoss};
use super::{FlightMode, LandedState, LinkLossAction, OffboardSetpoint};
use spandrel_model::frames::{Frd, Vec3};
use spandrel_model::time::SimTime;

/// Failsafes and checks run this often.
const PERIOD: SimTime = SimTime::from_ms(50);
/// Sticks count as centred for arming within this.
const CENTRED: f64 = 0.2;
/// Level enough to arm, cosine of the tilt (20 degrees).
const LEVEL: f64 = 0.94;
/// Something this near above forbids arming, m.
const HEADROOM_M: f64 = 1.0;
/// Horizontal accuracy for arming, m (1 sigma).
const ARMING_ACCURACY_M: f64 = 5.0;
/// This far from the wanted attitude (40 degrees, as a cosine) for this long without flying: crashed, s.
const UPSET_COSINE: f64 = 0.766;
const UPSET_S: f64 = 2.5;
/// Still moving faster than this it may yet recover, m/s.
const UPSET_SPEED_M_S: f64 = 1.5;
/// As far from the wanted attitude for this long, it does not obey, s (PX4: FD_FAIL_R_TTRI).
const ASTRAY_S: f64 = 0.3;
/// Without position this long an automatic mode gives up, s.
const BLIND_S: f64 = 1.0;

/// What the supervision remembers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FailsafeState {
    /// The mode that was asked for; a failsafe may fly another one meanwhile.
    pub intended: FlightMode,
    /// A failsafe acts in place of the intended mode.
    pub overridden: bool,
    /// Standing on the ground since.
    pub standing_since: SimTime,
    /// It has flown since it was armed.
    pub flown: bool,
    /// Cosine of the angle between wanted and believed thrust direction.
    pub attitude_error_cosine: f64,
    /// Upset since.
    pub upset_since: Option<SimTime>,
    /// Away from the wanted attitude since.
    off_attitude_since: Option<SimTime>,
    due: SimTime,
    manual_lost: Option<SimTime>,
    no_position_since: Option<SimTime>,
    low_warned: bool,
    critical_warned: bool,
    /// The gravest battery level (1 low, 2 critical, 3 emergency) whose failsafe has acted in this flight: each does so once, the pilot has the
    /// last word.
    battery_level_handled: usize,
    /// Below the low and the critical voltage since.
    low_voltage_since: [Option<SimTime>; 2],
    /// Sticks have come since arming: their loss counts in automatic modes, too.
    pub sticks_seen: bool,
    /// The mission was started by a command in this flight.
    pub mission_started: bool,
    /// It has been above the fence's floor in this flight.
    pub above_floor: bool,
    /// Heading when motors were armed, rad.
    pub armed_yaw_rad: Option<f64>,
}

impl FailsafeState {
    /// Motors are armed: nothing has happened yet.
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

/// What a failsafe does, and why.
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

    /// Position is lost: the pilot gets the altitude mode, an automatic mode sinks where it is.
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

    /// What a lost link leads to.
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
        let why = "external set-points lost";
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

    /// To the place of the last set-point, where it had one; else it stops.
    pub(super) fn end_offboard(&mut self, now: SimTime) {
        self.failsafe.intended = FlightMode::Hold;
        let paused = self.navigator.paused;
        self.enter(FlightMode::Hold, now);
        // A setpoint may run out while it is paused.
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
        // A pack that was changed on the ground warns again.
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

    /// How grave the battery's state is: 0 good, 1 low, 2 critical, 3 emergency.
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

    /// Who took off with a low battery, or lost the position when it became low, is brought back too.
    fn check_battery(&mut self, left_pct: f64) {
        const NAMES: [&str; 4] = ["", "low battery", "critical battery", "battery emergency"];
        let level = self.battery_level(left_pct);
        if level <= self.failsafe.battery_level_handled {
            return;
        }
        // The gravest reaction that is set at or below this level.
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

    /// Carries out a reaction that stays: the pilot has the last word.
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

    /// In the air it does not turn as it is told: a motor or propeller has failed, or something holds it. Told once in a flight.
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

    /// Lying somewhere in an attitude that the rotors cannot mend: they stop.
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

    /// Why arming would be refused now.
    #[must_use]
    pub fn arming_reasons(&self, now: SimTime) -> Vec<String> {
        let mut out = self.ground_arming_reasons(now);
        out.extend(self.stick_arming_refusal(now).map(str::to_owned));
        out
    }

    /// Why the checks before arming fail.
    fn prearm_reasons(&self, now: SimTime) -> Vec<String> {
        if self.tuning.arms_by_mode { self.ground_arming_reasons(now) } else { self.arming_reasons(now) }
    }

    fn stick_arming_refusal(&self, now: SimTime) -> Option<&'static str> {
        if !self.links.sticks_fresh(self.tuning.manual_timeout_s(), now) {
            return None;
        }
        if !self.tuning.arms_by_mode {
            return (self.links.deflection() > CENTRED).then_some("Sticks not centred");
        }
        let climbs = self.failsafe.intended.is_manual() && self.links.sticks.up > 0.0;
        if self.links.lateral_deflection() > CENTRED { Some("Sticks not centred") } else { climbs.then_some("Throttle too high") }
    }

    /// The mode, the hold in its place while nobody has the sticks, or the fence needs a position.
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
            // The mode flies without.
        } else if !self.estimator.located() {
            out.push("No GNSS fix".into());
        } else if !e.position_valid || e.horizontal_m > ARMING_ACCURACY_M {
            out.push("Position not accurate enough".into());
        }
        if (e.attitude * Vec3::<Frd>::new(0.0, 0.0, 1.0)).down() < LEVEL {
            out.push("Not level".into());
        }
        match self.unfused.battery {
            None => out.push("Battery not measured".into()),
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
            out.push("Something stands over the vehicle".into());
        }
        out
    }

    /// Moved sticks take over from automatic flight.
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
                if mission { "Mission paused: pilot took over by the sticks" } else { "Pilot took over by the sticks" },
            );
            self.failsafe.intended = FlightMode::Position;
            self.enter(FlightMode::Position, now);
        }
    }
}
