//! The vehicle's MAVLink interface, in one of three flavors. It processes incoming datagrams from all links and
//! produces outgoing ones. It never reads a clock.
//!
//! Two halves share the links: [`vehicle_link`] is the autopilot interface; [`payload`] is the interface to the
//! aircraft's equipment and includes the scoring feed. `payload` does not depend on `vehicle_link`.

mod clock;
mod component_ids;
pub mod files;
mod inputs;
pub mod link;
mod message_requests;
mod numbered_requests;
pub mod payload;
mod practice;
mod publish;
mod receive;
mod refused_request;
pub mod relay;
mod simulated_aircraft;
pub mod streams;
mod text_queue;
mod vehicle_command;
pub mod vehicle_link;

use crate::autopilot::Autopilot;
pub use clock::VehicleClock;
use link::PeerLink;
pub use link::{LinkId, LinkKind, Links, LockstepState, ReceivedDatagram, Transmit};
pub use payload::camera;
pub use payload::{HazardTruth, Payload, PayloadComponents, PayloadLink, RadioTruth, ScoringTruth};
pub use practice::PracticeState;
pub use receive::HANDLED;
pub use relay::RelayEndpoint;
pub use simulated_aircraft::SimulatedAircraft;
use spandrel_mavlink::dialect::MavSeverity;
use spandrel_model::time::SimTime;
pub use vehicle_command::VehicleCommand;
pub use vehicle_link::{FailureInjection, StorageRequest, VehicleLink};
pub use vehicle_link::{flavor, logs, params, snapshot};

/// The vehicle's MAVLink endpoint.
#[derive(Debug, Clone)]
pub struct Endpoint {
    /// The vehicle's links.
    pub links: Links,
    /// The autopilot interface.
    pub vehicle: VehicleLink,
    /// The equipment interface and the scoring feed.
    pub payload: PayloadLink,
    /// Inputs that have affected the vehicle and are not yet in the digest.
    digest_input: Vec<u8>,
    row_buffer: Vec<usize>,
    /// Stick positions in the last tick, as transmitter pulses, microseconds; `None` after the timeout.
    published_pulses_us: Option<[u16; 4]>,
}

impl Endpoint {
    /// Creates an endpoint without links.
    #[must_use]
    pub fn new(system_id: u8, aircraft: params::AircraftValues, flavor: &'static flavor::Flavor) -> Self {
        Self {
            links: Links::new(system_id, &component_ids::BUILTIN),
            vehicle: VehicleLink::new(system_id, aircraft, flavor),
            payload: PayloadLink::new(PayloadComponents::BUILTIN),
            digest_input: Vec::new(),
            row_buffer: Vec::new(),
            published_pulses_us: None,
        }
    }

    /// Adds a link to a peer.
    pub fn open(&mut self, id: LinkId, kind: LinkKind, lockstep: bool, now: SimTime) {
        let must_ask = self.vehicle.flavor().must_request_streams(kind);
        let schedule = streams::schedule(kind, must_ask, now);
        self.links.open(id, PeerLink::new(kind, lockstep, self.links.system_id(), must_ask, schedule, now));
    }

    /// Removes a link.
    pub fn close(&mut self, id: LinkId) {
        self.links.close(id);
        self.vehicle.forget(id);
        self.payload.forget(id);
    }

    /// Applies the flavor's parameter defaults to a new autopilot.
    pub fn prepare(&mut self, autopilot: &mut Autopilot) {
        self.vehicle.prepare(autopilot, &mut self.payload.equipment);
    }

    /// Applies parameters and plans to a restarted autopilot, and resets the links to their default rates.
    pub fn boot(&mut self, aircraft: &SimulatedAircraft, autopilot: &mut Autopilot) {
        self.vehicle.boot(aircraft.plane, autopilot, &mut self.payload.equipment);
        for (_, link) in self.links.iter_mut() {
            link.reset_rates(aircraft.clock.now);
        }
        self.vehicle.push_text(MavSeverity::MAV_SEVERITY_INFO, "Autopilot restarted");
    }

    /// Sets the simulation speed, in seconds of simulation time per second of client time. It scales the timeouts of
    /// clients that are not in lockstep. Logs record it immediately as a text, and as NAMED_VALUE_FLOAT `speed_factor`
    /// along with the other slow values.
    pub fn set_speed_factor(&mut self, factor: f64, autopilot: &mut Autopilot) {
        self.vehicle.set_speed_factor(factor, autopilot);
        self.payload.speed_factor = factor;
    }

    /// Applies a parameter file and broadcasts the parameters.
    ///
    /// # Errors
    /// Returns all invalid lines. No parameter is set in that case.
    pub fn load_parameters(&mut self, text: &str, autopilot: &mut Autopilot) -> Result<(), Vec<params::text::ParamFileProblem>> {
        self.vehicle.load_parameters(text, autopilot, &mut self.payload.equipment, &self.links)
    }

    /// Returns the inputs recorded for the digest since the last call.
    pub fn take_digest_input(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.digest_input)
    }
}
