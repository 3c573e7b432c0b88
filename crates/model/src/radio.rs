//! Radio propagation and the links between the pilot and the aircraft, as formulas: free space, concrete (ITU-R P.2040), diffraction
//! at an edge (ITU-R P.526), and link budgets.

use super::math;

/// Speed of light, m/s (exact).
const LIGHT_M_S: f64 = 299_792_458.0;
/// Distance below which the loss in free space no longer falls, m: the antennas are then in each other's near field.
const MIN_DISTANCE_M: f64 = 1.0;
/// Relative permittivity of concrete, 1 to 100 GHz (ITU-R P.2040, table of material properties).
const CONCRETE_PERMITTIVITY: f64 = 5.24;
/// Conductivity of concrete at 1 GHz, S/m, and the exponent of the frequency in GHz (same source).
const CONCRETE_CONDUCTIVITY: (f64, f64) = (0.0462, 0.7822);
/// Attenuation rate of a dielectric in dB/m, times the square root of the permittivity, over the conductivity in S/m (ITU-R P.2040,
/// attenuation rate for small losses).
const ATTENUATION_FACTOR: f64 = 1636.0;
/// Diffraction parameter below which an edge has no effect (ITU-R P.526, single knife edge).
const MIN_DIFFRACTION_PARAMETER: f64 = -0.78;
/// Half the width of the margin over which a link degrades, dB: it is free of errors above it and dead below it (estimate: steps
/// between the codings of a digital link, blurred by fading).
pub const DEGRADATION_DB: f64 = 3.0;

/// Returns the wavelength, m.
#[must_use]
pub fn wavelength_m(frequency_ghz: f64) -> f64 {
    LIGHT_M_S / (frequency_ghz * 1e9)
}

/// Returns the loss in free space between isotropic antennas (Friis), dB.
#[must_use]
pub fn free_space_loss_db(distance_m: f64, frequency_ghz: f64) -> f64 {
    20.0 * math::log10(2.0 * math::TAU * distance_m.max(MIN_DISTANCE_M) / wavelength_m(frequency_ghz))
}

/// Returns the attenuation of concrete, dB/m.
#[must_use]
pub fn concrete_db_per_m(frequency_ghz: f64) -> f64 {
    let (at_1_ghz, exponent) = CONCRETE_CONDUCTIVITY;
    ATTENUATION_FACTOR * at_1_ghz * math::pow(frequency_ghz, exponent) / CONCRETE_PERMITTIVITY.sqrt()
}

/// Returns the loss by reflection at the two faces of a concrete member, at normal incidence and without multiple reflections, dB.
#[must_use]
pub fn concrete_faces_db() -> f64 {
    let index = CONCRETE_PERMITTIVITY.sqrt();
    let reflected = (index - 1.0) / (index + 1.0);
    -20.0 * math::log10(1.0 - reflected * reflected)
}

/// Returns the diffraction parameter ν of an edge at a height above the straight line between two antennas, m, at distances from
/// them, m (ITU-R P.526).
#[must_use]
pub fn diffraction_parameter(height_m: f64, (from_m, to_m): (f64, f64), frequency_ghz: f64) -> f64 {
    height_m * (2.0 / wavelength_m(frequency_ghz) * (1.0 / from_m + 1.0 / to_m)).sqrt()
}

/// Returns the loss J(ν) by diffraction at a knife edge, dB (ITU-R P.526, approximation for ν > -0.78; 0 below).
#[must_use]
pub fn knife_edge_loss_db(parameter: f64) -> f64 {
    if parameter <= MIN_DIFFRACTION_PARAMETER {
        return 0.0;
    }
    let beyond = parameter - 0.1;
    (6.9 + 20.0 * math::log10((beyond * beyond + 1.0).sqrt() + beyond)).max(0.0)
}

/// How a signal arrives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum RadioWay {
    /// In a straight line through air.
    LineOfSight,
    /// Around an edge.
    AroundEdge,
    /// Through concrete.
    ThroughConcrete,
    /// Not at all.
    Blocked,
}

/// A link between the pilot and the aircraft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinkBudget {
    /// Carrier frequency, GHz.
    pub frequency_ghz: f64,
    /// Radiated power in the antenna's main direction (EIRP), dBm.
    pub radiated_dbm: f64,
    /// Gain of the receiving antenna, dBi.
    pub antenna_dbi: f64,
    /// Received power at which half of the data arrives, dBm.
    pub sensitivity_dbm: f64,
}

/// Control and telemetry. The power is the limit of ETSI EN 300 328. Sensitivity (estimate): a spread-spectrum receiver of -104 dBm,
/// and 10 dB for interference and fading, as the band is in use everywhere.
pub const CONTROL: LinkBudget = LinkBudget { frequency_ghz: 2.4, radiated_dbm: 20.0, antenna_dbi: 2.0, sensitivity_dbm: -94.0 };
/// Video. The power is the limit of ETSI EN 300 440. Sensitivity (estimate): thermal noise in 10 MHz (-104 dBm), a noise figure of 6 dB
/// and the 10 dB that the coding of a high-definition picture needs.
pub const VIDEO: LinkBudget = LinkBudget { frequency_ghz: 5.8, radiated_dbm: 14.0, antenna_dbi: 2.0, sensitivity_dbm: -88.0 };

impl LinkBudget {
    /// Returns the received power for a loss between the antennas, dBm.
    #[must_use]
    pub fn received_dbm(&self, loss_db: f64) -> f64 {
        self.radiated_dbm + self.antenna_dbi - loss_db
    }

    /// Returns how much stronger the signal is than the sensitivity for a loss between the antennas, dB.
    #[must_use]
    pub fn margin_db(&self, loss_db: f64) -> f64 {
        self.received_dbm(loss_db) - self.sensitivity_dbm
    }
}

/// Returns the share of data that arrives at a margin in dB, 0 to 1: all of it from 3 dB, nothing from -3 dB.
#[must_use]
pub fn delivered_share(margin_db: f64) -> f64 {
    (0.5 + 0.5 * margin_db / DEGRADATION_DB).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of values computed by hand with six digits, dB.
    const ROUNDING_DB: f64 = 1e-3;

    #[test]
    fn exact_diffraction_loss_follows_the_published_approximation() {
        // J(0) = 6.9 + 20 lg(sqrt(1.01) - 0.1), J(1) = 6.9 + 20 lg(sqrt(1.81) + 0.9), J(5) = 6.9 + 20 lg(sqrt(25.01) + 4.9).
        for (parameter, loss_db) in [(0.0, 6.032_9), (1.0, 13.925_7), (5.0, 26.813_6), (-0.78, 0.0), (-2.0, 0.0)] {
            let found_db = knife_edge_loss_db(parameter);
            assert!((found_db - loss_db).abs() < ROUNDING_DB, "{parameter}: {found_db}");
        }
        // The approximation ends where the loss is nearly 0.
        assert!(knife_edge_loss_db(-0.779) < 0.05);
    }

    #[test]
    fn exact_concrete_attenuation_follows_the_published_formula() {
        // 1636 σ / sqrt(5.24), with σ = 0.0462 f^0.7822.
        for (frequency_ghz, db_per_m) in [(1.0, 33.018_7), (2.4, 65.487_9), (5.8, 130.590_9)] {
            let found = concrete_db_per_m(frequency_ghz);
            assert!((found - db_per_m).abs() < ROUNDING_DB, "{frequency_ghz} GHz: {found}");
        }
        assert!((concrete_faces_db() - 1.448_6).abs() < ROUNDING_DB, "{}", concrete_faces_db());
    }

    #[test]
    fn exact_loss_in_free_space_is_the_textbook_value() {
        // 32.45 + 20 lg(f / MHz) + 20 lg(d / km).
        for (distance_m, frequency_ghz) in [(100.0, 2.4), (100.0, 5.8), (1_500.0, 2.4)] {
            let textbook = 32.45 + 20.0 * math::log10(frequency_ghz * 1e3) + 20.0 * math::log10(distance_m / 1e3);
            assert!((free_space_loss_db(distance_m, frequency_ghz) - textbook).abs() < 0.01);
        }
        assert_eq!(free_space_loss_db(0.0, 2.4), free_space_loss_db(1.0, 2.4));
    }

    #[test]
    fn val_concrete_and_edges_attenuate_as_published() {
        // About 65 and 130 dB/m, and 23 and 27 dB behind an edge 3 m above the line of sight, 14 m from the aircraft, far from the pilot.
        assert!((concrete_db_per_m(CONTROL.frequency_ghz) - 65.0).abs() < 1.0);
        assert!((concrete_db_per_m(VIDEO.frequency_ghz) - 130.0).abs() < 1.0);
        let loss_db = |frequency_ghz| knife_edge_loss_db(diffraction_parameter(3.0, (1e6, 14.0), frequency_ghz));
        assert!((loss_db(CONTROL.frequency_ghz) - 23.0).abs() < 0.5, "{}", loss_db(CONTROL.frequency_ghz));
        assert!((loss_db(VIDEO.frequency_ghz) - 27.0).abs() < 0.5, "{}", loss_db(VIDEO.frequency_ghz));
    }

    #[test]
    fn prop_losses_grow_and_shares_fall_monotonically() {
        let is_increasing = |values: Vec<f64>| values.windows(2).all(|pair| pair[0] <= pair[1]);
        let steps = || (0..400).map(f64::from);
        assert!(is_increasing(steps().map(|k| knife_edge_loss_db(-2.0 + 0.05 * k)).collect()));
        assert!(is_increasing(steps().map(|k| free_space_loss_db(5.0 * k, 2.4)).collect()));
        assert!(is_increasing(steps().map(|k| concrete_db_per_m(1.0 + 0.1 * k)).collect()));
        assert!(is_increasing(steps().map(|k| delivered_share(-20.0 + 0.1 * k)).collect()));
        assert_eq!([-3.0, 0.0, 3.0].map(delivered_share), [0.0, 0.5, 1.0]);
    }

    #[test]
    fn prop_video_has_less_margin_than_control_at_every_distance() {
        for k in 1..400 {
            let margin = |link: &LinkBudget| link.margin_db(free_space_loss_db(5.0 * f64::from(k), link.frequency_ghz));
            assert!(margin(&CONTROL) > margin(&VIDEO) + 10.0);
        }
    }
}
