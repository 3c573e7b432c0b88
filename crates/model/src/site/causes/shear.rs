//! Cracks from shear: in the sides of a concrete beam near its supports, inclined by 45 degrees, perpendicular to the diagonal tension (ACI
//! 224.1R; the angle is that of a truss model with AASHTO LRFD 5.7.3.4.1, θ = 45 degrees).

use super::place::{FaceAxes, Place, crack_code, spread};
use super::structure::{Structure, Surface, is_concrete};
use crate::frames::Vec3;
use crate::scenario::DefectCause;

/// Share of the largest shear force from which a beam cracks (estimate).
const CRACKING_SHARE: f64 = 0.5;
/// Distances from the support between which cracks are, in beam depths (estimate: the support's pressure closes those that are nearer).
const DISTANCE_DEPTHS: (f64, f64) = (0.4, 2.0);
/// Distance between places along the axis, m.
const SPACING_M: f64 = 0.2;
/// Maximum length of a crack, in beam depths: from edge to edge, with a margin.
const MAX_LENGTH_DEPTHS: f64 = 1.2;

/// Returns the places for cracks from shear.
pub(super) fn places(structure: &Structure) -> Vec<Place> {
    let sides = structure.surfaces.iter().enumerate().filter(|(_, one)| one.is_side() && is_concrete(structure.element(one)));
    sides.flat_map(|(k, surface)| of_surface(structure, k, surface)).collect()
}

fn of_surface(structure: &Structure, k: usize, surface: &Surface) -> Vec<Place> {
    let run = structure.run(surface.member);
    let axis = run.frame.along;
    let Some((beam, peaks)) = run.beam.as_ref().filter(|_| surface.face.normal.dot(axis).abs() < 0.3) else { return Vec::new() };
    let axes = FaceAxes::along(surface, axis);
    let depth_m = run.extent.up_m.1 - run.extent.up_m.0;
    let code = crack_code(structure.element(surface));
    let mut out = Vec::new();
    for u_m in spread(axes.u_m, SPACING_M) {
        let point_m = axes.point(u_m, 0.5 * (axes.v_m.0 + axes.v_m.1));
        let x_m = point_m.dot(axis);
        let shear = beam.shear(x_m);
        let distance = beam.to_support_m(x_m) / depth_m;
        if shear.abs() < CRACKING_SHARE * peaks.shear || distance < DISTANCE_DEPTHS.0 || distance > DISTANCE_DEPTHS.1 {
            continue;
        }
        // Where the shear is positive, cracks rise along the axis.
        let along = (axis * shear.signum() + Vec3::new(0.0, 0.0, 1.0)).unit();
        out.push(Place {
            jitter_m: [axes.u * (0.5 * SPACING_M), axes.v * (0.1 * depth_m)],
            max_length_m: MAX_LENGTH_DEPTHS * axes.size_m().1,
            weight: shear.abs() / peaks.shear,
            ..Place::new(DefectCause::Shear, code, k, point_m, along)
        });
    }
    out
}
