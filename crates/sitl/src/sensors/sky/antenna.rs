//! Strength of a reflected signal relative to the direct one: reflection coefficients, roughness and the receiver's antenna.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::site::reflectors::{MirrorMaterial, Reflection, WAVELENGTH_M};

/// Relative permittivity of water at 1.6 GHz (ITU-R P.527: about 80 for fresh water).
const WATER_PERMITTIVITY: f64 = 80.0;
/// Relative permittivity of concrete (ITU-R P.2040, Table 3: 5.24).
const CONCRETE_PERMITTIVITY: f64 = 5.24;
/// Relative permittivity that stands for metal, which reflects everything.
const METAL_PERMITTIVITY: f64 = 1e6;
/// Standard deviation of the height of the lake's surface, m (estimate: small waves in a light wind).
const WAVE_HEIGHT_M: f64 = 0.02;
/// Gain of the antenna at the horizon and straight below, relative to the zenith, dB (estimate: patch antenna on a small ground plane).
const HORIZON_GAIN_DB: f64 = -10.0;
const NADIR_GAIN_DB: f64 = -18.0;
/// Additional loss of signals with the opposite polarization at the zenith, dB (estimate). At the horizon and below, there is none.
const CROSS_POLARIZATION_LOSS_DB: f64 = 10.0;
/// Carrier-to-noise density of a direct signal at the zenith, dB Hz (estimate).
const ZENITH_CN0_DB_HZ: f64 = 47.0;

/// Returns the gain relative to the zenith of a signal from a direction, dB.
fn gain_db(from: Vec3<Enu>) -> f64 {
    let up = from.up();
    if up >= 0.0 { HORIZON_GAIN_DB * (1.0 - up) } else { HORIZON_GAIN_DB - (NADIR_GAIN_DB - HORIZON_GAIN_DB) * up }
}

/// Returns the carrier-to-noise density of a direct signal, dB Hz.
pub(super) fn direct_cn0_db_hz(satellite: Vec3<Enu>) -> f64 {
    ZENITH_CN0_DB_HZ + gain_db(satellite)
}

/// Returns the amplitude of a reflected signal divided by that of the direct one.
pub(super) fn relative_amplitude(reflection: &Reflection, satellite: Vec3<Enu>) -> f64 {
    let arrival = satellite - reflection.normal * (2.0 * reflection.cos_incidence);
    let (same, opposite) = circular_coefficients(permittivity(reflection.material), reflection.cos_incidence);
    let gain = gain_db(arrival) - gain_db(satellite);
    let loss_db = CROSS_POLARIZATION_LOSS_DB * arrival.up().max(0.0);
    let received = same.abs() * ratio_from_db(gain) + opposite.abs() * ratio_from_db(gain - loss_db);
    received * reflection.zone_share * roughness(reflection)
}

fn permittivity(material: MirrorMaterial) -> f64 {
    match material {
        MirrorMaterial::Water => WATER_PERMITTIVITY,
        MirrorMaterial::Concrete => CONCRETE_PERMITTIVITY,
        MirrorMaterial::Steel => METAL_PERMITTIVITY,
    }
}

/// Returns the reflection coefficients for circular polarization that stays the same and that becomes the opposite: half the sum and
/// half the difference of Fresnel's coefficients (ITU-R P.680).
fn circular_coefficients(permittivity: f64, cos_incidence: f64) -> (f64, f64) {
    let root = (permittivity - 1.0 + cos_incidence * cos_incidence).sqrt();
    let horizontal = (cos_incidence - root) / (cos_incidence + root);
    let vertical = (permittivity * cos_incidence - root) / (permittivity * cos_incidence + root);
    (0.5 * (vertical + horizontal), 0.5 * (vertical - horizontal))
}

/// Returns the share of the amplitude that a surface with waves still reflects like a mirror (Ament, *Toward a Theory of Reflection by
/// a Rough Surface*, Proceedings of the IRE 41, 1953). Walls are smooth.
fn roughness(reflection: &Reflection) -> f64 {
    match reflection.material {
        MirrorMaterial::Water => {
            let phase = 2.0 * math::TAU * WAVE_HEIGHT_M * reflection.cos_incidence / WAVELENGTH_M;
            math::exp(-0.5 * phase * phase)
        }
        MirrorMaterial::Concrete | MirrorMaterial::Steel => 1.0,
    }
}

/// Returns a ratio of amplitudes from decibels.
pub(super) fn ratio_from_db(db: f64) -> f64 {
    math::pow(10.0, db / 20.0)
}

/// Returns decibels from a ratio of amplitudes.
pub(super) fn db_from_ratio(ratio: f64) -> f64 {
    20.0 * math::log10(ratio)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_reflection_swaps_the_polarization_head_on_and_keeps_it_at_grazing_angles() {
        // Head on, the coefficient is (1 - √ε) / (1 + √ε): 0.7997 for water.
        let (same, opposite) = circular_coefficients(WATER_PERMITTIVITY, 1.0);
        let expected = (80f64.sqrt() - 1.0) / (80f64.sqrt() + 1.0);
        assert!(same.abs() < 1e-12 && (opposite - expected).abs() < 1e-12, "{same} {opposite}");
        let (same, opposite) = circular_coefficients(CONCRETE_PERMITTIVITY, 0.0);
        assert_eq!((same, opposite), (-1.0, 0.0));
        let (same, opposite) = circular_coefficients(METAL_PERMITTIVITY, 0.7);
        // A permittivity of a million differs from a perfect conductor by a few thousandths.
        assert!(same.abs() < 5e-3 && (opposite - 1.0).abs() < 5e-3, "{same} {opposite}");
    }
}
