//! Thrust of a rotor that moves through the air: inflow along its axis and translational lift in its disk plane.
//!
//! Both are the linear models that RotorPy and Svacha et al. (*Improving Quadrotor Trajectory Tracking by Compensating for Aerodynamic
//! Effects*, ICUAS 2017) use. They hold for small changes around hover, so the changes of the thrust are limited.

use spandrel_model::vehicle::{Aerodynamics, MAX_TRANSLATIONAL_LIFT};

/// Maximum change of the thrust by inflow along the axis, as a fraction of the thrust at the same rotor speed in still air
/// (estimate: at that change the blades' mean angle of attack is zero or twice the one in hover, where the linear model ends).
const MAX_INFLOW_CHANGE: f64 = 1.0;

/// Coefficients of the thrust of a moving rotor. Without the keys in the vehicle file they are zero, and the thrust does not depend on
/// the motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inflow {
    axial_n_s2_m: f64,
    edgewise_n_s2_m2: f64,
}

impl Inflow {
    /// Returns the coefficients of an aircraft.
    #[must_use]
    pub fn of(air: &Aerodynamics) -> Self {
        Self { axial_n_s2_m: air.inflow_coefficient_n_s2_m, edgewise_n_s2_m2: air.translational_lift_n_s2_m2 }
    }

    /// Returns the thrust along the axis per rotor speed and velocity, N s²/m.
    #[inline]
    pub(super) fn axial_n_s2_m(&self) -> f64 {
        self.axial_n_s2_m
    }

    /// Returns the thrust per squared velocity in the disk plane, N s²/m².
    #[inline]
    pub(super) fn edgewise_n_s2_m2(&self) -> f64 {
        self.edgewise_n_s2_m2
    }

    /// Returns the largest changes by inflow and by translational lift, as fractions of the thrust in still air.
    #[inline]
    pub(super) fn limits(&self) -> [f64; 2] {
        [MAX_INFLOW_CHANGE, MAX_TRANSLATIONAL_LIFT]
    }
}
