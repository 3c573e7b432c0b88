//! Additional scoring data besides the true motion (docs/src/reference/wire.md, "Scoring data"): named values, sent on change and
//! at rates of their own.

use super::Endpoint;
use super::snapshot::VehicleSnapshot;
use super::streams::AUTOPILOT;
use spandrel_mavlink::contract::named::Named;
use spandrel_mavlink::dialect::MavMessage;
use spandrel_model::time::{Schedule, SimTime};

/// Schedules of the named values.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TruthSchedule {
    contact: Schedule,
    clearance: Schedule,
    lux: Schedule,
    slow: Schedule,
}

impl TruthSchedule {
    /// Creates the schedules with the specified rates; everything is due immediately.
    pub(super) fn new() -> Self {
        let at = |hz| Schedule::new(SimTime::ZERO, hz);
        Self { contact: at(10.0), clearance: at(30.0), lux: at(5.0), slow: at(0.2) }
    }
}

impl Endpoint {
    /// Sends the named values for scoring: contact on change and at 10 Hz; hits, respawns and traffic on change and with the slow
    /// values.
    pub(super) fn truth(&mut self, view: &VehicleSnapshot) {
        let s = view.scoring;
        let rates = &mut self.truth_rates;
        let mut out = Vec::new();
        if rates.contact.fire(view.now) | (s.contact != self.sent.contact) {
            out.push(Named::Contact(s.contact));
        }
        let slow = rates.slow.fire(view.now);
        if slow || s.hits != self.sent.hits {
            out.push(Named::Hits(s.hits));
        }
        if slow || s.respawns != self.sent.respawns {
            out.push(Named::Respawns(s.respawns));
        }
        // Traffic that was never stopped is omitted.
        if slow || s.traffic != self.sent.traffic {
            out.extend(s.traffic.into_iter().filter(|code| *code != 0).map(Named::Traffic));
        }
        if slow {
            out.push(Named::Seed(s.seed.cast_unsigned()));
            out.push(Named::ScenarioCrc(s.scenario_crc));
            if self.speed_factor != 1.0 {
                out.push(Named::Pace(self.speed_factor));
            }
        }
        if rates.clearance.fire(view.now) {
            out.push(Named::ClearanceM(s.clearance_m));
        }
        if rates.lux.fire(view.now) {
            out.push(Named::Lux(s.lux));
        }
        self.sent = *s;
        let out: Vec<MavMessage> = out.into_iter().map(|value| value.message(view.sim_ms())).collect();
        for link in self.listeners().filter(|link| !link.is_limited() && link.wants_truth()) {
            out.iter().for_each(|message| link.send(AUTOPILOT, message));
        }
    }
}
