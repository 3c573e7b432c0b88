//! Image quality of a defect in a picture: ground sampling distance, exposure and motion blur. The formulas are in
//! docs/src/reference/domain.md, "Resolution" and "Light levels".

use serde::Serialize;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::site::DefectView;
use spandrel_model::site::visibility::required_illuminance_lux;
use spandrel_model::vehicle::Camera;

/// Millimeters per meter.
const MM_PER_M: f64 = 1_000.0;

/// Measured quality with which a picture shows one defect.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ImageQuality {
    /// Distance from the lens to the defect, m.
    pub distance_m: f64,
    /// Angle between the line of sight and the surface normal, degrees.
    pub incidence_deg: f64,
    /// Ground sampling distance at the defect, across the line of sight, mm per pixel.
    pub gsd_mm: f64,
    /// Illuminance at the defect, lx.
    pub illuminance_lux: f64,
    /// Illuminance that the camera needs at its longest exposure and highest sensitivity, lx.
    pub required_illuminance_lux: f64,
    /// Shortest exposure possible in this light, s.
    pub exposure_s: f64,
    /// Speed of the camera across the line of sight, m/s.
    pub speed_across_m_s: f64,
    /// Rotation rate of the optical axis, rad/s.
    pub rotation_rad_s: f64,
    /// Motion blur from speed and rotation, px.
    pub smear_px: f64,
}

/// Motion of the camera when a picture was taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraMotion {
    /// Velocity over ground, m/s.
    pub velocity_m_s: Vec3<Enu>,
    /// Rotation rate of the optical axis, rad/s.
    pub rotation_rad_s: f64,
}

impl ImageQuality {
    /// Measures the quality of one defect's view in a picture taken with `camera` at the zoom of that picture.
    #[must_use]
    pub fn measure(view: &DefectView, to_defect: Vec3<Enu>, camera: &Camera, motion: &CameraMotion) -> Self {
        let gsd_m = view.distance_m / camera.focal_px();
        let ray = to_defect.unit();
        let across = motion.velocity_m_s - ray * motion.velocity_m_s.dot(ray);
        let exposure_s = exposure_s(camera, view.illuminance_lux);
        Self {
            distance_m: view.distance_m,
            incidence_deg: view.incidence_rad.to_degrees(),
            gsd_mm: gsd_m * MM_PER_M,
            illuminance_lux: view.illuminance_lux,
            required_illuminance_lux: view.required_illuminance_lux,
            exposure_s,
            speed_across_m_s: across.norm(),
            rotation_rad_s: motion.rotation_rad_s,
            smear_px: exposure_s * (across.norm() / gsd_m + motion.rotation_rad_s * camera.focal_px()),
        }
    }
}

/// Returns the shortest exposure in seconds for an illuminance of `lux` at the camera's maximum sensitivity, limited to
/// the camera's maximum exposure.
#[must_use]
pub fn exposure_s(camera: &Camera, lux: f64) -> f64 {
    (required_illuminance_lux(camera) * camera.max_exposure_time_s / lux.max(f64::MIN_POSITIVE)).min(camera.max_exposure_time_s)
}

/// Returns the smallest ground sampling distance in mm per pixel at which the camera can photograph a surface that is
/// `distance_m` away: at full zoom, across the line of sight.
#[must_use]
pub fn best_gsd_mm(camera: &Camera, distance_m: f64) -> f64 {
    MM_PER_M * distance_m / (camera.focal_px() * camera.zoom_max)
}

/// Returns the angle between two unit vectors in radians.
#[must_use]
pub fn angle_rad(a: Vec3<Enu>, b: Vec3<Enu>) -> f64 {
    math::atan2(a.cross(b).norm(), a.dot(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_angle_is_precise_for_small_and_large_angles() {
        let east = Vec3::new(1.0, 0.0, 0.0);
        for angle in [0.0, 1e-6, 0.5, math::PI] {
            let (s, c) = math::sin_cos(angle);
            assert!((angle_rad(east, Vec3::new(c, s, 0.0)) - angle).abs() < 1e-12, "{angle}");
        }
    }
}
