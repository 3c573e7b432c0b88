//! Visibility culling for a shot.

use crate::camera::PinholeCamera;
use crate::cells::{BoundingSphere, Frustum};
use crate::matrix::Matrix;
use crate::scene::{Instance, MoverModel};
use crate::shot::Shot;
use spandrel_model::frames::{Enu, Vec3};

/// View parameters of a shot.
pub struct ShotView {
    projection: Matrix,
    water_m: f64,
    /// Camera position, ENU, m.
    pub eye_m: Vec3<Enu>,
    /// 1 if the lamp is on, otherwise 0.
    pub lamp: usize,
    /// 1 if waves break, otherwise 0.
    pub breaking: usize,
    /// Whether drops or flakes are in the picture.
    pub falling: bool,
    /// Whether the lake may be visible in the picture.
    pub lake: bool,
}

impl ShotView {
    /// Returns the view parameters of a shot for a water level in meters.
    pub fn of(shot: &Shot, water_m: f64) -> Self {
        Self {
            projection: shot.eye.view_projection(shot.aspect()),
            water_m,
            eye_m: shot.eye.position_m,
            lamp: usize::from(shot.beam.is_some()),
            breaking: usize::from(shot.wind.breaking_share() > 0.0),
            falling: shot.weather.falls_in_view(),
            lake: may_be_visible_in_lake(&shot.eye, shot.aspect(), water_m),
        }
    }

    /// Returns the frustum of the direct view.
    pub fn direct_view(&self) -> Frustum {
        Frustum::of(&self.projection)
    }

    /// Returns the frustum of the reflection in the lake.
    pub fn mirrored(&self) -> Frustum {
        Frustum::of(&self.projection.after(&Matrix::mirror(self.water_m)))
    }

    /// Returns the moving objects that may be visible directly or in the lake. `model_radii_m` contains the distance
    /// from each model's origin to its farthest vertex, m.
    pub fn visible_objects(&self, moving: &[(MoverModel, Instance)], model_radii_m: &[f64]) -> Vec<(MoverModel, Instance)> {
        let (straight, mirrored) = (self.direct_view(), self.mirrored());
        let shows = |(model, instance): &&(MoverModel, Instance)| {
            let [x, y, z] = instance.rows.map(|row| f64::from(row[3]));
            let radius_m = model_radii_m.get(model.index()).copied().unwrap_or(0.0);
            let ball = BoundingSphere { center_m: Vec3::new(x, y, z), radius_m };
            straight.may_be_visible(&ball) || (self.lake && mirrored.may_be_visible(&ball))
        };
        moving.iter().filter(shows).copied().collect()
    }
}

/// Returns false if the camera is above the water and no ray of the picture points down.
fn may_be_visible_in_lake(eye: &PinholeCamera, aspect: f64, water_m: f64) -> bool {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
    eye.position_m.up() <= water_m || corners.iter().any(|(x, y)| eye.ray(*x, *y, aspect).up() < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASPECT: f64 = 1.5;

    /// Returns a camera 10 m above the lake that looks north, with a view direction that rises by `rise_m` over 50 m.
    fn eye(rise_m: f64) -> PinholeCamera {
        PinholeCamera::at(Vec3::new(0.0, 0.0, 10.0), Vec3::new(0.0, 50.0, 10.0 + rise_m), 1.0, ASPECT)
    }

    fn visible_from(rise_m: f64, all: &[(MoverModel, Instance)]) -> Vec<(MoverModel, Instance)> {
        let (eye, water_m) = (eye(rise_m), 0.0);
        let (projection, lake) = (eye.view_projection(ASPECT), may_be_visible_in_lake(&eye, ASPECT, water_m));
        let view = ShotView { projection, water_m, eye_m: eye.position_m, lamp: 0, breaking: 0, falling: false, lake };
        view.visible_objects(all, &[3.0; 6])
    }

    #[test]
    fn exact_lake_is_culled_if_no_ray_points_down() {
        let shows = |rise_m: f64, water_m: f64| may_be_visible_in_lake(&eye(rise_m), ASPECT, water_m);
        assert!(shows(0.0, 0.0) && !shows(60.0, 0.0));
        assert!(shows(60.0, 11.0), "from below the water");
    }

    #[test]
    fn exact_moving_objects_are_culled_unless_the_lake_shows_them() {
        let at = |east: f64, north: f64, up: f64| {
            let axes = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)];
            (MoverModel::Car, Instance::placed(Vec3::new(east, north, up), axes, [1.0; 4]))
        };
        let [ahead, behind, beside, above] =
            [at(0.0, 50.0, 10.0), at(0.0, -50.0, 10.0), at(90.0, 50.0, 10.0), at(0.0, 40.0, 40.0)];
        assert_eq!(visible_from(0.0, &[ahead, behind, beside, above]), [ahead]);
        // In a downward view of the lake, the reflection shows objects ahead and above.
        assert_eq!(visible_from(-45.0, &[ahead, behind, beside, above]), [ahead, above]);
        assert_eq!(visible_from(-400.0, &[ahead]), []);
    }
}
