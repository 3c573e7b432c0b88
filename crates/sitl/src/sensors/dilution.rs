//! Dilution of precision of a satellite geometry, and the limits of a receiver.

use nalgebra::{Matrix4, Vector4};
use spandrel_model::frames::{Enu, Vec3};

/// Elevation mask, rad (10 degrees, common in receivers).
pub(super) const ELEVATION_MASK_RAD: f64 = 0.174_533;
/// Minimum number of satellites for a fix (four for the four unknowns, and one for a consistency check).
pub(super) const MIN_SATELLITES: usize = 5;
/// Maximum horizontal dilution of precision for a fix (estimate: receivers flag larger values as unusable).
pub(super) const MAX_HDOP: f64 = 8.0;
/// Range within which structures hide satellites, m (larger than any site).
pub(super) const BLOCKING_RANGE_M: f64 = 400.0;

/// Returns the derivative of a satellite's pseudorange with respect to the position (east, north, up) and the receiver's clock error.
pub(super) fn geometry_row(satellite: Vec3<Enu>) -> Vector4<f64> {
    Vector4::new(-satellite.east(), -satellite.north(), -satellite.up(), 1.0)
}

/// Returns the horizontal and vertical dilution of precision, or `None` with too few satellites or a degenerate
/// geometry.
pub(super) fn dilution(sky: impl Iterator<Item = Vec3<Enu>>) -> Option<(f64, f64)> {
    let normal: Matrix4<f64> = sky.fold(Matrix4::zeros(), |sum, d| {
        let row = geometry_row(d);
        sum + row * row.transpose()
    });
    let inverse = normal.try_inverse()?;
    let (h2, v2) = (inverse[(0, 0)] + inverse[(1, 1)], inverse[(2, 2)]);
    (h2.is_finite() && h2 > 0.0 && v2 > 0.0).then(|| (h2.sqrt(), v2.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::math;

    #[test]
    fn exact_four_satellites_have_textbook_dilution() {
        // One at the zenith and three at 120 degrees on the horizon: HDOP² = 4/3 and VDOP² = 4/3.
        let third = math::TAU / 3.0;
        let low = (0..3).map(|i| Vec3::new(math::sin(third * f64::from(i)), math::cos(third * f64::from(i)), 0.0));
        let all = low.chain(std::iter::once(Vec3::new(0.0, 0.0, 1.0)));
        let expected = (4.0_f64 / 3.0).sqrt();
        let (h, v) = dilution(all).unwrap_or((0.0, 0.0));
        assert!((h - expected).abs() < 1e-12 && (v - expected).abs() < 1e-12, "{h} {v}");
    }
}
