//! One simulation step, in a written order (docs/src/reference/wire.md, "One simulation step"). Sans-IO: datagrams and times come
//! in, datagrams go out.

mod crash_handling;
mod host_api;
pub mod inbox;
mod instructor;
mod radio;
mod tick;

use super::autopilot::{Autopilot, CONTROL_HZ};
use super::backend::Backend;
use super::endpoint::flavour::Flavour;
use super::endpoint::params::{AircraftValues, BatteryThresholds, InstructorSettings};
use super::endpoint::snapshot::{ScoringTruth, VehicleSnapshot};
use super::endpoint::{Endpoint, LinkId, LinkKind, LockstepState, Transmit};
use super::faults::Faults;
use super::log::FlightRecorder;
use super::physics::{self, Actuators, AirState, AirframeModel};
use super::sensors::{Readings, Sensors};
use host_api::FileJobScheduler;
use inbox::Inbox;
use radio::RadioLink;
use sha2::{Digest, Sha256};
use spandrel_mavlink::dialect::MavSeverity;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::scenario::{AfterCrash, Scenario};
use spandrel_model::site::Site;
use spandrel_model::site::bridge_closures::BridgeClosures;
use spandrel_model::site::wind::WindField;
use spandrel_model::time::{Schedule, SimTime};
use spandrel_model::vehicle::Vehicle;
use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

/// Physics step.
pub const STEP: SimTime = SimTime::from_ms(1);
/// Peers in step are asked this often.
pub const LOCKSTEP: SimTime = SimTime::from_ms(20);
/// Uncommon clearances are not looked for beyond this, m.
const CLEARANCE_REACH_M: f64 = 30.0;

/// What to simulate.
#[derive(Debug, Clone)]
pub struct SimConfig {
    /// The job.
    pub scenario: Arc<Scenario>,
    /// The aircraft.
    pub vehicle: Arc<Vehicle>,
    /// Seed for everything random.
    pub seed: u64,
    /// Vehicle number; the system id is one more.
    pub instance: u8,
    /// Whose interface is spoken.
    pub flavour: &'static Flavour,
    /// What a crash leads to; `None`: what the scenario says.
    pub after_crash: Option<AfterCrash>,
}

impl SimConfig {
    fn after_crash(&self) -> AfterCrash {
        self.after_crash.unwrap_or(self.scenario.rules.after_crash)
    }
}

/// Something worth a log line.
#[derive(Debug, Clone, PartialEq)]
pub enum SimEvent {
    /// First time off the ground.
    LiftOff,
    /// Something was touched.
    Crash {
        /// What, in words.
        what: String,
        /// How fast, m/s.
        impact_m_s: f64,
    },
    /// Put back at the last safe hover.
    Respawn,
    /// The battery is empty.
    BatteryEmpty,
    /// The session's flight is over.
    Ended {
        /// Why.
        reason: String,
    },
}

/// The whole vehicle and its site.
#[derive(Debug, Clone)]
pub struct Sim {
    config: SimConfig,
    site: Arc<Site>,
    model: Arc<AirframeModel>,
    state: physics::PhysicsState,
    sensors: Sensors,
    backend: Backend,
    endpoint: Endpoint,
    wind: WindField,
    now: SimTime,
    /// When the autopilot's software started.
    booted: SimTime,
    readings: Readings,
    actuators: Actuators,
    scoring: ScoringTruth,
    control_due: Schedule,
    wind_due: Schedule,
    clearance_due: Schedule,
    lux_due: Schedule,
    air: AirState,
    last_safe_hover: (Vec3<Ned>, f64),
    crashed_since: Option<SimTime>,
    /// The running contact began, or went on, with a crash's speed.
    hard_contact: bool,
    touched_at: SimTime,
    standing_up_m: f64,
    has_lifted_off: bool,
    end_reason: Option<String>,
    battery_empty_reported: bool,
    speed_factor: f64,
    pending_answers: BTreeMap<LinkId, i64>,
    inbox: Inbox,
    radio: RadioLink,
    faults: Faults,
    file_work: FileJobScheduler,
    instructor_settings: InstructorSettings,
    /// When traffic was stopped and let go.
    closures: BridgeClosures,
    /// Changes of parameters that the world has followed.
    applied_changes: u64,
    events: VecDeque<SimEvent>,
    digest: Sha256,
    recorder: FlightRecorder,
}

/// One instant of the vehicle, borrowing each of its parts on its own, so that endpoint and autopilot stay free to change.
macro_rules! view {
    ($sim:expr, $estimate:expr, $status:expr, $fence_enabled:expr) => {
        VehicleSnapshot {
            now: $sim.now,
            autopilot_booted: $sim.booted,
            start_unix_s: $sim.config.scenario.light.start_unix_s,
            vehicle: &$sim.config.vehicle,
            plane: $sim.site.plane(),
            estimate: $estimate,
            status: $status,
            readings: &$sim.readings,
            truth: &$sim.state.rigid,
            specific_force_m_s2: $sim.state.specific_force_m_s2,
            battery: &$sim.state.battery,
            actuators: &$sim.actuators,
            wind_m_s: $sim.air.velocity_m_s,
            scoring: &$sim.scoring,
            sticks: $sim.endpoint.sticks($sim.now),
            pulses_us: $sim.endpoint.pulses_us($sim.now),
            aux_us: $sim.endpoint.aux_us(),
            link_kind: LinkKind::GroundStation,
            gimbal: $sim.endpoint.payload.gimbal,
            lamp: $sim.endpoint.payload.lamp,
            camera: $sim.endpoint.payload.camera.summary($sim.now),
            plans: $sim.endpoint.plans(),
            flavour: $sim.endpoint.flavour(),
            requested_mode: $sim.endpoint.requested_mode(),
            system_id: $sim.endpoint.system_id(),
            flight: $sim.endpoint.flight(),
            fence_enabled: $fence_enabled,
        }
    };
}

impl Sim {
    /// On the pad, motors off.
    #[must_use]
    pub fn new(config: SimConfig, site: Arc<Site>) -> Self {
        let (scenario, vehicle, seed) = (&config.scenario, &config.vehicle, config.seed);
        let feet_m = vehicle.hull.feet_m.iter().map(|f| f.down()).fold(0.0, f64::max) + 0.02;
        let team = &scenario.ground_team;
        let start = (team.pad_m + Vec3::new(0.0, 0.0, feet_m)).ned();
        let yaw = spandrel_model::math::wrap_pi(team.pad_heading_deg.to_radians());
        let mut autopilot = new_autopilot(&config);
        let at = |hz| Schedule::new(SimTime::ZERO, hz);
        let rules = &scenario.rules;
        let pack = AircraftValues {
            cells: vehicle.battery.cells,
            capacity_mah: 1000.0 * vehicle.battery.capacity_ah,
            thresholds: BatteryThresholds { low_pct: rules.low_battery_pct, critical_pct: rules.critical_battery_pct },
            returns_when_low: rules.low_battery_return,
            frame: autopilot.airframe_envelope(),
        };
        let mut endpoint = Endpoint::new(config.instance + 1, pack, config.flavour);
        endpoint.prepare(&mut autopilot);
        Self {
            model: Arc::new(AirframeModel::new(vehicle, scenario.rules.battery)),
            state: physics::PhysicsState::at_rest(start, yaw),
            sensors: Sensors::new(vehicle, scenario.rules.gnss_shadow, scenario.origin, seed),
            backend: Backend::Builtin(Box::new(autopilot)),
            endpoint,
            wind: WindField::new(&scenario.wind, seed),
            now: SimTime::ZERO,
            booted: SimTime::ZERO,
            readings: Readings::default(),
            actuators: Actuators::default(),
            scoring: ScoringTruth {
                seed: i32::try_from(seed & 0x7fff_ffff).unwrap_or(0),
                scenario_crc: scenario.crc,
                clearance_m: CLEARANCE_REACH_M,
                ..ScoringTruth::default()
            },
            control_due: at(CONTROL_HZ),
            wind_due: at(100.0),
            clearance_due: at(30.0),
            lux_due: at(5.0),
            air: AirState::STILL,
            last_safe_hover: (start, yaw),
            crashed_since: None,
            hard_contact: false,
            touched_at: SimTime::ZERO,
            standing_up_m: -start.down(),
            has_lifted_off: false,
            end_reason: None,
            battery_empty_reported: false,
            speed_factor: 1.0,
            pending_answers: BTreeMap::new(),
            inbox: Inbox::default(),
            radio: RadioLink::new(seed),
            faults: Faults::new(seed),
            file_work: FileJobScheduler::default(),
            applied_changes: 0,
            instructor_settings: InstructorSettings { wind: None, loss: 0.0, delay: SimTime::ZERO, open: true },
            closures: BridgeClosures::default(),
            events: VecDeque::new(),
            digest: Sha256::new(),
            recorder: FlightRecorder::default(),
            site,
            config,
        }
    }

    /// A peer is there.
    pub fn open_link(&mut self, link: LinkId, kind: LinkKind, lockstep: bool) {
        self.endpoint.open(link, kind, lockstep, self.now);
        self.scale_timeouts();
    }

    /// Nothing but answers goes out on a link until a heartbeat has come over it.
    pub fn await_heartbeat(&mut self, link: LinkId) {
        self.endpoint.await_heartbeat(link);
    }

    /// A link carries no more than so many bytes a second.
    pub fn limit_link(&mut self, link: LinkId, bytes_s: f64) {
        self.endpoint.limit(link, bytes_s, self.now);
    }

    /// A peer is gone; nobody waits for it any more.
    pub fn close_link(&mut self, link: LinkId) {
        self.endpoint.close(link);
        self.inbox.close(link);
        self.pending_answers.remove(&link);
        self.scale_timeouts();
    }

    /// Simulation runs this many times faster than its clients' clocks: with no peer in step, the limits after which a client counts as
    /// lost grow by it (never below 1).
    pub fn set_speed_factor(&mut self, pace: f64) {
        self.speed_factor = if pace.is_finite() { pace.max(1.0) } else { 1.0 };
        self.scale_timeouts();
    }

    /// Clients in step live in simulation time; without any, clients live in their own.
    fn scale_timeouts(&mut self) {
        let in_step = self.endpoint.stepped().next().is_some();
        let pace = if in_step { 1.0 } else { self.speed_factor };
        let Backend::Builtin(autopilot) = &mut self.backend;
        self.endpoint.set_speed_factor(pace, autopilot);
    }

    /// Bytes from clients that belonged to no frame.
    #[must_use]
    pub fn bad_bytes(&self) -> u64 {
        self.endpoint.bad_bytes()
    }

    /// Datagrams that came faster than they may act, and frames that a link could not carry.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.inbox.dropped() + self.endpoint.dropped()
    }

    /// Simulation time.
    #[must_use]
    pub fn now(&self) -> SimTime {
        self.now
    }

    /// The truth, for tools and tests.
    #[must_use]
    pub fn truth(&self) -> &physics::PhysicsState {
        &self.state
    }

    /// Why the flight is over, once it is.
    #[must_use]
    pub fn ended(&self) -> Option<&str> {
        self.end_reason.as_deref()
    }

    /// Takes in a datagram. It acts at the next tick, or a later one when its link sends more than [`inbox`] lets act in one; in step,
    /// after every answer is in, in the order of the links.
    pub fn handle_datagram(&mut self, link: LinkId, bytes: &[u8]) {
        if self.is_over_radio(link) {
            self.radio.receive(link, bytes, self.now);
            return;
        }
        self.inbox.push(link, bytes);
        self.endpoint.note_station_heard(link);
        if !self.pending_answers.is_empty() {
            self.note_lockstep_answers(link, bytes);
        }
    }

    fn note_lockstep_answers(&mut self, link: LinkId, bytes: &[u8]) {
        let Some(token) = self.pending_answers.get(&link) else { return };
        if self.endpoint.lockstep_answers(link, bytes).contains(token) {
            self.pending_answers.remove(&link);
            self.endpoint.join(link);
        }
    }

    /// True while a peer in step owes its answer: time stands still.
    #[must_use]
    pub fn waiting(&self) -> bool {
        !self.pending_answers.is_empty()
    }

    /// Whether time waits for a peer that has never answered, and if so, whether anything has come from it.
    #[must_use]
    pub fn awaits_first_answer(&self) -> Option<bool> {
        let owing = |(link, step, heard): (LinkId, LockstepState, bool)| {
            (step == LockstepState::Awaited && self.pending_answers.contains_key(&link)).then_some(heard)
        };
        self.endpoint.stepped().filter_map(owing).reduce(|a, b| a && b)
    }

    /// Shows peers that have never answered that the vehicle is there: heartbeats, and the question again. Nothing else changes.
    pub fn send_first_contact(&mut self) {
        self.pause(false);
        self.endpoint.request_lockstep(self.now);
    }

    /// Waits no longer for first answers: lockstep begins with them.
    pub fn skip_first_answers(&mut self) {
        let owing: Vec<LinkId> = self.pending_answers.keys().copied().collect();
        for link in owing {
            self.endpoint.serve_in_real_time(link);
        }
        let kept: Vec<LinkId> = self.endpoint.all_in_step().collect();
        self.pending_answers.retain(|link, _| kept.contains(link));
    }

    /// A peer that is to be kept in step has not answered yet: time runs with the wall's until it does.
    #[must_use]
    pub fn runs_in_real_time(&self) -> bool {
        self.endpoint.stepped().any(|(_, step, _)| step == LockstepState::Late)
    }

    /// When the next tick is due.
    #[must_use]
    pub fn poll_timeout(&self) -> SimTime {
        self.now + STEP
    }

    /// The next datagram to send.
    pub fn poll_transmit(&mut self) -> Option<Transmit> {
        while let Some(transmit) = self.endpoint.poll() {
            if !self.is_over_radio(transmit.link) {
                return Some(transmit);
            }
            self.radio.send(transmit, self.now);
        }
        self.radio.sent(self.now)
    }

    /// The next event.
    pub fn poll_event(&mut self) -> Option<SimEvent> {
        self.events.pop_front()
    }

    /// SHA-256 over the state of every tick so far.
    #[must_use]
    pub fn digest(&self) -> [u8; 32] {
        self.digest.clone().finalize().into()
    }

    /// Runs the ticks that are due up to `until`, up to where peers in step must be asked, or up to where a client has asked for work on
    /// files ([`Sim::poll_file_job`]): it is done before the next tick, so that the answer has its place in simulation time.
    pub fn handle_timeout(&mut self, until: SimTime) {
        if self.waiting() {
            return;
        }
        self.process_inbox();
        while self.now + STEP <= until && !self.has_file_job() {
            self.tick();
            if self.now.ns() % LOCKSTEP.ns() == 0 && self.ask_peers() {
                return;
            }
            self.process_inbox();
        }
    }

    /// True when there is somebody to wait for.
    fn ask_peers(&mut self) -> bool {
        self.endpoint.request_lockstep(self.now);
        self.pending_answers = self.endpoint.all_in_step().map(|link| (link, self.now.ns())).collect();
        !self.pending_answers.is_empty()
    }

    /// What has arrived acts now, as far as this tick's share of each link goes.
    fn process_inbox(&mut self) {
        while let Some((link, bytes)) = self.radio.received(self.now) {
            self.inbox.push(link, &bytes);
        }
        for (link, bytes) in self.inbox.take(self.now) {
            self.read(link, &bytes);
            self.digest.update(self.endpoint.take_digest_input());
        }
    }

    fn read(&mut self, link: LinkId, bytes: &[u8]) {
        let Backend::Builtin(autopilot) = &mut self.backend;
        let (estimate, status) = (*autopilot.estimate(), autopilot.status().clone());
        let view = view!(self, &estimate, &status, autopilot.tuning.fence_enabled);
        self.endpoint.receive(link, bytes, &view, autopilot);
        if self.endpoint.take_restart() {
            self.restart_autopilot();
        }
    }

    /// The autopilot's software starts again on the ground; the world goes on.
    fn restart_autopilot(&mut self) {
        let Backend::Builtin(autopilot) = &mut self.backend;
        **autopilot = new_autopilot(&self.config);
        self.booted = self.now;
        let (estimate, status) = (*autopilot.estimate(), autopilot.status().clone());
        let view = view!(self, &estimate, &status, autopilot.tuning.fence_enabled);
        self.endpoint.boot(&view, autopilot);
        self.scale_timeouts();
    }

    /// Time stands still, and clients hear that the vehicle is there: a heartbeat on every link, and at the beginning a word. Call it once
    /// a second of wall time; nothing else of the vehicle changes.
    pub fn pause(&mut self, begins: bool) {
        if begins {
            self.endpoint.push_text(MavSeverity::MAV_SEVERITY_INFO, "Time stands still");
        }
        let Backend::Builtin(autopilot) = &mut self.backend;
        let view = view!(self, autopilot.estimate(), autopilot.status(), autopilot.tuning.fence_enabled);
        self.endpoint.send_heartbeats(&view);
    }

    /// Time runs again; clients are told with the next tick.
    pub fn resume(&mut self) {
        self.endpoint.push_text(MavSeverity::MAV_SEVERITY_INFO, "Time runs again");
    }

    fn publish(&mut self) {
        let Backend::Builtin(autopilot) = &mut self.backend;
        let (events, reached) = (autopilot.drain_events(), autopilot.drain_reached());
        let view = view!(self, autopilot.estimate(), autopilot.status(), autopilot.tuning.fence_enabled);
        let texts: Vec<(u8, &str)> = events.iter().map(|event| (event.severity.number(), event.text.as_str())).collect();
        self.recorder.observe(&view, &texts, || self.endpoint.parameters().map(|(name, value)| (name, value.into())));
        self.endpoint.publish(&view, events, reached);
    }
}

fn new_autopilot(config: &SimConfig) -> Autopilot {
    let scenario = &config.scenario;
    let mut tuning = Autopilot::tuning_for(&scenario.rules);
    tuning.start_unix_s = scenario.light.start_unix_s;
    Autopilot::new(&config.vehicle, &scenario.rules, scenario.origin, tuning)
}
