//! Conditions that every placed defect meets: it fits on its face, nothing covers it, and a camera on or near the task's path can
//! photograph it.

use super::camera_pose::CameraPose;
use super::faces::MemberFace;
use super::light::RayCast;
use super::reference_camera::{CAMERA_CLEARANCE_M, CAMERA_DISTANCE_FRACTIONS, REFERENCE_CAMERA, REFERENCE_LAMP};
use super::reference_camera::{nearest_points, pose_toward};
use super::visibility;
use crate::frames::{Enu, Vec3};
use crate::scenario::bridges::Member;
use crate::scenario::{PlacedDefect, Task};

/// Minimum width of bare surface around a defect, m, which keeps defects away from joints and edges.
pub(super) const EDGE_MARGIN_M: f64 = 0.03;
/// Minimum free space in front of a defect, along its normal, m.
const MIN_FREE_DEPTH_M: f64 = 0.5;

/// Site data and queries needed to place defects.
#[derive(Clone, Copy)]
pub struct PlacementContext<'a> {
    /// All bridge members. The object ID of a ray hit is an index into this list.
    pub members: &'a [Member],
    /// All the job's tasks.
    pub tasks: &'a [Task],
    /// Ray queries against static geometry.
    pub cast: RayCast<'a>,
    /// Ambient light at session start by position and normal, lx.
    pub ambient: visibility::AmbientLight<'a>,
    /// Distance from a point to the nearest surface, m; infinity if it exceeds [`CAMERA_CLEARANCE_M`].
    pub clearance_m: &'a dyn Fn(Vec3<Enu>) -> f64,
    /// Height of the water's surface, m.
    pub water_up_m: f64,
}

/// Returns the end points of a defect along its length and its width, each extended by a margin.
pub(super) fn end_points(defect: &PlacedDefect, margin_m: f64) -> [Vec3<Enu>; 4] {
    let across = defect.normal.cross(defect.along);
    let (l, w) = (0.5 * defect.length_m + margin_m, 0.5 * defect.width_m + margin_m);
    let c = defect.position_m;
    [c + defect.along * l, c - defect.along * l, c + across * w, c - across * w]
}

/// Returns true if the defect and a margin, m, are entirely inside the face.
pub(super) fn fits_in_face(defect: &PlacedDefect, face: &MemberFace, margin_m: f64) -> bool {
    end_points(defect, margin_m).iter().all(|p| face.edge_distance_m(*p) > 0.0)
}

/// Returns true if no other member covers the defect or touches its surroundings up to a margin, m. Rays from slightly above the center
/// and the ends of the defect must hit this member first.
pub(super) fn is_exposed(defect: &PlacedDefect, object: u32, cast: RayCast, margin_m: f64) -> bool {
    let mut points = end_points(defect, margin_m).to_vec();
    points.push(defect.position_m);
    points.iter().all(|p| {
        let above = *p + defect.normal * MIN_FREE_DEPTH_M;
        let room_up = cast(*p + defect.normal * 0.005, defect.normal, MIN_FREE_DEPTH_M).is_none();
        let back = cast(above, -defect.normal, MIN_FREE_DEPTH_M + 0.01);
        room_up && back.is_some_and(|h| h.object.0 == object && (h.distance_m - MIN_FREE_DEPTH_M).abs() < 0.002)
    })
}

/// Returns a pose where the reference camera captures the defect, within the task's threshold of its path and with
/// sufficient clearance; `None` if no candidate qualifies.
#[must_use]
pub fn find_view(defect: &PlacedDefect, task: &Task, context: &PlacementContext) -> Option<CameraPose> {
    nearest_points(defect.position_m, task).into_iter().find_map(|k| {
        CAMERA_DISTANCE_FRACTIONS.iter().find_map(|share| {
            let pose = pose_toward(defect.position_m, task, k, *share);
            // Checks the cheapest conditions first: line of sight and pixels, then clearance, then light.
            let bright =
                visibility::evaluate_defect(defect, &pose, (&REFERENCE_CAMERA, &REFERENCE_LAMP), context.cast, &|_, _| 1e9);
            let air = || (context.clearance_m)(pose.position_m) >= CAMERA_CLEARANCE_M;
            let lit = || {
                let lamp = visibility::lamp_lux(&REFERENCE_LAMP, &pose, defect.position_m, defect.normal);
                let needed = visibility::required_illuminance_lux(&REFERENCE_CAMERA);
                lamp >= needed || lamp + (context.ambient)(defect.position_m, defect.normal) >= needed
            };
            (bright.is_some_and(|v| v.hit) && air() && lit()).then_some(pose)
        })
    })
}
