//! Inputs of the autopilot and payload interfaces, built from the simulated aircraft and its autopilot.

use super::link::LinkKind;
use super::payload::{PayloadComponents, PayloadInput, PayloadLink, PayloadSnapshot};
use super::simulated_aircraft::SimulatedAircraft;
use super::vehicle_link::VehicleLink;
use super::vehicle_link::snapshot::VehicleSnapshot;
use crate::autopilot::Autopilot;

/// Returns the aircraft state for the equipment and the scoring feed.
pub(super) fn payload_input<'v>(
    vehicle: &VehicleLink,
    aircraft: &SimulatedAircraft<'v>,
    autopilot: &Autopilot,
) -> PayloadInput<'v> {
    let estimate = autopilot.estimate();
    let sticks = vehicle.sticks(aircraft.clock.now);
    PayloadInput {
        clock: aircraft.clock,
        vehicle: aircraft.vehicle,
        plane: aircraft.plane,
        site: aircraft.site,
        position_m: estimate.position_m,
        attitude: estimate.attitude,
        home_m: autopilot.status().home_m,
        roi_above_sea_level: vehicle.flavor().roi_altitude_above_sea_level,
        sticks: sticks.map(|s| [s.forward, s.right, s.up, s.yaw]),
        truth: aircraft.truth,
        specific_force_m_s2: aircraft.specific_force_m_s2,
        wind_m_s: aircraft.wind_m_s,
        scoring: aircraft.scoring,
        hazards: aircraft.hazards,
        battery: aircraft.battery,
        components: PayloadComponents::BUILTIN,
    }
}

/// State used to build messages.
#[derive(Debug, Clone, Copy)]
pub struct StreamInputs<'a> {
    /// Vehicle state.
    pub vehicle: VehicleSnapshot<'a>,
    /// Equipment state.
    pub payload: PayloadSnapshot<'a>,
}

impl<'a> StreamInputs<'a> {
    /// Returns the current state for ground stations.
    #[must_use]
    pub fn new(
        vehicle: &VehicleLink,
        payload: &PayloadLink,
        aircraft: &SimulatedAircraft<'a>,
        autopilot: &'a Autopilot,
        input: &'a PayloadInput<'a>,
    ) -> Self {
        let equipment = &payload.equipment;
        Self { vehicle: vehicle.snapshot(aircraft, autopilot, equipment), payload: PayloadSnapshot::new(input, equipment) }
    }

    /// Returns a copy for another kind of link.
    #[must_use]
    pub fn for_link(&self, kind: LinkKind) -> Self {
        Self { vehicle: self.vehicle.for_link(kind), payload: self.payload.for_link(kind) }
    }
}
