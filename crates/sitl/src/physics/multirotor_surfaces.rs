//! Surface effects of all rotors together.
//!
//! Ground: Sanchez-Cuevas, Heredia and Ollero (*Characterization of the Aerodynamic Ground Effect and Its Influence in Multirotor
//! Control*, International Journal of Aerospace Engineering, 2017). The mirror images of the other rotors and the fountain flow between
//! the rotors add to the rotor's own image. Their formula is for four rotors over a plane. Here each rotor contributes its own image,
//! so that it also holds for other layouts and over an edge; for four rotors over a plane, the sum is their formula.
//!
//! Ceiling: the fit of Jimenez-Cano et al. (*Contact-Based Bridge Inspection Multirotors: Design, Modeling, and Control Considering the
//! Ceiling Effect*, IEEE Robotics and Automation Letters 4, 2019).

use super::state::MAX_ROTORS;
use nalgebra::Vector2;

/// Range of the effects in rotor radii. Without the fade, the factor of four rotors would still be 1.03 at 5 radii.
pub const RANGE_ROTOR_RADII: f64 = 10.0;
/// Distance in rotor radii from which the effect of the ground fades out linearly to zero at the end of the range (estimate).
const FADE_ROTOR_RADII: f64 = 5.0;
/// Distance in rotor radii below which both effects stay constant (the lower end of the published measurements on the ground).
const MIN_ROTOR_RADII: f64 = 0.5;
/// Coefficient K_b of the fountain flow (Sanchez-Cuevas).
const FOUNTAIN: f64 = 2.0;
/// Maximum of both factors (estimate; it matters only for rotors that overlap, and for a large rotor close to a ceiling).
const MAX_FACTOR: f64 = 2.0;
/// Coefficients K_1 and K_2 of the ceiling effect (Jimenez-Cano); K_2 in meters.
const CEILING: (f64, f64) = (6.924, 0.0378);

/// Hubs of the rotors in the disk plane, and their radius.
#[derive(Debug, Clone, PartialEq)]
pub struct RotorLayout {
    /// Hub positions, m.
    pub hubs_m: Vec<Vector2<f64>>,
    /// Rotor radius, m.
    pub radius_m: f64,
}

impl RotorLayout {
    /// Returns the diagonal of the layout: the largest distance between two hubs, m.
    fn diagonal_m(&self) -> f64 {
        let from = |a: &Vector2<f64>| self.hubs_m.iter().map(|b| (a - b).norm()).fold(0.0, f64::max);
        self.hubs_m.iter().map(from).fold(0.0, f64::max)
    }

    /// Returns the thrust factor of each rotor over ground at these distances below the hubs, m; `None` if there is no ground.
    #[must_use]
    pub fn ground_factors(&self, heights_m: &[Option<f64>; MAX_ROTORS]) -> [f64; MAX_ROTORS] {
        let mut out = [1.0; MAX_ROTORS];
        let over_ground = heights_m.iter().take(self.hubs_m.len()).flatten().count();
        let share = over_ground as f64 / self.hubs_m.len().max(1) as f64;
        let diagonal_m = self.diagonal_m();
        for (i, factor) in out.iter_mut().enumerate().take(self.hubs_m.len()) {
            let Some(height_m) = heights_m[i] else { continue };
            let z_m = height_m.max(MIN_ROTOR_RADII * self.radius_m);
            let fountain = 2.0 * FOUNTAIN * share * self.image(z_m, diagonal_m);
            let sum = self.own_image(z_m) + self.other_images(i, heights_m) + fountain;
            *factor = 1.0 / (1.0 - sum * fade(z_m / self.radius_m)).max(1.0 / MAX_FACTOR);
        }
        out
    }

    /// Term of the rotor's own image: Cheeseman and Bennett.
    fn own_image(&self, z_m: f64) -> f64 {
        let ratio = self.radius_m / (4.0 * z_m);
        ratio * ratio
    }

    /// Sum of the terms of the other rotors' images.
    fn other_images(&self, index: usize, heights_m: &[Option<f64>; MAX_ROTORS]) -> f64 {
        let others = self.hubs_m.iter().zip(heights_m).enumerate().filter(|(j, _)| *j != index);
        let term = |(_, (hub, height)): (usize, (&Vector2<f64>, &Option<f64>))| {
            let z_m = (*height)?.max(MIN_ROTOR_RADII * self.radius_m);
            Some(0.5 * self.image(z_m, (hub - self.hubs_m[index]).norm()))
        };
        others.filter_map(term).sum()
    }

    /// R² z / (distance² + 4 z²)^(3/2).
    fn image(&self, z_m: f64, distance_m: f64) -> f64 {
        let squared = distance_m * distance_m + 4.0 * z_m * z_m;
        self.radius_m * self.radius_m * z_m / (squared * squared.sqrt())
    }

    /// Returns the thrust factor of a rotor below a ceiling at a distance above the hub, m.
    #[must_use]
    pub fn ceiling_factor(&self, distance_m: f64) -> f64 {
        let (k_1, k_2_m) = CEILING;
        let ratio = self.radius_m / (distance_m.max(MIN_ROTOR_RADII * self.radius_m) + k_2_m);
        1.0 / (1.0 - ratio * ratio / k_1).max(1.0 / MAX_FACTOR)
    }
}

/// Share of the ground effect at a height in rotor radii.
fn fade(height_over_radius: f64) -> f64 {
    ((RANGE_ROTOR_RADII - height_over_radius) / (RANGE_ROTOR_RADII - FADE_ROTOR_RADII)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::math;

    /// The Phantom 2's layout: the published values are for its ratio of arm to radius.
    fn phantom() -> RotorLayout {
        let (arm_m, radius_m) = (0.1237, 0.119);
        let hubs = [(1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)];
        RotorLayout { hubs_m: hubs.map(|(x, y)| Vector2::new(arm_m * x, arm_m * y)).to_vec(), radius_m }
    }

    fn over_plane(layout: &RotorLayout, height_m: f64) -> [f64; MAX_ROTORS] {
        layout.ground_factors(&[Some(height_m); MAX_ROTORS])
    }

    #[test]
    fn val_ground_and_ceiling_match_the_published_values() {
        // Relative tolerance.
        const TOLERANCE: f64 = 0.05;
        let layout = phantom();
        for (radii, expected) in [(0.5, 1.58), (1.0, 1.26), (2.0, 1.13)] {
            let got = over_plane(&layout, radii * layout.radius_m)[0];
            assert!((got / expected - 1.0).abs() < TOLERANCE, "{radii}: {got}");
        }
        for (radii, expected) in [(0.5, 1.28), (1.0, 1.09)] {
            let got = layout.ceiling_factor(radii * layout.radius_m);
            assert!((got / expected - 1.0).abs() < TOLERANCE, "{radii}: {got}");
        }
    }

    #[test]
    fn exact_four_rotors_over_a_plane_follow_the_formula_of_sanchez_cuevas() {
        let layout = phantom();
        let (r, d, b) = (layout.radius_m, 2.0 * 0.1237, 2.0 * 0.1237 * 2.0_f64.sqrt());
        for z in [0.06, 0.12, 0.3, 0.59] {
            let term = |squared: f64| z / math::pow(squared + 4.0 * z * z, 1.5);
            let own = (r / (4.0 * z)) * (r / (4.0 * z));
            let sum = own + r * r * term(d * d) + 0.5 * r * r * term(2.0 * d * d) + 2.0 * r * r * term(b * b) * 2.0;
            for factor in over_plane(&layout, z).iter().take(4) {
                assert!((factor - 1.0 / (1.0 - sum)).abs() < 1e-12, "{z}: {factor}");
            }
        }
    }

    #[test]
    fn exact_only_rotors_over_ground_gain_thrust() {
        let layout = phantom();
        let mut heights = [None; MAX_ROTORS];
        heights[0] = Some(0.12);
        let alone = layout.ground_factors(&heights);
        assert!(alone[0] > 1.0 && alone[0] < over_plane(&layout, 0.12)[0]);
        assert_eq!(alone[1..], [1.0; MAX_ROTORS - 1]);
        assert_eq!(layout.ground_factors(&[None; MAX_ROTORS]), [1.0; MAX_ROTORS]);
    }

    #[test]
    fn prop_factors_are_bounded_and_decrease_with_distance() {
        let overlapping = RotorLayout { hubs_m: vec![Vector2::zeros(); MAX_ROTORS], radius_m: 1.0 };
        for layout in [phantom(), overlapping] {
            let mut before = (MAX_FACTOR, MAX_FACTOR);
            for k in 0..=1_200 {
                let distance_m = 0.01 * f64::from(k) * layout.radius_m;
                let now = (over_plane(&layout, distance_m)[0], layout.ceiling_factor(distance_m));
                assert!(now.0 >= 1.0 && now.0 <= before.0 && now.1 >= 1.0 && now.1 <= before.1, "{k}: {now:?}");
                before = now;
            }
            assert_eq!(before.0, 1.0);
        }
    }
}
