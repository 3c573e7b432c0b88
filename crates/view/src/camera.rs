//! Camera poses and projections.

use super::matrix::Matrix;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::site::CameraPose;
use spandrel_model::vehicle::Camera;

const UP: Vec3<Enu> = Vec3::new(0.0, 0.0, 1.0);
/// Near plane, m.
pub const NEAR_PLANE_M: f64 = 0.05;
/// The inspector's vertical field of view, rad (60 deg: close to a natural perspective on a screen; estimate).
pub const INSPECTOR_FOV_RAD: f64 = 1.05;

/// A pinhole camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PinholeCamera {
    /// Position, ENU, m.
    pub position_m: Vec3<Enu>,
    /// Unit vector of the optical axis.
    pub forward: Vec3<Enu>,
    /// Unit vector to the right.
    pub right: Vec3<Enu>,
    /// Horizontal field of view, rad.
    pub hfov_rad: f64,
}

impl PinholeCamera {
    /// Creates a camera without roll at `position_m` that is aimed at `target_m`. `vfov_rad` is the vertical field of
    /// view; `aspect` is width over height.
    #[must_use]
    pub fn at(position_m: Vec3<Enu>, target_m: Vec3<Enu>, vfov_rad: f64, aspect: f64) -> Self {
        let to = target_m - position_m;
        let forward = if to.norm() > 1e-9 { to.unit() } else { Vec3::new(0.0, 1.0, 0.0) };
        let level = forward.cross(UP);
        let right = if level.norm() > 1e-9 { level.unit() } else { Vec3::new(1.0, 0.0, 0.0) };
        let hfov_rad = 2.0 * math::atan2(aspect * math::tan(0.5 * vfov_rad), 1.0);
        Self { position_m, forward, right, hfov_rad }
    }

    /// Creates the view of the aircraft's camera. The horizontal field of view does not depend on the picture's height.
    #[must_use]
    pub fn of(pose: &CameraPose, camera: &Camera) -> Self {
        Self { position_m: pose.position_m, forward: pose.forward, right: pose.right, hfov_rad: camera.hfov_rad }
    }

    /// Returns the unit vector toward the top of the picture.
    #[must_use]
    pub fn up(&self) -> Vec3<Enu> {
        self.right.cross(self.forward)
    }

    /// Returns half the width and half the height of the picture at distance 1.
    #[must_use]
    pub fn half_extents(&self, aspect: f64) -> (f64, f64) {
        let half = math::tan(0.5 * self.hfov_rad);
        (half, half / aspect)
    }

    /// Returns the view-projection matrix (world to clip space).
    #[must_use]
    pub fn view_projection(&self, aspect: f64) -> Matrix {
        let (w, h) = self.half_extents(aspect);
        Matrix::perspective(w, h, NEAR_PLANE_M).after(&Matrix::view(self.position_m, self.right, self.up(), -self.forward))
    }

    /// Returns the unit vector from the camera through a picture point; `x` (right) and `y` (up) are in [-1, 1].
    #[must_use]
    pub fn ray(&self, x: f64, y: f64, aspect: f64) -> Vec3<Enu> {
        let (w, h) = self.half_extents(aspect);
        (self.forward + self.right * (x * w) + self.up() * (y * h)).unit()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_target_is_centered_and_up_points_up() {
        let eye = PinholeCamera::at(Vec3::new(10.0, -20.0, 5.0), Vec3::new(0.0, 30.0, 12.0), 1.0, 1.6);
        let clip = eye.view_projection(1.6).apply(Vec3::new(0.0, 30.0, 12.0));
        assert!(clip[0].abs() < 1e-9 && clip[1].abs() < 1e-9 && clip[3] > 0.0);
        assert!(eye.view_projection(1.6).apply(Vec3::new(0.0, 30.0, 13.0))[1] > 0.0);
        let edge = eye.ray(0.0, 1.0, 1.6);
        assert!((math::acos(edge.dot(eye.forward)) - 0.5).abs() < 1e-9, "half of the vertical field of view");
    }
}
