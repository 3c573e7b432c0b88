//! Air density compared with the published standard atmosphere.

use spandrel_model::vehicle::standard_density_kg_m3;

#[test]
fn val_density_matches_the_standard_atmosphere() {
    // ISO 2533 at geopotential altitudes, kg/m³; tolerance for four published decimals.
    const TOLERANCE_KG_M3: f64 = 1e-4;
    for (altitude_m, expected) in [(0.0, 1.2250), (500.0, 1.1673), (1000.0, 1.1116), (2000.0, 1.0065), (5000.0, 0.7361)] {
        let got = standard_density_kg_m3(altitude_m);
        assert!((got - expected).abs() < TOLERANCE_KG_M3, "{altitude_m} m: {got}");
    }
}

#[test]
fn prop_density_is_positive_at_any_altitude() {
    for altitude_m in [-1e9, -400.0, 20_000.0, 1e9] {
        let got = standard_density_kg_m3(altitude_m);
        assert!(got.is_finite() && got > 0.0, "{altitude_m} m: {got}");
    }
}
