//! Statistics of positions during a hold.

use spandrel_model::frames::{Ned, Vec3};

/// Returns the mean position, and the standard deviations of the position north, east and down, m.
pub fn mean_and_deviations(places: &[Vec3<Ned>]) -> (Vec3<Ned>, [f64; 3]) {
    let count = places.len() as f64;
    let mean = places.iter().fold(Vec3::zero(), |sum, place| sum + *place) / count;
    let squares = places.iter().map(|place| (*place - mean).array().map(|d| d * d));
    let sums = squares.fold([0.0; 3], |sum: [f64; 3], d| [sum[0] + d[0], sum[1] + d[1], sum[2] + d[2]]);
    (mean, sums.map(|s| (s / count).sqrt()))
}
