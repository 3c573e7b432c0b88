//! Position and velocity errors that follow from the errors of the pseudoranges: weighted least squares.

use crate::sensors::dilution::geometry_row;
use nalgebra::{Matrix4, Vector4};
use spandrel_model::frames::{Enu, Ned, Vec3};

/// One satellite's contribution to the solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Observation {
    /// Unit vector to the satellite.
    pub(super) satellite: Vec3<Enu>,
    /// Standard deviation that the receiver assumes, m. It determines the weight.
    pub(super) sigma_m: f64,
    /// Error of the pseudorange, m.
    pub(super) range_error_m: f64,
    /// Error of its rate, m/s.
    pub(super) rate_error_m_s: f64,
}

/// Errors of a fix, and what the receiver knows about them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Solution {
    /// Error of the position, m.
    pub(super) position_m: Vec3<Ned>,
    /// Error of the velocity, m/s.
    pub(super) velocity_m_s: Vec3<Ned>,
    /// Estimated standard deviation per horizontal axis, m.
    pub(super) horizontal_m: f64,
    /// Estimated standard deviation of the height, m.
    pub(super) vertical_m: f64,
}

/// Solves for the errors. The standard deviations follow from the assumed ones and, if the residuals are larger than assumed, from
/// the residuals. Returns `None` with fewer than four satellites or a degenerate geometry.
pub(super) fn solve(observations: &[Observation]) -> Option<Solution> {
    if observations.len() < 4 {
        return None;
    }
    let normal = observations.iter().fold(Matrix4::zeros(), |sum, one| {
        let row = geometry_row(one.satellite) / one.sigma_m;
        sum + row * row.transpose()
    });
    let covariance = normal.try_inverse().filter(|inverse| (0..3).all(|axis| inverse[(axis, axis)] > 0.0))?;
    let project = |error: &dyn Fn(&Observation) -> f64| covariance * weighted_sum(observations, error);
    let (position, velocity) = (project(&|one| one.range_error_m), project(&|one| one.rate_error_m_s));
    let factor = residual_factor(observations, &position);
    Some(Solution {
        position_m: ned(&position),
        velocity_m_s: ned(&velocity),
        horizontal_m: factor * (0.5 * (covariance[(0, 0)] + covariance[(1, 1)])).sqrt(),
        vertical_m: factor * covariance[(2, 2)].sqrt(),
    })
}

fn weighted_sum(observations: &[Observation], error: &dyn Fn(&Observation) -> f64) -> Vector4<f64> {
    observations
        .iter()
        .fold(Vector4::zeros(), |sum, one| sum + geometry_row(one.satellite) * (error(one) / (one.sigma_m * one.sigma_m)))
}

/// Returns by how much the residuals exceed the assumed standard deviations; at least 1.
fn residual_factor(observations: &[Observation], position: &Vector4<f64>) -> f64 {
    let redundant = observations.len().saturating_sub(4);
    if redundant == 0 {
        return 1.0;
    }
    let residual = |one: &Observation| (one.range_error_m - geometry_row(one.satellite).dot(position)) / one.sigma_m;
    let squares: f64 = observations.iter().map(residual).map(|r| r * r).sum();
    (squares / redundant as f64).sqrt().max(1.0)
}

/// FRAME: the first three unknowns are east, north and up.
fn ned(unknowns: &Vector4<f64>) -> Vec3<Ned> {
    Vec3::<Enu>::new(unknowns[0], unknowns[1], unknowns[2]).ned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::math;

    /// Rounding of the inverse of a well-conditioned 4 by 4 matrix, m.
    const ROUNDING_M: f64 = 1e-9;

    fn sky() -> Vec<Vec3<Enu>> {
        let low = (0..5).map(|k| (f64::from(k) * math::TAU / 5.0, 0.3));
        low.chain([(0.4, 1.0), (3.0, 1.2)])
            .map(|(azimuth, elevation)| {
                let ((s, c), (up, flat)) = (math::sin_cos(azimuth), math::sin_cos(elevation));
                Vec3::new(flat * s, flat * c, up)
            })
            .collect()
    }

    fn observations(error: impl Fn(usize, Vec3<Enu>) -> f64) -> Vec<Observation> {
        let of = |(k, satellite): (usize, Vec3<Enu>)| Observation {
            satellite,
            sigma_m: 1.0 + 0.3 * k as f64,
            range_error_m: error(k, satellite),
            rate_error_m_s: 0.1 * error(k, satellite),
        };
        sky().into_iter().enumerate().map(of).collect()
    }

    #[test]
    fn exact_ranges_of_a_displaced_receiver_give_the_displacement_and_a_common_delay_gives_none() {
        let shift = Vec3::<Enu>::new(3.0, -2.0, 5.0);
        let found = solve(&observations(|_, satellite| 7.0 - satellite.dot(shift))).expect("seven satellites");
        assert!((found.position_m.enu() - shift).norm() < ROUNDING_M, "{found:?}");
        assert!((found.velocity_m_s.enu() - shift * 0.1).norm() < ROUNDING_M, "{found:?}");
    }

    #[test]
    fn exact_late_signal_of_one_satellite_moves_the_fix_as_least_squares_do() {
        // Four satellites: one at the zenith, three on the horizon. A delay b of the zenith's signal moves the height by -b
        // (one height, three clocks) and nothing else.
        let third = math::TAU / 3.0;
        let mut all: Vec<Observation> = (0..3)
            .map(|k| Vec3::new(math::sin(third * f64::from(k)), math::cos(third * f64::from(k)), 0.0))
            .map(|satellite| Observation { satellite, sigma_m: 1.0, range_error_m: 0.0, rate_error_m_s: 0.0 })
            .collect();
        all.push(Observation { satellite: Vec3::new(0.0, 0.0, 1.0), sigma_m: 3.0, range_error_m: 12.0, rate_error_m_s: 0.0 });
        let found = solve(&all).expect("four satellites");
        assert!((found.position_m - Vec3::new(0.0, 0.0, 12.0)).norm() < ROUNDING_M, "{found:?}");
        // The height's variance is the zenith's, 9, plus that of the mean of the three clocks, 1/3.
        assert!((found.vertical_m - (9.0_f64 + 1.0 / 3.0).sqrt()).abs() < ROUNDING_M, "{found:?}");
        assert_eq!(solve(&all[..3]), None);
    }

    #[test]
    fn exact_contradicting_ranges_raise_the_estimated_error() {
        let calm = solve(&observations(|_, _| 0.0)).expect("seven satellites");
        let wrong = solve(&observations(|k, _| if k == 0 { 30.0 } else { 0.0 })).expect("seven satellites");
        assert!(wrong.horizontal_m > 2.0 * calm.horizontal_m, "{calm:?} {wrong:?}");
        assert!((wrong.vertical_m / wrong.horizontal_m - calm.vertical_m / calm.horizontal_m).abs() < ROUNDING_M);
    }
}
