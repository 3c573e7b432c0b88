//! The battery in the cold.

use super::BatterySpec;
use crate::math;

/// Temperature for which aircraft files state the battery's resistance, °C (estimate: data sheets use 20 to 25 °C).
pub const BATTERY_REFERENCE_C: f64 = 25.0;
/// Activation energy of the battery's conduction, relative to Boltzmann's constant, K.
const ACTIVATION_K: f64 = 3131.0;
/// Temperature of 0 °C, K.
const ZERO_CELSIUS_K: f64 = 273.15;

impl BatterySpec {
    /// Returns the internal resistance of the pack at a temperature, °C, in ohm. It grows with cold by an Arrhenius law,
    /// R = 1.1e-6 exp(3131 K / T) (measured with packs of two lithium polymer cells), and so the voltage sags.
    #[must_use]
    pub fn resistance_ohm(&self, temperature_c: f64) -> f64 {
        let kelvin = |celsius: f64| celsius + ZERO_CELSIUS_K;
        self.internal_resistance_ohm * math::exp(ACTIVATION_K * (1.0 / kelvin(temperature_c) - 1.0 / kelvin(BATTERY_REFERENCE_C)))
    }
}
