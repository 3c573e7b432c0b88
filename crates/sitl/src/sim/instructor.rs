//! Applies inputs of the instructor and the inspector during a flight: failures, weather, radio impairment, traffic and walks.

use super::radio_shadow::{RadioShadow, is_for_simulator};
use super::{Sim, SimEvent};
use crate::endpoint::{FailureInjection, LinkId, LinkKind};
use crate::faults::{FailureUnit, Faults};
use spandrel_model::site::bridge_closures::BridgeClosures;
use spandrel_model::site::inspector_walks::Walk;
use spandrel_model::time::SimTime;
use std::sync::Arc;

/// Duration of the transition after an instructor changes the wind.
const WIND_TRANSITION_TIME: SimTime = SimTime::from_ms(5_000);

impl Sim {
    /// Returns true if a link is subject to radio impairment. Payload links, lockstep peers and the cable to an
    /// external autopilot are exempt.
    pub(super) fn is_over_radio(&self, link: LinkId) -> bool {
        !self.radio.is_lossless()
            && self
                .controller
                .links()
                .kind(link)
                .is_some_and(|(kind, in_step)| !matches!(kind, LinkKind::Payload | LinkKind::Autopilot) && !in_step)
    }

    /// Applies failures and weather set by commands and parameters.
    pub(super) fn apply_instructor_inputs(&mut self) {
        while let Some(FailureInjection { unit, kind, instance }) = self.controller.next_injection() {
            self.faults.inject(unit, kind, instance, self.config.vehicle.rotors.len());
            let battery = &mut self.state.battery;
            match instance.checked_sub(1) {
                _ if unit != FailureUnit::Battery => {}
                Some(cell) => battery.fail_cell(cell, kind.is_some()),
                None if kind.is_some() => battery.charge = Faults::charge(battery.charge),
                None => battery.failed_cells = 0,
            }
        }
        let changes = self.controller.parameter_changes();
        if std::mem::replace(&mut self.applied_changes, changes) == changes {
            return;
        }
        let world = self.controller.instructor_settings();
        if world.wind != self.instructor_settings.wind {
            let own = &self.config.scenario.wind;
            let (speed_m_s, from_deg) = world.wind.unwrap_or((own.speed_m_s, own.from_deg));
            self.wind.add_change(self.now, WIND_TRANSITION_TIME, speed_m_s, from_deg);
        }
        if world.open != self.instructor_settings.open {
            self.site_changes.closures.apply_code(BridgeClosures::code(self.now, world.open));
            self.apply_site_changes();
        }
        self.instructor_settings = world;
        self.set_radio_loss();
    }

    /// Returns whether the structure silences control and telemetry at this time.
    pub(super) fn is_radio_silent(&self) -> bool {
        self.radio_shadow.as_ref().is_some_and(RadioShadow::is_silent)
    }

    /// Returns whether a datagram arrives although the structure silences the radio, because it is for the simulator.
    pub(super) fn bypasses_silence(&self, bytes: &[u8]) -> bool {
        self.is_radio_silent() && is_for_simulator(bytes)
    }

    /// Applies the loss and delay that the instructor has set, and the silence behind structures.
    pub(super) fn set_radio_loss(&mut self) {
        let loss = if self.is_radio_silent() { 1.0 } else { self.instructor_settings.loss };
        self.radio.set(loss, self.instructor_settings.delay);
    }

    /// Starts the walk that a client has requested. The site may have changed since the request was accepted.
    pub(super) fn apply_walk_request(&mut self) {
        let Some(place) = self.controller.payload_mut().equipment.take_walk_request() else { return };
        let walk = self.site.inspector().walk_to(place, self.now);
        let Some(code) = walk.and_then(Walk::code) else { return };
        self.site_changes.walks.apply_code(code);
        self.apply_site_changes();
        self.events.push_back(SimEvent::Walk { place });
    }

    fn apply_site_changes(&mut self) {
        self.site = Arc::new(self.site.with_changes(self.site_changes.clone()));
        self.scoring.traffic = self.site_changes.closures.last_codes();
        self.scoring.walks = self.site_changes.walks.last_codes();
    }
}
