//! Vortex ring state: in a descent about as fast as its own downwash, a rotor draws in the air that it has just pushed down, loses
//! thrust and shakes.
//!
//! The region follows the stability boundary of Johnson (*Model for Vortex Ring State Influence on Rotorcraft Flight Dynamics*,
//! NASA/TP-2005-213477) and Chen: descents of 0.5 to 1.5 times the induced velocity in hover, at airspeeds in the disk plane below
//! 0.95 times the induced velocity. The loss is greatest in the middle and ends smoothly at the boundary. Johnson models the loss as
//! a change of the mean inflow; here it is a fraction of the thrust, and its size is a key of the vehicle file.

use super::recirculation::HoverDisk;
use nalgebra::Vector2;
use spandrel_model::math::{self, PI};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;

/// Slowest and fastest descent with a loss, relative to the induced velocity in hover (Johnson's boundary, rounded).
const DESCENT_RATIOS: [f64; 2] = [0.5, 1.5];
/// Airspeed in the disk plane from which the wake is blown away, relative to the induced velocity in hover (Johnson's boundary).
const EDGEWISE_RATIO: f64 = 0.95;
/// Constants of the vortex ring state of one aircraft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VortexRing {
    loss: f64,
    disk: HoverDisk,
}

impl VortexRing {
    /// Returns `None` if the vehicle file does not switch the effect on.
    #[must_use]
    pub fn of(vehicle: &Vehicle) -> Option<Self> {
        let loss = vehicle.aerodynamics.vortex_ring_loss;
        (loss > 0.0).then(|| Self { loss, disk: HoverDisk::of(vehicle) })
    }

    /// Returns the induced velocity in hover, m/s.
    #[must_use]
    pub fn induced_velocity_m_s(&self, density_kg_m3: f64) -> f64 {
        self.disk.induced_velocity_m_s(density_kg_m3)
    }

    /// Returns the thrust factor of a rotor that descends through the air at `descent_m_s` along its axis and moves at
    /// `edgewise_m_s` in its disk plane.
    #[must_use]
    pub fn factor(&self, rotor: usize, descent_m_s: f64, edgewise_m_s: Vector2<f64>, density_kg_m3: f64, now: SimTime) -> f64 {
        let induced_m_s = self.induced_velocity_m_s(density_kg_m3);
        let depth = depth(descent_m_s / induced_m_s, edgewise_m_s.norm() / induced_m_s);
        if depth <= 0.0 {
            return 1.0;
        }
        1.0 - self.loss * depth * self.disk.fluctuation(rotor, induced_m_s, now)
    }
}

/// Returns how deep a rotor is in the vortex ring state: 1 in the middle, 0 at the boundary and outside, with a continuous slope.
#[must_use]
pub fn depth(descent_ratio: f64, edgewise_ratio: f64) -> f64 {
    let [slow, fast] = DESCENT_RATIOS;
    if !(slow..=fast).contains(&descent_ratio) || edgewise_ratio.abs() >= EDGEWISE_RATIO {
        return 0.0;
    }
    let across = math::sin(PI * (descent_ratio - slow) / (fast - slow));
    let along = 1.0 - (edgewise_ratio / EDGEWISE_RATIO) * (edgewise_ratio / EDGEWISE_RATIO);
    (across * along) * (across * along)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::testing::vehicle_with;
    use crate::physics::recirculation::FREQUENCY_RADIUS_RATIO;
    use crate::sensors::tests::error_free_sensors;
    use spandrel_model::math::GRAVITY_M_S2;
    use spandrel_model::vehicle::SEA_LEVEL_AIR_DENSITY_KG_M3;

    /// Rounding tolerance.
    const TOLERANCE: f64 = 1e-12;

    fn ring(loss: f64) -> VortexRing {
        let mut vehicle = vehicle_with(error_free_sensors());
        vehicle.aerodynamics.vortex_ring_loss = loss;
        VortexRing::of(&vehicle).unwrap()
    }

    #[test]
    fn exact_effect_is_off_without_its_key() {
        assert_eq!(VortexRing::of(&vehicle_with(error_free_sensors())), None);
    }

    #[test]
    fn exact_induced_velocity_follows_from_momentum_theory() {
        // 1.3 kg on four rotors with a radius of 0.12 m.
        let expected = (1.3 * GRAVITY_M_S2 / 4.0 / (2.0 * SEA_LEVEL_AIR_DENSITY_KG_M3 * PI * 0.12 * 0.12)).sqrt();
        assert!((ring(0.2).induced_velocity_m_s(SEA_LEVEL_AIR_DENSITY_KG_M3) - expected).abs() < TOLERANCE);
    }

    #[test]
    fn exact_loss_is_greatest_at_the_induced_velocity_and_ends_at_the_boundary() {
        assert!((depth(1.0, 0.0) - 1.0).abs() < TOLERANCE);
        for (descent, edgewise) in [(0.5, 0.0), (1.5, 0.0), (1.0, 0.95), (0.0, 0.0), (-1.0, 0.0), (2.0, 0.0), (1.0, 3.0)] {
            assert!(depth(descent, edgewise).abs() < TOLERANCE, "{descent} {edgewise}");
        }
        assert!((depth(0.75, 0.0) - 0.5).abs() < TOLERANCE && (depth(1.25, 0.0) - 0.5).abs() < TOLERANCE);
    }

    #[test]
    fn exact_mean_loss_over_one_period_is_the_key() {
        const SAMPLES: i64 = 1000;
        let ring = ring(0.2);
        let induced_m_s = ring.induced_velocity_m_s(SEA_LEVEL_AIR_DENSITY_KG_M3);
        let period_s = 0.12 / (FREQUENCY_RADIUS_RATIO * induced_m_s);
        let at = |k: i64| SimTime::from_s(period_s * k as f64 / SAMPLES as f64);
        let factors = (0..SAMPLES).map(|k| ring.factor(1, induced_m_s, Vector2::zeros(), SEA_LEVEL_AIR_DENSITY_KG_M3, at(k)));
        let mean = factors.sum::<f64>() / SAMPLES as f64;
        // The times are rounded to nanoseconds.
        assert!((mean - 0.8).abs() < 1e-6, "{mean}");
    }

    #[test]
    fn prop_factor_is_bounded_smooth_and_repeatable() {
        // Largest change of the factor between two descents that differ by 1 mm/s.
        const MAX_STEP: f64 = 1e-3;
        let ring = ring(0.5);
        let edgewise = [0.0, 1.0, 4.0, 5.0, 50.0, 1e300].map(|m_s| Vector2::new(m_s, 0.0));
        for edgewise_m_s in edgewise {
            let mut before = 1.0;
            for k in -5_000..20_000 {
                let descent_m_s = 1e-3 * f64::from(k);
                let factor = || ring.factor(2, descent_m_s, edgewise_m_s, SEA_LEVEL_AIR_DENSITY_KG_M3, SimTime::from_ms(1234));
                assert!((0.25..=1.0).contains(&factor()), "{descent_m_s}: {}", factor());
                assert!((factor() - before).abs() < MAX_STEP, "{descent_m_s}");
                assert_eq!(factor().to_bits(), factor().to_bits());
                before = factor();
            }
        }
        for descent_m_s in [1e300, -1e300, f64::MAX] {
            assert_eq!(ring.factor(0, descent_m_s, Vector2::zeros(), SEA_LEVEL_AIR_DENSITY_KG_M3, SimTime::ZERO), 1.0);
        }
    }
}
