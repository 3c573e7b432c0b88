//! The autopilot's interface (component 1): heartbeat, parameters, missions, modes, arming, files, logs, manual
//! control, setpoints, calibration, events and shell.

pub(super) mod aux_functions;
mod available_modes;
mod buttons;
mod calibration;
pub(super) mod commands;
mod events;
pub mod flavor;
mod flight_times;
mod follow_targets;
mod ftp;
mod ground_station;
mod host_requests;
mod inbound;
mod link_services;
mod log_messages;
pub mod logs;
pub(super) mod manual;
mod manual_input;
mod mission;
mod mission_service;
mod mode_requests;
mod offboard;
mod outcome;
mod param_messages;
mod param_persistence;
mod param_service;
mod param_storage;
pub mod params;
mod publish;
mod receive;
mod setpoint_messages;
mod shell;
pub mod snapshot;
mod status_texts;
pub(super) mod streams;
mod switch_position;
mod terrain;

use super::files::FileServer;
use super::link::LinkId;
use super::payload::Payload;
use super::practice::PracticeInbox;
use super::simulated_aircraft::SimulatedAircraft;
use super::text_queue::TextQueue;
use crate::autopilot::{Autopilot, Sticks};
use crate::endpoint::numbered_requests::NumberedRequests;
use calibration::Calibration;
use events::EventReports;
use flavor::Flavor;
pub use flight_times::FlightTimes;
pub use host_requests::{FailureInjection, StorageRequest};
pub(super) use inbound::InboundMessage;
use logs::LogTransfers;
use manual::ManualControl;
pub use mission::PlanSummary;
use mission::{ItemEncoding, PlanStore};
use param_storage::ParamStorage;
use params::{AircraftValues, InstructorSettings, ParamValue, Params, metadata};
pub(super) use receive::HANDLED;
use shell::NshShell;
use snapshot::VehicleSnapshot;
use spandrel_mavlink::contract::practice::PracticeRequest;
use spandrel_mavlink::dialect::MavSeverity;
use spandrel_model::time::SimTime;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use switch_position::SwitchPosition;

/// State of the autopilot interface.
#[derive(Debug, Clone)]
pub struct VehicleLink {
    system_id: u8,
    flavor: &'static Flavor,
    /// The flavor's number for the last requested mode; several numbers may map to the same internal mode.
    requested_mode: u32,
    /// The file server.
    pub files: FileServer,
    /// The flight logs.
    pub logs: LogTransfers,
    params: Params,
    storage: ParamStorage,
    param_lists: BTreeMap<LinkId, VecDeque<usize>>,
    /// Parameter revision, plan item counts and fence switch that the parameters already show, cached because looking
    /// up parameters by name in every tick is too slow.
    shown_by_params: Option<(u64, [u16; 3], bool)>,
    restart_requested: bool,
    injections: VecDeque<FailureInjection>,
    practice_requests: PracticeInbox,
    /// Requests for a response to the sticks.
    stick_requests: NumberedRequests,
    /// Whether manual control is accepted.
    pub accepts_sticks: bool,
    plans: PlanStore,
    manual: ManualControl,
    /// Last position of the mode switch, from 0.
    mode_switch: Option<usize>,
    /// Last positions of the auxiliary switches on channels 5 to 16.
    switches: [Option<SwitchPosition>; manual::AUX_CHANNEL_COUNT],
    texts: TextQueue,
    /// Messages to broadcast once, with the next tick.
    announcements: BTreeSet<u32>,
    speed_factor: f64,
    reported_speed_factor: f64,
    last_stream_warning: SimTime,
    flight: FlightTimes,
    was_armed: bool,
    /// Number of geofence actions as of the last tick.
    fence_actions: u16,
    /// The calibration in progress.
    calibration: Option<Calibration>,
    /// Events sent to ground stations.
    events: EventReports,
    /// The console.
    shell: NshShell,
}

/// Minimum interval between warnings about setpoints, which arrive many times a second.
const STREAM_WARNING_INTERVAL: SimTime = SimTime::from_ms(1_000);

impl VehicleLink {
    /// Creates an autopilot interface with the flavor's default parameters.
    #[must_use]
    pub fn new(system_id: u8, aircraft: AircraftValues, flavor: &'static Flavor) -> Self {
        let params = Params::new(system_id, aircraft, flavor.params);
        Self {
            system_id,
            flavor,
            requested_mode: 0,
            files: metadata_server(flavor),
            logs: LogTransfers::default(),
            storage: ParamStorage::new(params.clone()),
            params,
            param_lists: BTreeMap::new(),
            shown_by_params: None,
            restart_requested: false,
            injections: VecDeque::new(),
            practice_requests: PracticeInbox::default(),
            stick_requests: NumberedRequests::default(),
            accepts_sticks: true,
            plans: PlanStore::with_lead_items(u16::from(flavor.home_item))
                .with_splines(flavor.splines)
                .with_zero_as_current_position(flavor.zero_means_current_position)
                .with_encoding(if flavor.uses_float_items { ItemEncoding::Float } else { ItemEncoding::Int }),
            manual: ManualControl::default(),
            mode_switch: None,
            switches: [None; manual::AUX_CHANNEL_COUNT],
            texts: TextQueue::default(),
            announcements: BTreeSet::new(),
            speed_factor: 1.0,
            reported_speed_factor: 1.0,
            last_stream_warning: SimTime::ZERO.saturating_sub(STREAM_WARNING_INTERVAL),
            flight: FlightTimes::default(),
            was_armed: false,
            fence_actions: 0,
            calibration: None,
            events: EventReports::default(),
            shell: NshShell::default(),
        }
    }

    /// Returns the autopilot flavor.
    #[must_use]
    pub fn flavor(&self) -> &'static Flavor {
        self.flavor
    }

    /// Returns the vehicle's state at one instant, for messages to ground stations.
    #[must_use]
    pub fn snapshot<'a>(
        &self,
        aircraft: &SimulatedAircraft<'a>,
        autopilot: &'a Autopilot,
        payload: &Payload,
    ) -> VehicleSnapshot<'a> {
        let clock = aircraft.clock;
        VehicleSnapshot {
            clock,
            vehicle: aircraft.vehicle,
            plane: aircraft.plane,
            estimate: autopilot.estimate(),
            status: autopilot.status(),
            readings: aircraft.readings,
            truth: aircraft.truth,
            specific_force_m_s2: aircraft.specific_force_m_s2,
            battery: aircraft.battery,
            actuators: aircraft.actuators,
            wind_m_s: aircraft.wind_m_s,
            scoring: aircraft.scoring,
            sticks: self.sticks(clock.now),
            pulses_us: self.manual.pulses_us(clock.now),
            aux_pulses_us: self.manual.aux_us(),
            gimbal: payload.gimbal,
            lamp: payload.lamp,
            camera: payload.camera.summary(clock.now),
            plans: self.plans.summary(),
            flavor: self.flavor,
            requested_mode: self.requested_mode,
            fence_enabled: autopilot.tuning.fence_enabled,
            system_id: self.system_id,
            flight: self.flight,
        }
    }

    /// Returns the stick positions, or `None` after the timeout.
    #[must_use]
    pub fn sticks(&self, now: SimTime) -> Option<Sticks> {
        self.manual.fresh(now)
    }

    /// Returns the names and current values of all parameters, sorted by name.
    pub fn parameters(&self) -> impl Iterator<Item = (&'static str, ParamValue)> {
        (0..self.params.count()).filter_map(|index| self.params.at(index))
    }

    /// Returns the environment settings that parameters control: wind, radio link, and traffic.
    #[must_use]
    pub fn instructor_settings(&self) -> InstructorSettings {
        self.params.instructor_settings()
    }

    /// Returns true once after a client has requested an autopilot reboot.
    pub fn take_restart_request(&mut self) -> bool {
        std::mem::take(&mut self.restart_requested)
    }

    /// Removes and returns the next failure to inject.
    pub fn next_injection(&mut self) -> Option<FailureInjection> {
        self.injections.pop_front()
    }

    /// Removes and returns the next request to freeze, resume or rewind the flight.
    pub fn next_practice_request(&mut self) -> Option<PracticeRequest> {
        self.practice_requests.next_request()
    }

    /// Removes and returns the messages to broadcast once.
    pub fn take_announcements(&mut self) -> BTreeSet<u32> {
        std::mem::take(&mut self.announcements)
    }

    /// Scales the timeouts of clients that are not in lockstep by the simulation speed, in seconds of simulation time
    /// per second of client time. A text announces the change.
    pub fn set_speed_factor(&mut self, factor: f64, autopilot: &mut Autopilot) {
        self.speed_factor = factor;
        self.plans.set_speed_factor(factor);
        autopilot.tuning.client_speed_factor = factor;
        self.manual.release_timeout_s = autopilot.tuning.manual_timeout_s();
    }

    /// Releases all state for a closed link.
    pub fn forget(&mut self, link: LinkId) {
        self.param_lists.remove(&link);
        self.files.forget(link);
        self.logs.forget(link);
        self.manual.forget(link);
        self.shell.disconnect(link);
    }

    /// Broadcasts a text with the next tick.
    pub fn push_text(&mut self, severity: MavSeverity, text: &str) {
        self.texts.push(severity, text);
    }

    /// Broadcasts a message once, with the next tick.
    fn announce(&mut self, message: u32) {
        self.announcements.insert(message);
    }

    /// Broadcasts a warning with the severity that PX4 uses for rejections.
    fn warn(&mut self, text: &str) {
        self.texts.push(MavSeverity::MAV_SEVERITY_CRITICAL, text);
    }

    /// Broadcasts an informational text.
    fn inform(&mut self, text: &str) {
        self.texts.push(MavSeverity::MAV_SEVERITY_INFO, text);
    }

    /// Warns about a stream of messages, at most once a second.
    fn warn_of_stream(&mut self, text: &str, now: SimTime) {
        if now - self.last_stream_warning >= STREAM_WARNING_INTERVAL {
            self.last_stream_warning = now;
            self.warn(text);
        }
    }

    /// Broadcasts the banner that identifies the autopilot.
    pub fn announce_identity(&mut self) {
        self.flavor.banner.iter().for_each(|line| self.texts.push(MavSeverity::MAV_SEVERITY_INFO, line));
    }

    /// Checks whether the mode that accepts go-to commands (GUIDED) is active, for flavors that have one.
    fn is_guided(&self, autopilot: &Autopilot) -> bool {
        let row = self.flavor.row_of(autopilot.status().mode, self.requested_mode);
        self.flavor.goto_mode == Some(row.number)
    }
}

/// Creates the file server with the vehicle's metadata files.
fn metadata_server(flavor: &Flavor) -> FileServer {
    let mut server = FileServer::default();
    let metadata::MetadataFiles { general, parameter, events } = metadata::files(flavor.params);
    for file in [general, parameter].into_iter().chain(events) {
        server.generate(file.path, file.bytes.clone());
    }
    server
}
