//! Effects of the surrounding air on the rotors, beyond a thrust proportional to the square of the rotor speed. Each effect is off
//! unless the aircraft file switches it on.

use crate::math;

/// Air density at sea level, kg/m³ (ISA, 15 °C, 1013.25 hPa). Coefficients in vehicle files apply at this density.
pub const SEA_LEVEL_AIR_DENSITY_KG_M3: f64 = 1.225;
/// Decrease of the temperature with altitude divided by the temperature at sea level, 1/m (ISO 2533: 6.5 K/km, 288.15 K).
const LAPSE_PER_M: f64 = 2.255_77e-5;
/// Exponent of the density ratio in the troposphere (ISO 2533).
const DENSITY_EXPONENT: f64 = 4.255_88;
/// Lowest temperature ratio, so that the density stays positive at any altitude (about 44 km).
const MIN_TEMPERATURE_RATIO: f64 = 0.01;

/// Air density that acts on the aircraft.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AirDensity {
    /// The sea-level density everywhere.
    #[default]
    SeaLevel,
    /// The density of the standard atmosphere at the aircraft's altitude.
    Altitude,
}

impl AirDensity {
    /// Returns the density at an altitude above mean sea level, kg/m³.
    #[must_use]
    pub fn kg_m3(self, altitude_m: f64) -> f64 {
        match self {
            Self::SeaLevel => SEA_LEVEL_AIR_DENSITY_KG_M3,
            Self::Altitude => standard_density_kg_m3(altitude_m),
        }
    }
}

/// Returns the temperature of the standard atmosphere (ISO 2533) at an altitude in the troposphere, divided by the one at sea level.
#[must_use]
pub fn standard_temperature_ratio(altitude_m: f64) -> f64 {
    (1.0 - LAPSE_PER_M * altitude_m).max(MIN_TEMPERATURE_RATIO)
}

/// Returns the density of the standard atmosphere (ISO 2533) at an altitude in the troposphere, kg/m³.
#[must_use]
pub fn standard_density_kg_m3(altitude_m: f64) -> f64 {
    SEA_LEVEL_AIR_DENSITY_KG_M3 * math::pow(standard_temperature_ratio(altitude_m), DENSITY_EXPONENT)
}

/// Model of the thrust near surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SurfaceEffects {
    /// Each rotor alone: ground by Cheeseman and Bennett, ceiling by Hsiao and Chirarattananon.
    #[default]
    SingleRotor,
    /// All rotors together: ground by Sanchez-Cuevas et al. with the fountain flow between the rotors, ceiling by Jimenez-Cano et al.
    Multirotor,
}

/// Effects of the air on the rotors. The default has none of them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Aerodynamics {
    /// Inflow coefficient k_z: thrust that a rotor loses per rad/s of rotor speed and per m/s of climb through the air, N s²/m.
    pub inflow_coefficient_n_s2_m: f64,
    /// Translational lift k_h: thrust that a rotor gains per square of the airspeed in its disk plane, N s²/m².
    pub translational_lift_n_s2_m2: f64,
    /// Mean fraction of the thrust that a rotor loses at the center of the vortex ring state, 0 to 0.5.
    pub vortex_ring_loss: f64,
    /// Air density.
    pub air_density: AirDensity,
    /// Thrust near surfaces.
    pub surface_effects: SurfaceEffects,
    /// Force toward a wall that the rotor tips touch, as a fraction of the thrust, 0 to 0.3.
    pub wall_suction: f64,
    /// Mean fraction of the thrust that a rotor loses between three surfaces at close range, 0 to 0.3.
    pub recirculation_loss: f64,
}

/// Maximum thrust gained in translational lift, as a fraction of the thrust at the same rotor speed in still air (estimate: k_h was
/// identified at speeds up to about 5 m/s, and the gain ends when the rotor has lost most of its induced velocity).
pub const MAX_TRANSLATIONAL_LIFT: f64 = 0.25;
