//! Context for handling a message to the autopilot.

use super::VehicleLink;
use super::snapshot::VehicleSnapshot;
use crate::autopilot::Autopilot;
use crate::endpoint::component_ids::AUTOPILOT;
use crate::endpoint::link::{LinkId, Links};
use crate::endpoint::payload::{Payload, PayloadInput};
use crate::endpoint::simulated_aircraft::SimulatedAircraft;
use spandrel_mavlink::codec::Encodable;
use spandrel_model::time::SimTime;

/// A message addressed to this vehicle, and the state needed to handle it.
pub(crate) struct InboundMessage<'a, 'v> {
    /// The link it arrived on.
    pub link: LinkId,
    /// The sender's system and component ID.
    pub from: (u8, u8),
    /// The simulated aircraft.
    pub aircraft: &'a SimulatedAircraft<'v>,
    /// Aircraft state available to the equipment.
    pub input: &'a PayloadInput<'v>,
    /// The autopilot.
    pub autopilot: &'a mut Autopilot,
    /// The camera, gimbal and lamp.
    pub payload: &'a mut Payload,
    /// All links.
    pub links: &'a mut Links,
}

impl InboundMessage<'_, '_> {
    /// Returns the simulation time.
    pub fn now(&self) -> SimTime {
        self.aircraft.clock.now
    }

    /// Returns the height of home above the site's origin in meters; 0 before home is set.
    pub fn home_height_m(&self) -> f64 {
        self.autopilot.status().home_m.map_or(0.0, |home| -home.down())
    }

    /// Sends a response from the autopilot.
    pub fn answer(&mut self, message: &impl Encodable) {
        self.links.answer(AUTOPILOT, self.link, message);
    }

    /// Sends a message from the autopilot to all links that receive unsolicited messages.
    pub fn broadcast(&mut self, message: &impl Encodable) {
        self.links.broadcast(AUTOPILOT, message);
    }

    /// Returns the vehicle's current state.
    pub fn view(&self, v: &VehicleLink) -> VehicleSnapshot<'_> {
        v.snapshot(self.aircraft, self.autopilot, self.payload)
    }
}
