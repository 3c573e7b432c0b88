//! Camera poses for close-up pictures of a spot on a surface, as teaching material needs them: at a given distance, with a clear
//! line of sight and room for the aircraft.

use super::camera_pose::CameraPose;
use super::reference_camera::{CAMERA_CLEARANCE_M, camera_aimed_at};
use super::{QueryTime, Site};
use crate::frames::{Enu, Vec3};
use crate::math;

/// A spot on a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceSpot {
    /// Position, m.
    pub position_m: Vec3<Enu>,
    /// Outward unit normal of the surface.
    pub normal: Vec3<Enu>,
}

/// Angles between the optical axis and the normal that are tried in this order, rad (estimate: the picture hardly differs from a
/// frontal one up to the last angle).
const INCIDENCES_RAD: [f64; 3] = [0.0, math::PI / 9.0, math::PI / 5.0];
/// Number of directions about the normal that are tried for each angle.
const DIRECTION_COUNT: usize = 8;
/// Height above the surface at which the line of sight ends, m.
const SURFACE_OFFSET_M: f64 = 0.02;

/// Returns the pose of a roll-free camera with its lamp on, at a distance from a spot and aimed at it: as frontal as the
/// surroundings permit. `None` if something is in the way, or if an aircraft has no room there.
#[must_use]
pub fn close_up_pose(site: &Site, spot: SurfaceSpot, distance_m: f64, at: QueryTime) -> Option<CameraPose> {
    directions(spot.normal).find_map(|direction| {
        let from = spot.position_m + spot.normal * SURFACE_OFFSET_M;
        let eye = spot.position_m + direction * distance_m;
        let line = eye - from;
        let clear = site.ray(from, line.unit(), line.norm(), at).is_none();
        // The distance itself may be smaller than the room that an aircraft needs.
        let room_m = CAMERA_CLEARANCE_M.min(distance_m * math::cos(INCIDENCES_RAD[INCIDENCES_RAD.len() - 1]));
        let free = site.nearest(eye, room_m, at).is_none_or(|near| near.distance_m >= room_m);
        (clear && free).then(|| camera_aimed_at(eye, spot.position_m))
    })
}

/// Returns unit vectors away from a surface, the most frontal ones first.
fn directions(normal: Vec3<Enu>) -> impl Iterator<Item = Vec3<Enu>> {
    let (first, second) = super::light::tangent_vectors(normal);
    INCIDENCES_RAD.into_iter().flat_map(move |incidence| {
        let count = if incidence == 0.0 { 1 } else { DIRECTION_COUNT };
        (0..count).map(move |k| {
            let (s, c) = math::sin_cos(math::TAU * k as f64 / DIRECTION_COUNT as f64);
            let (tilt_sin, tilt_cos) = math::sin_cos(incidence);
            normal * tilt_cos + (first * c + second * s) * tilt_sin
        })
    })
}
