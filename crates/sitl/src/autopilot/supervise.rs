//! Failsafes, arming checks, battery warnings, and the pilot's hand on the sticks.

use super::core::{Autopilot, Severity};
use super::operator_rules::{OffboardLoss, Response};
use super::{Landed, LinkLoss, Mode, OffboardSetpoint};
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
pub struct Watch {
    /// The mode that was asked for; a failsafe may fly another one meanwhile.
    pub intended: Mode,
    /// A failsafe acts in place of the intended mode.
    pub overridden: bool,
    /// Standing on the ground since.
    pub standing_since: SimTime,
    /// It has flown since it was armed.
    pub flown: bool,
    /// Cosine of the angle between wanted and believed thrust direction.
    pub aim_cosine: f64,
    /// Upset since.
    pub upset_since: Option<SimTime>,
    /// Away from the wanted attitude since.
    astray_since: Option<SimTime>,
    due: SimTime,
    manual_lost: Option<SimTime>,
    blind_since: Option<SimTime>,
    low_warned: bool,
    critical_warned: bool,
    /// The gravest battery level (1 low, 2 critical, 3 emergency) whose failsafe has acted in this flight: each does so once, the pilot has the
    /// last word.
    battery_acted: usize,
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

impl Watch {
    /// Motors are armed: nothing has happened yet.
    pub(super) fn begin_flight(&mut self) {
        (self.sticks_seen, self.mission_started, self.above_floor) = (false, false, false);
    }
}

impl Default for Watch {
    fn default() -> Self {
        Self {
            intended: Mode::Position,
            overridden: false,
            standing_since: SimTime::ZERO,
            flown: false,
            aim_cosine: 1.0,
            upset_since: None,
            astray_since: None,
            due: SimTime::ZERO,
            manual_lost: None,
            blind_since: None,
            low_warned: false,
            critical_warned: false,
            battery_acted: 0,
            low_voltage_since: [None; 2],
            sticks_seen: false,
            mission_started: false,
            above_floor: false,
            armed_yaw_rad: None,
        }
    }
}

/// What a failsafe does, and why.
type Action = Option<(Mode, &'static str)>;

impl Autopilot {
    pub(super) fn supervise(&mut self, now: SimTime) {
        if now < self.watch.due {
            return;
        }
        self.watch.due = now + PERIOD;
        if self.status.home_m.is_none() && self.estimate.position_valid {
            self.move_home(self.estimate.position_m);
        }
        self.warn_of_battery();
        self.note_fence();
        if !self.status.armed {
            self.status.arming_reasons = self.prearm_reasons(now);
            self.status.failsafe = None;
            self.watch.overridden = false;
            self.watch.manual_lost = None;
            self.status.mode = self.watch.intended;
            return;
        }
        self.status.arming_reasons.clear();
        self.watch_obedience(now);
        self.watch_attitude(now);
        if self.status.armed && self.status.landed != Landed::OnGround {
            self.keep_fence(now);
        }
        if self.status.armed && self.status.landed != Landed::OnGround {
            self.act_on_failures(now);
        }
    }

    fn act_on_failures(&mut self, now: SimTime) {
        let action = self.blind(now).or_else(|| self.manual_lost(now)).or_else(|| self.link_lost(now));
        match action {
            Some((mode, why)) => {
                if self.status.failsafe.as_deref() != Some(why) {
                    self.status.failsafe = Some(why.into());
                    self.say(Severity::Critical, format!("Failsafe: {why}"));
                }
                self.watch.overridden = true;
                if self.status.mode != mode {
                    self.enter(mode, now);
                }
            }
            None => {
                if self.status.failsafe.take().is_some() {
                    self.say(Severity::Info, "Failsafe cleared");
                }
                if self.watch.overridden {
                    self.watch.overridden = false;
                    self.enter(self.watch.intended, now);
                }
            }
        }
    }

    /// Position is lost: the pilot gets the altitude mode, an automatic mode sinks where it is.
    fn blind(&mut self, now: SimTime) -> Action {
        if self.estimate.position_valid || !self.watch.intended.needs_position() {
            self.watch.blind_since = None;
            return None;
        }
        let since = *self.watch.blind_since.get_or_insert(now);
        let pilot = self.links.sticks_fresh(self.tuning.manual_patience_s(), now);
        let lands = self.tuning.rules.responses.blind_lands;
        match (pilot && !lands, self.watch.intended) {
            (true, _) if self.watch.intended.is_manual() || (now - since).s() > BLIND_S => {
                Some((Mode::Altitude, "position lost, holding height only"))
            }
            (false, _) if (now - since).s() > BLIND_S => Some((Mode::Land, "position lost, landing")),
            _ => None,
        }
    }

    fn manual_lost(&mut self, now: SimTime) -> Action {
        let fresh = self.links.sticks_fresh(self.tuning.manual_patience_s(), now);
        self.watch.sticks_seen |= fresh;
        let intended = self.watch.intended;
        let except = self.tuning.rules.responses.manual_loss_except;
        let counts = intended.is_manual() || self.watch.sticks_seen && !except.cover(intended);
        if fresh || !counts {
            self.watch.manual_lost = None;
            return None;
        }
        let since = *self.watch.manual_lost.get_or_insert(now);
        let hold = if self.estimate.position_valid { Mode::Hold } else { Mode::Land };
        let why = "manual control lost";
        if (now - since).s() < self.tuning.failsafe_delay_s {
            return Some((hold, why));
        }
        self.lost(self.tuning.manual_loss, hold, why)
    }

    /// What a lost link leads to.
    fn lost(&mut self, loss: LinkLoss, hold: Mode, why: &'static str) -> Action {
        if loss == LinkLoss::Terminate {
            self.disarm(&format!("Disarmed: {why}"));
            return None;
        }
        Some((self.loss_mode(loss, hold), why))
    }

    fn loss_mode(&self, loss: LinkLoss, hold: Mode) -> Mode {
        match loss {
            LinkLoss::Return if self.estimate.position_valid => Mode::Return,
            LinkLoss::Return | LinkLoss::Land | LinkLoss::Terminate => Mode::Land,
            LinkLoss::Ignore | LinkLoss::Hold => hold,
        }
    }

    fn link_lost(&mut self, now: SimTime) -> Action {
        let t = &self.tuning;
        let silent = |at: Option<SimTime>, limit: f64| at.is_some_and(|at| (now - at).s() > limit);
        if self.watch.intended == Mode::Offboard && !self.links.offboard_fresh(t.offboard_patience_s(), now) {
            if t.setpoints_end {
                self.end_errand(now);
                return None;
            }
            return self.offboard_lost(now);
        }
        let counts = t.data_link_loss != LinkLoss::Ignore && !t.rules.responses.data_link_loss_except.cover(self.watch.intended);
        if counts && silent(self.links.ground_station, t.data_link_patience_s()) {
            return self.lost(t.data_link_loss, Mode::Hold, "ground station lost");
        }
        None
    }

    fn offboard_lost(&mut self, now: SimTime) -> Action {
        let why = "external set-points lost";
        let located = self.estimate.position_valid;
        let hold = if located { Mode::Hold } else { Mode::Land };
        match self.tuning.rules.responses.offboard_loss {
            OffboardLoss::Sticks(mode) => {
                let pilot = self.links.sticks_fresh(self.tuning.manual_patience_s(), now);
                let flown = pilot && (located || !mode.needs_position());
                if flown { Some((mode, why)) } else { self.lost(self.tuning.manual_loss, hold, why) }
            }
            OffboardLoss::Fixed(Response::Terminate) => self.lost(LinkLoss::Terminate, hold, why),
            OffboardLoss::Fixed(Response::Return) => Some((self.loss_mode(LinkLoss::Return, hold), why)),
            OffboardLoss::Fixed(Response::Land) => Some((Mode::Land, why)),
            OffboardLoss::Fixed(Response::Hold | Response::Warn) => Some((hold, why)),
        }
    }

    /// To the place of the last set-point, where it had one; else it stops.
    pub(super) fn end_errand(&mut self, now: SimTime) {
        self.watch.intended = Mode::Hold;
        let paused = self.course.paused;
        self.enter(Mode::Hold, now);
        // A setpoint may run out while it is paused.
        self.course.paused = paused;
        if let Some((OffboardSetpoint { position_m: [Some(n), Some(e), Some(d)], yaw_rad, .. }, _)) = self.links.offboard {
            self.course.target_m = Vec3::new(n, e, d);
            self.course.target_yaw_rad = yaw_rad;
        }
    }

    fn warn_of_battery(&mut self) {
        let Some(left) = self.seen.battery.map(|b| b.remaining_pct) else { return };
        let (low, critical) = (self.tuning.battery_low_pct, self.tuning.battery_critical_pct);
        if left < low && !self.watch.low_warned {
            self.watch.low_warned = true;
            self.say(Severity::Warning, format!("Low battery: {left:.0} %"));
        }
        if left < critical && !self.watch.critical_warned {
            self.watch.critical_warned = true;
            self.say(Severity::Critical, format!("Critical battery: {left:.0} %"));
        }
        // A pack that was changed on the ground warns again.
        if left > low + 5.0 {
            self.watch.low_warned = false;
            self.watch.critical_warned = false;
        }
        let flying = self.status.armed && self.status.landed != Landed::OnGround;
        if flying {
            self.act_on_battery(left);
        } else {
            (self.watch.battery_acted, self.watch.low_voltage_since) = (0, [None; 2]);
        }
    }

    /// How grave the battery's state is: 0 good, 1 low, 2 critical, 3 emergency.
    fn battery_level(&mut self, left_pct: f64) -> usize {
        let rules = self.tuning.rules.responses;
        let voltage_v = self.seen.battery.map_or(f64::INFINITY, |b| b.voltage_v);
        let now = self.last_step;
        let mut sagged = [false; 2];
        for (k, limit_v) in rules.battery_low_v.into_iter().enumerate() {
            let since = &mut self.watch.low_voltage_since[k];
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
    fn act_on_battery(&mut self, left_pct: f64) {
        const NAMES: [&str; 4] = ["", "low battery", "critical battery", "battery emergency"];
        let level = self.battery_level(left_pct);
        if level <= self.watch.battery_acted {
            return;
        }
        // The gravest reaction that is set at or below this level.
        let set = self.tuning.rules.responses.battery;
        let Some((level, response)) = (self.watch.battery_acted + 1..=level).rev().find_map(|k| Some((k, set[k - 1]?))) else {
            return;
        };
        if response == Response::Return && !self.estimate.position_valid {
            return;
        }
        self.watch.battery_acted = level;
        self.respond(response, NAMES[level], if level == 1 { Severity::Warning } else { Severity::Critical });
    }

    /// Carries out a reaction that stays: the pilot has the last word.
    fn respond(&mut self, response: Response, why: &str, severity: Severity) {
        let located = self.estimate.position_valid;
        let (mode, what) = match response {
            Response::Warn => return,
            Response::Hold if located => (Mode::Hold, "holding"),
            Response::Return if located => (Mode::Return, "returning"),
            Response::Hold | Response::Return | Response::Land => (Mode::Land, "landing"),
            Response::Terminate => {
                self.disarm(&format!("Disarmed: {why}"));
                return;
            }
        };
        self.say(severity, format!("Failsafe: {why}, {what}"));
        self.watch.intended = mode;
        self.enter(mode, self.last_step);
    }

    /// In the air it does not turn as it is told: a motor or propeller has failed, or something holds it. Told once in a flight.
    fn watch_obedience(&mut self, now: SimTime) {
        if self.watch.aim_cosine > UPSET_COSINE || self.status.landed == Landed::OnGround {
            self.watch.astray_since = None;
            return;
        }
        let since = *self.watch.astray_since.get_or_insert(now);
        if self.status.health.obeys && (now - since).s() > ASTRAY_S {
            self.status.health.obeys = false;
            self.say(Severity::Critical, "Attitude lost: motor or propeller failure?");
            self.respond(self.tuning.rules.responses.motor_failure, "motor failure", Severity::Critical);
        }
    }

    /// Lying somewhere in an attitude that the rotors cannot mend: they stop.
    fn watch_attitude(&mut self, now: SimTime) {
        let moving = self.estimate.velocity_m_s.norm() > UPSET_SPEED_M_S;
        let checked = self.tuning.rules.responses.crash_check;
        if !checked || self.watch.aim_cosine > UPSET_COSINE || moving || self.status.landed == Landed::OnGround {
            self.watch.upset_since = None;
            return;
        }
        let since = *self.watch.upset_since.get_or_insert(now);
        if (now - since).s() > UPSET_S {
            self.say(Severity::Critical, "Crash detected");
            self.disarm("Disarmed: crashed");
        }
    }

    /// Why arming would be refused now.
    #[must_use]
    pub fn arming_reasons(&self, now: SimTime) -> Vec<String> {
        let mut out = self.standing_reasons(now);
        out.extend(self.sticks_in_the_way(now).map(str::to_owned));
        out
    }

    /// Why the checks before arming fail.
    fn prearm_reasons(&self, now: SimTime) -> Vec<String> {
        if self.tuning.arms_by_mode { self.standing_reasons(now) } else { self.arming_reasons(now) }
    }

    fn sticks_in_the_way(&self, now: SimTime) -> Option<&'static str> {
        if !self.links.sticks_fresh(self.tuning.manual_patience_s(), now) {
            return None;
        }
        if !self.tuning.arms_by_mode {
            return (self.links.deflection() > CENTRED).then_some("Sticks not centred");
        }
        let climbs = self.watch.intended.is_manual() && self.links.sticks.up > 0.0;
        if self.links.lateral_deflection() > CENTRED { Some("Sticks not centred") } else { climbs.then_some("Throttle too high") }
    }

    /// The mode, the hold in its place while nobody has the sticks, or the fence needs a position.
    fn needs_position_to_arm(&self, now: SimTime) -> bool {
        let pilot = self.links.sticks_fresh(self.tuning.manual_patience_s(), now);
        !self.tuning.arms_by_mode || !pilot || self.watch.intended.needs_position() || self.status.fence.set
    }

    fn standing_reasons(&self, now: SimTime) -> Vec<String> {
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
        match self.seen.battery {
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
        if self.seen.range_up_m.is_some_and(|r| r < HEADROOM_M) {
            out.push("Something stands over the vehicle".into());
        }
        out
    }

    /// Moved sticks take over from automatic flight.
    pub(super) fn take_over(&mut self, now: SimTime) {
        let automatic = self.watch.intended != Mode::Offboard && !self.watch.intended.is_manual();
        let rules = &self.tuning.rules.responses;
        let takes = automatic && self.tuning.stick_takeover || self.watch.intended == Mode::Offboard && rules.takeover_offboard;
        let flying = self.status.armed && matches!(self.status.landed, Landed::InAir | Landed::Landing);
        if takes && flying && !self.watch.overridden && self.links.moved(rules.takeover_share) {
            let mission = self.status.mode == Mode::Mission;
            self.say(
                Severity::Info,
                if mission { "Mission paused: pilot took over by the sticks" } else { "Pilot took over by the sticks" },
            );
            self.watch.intended = Mode::Position;
            self.enter(Mode::Position, now);
        }
    }
}
