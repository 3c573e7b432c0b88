//! Position and orientation of the aircraft's camera.

use crate::frames::{Enu, Frd, Ned, Rotation, Vec3};
use crate::pose::Pose;
use crate::vehicle::Camera;

/// Position and orientation of a camera, and the state of its lamp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraPose {
    /// Lens position, m.
    pub position_m: Vec3<Enu>,
    /// Unit vector of the optical axis.
    pub forward: Vec3<Enu>,
    /// Unit vector toward the right side of the image.
    pub right: Vec3<Enu>,
    /// True if the lamp, which points along the optical axis, is on.
    pub lamp_on: bool,
}

impl CameraPose {
    /// Returns the camera pose for an aircraft pose. The attitude determines the heading. The gimbal keeps the camera
    /// free of roll and at a pitch of `gimbal_rad` above the horizon.
    #[must_use]
    pub fn on_aircraft(camera: &Camera, Pose { position_m, ned_from_frd }: Pose<Enu>, gimbal_rad: f64, lamp_on: bool) -> Self {
        let looking: Rotation<Frd, Ned> = Rotation::from_euler(0.0, gimbal_rad, ned_from_frd.yaw_rad());
        Self {
            position_m: position_m + (ned_from_frd * camera.position_m).enu(),
            forward: (looking * Vec3::new(1.0, 0.0, 0.0)).enu(),
            right: (looking * Vec3::new(0.0, 1.0, 0.0)).enu(),
            lamp_on,
        }
    }
}
