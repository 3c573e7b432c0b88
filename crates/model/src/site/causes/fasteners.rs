//! Loose and missing fasteners at the field splices of steel girders. Splices are near the points of contraflexure of continuous girders,
//! where the moment is small (AASHTO LRFD 6.13.6.1.3a), and elsewhere near the quarter points of long spans (estimate).

use super::place::{FaceAxes, Place, spread};
use super::structure::{Run, Structure};
use crate::defect_codes::CONNECTION;
use crate::elements::{ElementGroup, ElementMaterial};
use crate::frames::Vec3;
use crate::scenario::DefectCause;

/// Minimum length of a simple span that has splices, m (estimate: longer girders can't be transported in one piece).
const MIN_SIMPLE_SPAN_M: f64 = 25.0;
/// Half length of a splice, m (estimate).
const HALF_SPLICE_M: f64 = 0.3;
/// Distances between places along and across, m.
const SPACING_M: (f64, f64) = (0.3, 0.2);

/// Returns the places for loose and missing fasteners.
pub(super) fn places(structure: &Structure) -> Vec<Place> {
    let mut out = Vec::new();
    for (k, surface) in structure.surfaces.iter().enumerate() {
        let element = structure.element(surface);
        let is_steel = element.group() == ElementGroup::Superstructure && element.material() == ElementMaterial::Steel;
        if !is_steel || !(surface.is_side() || surface.is_underside()) {
            continue;
        }
        let run = structure.run(surface.member);
        let axis = run.frame.along;
        if surface.face.normal.dot(axis).abs() > 0.3 {
            continue;
        }
        let axes = FaceAxes::along(surface, axis);
        for splice_m in splices_m(run) {
            let from_m = axes.point(axes.u_m.0, axes.v_m.0).dot(axis) - axes.u_m.0;
            let middle = splice_m - from_m;
            if middle < axes.u_m.0 || middle > axes.u_m.1 {
                continue;
            }
            let along = spread((middle - HALF_SPLICE_M, middle + HALF_SPLICE_M), SPACING_M.0);
            let points = along.into_iter().flat_map(|u_m| spread(axes.v_m, SPACING_M.1).into_iter().map(move |v_m| (u_m, v_m)));
            out.extend(points.map(|(u_m, v_m)| Place {
                jitter_m: [Vec3::zero(), axes.v * (0.4 * SPACING_M.1)],
                ..Place::new(DefectCause::Fasteners, CONNECTION, k, axes.point(u_m, v_m), axes.u)
            }));
        }
    }
    out
}

/// Returns the positions of a run's splices along its axis.
fn splices_m(run: &Run) -> Vec<f64> {
    let Some((beam, _)) = &run.beam else { return Vec::new() };
    let turns = beam.contraflexures_m();
    if !turns.is_empty() {
        return turns;
    }
    let long = beam.spans_m().filter(|(_, length_m)| *length_m >= MIN_SIMPLE_SPAN_M);
    long.flat_map(|(start_m, length_m)| [0.25, 0.75].map(|share| start_m + share * length_m)).collect()
}
