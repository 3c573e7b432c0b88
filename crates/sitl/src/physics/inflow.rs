//! Thrust of a rotor that moves through the air: inflow along its axis and translational lift in its disk plane.
//!
//! Both are the linear models that RotorPy and Svacha et al. (*Improving Quadrotor Trajectory Tracking by Compensating for Aerodynamic
//! Effects*, ICUAS 2017) use. They hold for small changes around hover, so the changes of the thrust are limited.

use spandrel_model::frames::{Frd, Vec3};
use spandrel_model::vehicle::{Aerodynamics, MAX_TRANSLATIONAL_LIFT};

/// Maximum change of the thrust by inflow along the axis, as a fraction of the thrust at the same rotor speed in still air
/// (estimate: at that change the blades' mean angle of attack is zero or twice the one in hover, where the linear model ends).
const MAX_INFLOW_CHANGE: f64 = 1.0;

/// Coefficients of the thrust of a moving rotor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inflow {
    axial_n_s2_m: f64,
    edgewise_n_s2_m2: f64,
}

impl Inflow {
    /// Returns `None` if the thrust does not depend on the motion.
    #[must_use]
    pub fn of(air: &Aerodynamics) -> Option<Self> {
        let (axial_n_s2_m, edgewise_n_s2_m2) = (air.inflow_coefficient_n_s2_m, air.translational_lift_n_s2_m2);
        (axial_n_s2_m > 0.0 || edgewise_n_s2_m2 > 0.0).then_some(Self { axial_n_s2_m, edgewise_n_s2_m2 })
    }

    /// Returns the change of a rotor's thrust by its motion, N. `static_n` is the thrust at the same rotor speed in still air.
    #[must_use]
    pub fn change_n(&self, hub_air_m_s: Vec3<Frd>, speed_rad_s: f64, static_n: f64) -> f64 {
        // A climb through the air is a negative velocity along the body's down axis.
        let axial_n = self.axial_n_s2_m * speed_rad_s * hub_air_m_s.down();
        let (forward, right) = (hub_air_m_s.forward(), hub_air_m_s.right());
        let edgewise_n = self.edgewise_n_s2_m2 * (forward * forward + right * right);
        let most_n = MAX_INFLOW_CHANGE * static_n;
        axial_n.max(-most_n).min(most_n) + edgewise_n.min(MAX_TRANSLATIONAL_LIFT * static_n)
    }
}
