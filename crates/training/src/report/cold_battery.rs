//! Cost of a cold battery in a flight: the charge and the voltage that a warm one would have kept, from the voltage and the current that the
//! vehicle reported.

use super::formatting;
use spandrel_mavlink::telemetry::{BatteryReport, Frame, Navigation};
use spandrel_model::scenario::Scenario;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{BATTERY_REFERENCE_C, BatterySpec};
use spandrel_text::{Language, text};

/// Longest time for which a report of the battery counts, s (estimate: two per second, of which some may be lost).
const MAX_REPORT_AGE_S: f64 = 1.5;

/// Costs of a cold battery, compared with one at 25 °C that delivers the same power.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColdBattery {
    /// Temperature of the battery, °C.
    pub temperature_c: f64,
    /// Charge that was drawn in addition, relative to that of a warm battery.
    pub extra_charge: f64,
    /// Largest voltage that was missing, V.
    pub missing_v: f64,
    /// Voltage that was left then, V.
    pub voltage_v: f64,
    /// When that was, s since lift-off.
    pub at_s: f64,
}

impl ColdBattery {
    /// Measures a flight; `None` if the battery was not cold, or without reports of its voltage and current.
    #[must_use]
    pub fn measure(scenario: &Scenario, battery: &BatterySpec, frames: &[Frame], navigation: &Navigation) -> Option<Self> {
        let (first, last) = (frames.first()?, frames.last()?);
        let temperature_c = scenario.rules.battery_temperature_c;
        let reports = navigation.battery().between(first.time, last.time);
        if !scenario.rules.has_cold_battery() || reports.is_empty() {
            return None;
        }
        let resistances_ohm = [temperature_c, BATTERY_REFERENCE_C].map(|celsius| battery.resistance_ohm(celsius));
        let mut found = Self { temperature_c, extra_charge: 0.0, missing_v: 0.0, voltage_v: 0.0, at_s: 0.0 };
        let (mut cold_as, mut warm_as) = (0.0, 0.0);
        for (k, (time, _, report)) in reports.iter().enumerate() {
            let Some(warm) = warm_battery(*report, resistances_ohm) else { continue };
            let until: SimTime = reports.get(k + 1).map_or(last.time, |next| next.0);
            let lasted_s = (until - *time).s().min(MAX_REPORT_AGE_S);
            cold_as += report.current_a * lasted_s;
            warm_as += warm.current_a * lasted_s;
            let missing_v = warm.voltage_v - report.voltage_v;
            if missing_v > found.missing_v {
                found = Self { missing_v, voltage_v: report.voltage_v, at_s: (*time - first.time).s(), ..found };
            }
        }
        (warm_as > 0.0).then(|| Self { extra_charge: cold_as / warm_as - 1.0, ..found })
    }

    /// Returns the costs as a sentence.
    #[must_use]
    pub fn sentence(&self, language: Language) -> String {
        text!(
            language,
            "report-cold-battery",
            temperature = formatting::number(self.temperature_c, 0),
            missing = formatting::number(self.missing_v, 1),
            at = formatting::clock(self.at_s),
            voltage = formatting::number(self.voltage_v, 1),
            share = formatting::number(100.0 * self.extra_charge, 1)
        )
    }
}

/// Returns voltage and current of a battery at another resistance that delivers the same power from the same charge; `None` if it cannot.
/// The resistances are the present and the other one, ohm.
fn warm_battery(cold: BatteryReport, [present_ohm, other_ohm]: [f64; 2]) -> Option<BatteryReport> {
    let open_v = cold.voltage_v + cold.current_a * present_ohm;
    let power_w = cold.voltage_v * cold.current_a;
    let discriminant = open_v * open_v - 4.0 * other_ohm * power_w;
    let voltage_v = 0.5 * (open_v + discriminant.max(0.0).sqrt());
    (discriminant >= 0.0 && voltage_v > 0.0).then(|| BatteryReport { voltage_v, current_a: power_w / voltage_v })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_warm_battery_delivers_the_same_power_from_the_same_charge() {
        let (cold, resistances_ohm) = (BatteryReport { voltage_v: 10.4, current_a: 18.0 }, [0.05, 0.02]);
        let warm = warm_battery(cold, resistances_ohm).unwrap();
        let open_v = |battery: BatteryReport, ohm: f64| battery.voltage_v + battery.current_a * ohm;
        assert!((warm.voltage_v * warm.current_a - 10.4 * 18.0).abs() < 1e-9, "{warm:?}");
        assert!((open_v(warm, 0.02) - open_v(cold, 0.05)).abs() < 1e-9 && warm.voltage_v > cold.voltage_v, "{warm:?}");
        let same = warm_battery(cold, [0.05, 0.05]).unwrap();
        assert!((same.voltage_v - 10.4).abs() < 1e-9 && (same.current_a - 18.0).abs() < 1e-9, "{same:?}");
    }
}
