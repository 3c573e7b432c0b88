//! Error of a pseudorange if a direct and a reflected signal arrive together.

use spandrel_model::math;
use spandrel_model::site::reflectors::WAVELENGTH_M;

/// Length of a chip of the C/A code, m (IS-GPS-200: 1.023 MHz). Galileo's signal gets the same envelope (estimate).
const CHIP_M: f64 = 293.052;
/// Spacing between the early and the late correlator, chips (van Dierendonck, Fenton and Ford, *Theory and Performance of Narrow
/// Correlator Spacing in a GPS Receiver*, NAVIGATION 39, 1992).
const CORRELATOR_SPACING_CHIPS: f64 = 0.1;
/// Largest relative amplitude: a reflection is weaker than the direct signal.
const MAX_AMPLITUDE: f64 = 0.95;

/// Returns the error, m, that a reflection with this relative amplitude and extra path causes. This is the envelope of an
/// early-minus-late loop (Braasch, in *Global Positioning System: Theory and Applications*, 1996) at the phase of the carrier:
/// proportional to the extra path up to the spacing of the correlators, then constant.
pub(super) fn error_m(amplitude: f64, extra_path_m: f64) -> f64 {
    let spacing_m = CORRELATOR_SPACING_CHIPS * CHIP_M;
    if extra_path_m >= CHIP_M + 0.5 * spacing_m {
        return 0.0;
    }
    let in_phase = amplitude.min(MAX_AMPLITUDE) * math::cos(math::TAU * extra_path_m / WAVELENGTH_M);
    let proportional_m = extra_path_m * in_phase / (1.0 + in_phase);
    let constant_m = 0.5 * spacing_m * in_phase;
    if proportional_m.abs() < constant_m.abs() { proportional_m } else { constant_m }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_envelope_grows_with_the_extra_path_then_stays_and_ends_after_a_chip() {
        // At a whole number of wavelengths, the signals are in phase; half a wavelength later, they are opposed.
        let whole = |count: f64| count * WAVELENGTH_M;
        let near_m = whole(20.0);
        assert!((error_m(0.25, near_m) - near_m * 0.25 / 1.25).abs() < 1e-9, "{}", error_m(0.25, near_m));
        let opposed_m = near_m + 0.5 * WAVELENGTH_M;
        assert!((error_m(0.25, opposed_m) + opposed_m * 0.25 / 0.75).abs() < 1e-9, "{}", error_m(0.25, opposed_m));
        // 0.25 of half a spacing of 29.3 m.
        assert!((error_m(0.25, whole(500.0)) - 3.663).abs() < 1e-3, "{}", error_m(0.25, whole(500.0)));
        assert_eq!(error_m(0.25, 310.0), 0.0);
    }
}
