//! The reference camera: its properties, and the poses on or near a task's path from which it photographs a position.
//! Placement and predicted detection of defects use it, so that neither depends on the aircraft.

use super::camera_pose::CameraPose;
use crate::frames::{Enu, Vec3};
use crate::math;
use crate::scenario::Task;
use crate::vehicle::{Camera, Lamp};

/// Reference camera, which can photograph every placed defect. Its resolution is lower than that of the shipped cameras
/// (3000 px over 100 degrees; estimate for a small low-end inspection drone), and its gimbal has the full range.
/// Placement must not depend on the aircraft, because the simulator and the monitor each derive the defects from the
/// scenario and the seed alone.
pub const REFERENCE_CAMERA: Camera = Camera {
    position_m: Vec3::new(0.0, 0.0, 0.0),
    width_px: 3000,
    height_px: 2250,
    hfov_rad: 100.0 * math::PI / 180.0,
    zoom_max: 1.0,
    f_number: 2.8,
    iso_max: 1600.0,
    max_exposure_time_s: 0.01,
    gimbal_pitch_min_rad: -math::FRAC_PI_2,
    gimbal_pitch_max_rad: math::FRAC_PI_2,
    gimbal_rate_rad_s: 1.0,
};
/// Lamp of the reference camera (estimate: a small clip-on light).
pub const REFERENCE_LAMP: Lamp = Lamp { luminous_flux_lm: 1000.0, beam_angle_rad: math::PI / 3.0 };

/// Minimum distance of the reference camera from any surface, m (half of 0.59 m tip to tip, plus a margin).
pub const CAMERA_CLEARANCE_M: f64 = 0.8;
/// Candidate distances by which the reference camera leaves the path toward the defect, as fractions of the task's
/// threshold. The largest one leaves a margin.
pub(super) const CAMERA_DISTANCE_FRACTIONS: [f64; 4] = [0.0, 0.3, 0.6, 0.9];
/// Number of path points to try as reference camera positions, nearest first.
const CANDIDATE_POINT_COUNT: usize = 5;

/// Returns the indices of the path points to try as reference camera positions, nearest first.
pub(super) fn nearest_points(position_m: Vec3<Enu>, task: &Task) -> Vec<usize> {
    let mut order: Vec<usize> = (0..task.path_m.len()).collect();
    order.sort_by(|a, b| {
        let d = |k: usize| (task.path_m[k] - position_m).norm_squared();
        d(*a).total_cmp(&d(*b)).then(a.cmp(b))
    });
    order.into_iter().step_by(2).take(CANDIDATE_POINT_COUNT).collect()
}

/// Returns the pose at a path point, moved toward a position by a share of the task's threshold and aimed at it.
pub(super) fn pose_toward(position_m: Vec3<Enu>, task: &Task, k: usize, share: f64) -> CameraPose {
    let to = position_m - task.path_m[k];
    let step = (share * task.threshold_m).min(to.norm() - CAMERA_CLEARANCE_M).max(0.0);
    camera_aimed_at(task.path_m[k] + to.unit() * step, position_m)
}

/// Returns the poses from which a task's path offers views of a position, nearest first ([`super::defects::find_view`] tries the
/// same ones).
pub(super) fn candidate_poses(position_m: Vec3<Enu>, task: &Task, share: f64) -> impl Iterator<Item = CameraPose> {
    nearest_points(position_m, task).into_iter().map(move |k| pose_toward(position_m, task, k, share))
}

/// Returns the pose of a roll-free camera that is aimed at a point, with the lamp on.
pub(super) fn camera_aimed_at(position_m: Vec3<Enu>, at_m: Vec3<Enu>) -> CameraPose {
    let forward = (at_m - position_m).unit();
    let level = forward.cross(Vec3::new(0.0, 0.0, 1.0));
    let right = if level.norm() > 1e-9 { level.unit() } else { Vec3::new(1.0, 0.0, 0.0) };
    CameraPose { position_m, forward, right, lamp_on: true }
}
