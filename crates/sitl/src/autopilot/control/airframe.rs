//! Aircraft properties other than the control gains.

use spandrel_model::scenario::{BatteryModel, SessionRules};
use spandrel_model::vehicle::{FlightLimits, Vehicle};

/// The aircraft's mass, limits, battery and landing gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Airframe {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Flight limits.
    pub limits: FlightLimits,
    /// Battery voltage at full charge, V.
    pub full_battery_v: f64,
    /// Whether voltage sag affects the motors.
    pub models_voltage_sag: bool,
    /// Height of the center of mass above the ground when the vehicle stands on its landing gear, m.
    pub resting_height_m: f64,
}

impl Airframe {
    /// Returns the aircraft's properties under the session's rules.
    #[must_use]
    pub fn new(vehicle: &Vehicle, rules: &SessionRules) -> Self {
        let battery = &vehicle.battery;
        Self {
            mass_kg: vehicle.mass_kg,
            limits: vehicle.limits,
            full_battery_v: f64::from(battery.cells) * battery.ocv_cell_v[10],
            models_voltage_sag: rules.battery == BatteryModel::Physical,
            resting_height_m: vehicle.hull.feet_m.iter().map(|f| f.down()).fold(vehicle.hull.body_half_extent_m[2], f64::max),
        }
    }
}
