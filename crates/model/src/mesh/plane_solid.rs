//! A convex part as the space behind the planes of its faces.

use super::faces::ConvexPart;
use super::vectors::{Point, dot, middle, norm, polygon_area_vector, sub, unit};

/// Minimum mean width of a face whose plane counts, m (estimate: ten times the tolerance of its corners).
const MIN_WIDTH_M: f64 = 1e-3;

/// The planes of a convex part.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaneSolid(Vec<(Point, f64)>);

impl PlaneSolid {
    /// Computes the planes of a part's faces.
    #[must_use]
    pub fn new(part: &ConvexPart) -> Self {
        let plane = |face: &Vec<u32>| {
            let corners: Vec<Point> = face.iter().map(|k| part.corners_m[*k as usize]).collect();
            let area_vector = polygon_area_vector(&corners);
            // A narrow face has no reliable plane.
            let around_m: f64 = (0..corners.len()).map(|k| norm(sub(corners[(k + 1) % corners.len()], corners[k]))).sum();
            let normal = unit(area_vector).filter(|_| norm(area_vector) > MIN_WIDTH_M * around_m)?;
            Some((normal, dot(normal, middle(&corners))))
        };
        Self(part.faces.iter().filter_map(plane).collect())
    }

    /// Returns the signed distance to the surface, m: exact inside, and at most the distance outside.
    #[must_use]
    pub fn distance_m(&self, p: Point) -> f64 {
        self.0.iter().map(|(normal, offset_m)| dot(*normal, p) - offset_m).fold(f64::NEG_INFINITY, f64::max)
    }
}
