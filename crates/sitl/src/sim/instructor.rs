//! What an instructor does to the flight while it goes on: faults, weather, a bad radio.

use super::Sim;
use crate::endpoint::{Injection, LinkId, LinkKind};
use crate::faults::{Faults, Unit};
use spandrel_model::site::gates::Gates;
use spandrel_model::time::SimTime;
use std::sync::Arc;

/// A wind that an instructor changes has changed within this.
const WIND_CHANGES_IN: SimTime = SimTime::from_ms(5_000);

impl Sim {
    /// Sidecars and peers in step sit beside the vehicle; all others are reached over the radio, while it is bad.
    pub(super) fn is_over_radio(&self, link: LinkId) -> bool {
        !self.radio.is_good() && self.endpoint.kind(link).is_some_and(|(kind, in_step)| kind != LinkKind::Payload && !in_step)
    }

    /// Faults and weather that came by command and parameter.
    pub(super) fn heed_the_instructor(&mut self) {
        while let Some(Injection { unit, kind, instance }) = self.endpoint.poll_injection() {
            self.faults.inject(unit, kind, instance, self.config.vehicle.rotors.len());
            let battery = &mut self.state.battery;
            match instance.checked_sub(1) {
                _ if unit != Unit::Battery => {}
                Some(cell) => battery.fail_cell(cell, kind.is_some()),
                None if kind.is_some() => battery.charge = Faults::charge(battery.charge),
                None => battery.dead_cells = 0,
            }
        }
        let changes = self.endpoint.parameter_changes();
        if std::mem::replace(&mut self.heeded, changes) == changes {
            return;
        }
        let world = self.endpoint.world();
        self.radio.set(world.loss, world.delay);
        if world.wind != self.world.wind {
            let own = &self.config.scenario.wind;
            let (speed_m_s, from_deg) = world.wind.unwrap_or((own.speed_m_s, own.from_deg));
            self.wind.change(self.now, WIND_CHANGES_IN, speed_m_s, from_deg);
        }
        if world.open != self.world.open {
            self.gates.hear(Gates::code(self.now, world.open));
            self.site = Arc::new(self.site.with_gates(self.gates.clone()));
            self.scoring.traffic = self.gates.last_codes();
        }
        self.world = world;
    }
}
