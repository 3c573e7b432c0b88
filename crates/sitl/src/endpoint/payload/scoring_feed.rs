//! Scoring data other than the true motion (docs/src/reference/wire.md, "Scoring data"): named values, each sent on
//! change and at its own rate.

use super::scoring_truth::ScoringTruth;
use spandrel_mavlink::contract::named_values::NamedValue;
use spandrel_model::time::{Schedule, SimTime};

/// Schedules of the named values, and the values most recently sent.
#[derive(Debug, Clone, PartialEq)]
pub struct ScoringFeed {
    contact: Schedule,
    clearance: Schedule,
    lux: Schedule,
    slow: Schedule,
    last: ScoringTruth,
}

impl ScoringFeed {
    /// Creates the feed. Every value is sent on the first call.
    #[must_use]
    pub fn new() -> Self {
        let at = |hz| Schedule::new(SimTime::ZERO, hz);
        Self { contact: at(10.0), clearance: at(30.0), lux: at(5.0), slow: at(0.2), last: ScoringTruth::default() }
    }

    /// Returns the values that are due: contact on change and at 10 Hz; hits, respawns, practice values, traffic and
    /// walks on change and with the slow values.
    pub fn take_due(&mut self, truth: &ScoringTruth, speed_factor: f64, now: SimTime) -> Vec<NamedValue> {
        let mut out = Vec::new();
        if self.contact.fire(now) | (truth.contact != self.last.contact) {
            out.push(NamedValue::Contact(truth.contact));
        }
        let slow = self.slow.fire(now);
        if slow || truth.hits != self.last.hits {
            out.push(NamedValue::Hits(truth.hits));
        }
        if slow || truth.respawns != self.last.respawns {
            out.push(NamedValue::Respawns(truth.respawns));
        }
        let has_changed = practice_state(truth) != practice_state(&self.last);
        if slow || has_changed {
            out.extend(practice_values(truth));
        }
        // Traffic that has never been stopped is omitted.
        if slow || truth.traffic != self.last.traffic {
            out.extend(truth.traffic.into_iter().filter(|code| *code != 0).map(NamedValue::Traffic));
        }
        if slow || truth.walks != self.last.walks {
            out.extend(truth.walks.into_iter().filter(|code| *code != 0).map(NamedValue::Walk));
        }
        if slow {
            out.push(NamedValue::Seed(truth.seed.cast_unsigned()));
            out.push(NamedValue::ScenarioCrc(truth.scenario_crc));
            if speed_factor != 1.0 {
                out.push(NamedValue::Pace(speed_factor));
            }
        }
        if self.clearance.fire(now) {
            out.push(NamedValue::ClearanceM(truth.clearance_m));
        }
        if self.lux.fire(now) {
            out.push(NamedValue::Lux(truth.lux));
        }
        self.last = *truth;
        out
    }

    /// Returns the values that are sent while the flight is frozen.
    pub fn frozen_values(&mut self, truth: &ScoringTruth) -> Vec<NamedValue> {
        (self.last.freezes, self.last.rewinds, self.last.is_frozen) = practice_state(truth);
        practice_values(truth)
    }
}

fn practice_state(truth: &ScoringTruth) -> (i32, i32, bool) {
    (truth.freezes, truth.rewinds, truth.is_frozen)
}

/// Returns the freezes and rewinds; nothing before the first one.
fn practice_values(truth: &ScoringTruth) -> Vec<NamedValue> {
    let (freezes, rewinds, is_frozen) = practice_state(truth);
    if freezes == 0 && rewinds == 0 {
        return Vec::new();
    }
    vec![NamedValue::Freezes(freezes), NamedValue::Rewinds(rewinds), NamedValue::Frozen(is_frozen)]
}

impl Default for ScoringFeed {
    fn default() -> Self {
        Self::new()
    }
}
