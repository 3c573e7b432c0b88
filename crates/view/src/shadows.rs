//! Shadow map projections: for the sun, over the whole site or in cascades ahead of the camera, and for the lamp.

use super::camera::PinholeCamera;
use super::matrix::Matrix;
use super::quality::Quality;
use super::shot::LampBeam;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;

/// Maximum distance of shadow casters from a map's center toward the sun, m.
const CASTER_RANGE_M: f64 = 700.0;
/// Maximum distance of shadow receivers beyond a map's center, m.
const RECEIVER_RANGE_M: f64 = 400.0;
/// Radii of the maps that follow the camera, m, by number of cascades.
const THREE_CASCADE_RADII_M: [f64; 3] = [16.0, 80.0, 380.0];
const FOUR_CASCADE_RADII_M: [f64; 4] = [10.0, 38.0, 130.0, 440.0];
/// Near plane of the lamp's map, m: in front of the aircraft's own parts.
const LAMP_NEAR_PLANE_M: f64 = 0.35;
/// Width of the lamp's map relative to its beam.
const LAMP_MARGIN_FACTOR: f64 = 1.08;

/// A shadow map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShadowMap {
    /// Projection from world to clip space.
    pub projection: Matrix,
    /// Texel size, m (for the lamp: at a distance of 1 m).
    pub texel_m: f64,
}

/// Returns the sun's shadow maps, finest first.
#[must_use]
pub fn sun_maps(quality: &Quality, eye: &PinholeCamera, bounds_m: (Vec3<Enu>, f64), sun: Vec3<Enu>) -> Vec<ShadowMap> {
    let ahead = |radius: f64| sun_map(eye.position_m + eye.forward * (0.75 * radius), radius, quality.shadow_px, sun);
    match quality.cascades {
        0 | 1 => vec![sun_map(bounds_m.0, bounds_m.1, quality.shadow_px, sun)],
        2 | 3 => THREE_CASCADE_RADII_M.iter().map(|r| ahead(*r)).collect(),
        _ => FOUR_CASCADE_RADII_M.iter().map(|r| ahead(*r)).collect(),
    }
}

fn sun_map(center_m: Vec3<Enu>, radius_m: f64, side_px: u32, sun: Vec3<Enu>) -> ShadowMap {
    let helper = if sun.up().abs() < 0.95 { Vec3::new(0.0, 0.0, 1.0) } else { Vec3::new(0.0, 1.0, 0.0) };
    let right = helper.cross(sun).unit();
    let up = sun.cross(right);
    let texel_m = 2.0 * radius_m / f64::from(side_px);
    // Snaps to whole texels to keep shadow edges from shimmering when the camera moves.
    let snap = |x: f64| (x / texel_m).round() * texel_m;
    let (x, y) = (snap(center_m.dot(right)), snap(center_m.dot(up)));
    let middle = right * x + up * y + sun * center_m.dot(sun);
    let projection =
        Matrix::orthographic(radius_m, -CASTER_RANGE_M, RECEIVER_RANGE_M).after(&Matrix::view(middle, right, up, sun));
    ShadowMap { projection, texel_m }
}

/// Returns the lamp's shadow map.
#[must_use]
pub fn lamp_map(beam: &LampBeam, side_px: u32) -> ShadowMap {
    let half = math::tan(beam.half_angle_rad) * LAMP_MARGIN_FACTOR;
    let up = beam.right.cross(beam.forward);
    let view = Matrix::view(beam.position_m, beam.right, up, -beam.forward);
    ShadowMap {
        projection: Matrix::perspective(half, half, LAMP_NEAR_PLANE_M).after(&view),
        texel_m: 2.0 * half / f64::from(side_px),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_map_depth_follows_the_distance_to_the_sun() {
        let sun = Vec3::new(0.6, 0.0, 0.8);
        let map = sun_map(Vec3::new(10.0, 20.0, 30.0), 50.0, 1024, sun);
        let low = map.projection.apply(Vec3::new(10.0, 20.0, 30.0));
        let high = map.projection.apply(Vec3::new(10.0, 20.0, 30.0) + sun * 25.0);
        assert!(high[2] > low[2] && low[2] > 0.0 && high[2] < 1.0);
        // Both points are on one sun ray, so they map to the same texel.
        assert!((high[0] - low[0]).abs() < 1e-9 && (high[1] - low[1]).abs() < 1e-9);
        assert!(low[0].abs() < 2.0 / 1024.0 && low[1].abs() < 2.0 / 1024.0, "in the middle, to the texel");
    }
}
