//! The vehicle's MAVLink interface beside an external autopilot. The autopilot's own link and all clients meet here: the relay
//! forwards frames between them, and the simulator's components answer for the equipment, the scoring feed and the instructor.
//!
//! The autopilot keeps its system and component ID. The simulator never sends a heartbeat of component 1.

mod autopilot_report;
mod commands;
mod forwarding;
mod gimbal_control;
mod instructor_params;
mod message_requests;
mod publish;
mod receive;
mod setup;
mod setup_requests;
mod streams;

use super::component_ids;
use super::link::{LinkId, LinkKind, Links, PeerLink};
use super::payload::{PayloadComponents, PayloadLink};
use super::practice::PracticeInbox;
use super::simulated_aircraft::SimulatedAircraft;
use super::text_queue::TextQueue;
use super::vehicle_link::FailureInjection;
use super::vehicle_link::manual::ManualControl;
use super::vehicle_link::params::InstructorSettings;
use super::vehicle_link::params::param_view::ParamView;
pub use autopilot_report::{AutopilotReport, FirmwareVersion, ReportedParam};
use instructor_params::InstructorParams;
use setup_requests::SetupRequests;
use spandrel_mavlink::codec::Encoder;
use spandrel_mavlink::contract::practice::PracticeRequest;
use spandrel_mavlink::dialect::{MavMessage, MavSeverity};
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Properties of an autopilot that the relay depends on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RelayRules {
    /// Encoding of parameter values.
    pub params: &'static ParamView,
    /// Whether the autopilot's simulator build cannot reboot itself, so that its process is restarted instead.
    pub restarts_by_process: bool,
    /// Whether altitudes of region-of-interest commands are above mean sea level, regardless of their frame.
    pub roi_above_sea_level: bool,
    /// The only sender from which the autopilot accepts sticks: system and component ID; `None` if it accepts any.
    pub stick_sender: Option<(u8, u8)>,
}

/// The MAVLink interface beside an external autopilot.
#[derive(Debug, Clone)]
pub struct RelayEndpoint {
    /// The vehicle's links, including the one to the autopilot.
    pub links: Links,
    /// The equipment interface and the scoring feed.
    pub payload: PayloadLink,
    /// The autopilot's latest reports.
    pub report: AutopilotReport,
    /// Whether manual control reaches the autopilot.
    pub accepts_sticks: bool,
    rules: RelayRules,
    autopilot_link: Option<LinkId>,
    instructor: InstructorParams,
    injections: VecDeque<FailureInjection>,
    practice_requests: PracticeInbox,
    manual: ManualControl,
    /// Encoder for sticks under the only accepted sender.
    stick_encoder: Option<Encoder>,
    texts: TextQueue,
    setup: SetupRequests,
    restart_requested: bool,
    home_m: Vec3<Ned>,
    row_buffer: Vec<usize>,
}

impl RelayEndpoint {
    /// Creates an interface without links. `home_m` is the landing pad, in the site frame.
    #[must_use]
    pub fn new(system_id: u8, rules: RelayRules, home_m: Vec3<Ned>) -> Self {
        Self {
            links: Links::new(system_id, &component_ids::SEPARATE),
            payload: PayloadLink::new(PayloadComponents::SEPARATE),
            report: AutopilotReport::default(),
            accepts_sticks: true,
            rules,
            autopilot_link: None,
            instructor: InstructorParams::new(rules.params),
            injections: VecDeque::new(),
            practice_requests: PracticeInbox::default(),
            manual: ManualControl::default(),
            stick_encoder: rules.stick_sender.map(|(system, component)| Encoder::new(system, component)),
            texts: TextQueue::default(),
            setup: SetupRequests::default(),
            restart_requested: false,
            home_m,
            row_buffer: Vec::new(),
        }
    }

    /// Adds a link to a peer or, with [`LinkKind::Autopilot`], to the autopilot.
    pub fn open(&mut self, id: LinkId, kind: LinkKind, lockstep: bool, now: SimTime) {
        if kind == LinkKind::Autopilot {
            self.autopilot_link = Some(id);
        }
        let schedule = streams::schedule(kind, now);
        self.links.open(id, PeerLink::new(kind, lockstep, self.links.system_id(), false, schedule, now));
    }

    /// Removes a link.
    pub fn close(&mut self, id: LinkId) {
        if self.autopilot_link == Some(id) {
            self.autopilot_link = None;
        }
        self.links.close(id);
        self.payload.forget(id);
        self.manual.forget(id);
    }

    /// Forgets what the previous autopilot process reported.
    pub fn forget_autopilot(&mut self) {
        self.report = AutopilotReport::default();
        self.setup = SetupRequests::default();
        self.restart_requested = false;
    }

    /// Scales the timeouts of clients that are not in lockstep, in seconds of simulation time per second of client time.
    pub fn set_speed_factor(&mut self, factor: f64) {
        self.payload.speed_factor = factor;
        self.manual.release_timeout_s = crate::autopilot::Tuning::default().manual_timeout_s() * factor;
    }

    /// Broadcasts a text with the next tick.
    pub fn push_text(&mut self, severity: MavSeverity, text: &str) {
        self.texts.push(severity, text);
    }

    /// Sends a message of the simulator's component to the autopilot.
    pub fn send_to_autopilot(&mut self, message: &MavMessage) {
        if let Some(link) = self.autopilot_link.and_then(|id| self.links.get_mut(id)) {
            link.send(component_ids::SIMULATOR, message);
        }
    }

    /// Returns the environment settings that parameters control: wind, radio link, and traffic.
    #[must_use]
    pub fn instructor_settings(&self) -> InstructorSettings {
        self.instructor.settings()
    }

    /// Returns the number of changes of these parameters so far.
    #[must_use]
    pub fn parameter_changes(&self) -> u64 {
        self.instructor.changes()
    }

    /// Removes and returns the next failure to inject.
    pub fn next_injection(&mut self) -> Option<FailureInjection> {
        self.injections.pop_front()
    }

    /// Removes and returns the next request to freeze or resume the flight.
    pub fn next_practice_request(&mut self) -> Option<PracticeRequest> {
        self.practice_requests.next_request()
    }

    /// Returns true once after a client has requested a reboot that the simulator carries out.
    pub fn take_restart_request(&mut self) -> bool {
        std::mem::take(&mut self.restart_requested)
    }

    /// Returns the aircraft state for the equipment and the scoring feed. Positions come from the ground truth.
    fn input<'v>(&self, aircraft: &SimulatedAircraft<'v>) -> super::payload::PayloadInput<'v> {
        let sticks = self.manual.fresh(aircraft.clock.now);
        super::payload::PayloadInput {
            clock: aircraft.clock,
            vehicle: aircraft.vehicle,
            plane: aircraft.plane,
            site: aircraft.site,
            position_m: aircraft.truth.position_m,
            attitude: aircraft.truth.attitude,
            home_m: Some(self.home_m),
            roi_above_sea_level: self.rules.roi_above_sea_level,
            sticks: sticks.map(|s| [s.forward, s.right, s.up, s.yaw]),
            truth: aircraft.truth,
            specific_force_m_s2: aircraft.specific_force_m_s2,
            wind_m_s: aircraft.wind_m_s,
            scoring: aircraft.scoring,
            hazards: aircraft.hazards,
            battery: aircraft.battery,
            components: self.payload.components,
        }
    }
}
