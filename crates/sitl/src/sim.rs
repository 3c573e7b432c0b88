//! Runs simulation steps in the documented order (docs/src/reference/wire.md, "One simulation step"). Performs no I/O:
//! it takes datagrams and timestamps and returns datagrams.

mod controller;
mod crash_handling;
mod external;
mod file_jobs;
mod host_api;
pub mod inbox;
mod instructor;
mod practice;
mod practice_controls;
mod radio;
mod radio_shadow;
pub mod shared_site;
mod tick;
mod wake_wind;

pub use external::AutopilotState;

use super::autopilot::{Autopilot, CONTROL_HZ};
use super::backend::Phase;
use super::endpoint::flavor::Flavor;
use super::endpoint::params::{AircraftValues, BatteryThresholds, InstructorSettings};
use super::endpoint::{
    Endpoint, HazardTruth, LinkId, LinkKind, LockstepState, ReceivedDatagram, ScoringTruth, SimulatedAircraft, Transmit,
    VehicleClock,
};
use super::faults::Faults;
use super::log::FlightRecorder;
use super::physics::{self, Actuators, AirState, AirframeModel};
use super::sensors::sky::receiver_spec;
use super::sensors::{Readings, SensorSite, Sensors};
use controller::{BuiltinController, Controller};
use file_jobs::FileJobScheduler;
use inbox::Inbox;
use practice_controls::PracticeControls;
use radio::RadioLink;
use radio_shadow::RadioShadow;
use sha2::{Digest, Sha256};
use spandrel_mavlink::dialect::MavSeverity;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::scenario::{AfterCrash, Scenario};
use spandrel_model::site::Site;
use spandrel_model::site::changes::SiteChanges;
use spandrel_model::site::wind::WindField;
use spandrel_model::time::{Schedule, SimTime};
use spandrel_model::vehicle::{SensorSpec, Vehicle};
use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;
use wake_wind::WakeWind;

/// Physics time step.
pub const STEP: SimTime = SimTime::from_ms(1);
/// Interval between lockstep requests to peers.
pub const LOCKSTEP: SimTime = SimTime::from_ms(20);
/// Rate at which the disturbance of the compass is computed for reports, Hz.
const HAZARD_RATE_HZ: f64 = 10.0;
/// Search radius for surfaces near the vehicle, m, and therefore the largest clearance that the vehicle publishes.
pub const CLEARANCE_SEARCH_RADIUS_M: f64 = 30.0;

/// Configuration of a simulation.
#[derive(Debug, Clone)]
pub struct SimConfig {
    /// The scenario.
    pub scenario: Arc<Scenario>,
    /// The aircraft.
    pub vehicle: Arc<Vehicle>,
    /// Seed for all random processes.
    pub seed: u64,
    /// Zero-based vehicle number. The system ID is one higher.
    pub instance: u8,
    /// The emulated autopilot.
    pub flavor: &'static Flavor,
    /// Action after a crash. `None` uses the scenario's rule.
    pub after_crash: Option<AfterCrash>,
}

impl SimConfig {
    fn after_crash(&self) -> AfterCrash {
        self.after_crash.unwrap_or(self.scenario.rules.after_crash)
    }
}

/// An event for the session log.
#[derive(Debug, Clone, PartialEq)]
pub enum SimEvent {
    /// The vehicle lifted off for the first time.
    LiftOff,
    /// The vehicle crashed.
    Crash {
        /// Name of the object hit.
        what: String,
        /// Impact speed, m/s.
        impact_m_s: f64,
    },
    /// The vehicle was reset: to its last safe hover or, with an external autopilot, to the landing pad.
    Respawn,
    /// The process of an external autopilot must be started again.
    AutopilotRestart {
        /// Why it is started again.
        reason: String,
    },
    /// An external autopilot has started.
    AutopilotStarted {
        /// Time that the start took on the autopilot's clock.
        took: SimTime,
        /// Whether it reports that it can arm.
        is_ready: bool,
    },
    /// An external autopilot sent data that its interface does not allow.
    AutopilotProblem {
        /// Description of the problem.
        problem: String,
    },
    /// The flight was frozen.
    Freeze,
    /// The flight was rewound.
    Rewind {
        /// Time of flight that was undone.
        undone: SimTime,
    },
    /// A client moved the aircraft to the start of a task's path.
    MoveToTask {
        /// Number of the task, from 1.
        task: u32,
    },
    /// The inspector begins to walk to another place.
    Walk {
        /// Number of the place, from 1.
        place: u8,
    },
    /// The battery is empty.
    BatteryEmpty,
    /// The flight has ended.
    Ended {
        /// Reason why the flight ended.
        reason: String,
    },
}

/// The complete vehicle and its site.
#[derive(Debug, Clone)]
pub struct Sim {
    config: SimConfig,
    site: Arc<Site>,
    model: Arc<AirframeModel>,
    state: physics::PhysicsState,
    sensors: Sensors,
    controller: Controller,
    wind: WindField,
    wakes: Option<WakeWind>,
    radio_shadow: Option<RadioShadow>,
    hazards: HazardTruth,
    now: SimTime,
    /// Boot time of the autopilot.
    boot_time: SimTime,
    readings: Readings,
    actuators: Actuators,
    scoring: ScoringTruth,
    control_due: Schedule,
    wind_due: Schedule,
    clearance_due: Schedule,
    hazards_due: Schedule,
    lux_due: Schedule,
    air: AirState,
    last_safe_hover: (Vec3<Ned>, f64),
    crashed_since: Option<SimTime>,
    /// Contacts with other vehicles that share the site.
    drone_contact: physics::ContactReport,
    /// Whether the current contact reached crash speed.
    hard_contact: bool,
    touched_at: SimTime,
    start_height_m: f64,
    has_lifted_off: bool,
    end_reason: Option<String>,
    battery_empty_reported: bool,
    speed_factor: f64,
    pending_responses: BTreeMap<LinkId, i64>,
    inbox: Inbox,
    radio: RadioLink,
    faults: Faults,
    file_jobs: FileJobScheduler,
    instructor_settings: InstructorSettings,
    /// Bridge closures and walks of the inspector.
    site_changes: SiteChanges,
    practice: PracticeControls,
    /// Number of parameter changes already applied to the environment.
    applied_changes: u64,
    events: VecDeque<SimEvent>,
    digest: Sha256,
    recorder: FlightRecorder,
}

/// The parts of the simulator that exchange messages with clients, borrowed separately.
struct Interface<'a> {
    aircraft: SimulatedAircraft<'a>,
    controller: &'a mut Controller,
    recorder: &'a mut FlightRecorder,
}

impl Sim {
    /// Creates the vehicle on its landing pad with motors off.
    #[must_use]
    pub fn new(config: SimConfig, site: Arc<Site>) -> Self {
        let config = with_receiver(config);
        let controller = Controller::Builtin(Box::new(builtin_controller(&config)));
        let sensor_spec = config.vehicle.sensors;
        Self::with_controller(config, site, controller, &sensor_spec)
    }

    /// Creates the vehicle with a flight controller and the rates and errors of its sensors.
    fn with_controller(config: SimConfig, site: Arc<Site>, controller: Controller, sensors: &SensorSpec) -> Self {
        let (scenario, vehicle, seed) = (&config.scenario, &config.vehicle, config.seed);
        let (start, yaw) = place_on_pad(&config);
        let at = |hz| Schedule::new(SimTime::ZERO, hz);
        Self {
            model: Arc::new(
                AirframeModel::new(vehicle, scenario.rules.battery)
                    .with_battery_at(scenario.rules.battery_temperature_c)
                    .with_rotor_spread(seed),
            ),
            state: physics::PhysicsState::at_rest(start, yaw),
            sensors: Sensors::new(&with_sensors(vehicle, sensors), SensorSite::of(scenario, site.members()), seed),
            controller,
            wind: WindField::new(&scenario.wind, seed),
            wakes: WakeWind::of(scenario, site.members(), &vehicle.rotors, seed),
            radio_shadow: RadioShadow::of(scenario, seed),
            hazards: HazardTruth::default(),
            now: SimTime::ZERO,
            boot_time: SimTime::ZERO,
            readings: Readings::default(),
            actuators: Actuators::default(),
            scoring: ScoringTruth {
                seed: i32::try_from(seed & 0x7fff_ffff).unwrap_or(0),
                scenario_crc: scenario.crc,
                clearance_m: CLEARANCE_SEARCH_RADIUS_M,
                ..ScoringTruth::default()
            },
            control_due: at(CONTROL_HZ),
            wind_due: at(100.0),
            clearance_due: at(30.0),
            hazards_due: at(HAZARD_RATE_HZ),
            lux_due: at(5.0),
            air: AirState::STILL,
            last_safe_hover: (start, yaw),
            crashed_since: None,
            drone_contact: physics::ContactReport::default(),
            hard_contact: false,
            touched_at: SimTime::ZERO,
            start_height_m: -start.down(),
            has_lifted_off: false,
            end_reason: None,
            battery_empty_reported: false,
            speed_factor: 1.0,
            pending_responses: BTreeMap::new(),
            inbox: Inbox::default(),
            radio: RadioLink::new(seed),
            faults: Faults::new(seed),
            file_jobs: FileJobScheduler::default(),
            applied_changes: 0,
            instructor_settings: InstructorSettings { wind: None, loss: 0.0, delay: SimTime::ZERO, open: true },
            site_changes: SiteChanges::default(),
            practice: PracticeControls::default(),
            events: VecDeque::new(),
            digest: Sha256::new(),
            recorder: FlightRecorder::default(),
            site,
            config,
        }
    }

    /// Opens a link to a peer.
    pub fn open_link(&mut self, link: LinkId, kind: LinkKind, lockstep: bool) {
        match &mut self.controller {
            Controller::Builtin(own) => own.endpoint.open(link, kind, lockstep, self.now),
            Controller::External(other) => other.endpoint.open(link, kind, lockstep, self.now),
        }
        self.scale_timeouts();
    }

    /// Sends only responses on a link until a heartbeat arrives on it.
    pub fn await_heartbeat(&mut self, link: LinkId) {
        self.controller.links_mut().await_heartbeat(link);
    }

    /// Limits a link's outgoing data rate, in bytes/s.
    pub fn limit_link_rate(&mut self, link: LinkId, bytes_s: f64) {
        self.controller.links_mut().limit(link, bytes_s, self.now);
    }

    /// Closes a link. Lockstep no longer waits for its peer.
    pub fn close_link(&mut self, link: LinkId) {
        self.controller.close(link);
        self.inbox.close(link);
        self.pending_responses.remove(&link);
        self.scale_timeouts();
    }

    /// Sets the simulation speed relative to the clients' clocks (minimum 1). Without a lockstep peer, client timeouts scale with
    /// it.
    pub fn set_speed_factor(&mut self, factor: f64) {
        self.speed_factor = if factor.is_finite() { factor.max(1.0) } else { 1.0 };
        self.scale_timeouts();
    }

    /// Lockstep clients run on simulation time. Without any, clients use their own clocks.
    fn scale_timeouts(&mut self) {
        let in_step = self.controller.links().lockstep_states().next().is_some();
        let factor = if in_step { 1.0 } else { self.speed_factor };
        self.controller.set_speed_factor(factor);
    }

    /// Number of received bytes that did not belong to any frame.
    #[must_use]
    pub fn bad_bytes(&self) -> u64 {
        self.controller.links().bad_bytes()
    }

    /// Number of datagrams dropped by rate limits and frames dropped by link limits.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.inbox.dropped() + self.controller.links().dropped()
    }

    /// Simulation time.
    #[must_use]
    pub fn now(&self) -> SimTime {
        self.now
    }

    /// The true physical state, for tools and tests.
    #[must_use]
    pub fn truth(&self) -> &physics::PhysicsState {
        &self.state
    }

    /// The reason the flight ended, or `None` while it continues.
    #[must_use]
    pub fn ended(&self) -> Option<&str> {
        self.end_reason.as_deref()
    }

    /// Receives a datagram. It is processed at the next tick, or later if its link exceeds the per-tick limits of [`inbox`]. In
    /// lockstep, datagrams are processed in link order once all responses have arrived.
    pub fn handle_datagram(&mut self, link: LinkId, bytes: &[u8]) {
        if self.is_over_radio(link) && !self.is_frozen() && !self.bypasses_silence(bytes) {
            self.radio.receive(link, bytes, self.now);
            return;
        }
        self.controller.links_mut().note_received(link);
        let mut datagram = ReceivedDatagram::new(bytes);
        if let Some(token) = self.pending_responses.get(&link)
            && self.controller.links().answers_lockstep(link, &mut datagram, *token)
        {
            self.pending_responses.remove(&link);
            self.controller.links_mut().join_lockstep(link);
        }
        if self.awaits_response_of(link) {
            let clock = self.interface().aircraft.clock;
            self.controller.links_mut().answer_time_requests(link, &mut datagram, clock);
        }
        self.inbox.push(link, datagram);
    }

    /// Returns true while simulation time is stopped because a lockstep peer has not responded.
    #[must_use]
    pub fn waiting(&self) -> bool {
        !self.pending_responses.is_empty()
    }

    /// Returns `None` unless the simulation is waiting for the first response of one or more peers. Otherwise, returns
    /// whether all of these peers have sent any data.
    #[must_use]
    pub fn awaits_first_response(&self) -> Option<bool> {
        let has_received = |(link, step, has_received): (LinkId, LockstepState, bool)| {
            (step == LockstepState::Awaited && self.pending_responses.contains_key(&link)).then_some(has_received)
        };
        self.controller.links().lockstep_states().filter_map(has_received).reduce(|a, b| a && b)
    }

    /// Returns true while the simulation waits for the first response of this peer.
    fn awaits_response_of(&self, link: LinkId) -> bool {
        self.pending_responses.contains_key(&link)
            && self.controller.links().lockstep_states().any(|(id, step, _)| id == link && step == LockstepState::Awaited)
    }

    /// Sends heartbeats and another lockstep request to peers that have never responded. Does not change the vehicle.
    pub fn send_first_heartbeats(&mut self) {
        self.pause(false);
        self.controller.links_mut().request_lockstep(self.now);
    }

    /// Sends the lockstep request again to the peers that have not responded: the datagram may be lost. Does not change the
    /// vehicle.
    pub fn repeat_lockstep_requests(&mut self) {
        for link in self.pending_responses.keys() {
            self.controller.links_mut().repeat_lockstep_request(*link);
        }
    }

    /// Stops waiting for first responses. Lockstep with each peer begins with its first response.
    pub fn stop_awaiting_first_responses(&mut self) {
        let pending: Vec<LinkId> = self.pending_responses.keys().copied().collect();
        for link in pending {
            self.controller.links_mut().serve_in_real_time(link);
        }
        let peers: Vec<LinkId> = self.controller.links().lockstep_peers().collect();
        self.pending_responses.retain(|link, _| peers.contains(link));
    }

    /// Returns true while a lockstep peer has not responded yet. Simulation time follows wall time until it does.
    #[must_use]
    pub fn runs_in_real_time(&self) -> bool {
        self.controller.links().lockstep_states().any(|(_, step, _)| step == LockstepState::Late)
    }

    /// Time at which the next tick is due.
    #[must_use]
    pub fn poll_timeout(&self) -> SimTime {
        self.now + STEP
    }

    /// Returns the next datagram to send.
    pub fn poll_transmit(&mut self) -> Option<Transmit> {
        while let Some(transmit) = self.controller.links_mut().poll() {
            // While simulation time is stopped, nothing that the radio link delays would arrive.
            if !self.is_over_radio(transmit.link) || self.is_frozen() || self.bypasses_silence(&transmit.bytes) {
                return Some(transmit);
            }
            self.radio.send(transmit, self.now);
        }
        self.radio.sent(self.now)
    }

    /// Returns the next event.
    pub fn poll_event(&mut self) -> Option<SimEvent> {
        self.events.pop_front()
    }

    /// SHA-256 digest of the state in all ticks so far.
    #[must_use]
    pub fn digest(&self) -> [u8; 32] {
        self.digest.clone().finalize().into()
    }

    /// Runs the ticks due up to `until`. Stops early for a lockstep request to peers or a client's file request
    /// ([`Sim::poll_file_job`]), which must be completed before the next tick so that its response arrives at a defined
    /// simulation time. While the flight is frozen, runs no tick, but answers clients.
    pub fn handle_timeout(&mut self, until: SimTime) {
        if self.waiting() {
            return;
        }
        self.process_inbox();
        if self.run_autopilot_start() {
            return;
        }
        while self.now + STEP <= until && !self.has_file_job() && !self.is_frozen() {
            if !self.exchange_with_autopilot() {
                return;
            }
            self.tick();
            self.freeze_after_rewind();
            if self.now.ns() % LOCKSTEP.ns() == 0 && self.send_lockstep_requests() {
                return;
            }
            self.process_inbox();
        }
    }

    /// Sends lockstep requests. Returns true if there are peers to wait for.
    fn send_lockstep_requests(&mut self) -> bool {
        self.controller.links_mut().request_lockstep(self.now);
        self.pending_responses = self.controller.links().lockstep_peers().map(|link| (link, self.now.ns())).collect();
        !self.pending_responses.is_empty()
    }

    /// Processes received datagrams up to the per-tick limit of each link.
    fn process_inbox(&mut self) {
        while let Some((link, bytes)) = self.radio.received(self.now) {
            self.inbox.push(link, ReceivedDatagram::new(&bytes));
        }
        let link_now = self.controller.link_clock(self.now);
        if self.is_frozen() {
            // No tick follows that would renew the limits.
            self.inbox.renew_limits();
        }
        for (link, datagram) in self.inbox.take(link_now) {
            self.process_datagram(link, datagram, link_now);
            self.apply_practice_requests();
        }
        self.resume_by_stick();
    }

    fn process_datagram(&mut self, link: LinkId, datagram: ReceivedDatagram, link_now: SimTime) {
        let Interface { aircraft, controller, .. } = self.interface();
        let (restart, digest_input) = match controller {
            Controller::Builtin(own) => {
                own.endpoint.receive(link, datagram, &aircraft, &mut own.autopilot);
                (own.endpoint.vehicle.take_restart_request(), own.endpoint.take_digest_input())
            }
            Controller::External(other) => {
                other.endpoint.receive(link, datagram, &aircraft, link_now);
                (other.endpoint.take_restart_request(), Vec::new())
            }
        };
        self.digest.update(digest_input);
        if restart {
            self.restart_autopilot();
        }
    }

    /// Restarts the autopilot on the ground. The environment is unaffected.
    fn restart_autopilot(&mut self) {
        self.boot_time = self.now;
        if self.controller.external().is_some() {
            self.restart_external_autopilot("reboot command");
            return;
        }
        let autopilot = new_autopilot(&self.config);
        let Interface { aircraft, controller, .. } = self.interface();
        if let Controller::Builtin(own) = controller {
            own.autopilot = autopilot;
            own.endpoint.boot(&aircraft, &mut own.autopilot);
        }
        self.scale_timeouts();
    }

    /// Borrows the state from which messages are built, and the parts that handle messages.
    fn interface(&mut self) -> Interface<'_> {
        let practice = self.practice_state();
        let aircraft = SimulatedAircraft {
            clock: VehicleClock {
                now: self.now,
                autopilot_boot_time: self.boot_time,
                start_unix_s: self.config.scenario.light.start_unix_s,
                link_kind: LinkKind::GroundStation,
            },
            vehicle: &self.config.vehicle,
            plane: self.site.plane(),
            site: &self.site,
            readings: &self.readings,
            truth: &self.state.rigid,
            specific_force_m_s2: self.state.specific_force_m_s2,
            battery: &self.state.battery,
            actuators: &self.actuators,
            wind_m_s: self.air.velocity_m_s,
            scoring: &self.scoring,
            hazards: self.hazards,
            practice,
        };
        Interface { aircraft, controller: &mut self.controller, recorder: &mut self.recorder }
    }

    /// Sends a heartbeat on every link while the simulation is paused, and a status text at the start of the pause.
    /// Call once per second of wall time. Does not change the vehicle.
    pub fn pause(&mut self, begins: bool) {
        if begins {
            self.controller.push_text(MavSeverity::MAV_SEVERITY_INFO, "Simulation paused");
        }
        let Interface { aircraft, controller, .. } = self.interface();
        match controller {
            Controller::Builtin(own) => own.endpoint.send_heartbeats(&aircraft, &own.autopilot),
            Controller::External(other) => other.endpoint.send_heartbeats(&aircraft),
        }
    }

    /// Announces that the simulation continues; clients receive the status text with the next tick.
    pub fn resume(&mut self) {
        self.controller.push_text(MavSeverity::MAV_SEVERITY_INFO, "Simulation resumed");
    }

    fn publish(&mut self) {
        let Interface { aircraft, controller, recorder } = self.interface();
        match controller {
            Controller::Builtin(own) => publish_builtin(own, &aircraft, recorder),
            Controller::External(other) => {
                let is_starting = other.autopilot.phase() != Phase::Running;
                let link_now = other.autopilot.clock(aircraft.clock.now);
                other.endpoint.publish(&aircraft, link_now, is_starting);
            }
        }
    }
}

/// Records the flight log and sends the messages of a vehicle with the built-in autopilot.
fn publish_builtin(own: &mut BuiltinController, aircraft: &SimulatedAircraft, recorder: &mut FlightRecorder) {
    let BuiltinController { autopilot, endpoint } = own;
    let (events, reached_items) = (autopilot.drain_events(), autopilot.drain_reached());
    if recorder.is_enabled() {
        let view = endpoint.vehicle.snapshot(aircraft, autopilot, &endpoint.payload.equipment);
        let texts: Vec<(u8, &str)> = events.iter().map(|event| (event.severity.number(), event.text.as_str())).collect();
        recorder.observe(&view, &texts, || endpoint.vehicle.parameters().map(|(name, value)| (name, value.into())));
    }
    endpoint.publish(aircraft, autopilot, events, reached_items);
}

/// Returns the position of the aircraft on the landing pad, and its heading in rad.
fn place_on_pad(config: &SimConfig) -> (Vec3<Ned>, f64) {
    let team = &config.scenario.ground_team;
    let feet_m = config.vehicle.hull.feet_m.iter().map(|f| f.down()).fold(0.0, f64::max) + 0.02;
    let start = (team.pad_m + Vec3::new(0.0, 0.0, feet_m)).ned();
    (start, spandrel_model::math::wrap_pi(team.pad_heading_deg.to_radians()))
}

/// Replaces the GNSS receiver by the one that a job with the real sky has, also for the estimator, which knows its receiver.
fn with_receiver(config: SimConfig) -> SimConfig {
    if !config.scenario.hazards.sky {
        return config;
    }
    let sensors = receiver_spec(&config.vehicle.sensors);
    SimConfig { vehicle: Arc::new(with_sensors(&config.vehicle, &sensors)), ..config }
}

fn with_sensors(vehicle: &Vehicle, sensors: &SensorSpec) -> Vehicle {
    Vehicle { sensors: *sensors, ..vehicle.clone() }
}

/// Creates the built-in autopilot and its interface.
fn builtin_controller(config: &SimConfig) -> BuiltinController {
    let (vehicle, rules) = (&config.vehicle, &config.scenario.rules);
    let mut autopilot = new_autopilot(config);
    let pack = AircraftValues {
        cells: vehicle.battery.cells,
        capacity_mah: 1000.0 * vehicle.battery.capacity_ah,
        thresholds: BatteryThresholds { low_charge_pct: rules.low_battery_pct, critical_charge_pct: rules.critical_battery_pct },
        returns_on_low_battery: rules.low_battery_return,
        stick_response: rules.stick_response,
        frame: autopilot.airframe_envelope(),
    };
    let mut endpoint = Endpoint::new(config.instance + 1, pack, config.flavor);
    endpoint.prepare(&mut autopilot);
    BuiltinController { autopilot, endpoint }
}

fn new_autopilot(config: &SimConfig) -> Autopilot {
    let scenario = &config.scenario;
    let mut tuning = Autopilot::default_tuning(&scenario.rules);
    tuning.start_unix_s = scenario.light.start_unix_s;
    Autopilot::new(&config.vehicle, &scenario.rules, scenario.origin, tuning)
}
