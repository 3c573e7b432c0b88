//! Cracks from bending: across the tension side of a concrete beam, where the moment exceeds the cracking moment. They start at the edge in
//! tension and are perpendicular to the axis (ACI 224.1R, "Causes, Evaluation, and Repair of Cracks in Concrete Structures").

use super::place::{Anchor, FaceAxes, Place, crack_code, spread};
use super::structure::{Structure, Surface};
use crate::scenario::DefectCause;

/// Share of the largest moment from which a beam cracks (estimate: a beam in service cracks in the middle of its spans and above its
/// supports).
const CRACKING_SHARE: f64 = 0.6;
/// Distance between places along the axis, m (estimate: cracks are about as far apart as the stirrups).
const SPACING_M: f64 = 0.25;
/// Maximum length of a crack in a side, as a share of its height: up to the compression zone (estimate).
const MAX_HEIGHT_SHARE: f64 = 0.75;

/// Returns the places for cracks from bending.
pub(super) fn places(structure: &Structure) -> Vec<Place> {
    let concrete = structure.surfaces.iter().enumerate().filter(|(_, one)| super::structure::is_concrete(structure.element(one)));
    concrete.flat_map(|(k, surface)| of_surface(structure, k, surface)).collect()
}

fn of_surface(structure: &Structure, k: usize, surface: &Surface) -> Vec<Place> {
    let run = structure.run(surface.member);
    let Some((beam, peaks)) = &run.beam else { return Vec::new() };
    let axis = run.frame.along;
    let is_end = surface.face.normal.dot(axis).abs() > 0.3;
    if is_end || !(surface.is_underside() || surface.is_side()) {
        return Vec::new();
    }
    let axes = FaceAxes::along(surface, axis);
    let code = crack_code(structure.element(surface));
    let mut out = Vec::new();
    for u_m in spread(axes.u_m, SPACING_M) {
        let middle_m = axes.point(u_m, 0.5 * (axes.v_m.0 + axes.v_m.1));
        let moment = beam.moment(middle_m.dot(axis));
        let share = peaks.share(moment);
        if share < CRACKING_SHARE || (surface.is_underside() && moment < 0.0) {
            continue;
        }
        let jitter_m = [axes.u * (0.5 * SPACING_M), axes.v * 0.0];
        let place =
            |point_m, along| Place { jitter_m, weight: share, ..Place::new(DefectCause::Bending, code, k, point_m, along) };
        if surface.is_underside() {
            out.push(Place { max_length_m: axes.size_m().1, ..place(middle_m, axes.v) });
        } else {
            // The lower edge is in tension below a sagging moment, the upper edge above a hogging one. Inclined edges are at their
            // own height.
            let up = if axes.v.up() > 0.0 { axes.v } else { -axes.v };
            let tension = if moment > 0.0 { -up } else { up };
            let Some(edge_m) = surface.face.boundary_m(middle_m, tension) else { continue };
            let max_length_m = MAX_HEIGHT_SHARE * axes.size_m().1;
            let place = Place { max_length_m, anchor: Anchor::Start, ..place(middle_m + tension * edge_m, -tension) };
            out.push(place);
        }
    }
    out
}
