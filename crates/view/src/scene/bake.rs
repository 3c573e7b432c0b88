//! Baked indirect light at vertices, computed with the light model used for scoring, so a soffit that counts as dark
//! also looks dark.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::site::light::ray_bundle;
use spandrel_model::site::{QueryTime, RayHit, Site};

/// Distance between samples and the edges of their face, m; prevents adjoining members from darkening them.
pub const SAMPLE_INSET_M: f64 = 0.25;
/// Maximum distance between a probe and a solid that covers the sample, m.
const COVERED_DISTANCE_M: f64 = 0.04;
/// Height of the probe above the surface, m.
const PROBE_HEIGHT_M: f64 = 0.05;

/// Height above a face at which a test point shows whether another member covers the face, m (touching members leave no
/// gap this wide).
const INSIDE_TEST_HEIGHT_M: f64 = 0.005;

/// Computes indirect light at points of a site.
pub struct LightBaker<'a> {
    site: &'a Site,
    sun: Vec3<Enu>,
    rays: Vec<(f64, f64)>,
}

impl<'a> LightBaker<'a> {
    /// Creates a baker with the given number of rays per point.
    pub fn new(site: &'a Site, sun: Vec3<Enu>, rays: usize) -> Self {
        Self { site, sun, rays: ray_bundle(rays) }
    }

    /// Returns the fractions of sky and sun illuminance that reach a surface indirectly.
    pub fn at(&self, position_m: Vec3<Enu>, normal: Vec3<Enu>) -> [f32; 2] {
        let cast = |o: Vec3<Enu>, d: Vec3<Enu>, max_m: f64| -> Option<RayHit> { self.site.geometry().ray(o, d, max_m) };
        let (sky, sun) = self.site.light().indirect_fractions(position_m, normal, self.sun, &self.rays, &cast);
        [sky as f32, sun as f32]
    }

    /// Returns the same fractions for a point on a member's face, or `None` if another member covers the point.
    pub fn on_member(&self, position_m: Vec3<Enu>, normal: Vec3<Enu>) -> Option<[f32; 2]> {
        let near = self.site.geometry().nearest_member(position_m + normal * PROBE_HEIGHT_M, PROBE_HEIGHT_M);
        let buried = near.is_some_and(|n| n.distance_m < COVERED_DISTANCE_M);
        (!buried).then(|| self.at(position_m, normal))
    }

    /// Returns the same fractions for a point of a coarse mesh, which may be up to `deviation_m` inside or outside of the member.
    pub fn near_surface(&self, position_m: Vec3<Enu>, normal: Vec3<Enu>, deviation_m: f64) -> [f32; 2] {
        let near = self.site.geometry().nearest_member(position_m, deviation_m);
        self.at(near.map_or(position_m, |near| near.point_m), normal)
    }

    /// Checks whether the point just above a face is inside another member and therefore not visible.
    pub fn is_inside(&self, position_m: Vec3<Enu>, normal: Vec3<Enu>) -> bool {
        let near = self.site.geometry().nearest_member(position_m + normal * INSIDE_TEST_HEIGHT_M, INSIDE_TEST_HEIGHT_M);
        near.is_some_and(|n| n.distance_m < 0.0)
    }
}

/// Fills gaps in a sample grid with the mean of their neighbors.
pub fn fill_gaps(samples: &[Option<[f32; 2]>], columns: usize) -> Vec<[f32; 2]> {
    let mut known = samples.to_vec();
    let rows = samples.len() / columns.max(1);
    for _ in 0..columns.max(rows) {
        if known.iter().all(Option::is_some) {
            break;
        }
        let before = known.clone();
        for (k, slot) in known.iter_mut().enumerate().filter(|(_, slot)| slot.is_none()) {
            let (row, column) = (k / columns, k % columns);
            let mut sum = [0.0, 0.0];
            let mut count = 0.0;
            let mut offer = |row: usize, column: usize| {
                if let Some([a, b]) = before[row * columns + column] {
                    sum = [sum[0] + a, sum[1] + b];
                    count += 1.0;
                }
            };
            if row > 0 {
                offer(row - 1, column);
            }
            if row + 1 < rows {
                offer(row + 1, column);
            }
            if column > 0 {
                offer(row, column - 1);
            }
            if column + 1 < columns {
                offer(row, column + 1);
            }
            if count > 0.0 {
                *slot = Some([sum[0] / count, sum[1] / count]);
            }
        }
    }
    known.into_iter().map(|sample| sample.unwrap_or([0.0, 0.0])).collect()
}

/// Returns the indirect light on the upward and downward surfaces of a small object in the air.
pub fn around(site: &Site, position_m: Vec3<Enu>, at: QueryTime) -> [f32; 4] {
    const RAYS: usize = 24;
    let bake = LightBaker::new(site, site.light().daylight(at).sun, RAYS);
    let up = Vec3::new(0.0, 0.0, 1.0);
    let ([a, b], [c, d]) = (bake.at(position_m, up), bake.at(position_m, -up));
    [a, b, c, d]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_gaps_get_the_mean_of_their_neighbors() {
        let a = Some([1.0, 0.0]);
        let b = Some([3.0, 2.0]);
        let fill_gaps = fill_gaps(&[a, None, b, a, None, b], 3);
        assert_eq!(fill_gaps[1], [2.0, 1.0]);
        assert_eq!(super::fill_gaps(&[None, None], 2), [[0.0, 0.0]; 2]);
    }
}
