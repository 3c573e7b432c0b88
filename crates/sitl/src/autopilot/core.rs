//! The autopilot object. It passes inputs and requests between the estimator, navigator, failsafes and control loops.

use super::control::airframe::Airframe;
use super::control::landed::{FlightPhase, LandingInput, PhaseChange};
use super::control::shaper::MotionLimits;
use super::control::{Control, ControlInput};
use super::estimator::estimate::Estimate;
use super::estimator::{Estimator, Pose};
use super::events::{AutopilotEvent, EventQueue, Severity};
use super::external_input::{OffboardSetpoint, Sticks};
use super::failsafe::Failsafe;
use super::failsafe::fence::FenceZone;
use super::failsafe::input::{FailsafeInput, FlightSummary};
use super::failsafe::losses::{Loss, LossResponse};
use super::failsafe::operator_rules::{FenceAutoEnable, FlightEnvelope, SCENARIO_BATTERY_ACTIONS};
use super::failsafe::response::FailsafeRequest;
use super::flight_state::FlightMode;
use super::navigator::Navigator;
use super::navigator::follow::FollowTarget;
use super::navigator::home::RallyPoint;
use super::navigator::input::NavigatorInput;
use super::navigator::mission::DeferredFields;
use super::navigator::mission_step::MissionStep;
use super::request::{AutopilotRequest, RequestOutcome};
use super::status::AutopilotStatus;
use super::tuning::Tuning;
use crate::physics::Actuators;
use crate::sensors::{BatteryReading, Readings};
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::geodesy::Geo;
use spandrel_model::scenario::SessionRules;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;

/// Rate of the control loops, Hz.
pub const CONTROL_HZ: f64 = 400.0;

/// Latest readings from the sensors that the estimator does not fuse.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct UnfusedReadings {
    battery: Option<BatteryReading>,
    range_down_m: Option<f64>,
    range_up_m: Option<f64>,
}

impl UnfusedReadings {
    fn update(&mut self, readings: &Readings) {
        self.battery = readings.battery.or(self.battery);
        self.range_down_m = readings.range_down_m.or(self.range_down_m);
        self.range_up_m = readings.range_up_m.or(self.range_up_m);
    }
}

/// Time of a call, and time since the last step, s.
#[derive(Debug, Clone, Copy)]
struct Tick {
    now: SimTime,
    dt_s: f64,
}

impl Tick {
    /// Returns the tick for a call between two steps.
    fn between_steps(now: SimTime) -> Self {
        Self { now, dt_s: 0.0 }
    }
}

/// The built-in autopilot. Plain data, so a clone is a snapshot.
#[derive(Debug, Clone)]
pub struct Autopilot {
    /// Operator settings. They can change between any two steps.
    pub tuning: Tuning,
    airframe: Airframe,
    estimator: Estimator,
    estimate: Estimate,
    navigator: Navigator,
    failsafe: Failsafe,
    control: Control,
    unfused: UnfusedReadings,
    armed: bool,
    /// Status for telemetry. Output only: the autopilot never reads it.
    status: AutopilotStatus,
    events: EventQueue,
    last_step: SimTime,
}

impl Autopilot {
    /// Starts the autopilot on the ground. `origin` is the origin of the local frame, used for the magnetic model and the air density.
    #[must_use]
    pub fn new(vehicle: &Vehicle, rules: &SessionRules, origin: Geo, mut tuning: Tuning) -> Self {
        if rules.low_battery_return {
            tuning.rules.responses.battery = SCENARIO_BATTERY_ACTIONS;
        }
        let estimator = Estimator::new(&vehicle.sensors, origin);
        Self {
            tuning,
            airframe: Airframe::new(vehicle, rules),
            estimate: estimator.estimate(),
            estimator,
            navigator: Navigator::default(),
            failsafe: Failsafe::new(&vehicle.sensors),
            control: Control::new(&vehicle.at_altitude(origin.altitude_m)),
            unfused: UnfusedReadings::default(),
            armed: false,
            status: AutopilotStatus::at_boot(),
            events: EventQueue::default(),
            last_step: SimTime::ZERO,
        }
    }

    /// Returns the operator settings for a scenario, whose rules define the battery thresholds.
    #[must_use]
    pub fn default_tuning(rules: &SessionRules) -> Tuning {
        Tuning {
            battery_low_pct: rules.low_battery_pct,
            battery_critical_pct: rules.critical_battery_pct,
            stick_response: rules.stick_response,
            ..Tuning::default()
        }
    }

    /// Returns true if the vehicle is armed and receives no stick input.
    #[must_use]
    pub fn is_unattended(&self, now: SimTime) -> bool {
        self.armed && !self.failsafe.links.has_recent_sticks(self.tuning.manual_timeout_s(), now)
    }

    /// Returns the airframe's limits without parameter overrides.
    #[must_use]
    pub fn airframe_envelope(&self) -> FlightEnvelope {
        let (limits, automatic) = (&self.airframe.limits, MotionLimits::automatic(&self.control.gains));
        FlightEnvelope {
            manual_speed_m_s: limits.forward_m_s,
            manual_climb_rate_m_s: limits.climb_m_s,
            manual_descent_rate_m_s: limits.descend_m_s,
            manual_yaw_rate_rad_s: limits.yaw_rate_rad_s,
            manual_tilt_rad: self.control.gains.tilt_rad,
            acceleration_m_s2: automatic.horizontal_acceleration_m_s2,
            climb_acceleration_m_s2: automatic.vertical_acceleration_m_s2,
            landing_descent_rate_m_s: limits.descend_m_s,
        }
    }

    /// Returns the current estimate.
    #[must_use]
    pub fn estimate(&self) -> &Estimate {
        &self.estimate
    }

    /// Returns the estimator, for covariance and bias telemetry.
    #[must_use]
    pub fn estimator(&self) -> &Estimator {
        &self.estimator
    }

    /// Returns the time of the last step.
    #[must_use]
    pub fn now(&self) -> SimTime {
        self.last_step
    }

    /// Returns the status for telemetry.
    #[must_use]
    pub fn status(&self) -> &AutopilotStatus {
        &self.status
    }

    /// Returns the conditions that currently prevent arming.
    #[must_use]
    pub fn arming_reasons(&self, now: SimTime) -> Vec<String> {
        let (tuning, estimate) = (&self.tuning, &self.estimate);
        self.failsafe.arming_reasons(&FailsafeInput { tuning, estimate, flight: self.flight_summary(), now })
    }

    /// Returns and clears the events since the last call, in order.
    pub fn drain_events(&mut self) -> Vec<AutopilotEvent> {
        self.events.drain()
    }

    /// Returns and clears the mission items reached since the last call, in order, for MISSION_ITEM_REACHED and payload items.
    pub fn drain_reached(&mut self) -> Vec<usize> {
        self.navigator.mission_status.reached = None;
        self.update_status();
        std::mem::take(&mut self.navigator.mission.reached)
    }

    /// Processes the pilot's stick input. Values are clamped to -1 to 1; NaN is treated as centered.
    pub fn sticks(&mut self, sticks: Sticks, now: SimTime) {
        self.failsafe.links.update_sticks(sticks, self.tuning.stick_deadband, now);
        let tick = Tick::between_steps(now);
        let request = self.supervise(tick, Failsafe::check_stick_takeover);
        self.apply_failsafe_request(request, tick);
        self.update_status();
    }

    /// Sets whether stick input arrives in guided mode, where the yaw stick changes the heading but does not take over
    /// control.
    pub fn set_sticks_in_guided(&mut self, flown: bool) {
        self.failsafe.links.guided = flown;
    }

    /// Handles an intentional release of the sticks, which does not trigger a failsafe.
    pub fn release_sticks(&mut self) {
        self.failsafe.release_sticks(self.navigator.modes.intended.is_manual());
    }

    /// Processes an external setpoint.
    pub fn offboard(&mut self, setpoint: OffboardSetpoint, now: SimTime) {
        self.failsafe.links.offboard = Some((setpoint, now));
        self.navigator.record_external_setpoint();
    }

    /// Records a heartbeat from a ground station.
    pub fn record_ground_station_heartbeat(&mut self, now: SimTime) {
        self.failsafe.links.ground_station = Some(now);
    }

    /// Returns the velocity, in m/s, of a target that reports only positions, computed from its last two positions.
    #[must_use]
    pub fn target_velocity(&self, position_m: Vec3<Ned>, now: SimTime) -> Vec3<Ned> {
        self.navigator.follower.target_velocity(position_m, now)
    }

    /// Handles a target report for follow mode.
    pub fn report_target(&mut self, target: FollowTarget, now: SimTime) {
        self.navigator.follower.report(target, &self.tuning.follow, now);
    }

    /// Replaces the mission. The first item becomes current.
    pub fn set_mission(&mut self, steps: Vec<MissionStep>) {
        self.navigate(Tick::between_steps(self.last_step), |navigator, input| navigator.set_mission(steps, input));
        self.update_status();
    }

    /// Marks the mission items whose heights are relative to home. Call it immediately after setting the mission, with
    /// heights computed from the home position at that time.
    pub fn set_home_relative_steps(&mut self, home_relative: Vec<bool>) {
        self.navigator.mission.set_home_relative_items(home_relative);
    }

    /// Sets the fields that mission items take from the vehicle position when they start. Call it immediately after
    /// setting the mission.
    pub fn set_deferred_fields(&mut self, deferred: Vec<DeferredFields>) {
        self.navigator.mission.set_deferred(deferred);
    }

    /// Jumps to a mission item. If `restart` is true, resets the mission's progress first. Returns false if the item does not
    /// exist.
    pub fn set_mission_current(&mut self, index: usize, restart: bool) -> bool {
        let known = self.navigator.set_mission_current(index, restart);
        self.update_status();
        known
    }

    /// Replaces the rally points. A return flies to the nearest one or to home.
    pub fn set_rally_points(&mut self, rally_points: Vec<RallyPoint>) {
        self.navigator.home.rally_points = rally_points;
    }

    /// Replaces the geofence zones.
    pub fn set_fence(&mut self, zones: Vec<FenceZone>) {
        self.failsafe.fence.set_zones(zones);
    }

    /// Handles a request and returns its outcome.
    pub fn request(&mut self, request: AutopilotRequest, now: SimTime) -> RequestOutcome {
        let tick = Tick::between_steps(now);
        let outcome = match request {
            AutopilotRequest::Arm { force } => self.arm(force, tick),
            AutopilotRequest::Disarm { force } => self.disarm_on_request(force, tick),
            AutopilotRequest::SetMode(_)
            | AutopilotRequest::Takeoff { .. }
            | AutopilotRequest::Land
            | AutopilotRequest::GoTo { .. }
            | AutopilotRequest::Turn(_)
            | AutopilotRequest::StartMission { .. }
            | AutopilotRequest::SetSpeed(_)
            | AutopilotRequest::SetHome(_)
            | AutopilotRequest::Orbit(_)
            | AutopilotRequest::LookAt(_)
            | AutopilotRequest::EnableFence(_)
            | AutopilotRequest::CircleAhead
            | AutopilotRequest::LandingSequence
            | AutopilotRequest::Pause(_) => self.navigate(tick, |navigator, input| navigator.request(request, input)),
        };
        self.update_status();
        outcome
    }

    /// Runs one control step (400 Hz) with the readings since the last step.
    pub fn step(&mut self, readings: &Readings, now: SimTime) -> Actuators {
        let tick = Tick { now, dt_s: (now - self.last_step).s().clamp(0.0, 0.05) };
        self.last_step = now;
        self.update_estimate(readings, now);
        self.run_failsafes(tick);
        self.status.intended = self.navigator.modes.intended;
        let t = &self.tuning;
        (self.status.battery_low_pct, self.status.battery_critical_pct) = (t.battery_low_pct, t.battery_critical_pct);
        let actuators = if self.armed { self.fly(tick) } else { self.control.keep_motors_stopped(&self.estimate) };
        self.update_status();
        actuators
    }

    fn fly(&mut self, tick: Tick) -> Actuators {
        self.update_phase(tick);
        if !self.armed {
            return self.control.stop_motors();
        }
        let setpoint = self.navigate(tick, |navigator, input| {
            navigator.record_path(input);
            navigator.setpoint(input)
        });
        let input = ControlInput {
            estimate: &self.estimate,
            airframe: &self.airframe,
            battery: self.unfused.battery,
            yaw_rate_rad_s: self.navigator.yaw_rate_rad_s(),
            now: tick.now,
            dt_s: tick.dt_s,
        };
        self.control.track(setpoint, &input)
    }

    fn update_estimate(&mut self, readings: &Readings, now: SimTime) {
        let readings = &self.failsafe.sensors.filter(readings, now);
        let rules = &self.tuning.rules;
        self.estimator.configure(rules.dead_reckoning_limit_s, rules.height_reference, !self.armed);
        self.estimator.step(readings, now);
        self.estimate = self.estimator.estimate();
        if let Some(step_m) = self.estimator.take_position_reset() {
            self.navigator.move_position_lock(step_m);
            let text = format!("GNSS position jumped {:.0} m: position reset", step_m.horizontal_norm());
            self.events.push(Severity::Critical, text);
        }
        self.unfused.update(readings);
        self.failsafe.check_sensors(self.estimator.dropped(), now);
        self.events.append(&mut self.failsafe.events);
    }

    /// Continues after a respawn in the air: resets the estimator and controllers to this state, armed. Keeps a manual
    /// mode; otherwise switches to Hold. The aircraft was at `from_m`.
    pub fn respawn(&mut self, from_m: Vec3<Ned>, pose: &Pose, now: SimTime) {
        self.continue_at(from_m, pose, now);
        self.events.push(Severity::Warning, "Respawned at last safe hover");
    }

    /// The same as [`Self::respawn`] without a text, for a rewind.
    pub fn continue_at(&mut self, from_m: Vec3<Ned>, pose: &Pose, now: SimTime) {
        self.estimator.reset_to_pose(from_m, pose, now);
        self.estimate = self.estimator.estimate();
        self.armed = true;
        self.failsafe.continue_in_air();
        self.control.reset();
        self.control.landing.continue_in_air(now);
        self.navigate(Tick::between_steps(now), Navigator::continue_in_air);
        self.update_status();
    }

    fn arm(&mut self, force: bool, tick: Tick) -> RequestOutcome {
        if self.armed {
            return RequestOutcome::Accepted;
        }
        let reasons = self.arming_reasons(tick.now);
        if !force && !reasons.is_empty() {
            return RequestOutcome::TemporarilyRejected(format!("Arming denied: {}", reasons.join(", ")));
        }
        self.armed = true;
        self.tuning.fence_enabled |= self.tuning.rules.fence.auto == FenceAutoEnable::OnArming;
        self.failsafe.begin_flight();
        self.control.begin_flight(tick.now);
        self.navigate(tick, Navigator::begin_flight);
        self.events.push(Severity::Info, "Armed");
        RequestOutcome::Accepted
    }

    fn disarm_on_request(&mut self, force: bool, tick: Tick) -> RequestOutcome {
        if self.armed && self.control.landing.phase != FlightPhase::OnGround && !force {
            return RequestOutcome::TemporarilyRejected("Disarming denied: not landed".into());
        }
        if self.armed {
            self.disarm("Disarmed", tick);
        }
        RequestOutcome::Accepted
    }

    fn disarm(&mut self, why: &str, tick: Tick) {
        self.armed = false;
        self.control.landing.disarm();
        self.failsafe.end_flight();
        self.tuning.fence_enabled |= !self.tuning.fence_switch_persists;
        self.tuning.fence_enabled &= self.tuning.rules.fence.auto == FenceAutoEnable::Never;
        self.events.push(Severity::Info, why);
        self.navigate(tick, Navigator::end_flight);
    }

    /// Calls the navigator with its inputs, and collects its events and requests.
    fn navigate<T>(&mut self, tick: Tick, call: impl FnOnce(&mut Navigator, &NavigatorInput) -> T) -> T {
        let landing = &self.control.landing;
        let input = NavigatorInput {
            tuning: &self.tuning,
            airframe: &self.airframe,
            gains: &self.control.gains,
            estimate: &self.estimate,
            links: &self.failsafe.links,
            fence: &self.failsafe.fence,
            armed: self.armed,
            phase: landing.phase,
            ground_down_m: landing.ground_down_m,
            range_down_m: self.unfused.range_down_m,
            now: tick.now,
            last_step: self.last_step,
            dt_s: tick.dt_s,
        };
        let result = call(&mut self.navigator, &input);
        self.events.append(&mut self.navigator.events);
        if let Some(enabled) = self.navigator.fence_switch.take() {
            self.tuning.fence_enabled = enabled;
        }
        result
    }

    /// Calls the failsafes with their inputs, and collects their events.
    fn supervise<T>(&mut self, tick: Tick, call: impl FnOnce(&mut Failsafe, &FailsafeInput) -> T) -> T {
        let (tuning, estimate, flight) = (&self.tuning, &self.estimate, self.flight_summary());
        let result = call(&mut self.failsafe, &FailsafeInput { tuning, estimate, flight, now: tick.now });
        self.events.append(&mut self.failsafe.events);
        result
    }

    fn flight_summary(&self) -> FlightSummary {
        let modes = &self.navigator.modes;
        FlightSummary {
            armed: self.armed,
            landed: self.navigator.landed_state(self.control.landing.phase),
            mode: modes.active,
            intended: modes.intended,
            overridden: modes.overridden,
            sticks_at_mode_start: modes.sticks_at_start,
            home_m: self.navigator.home.position_m,
            mission_is_empty: self.navigator.mission.is_empty(),
            global_position_known: self.estimator.located(),
            attitude_error_cosine: self.control.attitude_error_cosine,
            battery: self.unfused.battery,
            range_up_m: self.unfused.range_up_m,
        }
    }

    /// Carries out a failsafe request.
    fn apply_failsafe_request(&mut self, request: Option<FailsafeRequest>, tick: Tick) {
        match request {
            None => {}
            Some(FailsafeRequest::Override(mode)) => self.navigate(tick, |n, input| n.override_mode(mode, input)),
            Some(FailsafeRequest::EndOverride) => self.navigate(tick, Navigator::end_override),
            Some(FailsafeRequest::SetMode { mode, ends_override }) => {
                self.navigate(tick, |n, input| n.change_mode(mode, ends_override, input));
            }
            Some(FailsafeRequest::EndOffboard) => self.navigate(tick, Navigator::end_offboard),
            Some(FailsafeRequest::Disarm(why)) => self.disarm(&why, tick),
        }
    }

    fn run_failsafes(&mut self, tick: Tick) {
        if !self.failsafe.is_due(tick.now) {
            return;
        }
        self.navigate(tick, Navigator::set_first_home);
        let request = self.supervise(tick, Failsafe::check_battery);
        self.apply_failsafe_request(request, tick);
        self.supervise(tick, Failsafe::update_fence);
        if !self.armed {
            self.status.arming_blockers = self.supervise(tick, Failsafe::check_on_ground);
            self.navigator.follow_request();
            return;
        }
        self.status.arming_blockers.clear();
        for check in [Failsafe::check_attitude_tracking, Failsafe::check_crash] {
            let request = self.supervise(tick, check);
            self.apply_failsafe_request(request, tick);
        }
        if self.is_flying() {
            let request = self.supervise(tick, Failsafe::enforce_fence);
            self.apply_failsafe_request(request, tick);
        }
        if self.is_flying() {
            self.check_losses(tick);
        }
    }

    fn is_flying(&self) -> bool {
        self.armed && self.control.landing.phase != FlightPhase::OnGround
    }

    fn check_losses(&mut self, tick: Tick) {
        let mut flown = None;
        for loss in Loss::ALL {
            match self.supervise(tick, |failsafe, input| failsafe.check_loss(loss, input)) {
                Some(LossResponse::Fly(mode)) => {
                    flown = Some(mode);
                    break;
                }
                Some(LossResponse::Request(request)) => self.apply_failsafe_request(Some(request), tick),
                None => {}
            }
        }
        let request = self.supervise(tick, |failsafe, input| failsafe.finish_loss_checks(flown, input));
        self.apply_failsafe_request(request, tick);
    }

    /// Updates the flight phase while armed.
    fn update_phase(&mut self, tick: Tick) {
        let phase = self.control.landing.phase;
        let mission = self.navigator.modes.active == FlightMode::Mission;
        if phase == FlightPhase::OnGround && mission && self.navigate(tick, Navigator::wait_on_ground) {
            self.control.landing.on_ground_since = tick.now;
        }
        let wants_to_fly = phase != FlightPhase::InAir && self.navigate(tick, |n, input| n.commands_takeoff(input));
        let input = LandingInput {
            estimate: &self.estimate,
            range_down_m: self.unfused.range_down_m,
            resting_height_m: self.airframe.resting_height_m,
            takeoff_commanded: wants_to_fly,
            ground_time_limits_s: [self.tuning.disarm_before_flight_s, self.tuning.disarm_after_landing_s],
            now: tick.now,
            dt_s: tick.dt_s,
        };
        match self.control.landing.update(&input) {
            None => {}
            Some(PhaseChange::LiftingOff) => {
                self.control.reset();
                self.navigate(tick, Navigator::lift_off);
            }
            Some(PhaseChange::TakenOff) => {
                self.tuning.fence_enabled |= self.tuning.rules.fence.auto == FenceAutoEnable::InFlight;
                self.events.push(Severity::Info, "Takeoff detected");
            }
            Some(PhaseChange::TakeoffAbandoned) => self.touch_down(tick),
            Some(PhaseChange::Landed) => {
                self.events.push(Severity::Info, "Landing detected");
                self.touch_down(tick);
            }
            Some(PhaseChange::GroundTimeout { flown }) => {
                self.disarm(if flown { "Disarmed by landing" } else { "Disarmed: no takeoff" }, tick);
            }
        }
    }

    fn touch_down(&mut self, tick: Tick) {
        self.control.reset();
        self.navigate(tick, Navigator::touch_down);
    }

    /// Updates the telemetry status from the state of all modules.
    fn update_status(&mut self) {
        let (status, navigator, failsafe) = (&mut self.status, &self.navigator, &self.failsafe);
        status.armed = self.armed;
        status.mode = navigator.modes.active;
        status.landed = navigator.landed_state(self.control.landing.phase);
        status.home_m = navigator.home.position_m;
        status.mission_current = navigator.mission_status.current;
        status.mission_reached = navigator.mission_status.reached;
        status.mission_finished = navigator.mission_status.finished;
        status.mission_paused = navigator.mission_status.paused;
        status.climbing_out = navigator.report.climbing_out;
        status.target_m = navigator.report.target_m;
        // A setpoint is large and rarely present, so it is copied only if there is one to set or clear.
        if status.setpoint.is_some() || navigator.report.setpoint.is_some() {
            status.setpoint = navigator.report.setpoint;
        }
        status.orbit = navigator.report.orbit;
        if status.failsafe.as_deref() != failsafe.active() {
            status.failsafe = failsafe.active().map(str::to_owned);
        }
        status.fence = *failsafe.fence_state();
        status.health = failsafe.health();
        status.attitude_target = self.control.attitude_target;
        status.thrust = self.control.thrust;
        status.position_resets = self.estimator.position_resets();
    }
}
