//! Battery warnings and failsafe.

use super::input::FailsafeInput;
use super::operator_rules::FailsafeResponse;
use super::response::{FailsafeRequest, respond};
use crate::autopilot::events::{EventQueue, Severity};
use crate::sensors::BatteryReading;
use spandrel_model::time::SimTime;

/// State of the battery failsafe.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BatteryMonitor {
    low_warned: bool,
    critical_warned: bool,
    /// Most severe battery level (1 = low, 2 = critical, 3 = emergency) whose failsafe has triggered in this flight.
    /// Each level triggers once, so the pilot can override it.
    highest_handled_level: usize,
    /// Times at which the voltage fell below the low and critical thresholds.
    low_voltage_since: [Option<SimTime>; 2],
}

impl BatteryMonitor {
    /// Warns about a low battery. In flight, returns the failsafe request.
    pub fn check(&mut self, input: &FailsafeInput, events: &mut EventQueue) -> Option<FailsafeRequest> {
        let battery = input.flight.battery?;
        let left_pct = battery.remaining_pct;
        let (low, critical) = (input.tuning.battery_low_pct, input.tuning.battery_critical_pct);
        if left_pct < low && !self.low_warned {
            self.low_warned = true;
            events.push(Severity::Warning, format!("Low battery: {left_pct:.0}%"));
        }
        if left_pct < critical && !self.critical_warned {
            self.critical_warned = true;
            events.push(Severity::Critical, format!("Critical battery: {left_pct:.0}%"));
        }
        // Changing the battery on the ground re-enables the warnings.
        if left_pct > low + 5.0 {
            (self.low_warned, self.critical_warned) = (false, false);
        }
        if input.flight.is_flying() {
            self.act(&battery, input, events)
        } else {
            (self.highest_handled_level, self.low_voltage_since) = (0, [None; 2]);
            None
        }
    }

    /// Battery level: 0 = good, 1 = low, 2 = critical, 3 = emergency.
    fn level(&mut self, battery: &BatteryReading, input: &FailsafeInput) -> usize {
        let (tuning, rules) = (input.tuning, &input.tuning.rules.responses);
        let mut sagged = [false; 2];
        for (k, limit_v) in rules.battery_low_v.into_iter().enumerate() {
            let since = &mut self.low_voltage_since[k];
            *since = if battery.voltage_v < limit_v { since.or(Some(input.now)) } else { None };
            sagged[k] = since.is_some_and(|since| (input.now - since).s() >= rules.battery_low_time_s);
        }
        match battery.remaining_pct {
            left if left < rules.battery_emergency_pct.min(tuning.battery_critical_pct) => 3,
            left if left < tuning.battery_critical_pct || sagged[1] => 2,
            left if left < tuning.battery_low_pct || sagged[0] => 1,
            _ => 0,
        }
    }

    /// Requests the failsafe action. It also triggers if the flight started with a low battery, or if the vehicle had
    /// no position when the battery reached the level.
    fn act(&mut self, battery: &BatteryReading, input: &FailsafeInput, events: &mut EventQueue) -> Option<FailsafeRequest> {
        const NAMES: [&str; 4] = ["", "low battery", "critical battery", "battery emergency"];
        let level = self.level(battery, input);
        if level <= self.highest_handled_level {
            return None;
        }
        // The action configured for the most severe new level that has one.
        let configured = input.tuning.rules.responses.battery;
        let (level, response) = (self.highest_handled_level + 1..=level).rev().find_map(|k| Some((k, configured[k - 1]?)))?;
        if response == FailsafeResponse::Return && !input.estimate.position_valid {
            return None;
        }
        self.highest_handled_level = level;
        let severity = if level == 1 { Severity::Warning } else { Severity::Critical };
        respond(response, NAMES[level], severity, input, events)
    }
}
