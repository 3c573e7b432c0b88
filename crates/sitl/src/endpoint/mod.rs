//! The vehicle's MAVLink interface, in one of three flavours. It processes the datagrams of all links and produces outgoing ones;
//! it does not read a clock.

mod ardupilot_items;
mod aux_functions;
pub mod budget;
pub mod buttons;
pub mod calibration;
pub mod camera;
mod camera_params;
pub mod commands;
mod context;
mod control;
mod deferred_fields;
pub mod events;
mod fence_and_rally;
pub mod files;
pub mod flavour;
mod ftp;
pub mod gimbal;
mod inbound;
mod items;
pub mod lamp;
pub mod link;
pub mod logs;
pub mod manual;
pub mod mission;
mod mission_positions;
mod notices;
mod offboard;
mod param_and_mission_services;
pub mod params;
pub mod payload;
mod persistence;
mod publish;
mod receive;
mod scoring;
mod shell;
pub mod signing_policy;
pub mod snapshot;
mod status_texts;
mod storage;
pub mod streams;

use crate::autopilot::Autopilot;
pub use context::{CommandContext, FailureInjection};
use flavour::Flavour;
pub use link::LockstepState;
use link::PeerLink;
use manual::ManualControl;
use mission::{ItemEncoding, PlanStore};
use params::{AircraftValues, Params};
pub use payload::Payload;
pub use receive::HANDLED;
use scoring::TruthSchedule;
use signing_policy::SigningPolicy;
use snapshot::{ScoringTruth, VehicleSnapshot};
use spandrel_mavlink::dialect::{MavMessage, MavMissionType, MavSeverity, TIMESYNC_DATA};
use spandrel_mavlink::router::Router;
use spandrel_model::time::SimTime;
use std::collections::{BTreeMap, VecDeque};
use storage::ParamStorage;
pub use storage::StorageRequest;
use streams::AUTOPILOT;

/// Identifies a link; assigned by the host.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct LinkId(pub u32);

/// Kind of peer, which determines the default rates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinkKind {
    /// A ground station over UDP.
    GroundStation,
    /// An SDK or companion computer.
    Sdk,
    /// A payload process, such as the monitor.
    Payload,
    /// A ground station over TCP.
    Tcp,
    /// A radio or a cable on a serial port.
    Serial,
}

/// A datagram to send.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Transmit {
    /// The link to send it on.
    pub link: LinkId,
    /// Complete frames.
    pub bytes: Vec<u8>,
}

/// State of the endpoint.
#[derive(Debug, Clone)]
pub struct Endpoint {
    system_id: u8,
    flavour: &'static Flavour,
    /// The flavour's number of the last requested mode; several may map to the same internal mode.
    chosen: u32,
    links: BTreeMap<LinkId, PeerLink>,
    router: Router<LinkId>,
    guard: Option<SigningPolicy>,
    /// The file server.
    pub files: files::FileServer,
    /// The camera component's file server.
    camera_files: files::FileServer,
    /// The flight logs.
    pub logs: logs::LogTransfers,
    params: Params,
    storage: ParamStorage,
    restart: bool,
    injections: VecDeque<FailureInjection>,
    /// Whether manual control is accepted.
    pub sticks_pass: bool,
    plans: PlanStore,
    manual: ManualControl,
    /// Camera, gimbal, lamp.
    pub payload: Payload,
    texts: Vec<(MavSeverity, String)>,
    text_id: u16,
    param_lists: BTreeMap<LinkId, VecDeque<usize>>,
    speed_factor: f64,
    reported_speed_factor: f64,
    complained: SimTime,
    truth_rates: TruthSchedule,
    sent: ScoringTruth,
    bad_bytes: u64,
    gone_dropped: u64,
    row_buffer: Vec<usize>,
    flight: snapshot::FlightTimes,
    was_armed: bool,
    fence_took: u16,
    /// Parameter revision, plan item counts and fence switch already shown by the parameters, cached because looking parameters
    /// up by name is too slow for every tick.
    shown_by_params: Option<(u64, [u16; 3], bool)>,
    /// Inputs that affected the vehicle and are not yet in the digest.
    acted: Vec<u8>,
    /// Last position of the mode switch, from 0.
    mode_switch: Option<usize>,
    /// Last positions of the auxiliary switches on channels 5 to 16.
    switches: [Option<aux_functions::SwitchPosition>; manual::AUX],
    /// The running calibration.
    calibration: Option<calibration::Calibration>,
    /// Events sent to ground stations.
    events: events::EventReports,
    /// The console.
    shell: shell::NshShell,
}

/// Maximum number of texts queued for the next tick; further ones are dropped.
const MOST_TEXTS: usize = 32;
/// Minimum interval between warnings about setpoints, which arrive many times a second.
const COMPLAIN_EVERY: SimTime = SimTime::from_ms(1_000);

impl Endpoint {
    /// Creates an endpoint without links.
    #[must_use]
    pub fn new(system_id: u8, pack: AircraftValues, flavour: &'static Flavour) -> Self {
        let params = Params::new(system_id, pack, flavour.params);
        Self {
            system_id,
            flavour,
            chosen: 0,
            links: BTreeMap::new(),
            router: Router::new(),
            guard: None,
            files: metadata_server(flavour),
            camera_files: camera_server(),
            logs: logs::LogTransfers::default(),
            storage: ParamStorage::new(params.clone()),
            restart: false,
            injections: VecDeque::new(),
            sticks_pass: true,
            params,
            plans: PlanStore::with_lead_items(u16::from(flavour.home_item))
                .with_splines(flavour.splines)
                .with_zero_as_here(flavour.zero_is_here)
                .with_encoding(if flavour.float_items { ItemEncoding::Float } else { ItemEncoding::Int }),
            manual: ManualControl::default(),
            payload: Payload::new(),
            texts: Vec::new(),
            text_id: 0,
            param_lists: BTreeMap::new(),
            speed_factor: 1.0,
            reported_speed_factor: 1.0,
            complained: SimTime::ZERO.saturating_sub(COMPLAIN_EVERY),
            truth_rates: TruthSchedule::new(),
            sent: ScoringTruth::default(),
            bad_bytes: 0,
            gone_dropped: 0,
            row_buffer: Vec::new(),
            flight: snapshot::FlightTimes::default(),
            was_armed: false,
            fence_took: 0,
            shown_by_params: None,
            acted: Vec::new(),
            mode_switch: None,
            switches: [None; manual::AUX],
            calibration: None,
            events: events::EventReports::default(),
            shell: shell::NshShell::default(),
        }
    }

    /// Adds a link to a peer.
    pub fn open(&mut self, id: LinkId, kind: LinkKind, lockstep: bool, now: SimTime) {
        let mut link = PeerLink::new(kind, lockstep, self.system_id, self.flavour.is_silent_until_asked(kind), now);
        link.sign_with(self.guard.as_ref().map(|guard| guard.signer(id.0 as u8)));
        self.links.insert(id, link);
    }

    /// Sends only responses on a link until a heartbeat is received: the sender's address may be forged, and streams would
    /// amplify every datagram.
    pub fn await_heartbeat(&mut self, id: LinkId) {
        if let Some(link) = self.links.get_mut(&id) {
            link.answers_only = true;
        }
    }

    /// Returns the links that receive unsolicited messages.
    fn listeners(&mut self) -> impl Iterator<Item = &mut PeerLink> {
        self.links.values_mut().filter(|link| !link.answers_only)
    }

    /// Limits a link's capacity to `bytes_s`, bytes/s: streams slow down, lists wait, and scoring data is omitted.
    pub fn limit(&mut self, id: LinkId, bytes_s: f64, now: SimTime) {
        if let Some(link) = self.links.get_mut(&id) {
            link.limit(bytes_s, now);
        }
    }

    /// Returns the number of frames dropped because a link was saturated or a peer exceeded its forwarding limit.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.gone_dropped + self.links.values().map(PeerLink::dropped).sum::<u64>()
    }

    /// Removes a link.
    pub fn close(&mut self, id: LinkId) {
        self.gone_dropped += self.links.remove(&id).map_or(0, |link| link.dropped());
        self.router.forget_link(id);
        self.param_lists.remove(&id);
        self.files.forget(id);
        self.camera_files.forget(id);
        self.logs.forget(id);
        self.manual.forget(id);
        self.shell.disconnect(id);
    }

    /// Returns the names and current values of all parameters, sorted by name.
    pub fn parameters(&self) -> impl Iterator<Item = (&'static str, params::ParamValue)> {
        (0..self.params.count()).filter_map(|index| self.params.at(index))
    }

    /// Returns the autopilot flavour.
    #[must_use]
    pub fn flavour(&self) -> &'static Flavour {
        self.flavour
    }

    /// Returns the flavour's number of the last requested mode.
    #[must_use]
    pub fn requested_mode(&self) -> u32 {
        self.chosen
    }

    /// Returns the MAVLink system ID.
    #[must_use]
    pub fn system_id(&self) -> u8 {
        self.system_id
    }

    /// Returns the times of the current or last flight.
    #[must_use]
    pub fn flight(&self) -> snapshot::FlightTimes {
        self.flight
    }

    /// Applies the flavour's parameter defaults to a new autopilot.
    pub fn prepare(&mut self, autopilot: &mut Autopilot) {
        if !self.flavour.params.defaults.is_empty() {
            self.apply_parameters(autopilot);
        }
    }

    /// Returns true once after a client requested a reboot of the autopilot.
    pub fn take_restart(&mut self) -> bool {
        std::mem::take(&mut self.restart)
    }

    /// Removes and returns the next failure to inject.
    pub fn poll_injection(&mut self) -> Option<FailureInjection> {
        self.injections.pop_front()
    }

    /// Returns the environment set by parameters: wind and radio.
    #[must_use]
    pub fn instructor_settings(&self) -> params::InstructorSettings {
        self.params.instructor_settings()
    }

    /// Returns the kind of a link and whether it runs in lockstep.
    #[must_use]
    pub fn kind(&self, id: LinkId) -> Option<(LinkKind, bool)> {
        self.links.get(&id).map(|link| (link.kind, link.lockstep))
    }

    /// Applies parameters and plans to a new autopilot, and resets the links to their default rates.
    pub fn boot(&mut self, view: &VehicleSnapshot, autopilot: &mut Autopilot) {
        (self.mode_switch, self.switches) = (None, [None; manual::AUX]);
        if self.params.drops_mission_at_boot() {
            self.plans.drop_mission();
        }
        self.apply_parameters(autopilot);
        param_and_mission_services::update_autopilot_plan(self, MavMissionType::MAV_MISSION_TYPE_ALL, view, autopilot);
        for link in self.links.values_mut() {
            link.reset_rates(view.now);
        }
        self.push_text(MavSeverity::MAV_SEVERITY_INFO, "Autopilot restarted");
    }

    /// Returns the links that simulation time waits for.
    pub fn all_in_step(&self) -> impl Iterator<Item = LinkId> {
        self.links.iter().filter(|(_, link)| link.blocks_lockstep()).map(|(id, _)| *id)
    }

    /// Returns the links in lockstep or about to join: their state, and whether anything was received from them.
    pub fn stepped(&self) -> impl Iterator<Item = (LinkId, LockstepState, bool)> {
        self.links.iter().filter(|(_, link)| link.lockstep).map(|(id, link)| (*id, link.lockstep_state, link.has_received))
    }

    /// Marks a peer as joined: simulation time waits for it from now on.
    pub fn join(&mut self, id: LinkId) {
        if let Some(link) = self.links.get_mut(&id) {
            link.lockstep_state = LockstepState::Joined;
        }
    }

    /// Stops waiting for a peer's first response.
    pub fn serve_in_real_time(&mut self, id: LinkId) {
        if let Some(link) = self.links.get_mut(&id).filter(|link| link.lockstep_state == LockstepState::Awaited) {
            link.lockstep_state = LockstepState::Late;
        }
    }

    /// Records that something was received from a peer.
    pub fn note_station_heard(&mut self, id: LinkId) {
        if let Some(link) = self.links.get_mut(&id) {
            link.has_received = true;
        }
    }

    /// Returns the number of bytes outside of valid frames, for all links.
    #[must_use]
    pub fn bad_bytes(&self) -> u64 {
        self.bad_bytes
    }

    /// Returns a summary of the plans.
    #[must_use]
    pub fn plans(&self) -> snapshot::PlanSummary {
        self.plans.summary()
    }

    /// Returns the stick positions; `None` after the timeout.
    #[must_use]
    pub fn sticks(&self, now: SimTime) -> Option<crate::autopilot::Sticks> {
        self.manual.fresh(now)
    }

    /// Returns the sticks as transmitter pulses, microseconds; `None` after the timeout.
    #[must_use]
    pub fn pulses_us(&self, now: SimTime) -> Option<[u16; 4]> {
        self.manual.pulses_us(now)
    }

    /// Returns transmitter channels 5 to 16, microseconds.
    #[must_use]
    pub fn aux_us(&self) -> [u16; manual::AUX] {
        self.manual.aux_us()
    }

    /// Sets the simulation speed, in seconds of simulation time per second of client time. Timeouts of clients that are not in
    /// lockstep are scaled by it, and logs record it: as a text now, and as NAMED_VALUE_FLOAT `speed_factor` with the other slow
    /// values.
    pub fn set_speed_factor(&mut self, pace: f64, autopilot: &mut Autopilot) {
        self.speed_factor = pace;
        self.plans.set_speed_factor(pace);
        autopilot.tuning.client_pace = pace;
        self.manual.release_timeout_s = autopilot.tuning.manual_timeout_s();
    }

    /// Warns about a stream of messages, at most once a second.
    fn warn_all(&mut self, text: &str, now: SimTime) {
        if now - self.complained >= COMPLAIN_EVERY {
            self.complained = now;
            self.push_text(MavSeverity::MAV_SEVERITY_CRITICAL, text);
        }
    }

    /// Sends a lockstep request to every peer in lockstep.
    pub fn request_lockstep(&mut self, now: SimTime) {
        let message = MavMessage::TIMESYNC(TIMESYNC_DATA { tc1: 0, ts1: now.ns(), target_system: 0, target_component: 0 });
        for link in self.links.values_mut().filter(|l| l.lockstep) {
            link.lockstep_token = Some(now.ns());
            link.send(AUTOPILOT, &message);
        }
    }

    /// Returns the next datagram.
    pub fn poll(&mut self) -> Option<Transmit> {
        self.links.iter_mut().find_map(|(id, link)| link.poll().map(|bytes| Transmit { link: *id, bytes }))
    }

    /// Broadcasts a text.
    pub fn push_text(&mut self, severity: MavSeverity, text: &str) {
        if self.texts.len() < MOST_TEXTS {
            self.texts.push((severity, text.to_string()));
        }
    }
}

/// Creates the file server with the vehicle's metadata files.
fn metadata_server(flavour: &Flavour) -> files::FileServer {
    let mut server = files::FileServer::default();
    let params::metadata::MetadataFiles { general, parameter, events } = params::metadata::files(flavour.params);
    for file in [general, parameter].into_iter().chain(events) {
        server.generate(file.path, file.bytes.clone());
    }
    server
}

/// Creates the camera's file server with its definition file.
fn camera_server() -> files::FileServer {
    let mut server = files::FileServer::default();
    server.generate(camera::settings::FILE, camera::settings::definition().into_bytes());
    server
}
