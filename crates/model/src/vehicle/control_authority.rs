//! Checks that the rotor layout can keep an aircraft in the air and rotate it about every axis.

use super::{Rotor, RotorModel};
use crate::math::{self, GRAVITY_M_S2};
use nalgebra::{DMatrix, DVector};

/// Minimum ratio of the smallest to the largest singular value of the matrix that maps rotor thrusts to lift and moments (roll
/// and pitch arms relative to the longest arm, yaw per unit of spin) for control authority (estimate; a square quadrotor has
/// 0.7).
const MIN_SINGULAR_VALUE_RATIO: f64 = 0.05;

/// Returns the first requirement that the rotor layout does not meet; `None` if it meets all of them.
#[must_use]
pub fn unmet_requirement(rotors: &[Rotor], model: &RotorModel, mass_kg: f64) -> Option<&'static str> {
    let arm_m = rotors.iter().map(|rotor| math::hypot(rotor.position_m.forward(), rotor.position_m.right())).fold(0.0, f64::max);
    if rotors.len() < 4 || arm_m <= 0.0 {
        return Some("at least four rotors, not all at the center of mass");
    }
    let entry = |row: usize, column: usize| match (row, &rotors[column]) {
        (0, _) => 1.0,
        (1, rotor) => -rotor.position_m.right() / arm_m,
        (2, rotor) => rotor.position_m.forward() / arm_m,
        (_, rotor) => -rotor.spin,
    };
    let map = DMatrix::from_fn(4, rotors.len(), entry).svd(true, true);
    if map.singular_values.min() < MIN_SINGULAR_VALUE_RATIO * map.singular_values.max() {
        return Some("rotors that are not all in one line and that spin in both directions");
    }
    let weight = DVector::from_vec(vec![mass_kg * GRAVITY_M_S2, 0.0, 0.0, 0.0]);
    let most_n = model.thrust_coefficient_n_s2 * model.max_speed_rad_s * model.max_speed_rad_s;
    let hover = map.solve(&weight, 0.0).ok()?;
    let holds = hover.iter().all(|thrust_n| (0.0..=most_n).contains(thrust_n));
    (!holds).then_some("rotors placed around the center of mass so that each stays within its thrust range in level hover")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Vec3;

    const MODEL: RotorModel = RotorModel {
        radius_m: 0.12,
        thrust_coefficient_n_s2: 1e-5,
        torque_coefficient_n_m_s2: 1e-7,
        time_constant_s: 0.05,
        max_speed_rad_s: 900.0,
        idle_speed_rad_s: 100.0,
        speed_spread: 0.0,
        inertia_kg_m2: 0.0,
        drag_coefficient_n_s2_m: 0.0,
        efficiency: 0.6,
    };

    fn rotors(places: &[(f64, f64, f64)]) -> Vec<Rotor> {
        places.iter().map(|(x, y, spin)| Rotor { position_m: Vec3::new(*x, *y, 0.0), spin: *spin }).collect()
    }

    #[test]
    fn exact_quad_and_hexarotor_have_control_authority() {
        assert_eq!(
            unmet_requirement(&rotors(&[(0.2, 0.2, 1.0), (-0.2, -0.2, 1.0), (0.2, -0.2, -1.0), (-0.2, 0.2, -1.0)]), &MODEL, 1.2),
            None
        );
        let hexagon: Vec<(f64, f64, f64)> = (0..6)
            .map(|k| {
                let (sine, cosine) = crate::math::sin_cos(f64::from(k) * crate::math::PI / 3.0);
                (0.3 * cosine, 0.3 * sine, if k % 2 == 0 { 1.0 } else { -1.0 })
            })
            .collect();
        assert_eq!(unmet_requirement(&rotors(&hexagon), &MODEL, 1.2), None);
    }

    #[test]
    fn exact_deficient_rotor_layouts_have_no_control_authority() {
        assert!(unmet_requirement(&rotors(&[(0.2, 0.2, 1.0), (-0.2, 0.0, -1.0), (0.2, -0.2, -1.0)]), &MODEL, 1.2).is_some());
        assert!(
            unmet_requirement(&rotors(&[(0.3, 0.0, 1.0), (0.1, 0.0, -1.0), (-0.1, 0.0, 1.0), (-0.3, 0.0, -1.0)]), &MODEL, 1.2)
                .is_some()
        );
        assert!(
            unmet_requirement(&rotors(&[(0.2, 0.2, 1.0), (-0.2, -0.2, 1.0), (0.2, -0.2, 1.0), (-0.2, 0.2, 1.0)]), &MODEL, 1.2)
                .is_some()
        );
        let aside = [(0.5, 0.2, 1.0), (0.1, -0.2, 1.0), (0.5, -0.2, -1.0), (0.1, 0.2, -1.0)];
        assert!(unmet_requirement(&rotors(&aside), &MODEL, 1.2).is_some());
    }
}
