//! Corrosion of cables: water that enters the wrapping runs down inside and leaves at the lowest parts, on the underside (NCHRP Report 534,
//! "Guidelines for Inspection and Strength Evaluation of Suspension Bridge Parallel-Wire Cables", 2004).

use super::place::{FaceAxes, Place, spread};
use super::structure::Structure;
use crate::defect_codes::CORROSION;
use crate::elements::ElementGroup;
use crate::frames::Vec3;
use crate::math;
use crate::scenario::DefectCause;

/// Distance between places along the cable, m.
const SPACING_M: f64 = 0.6;
/// Height above the lowest point within which the frequency falls by a factor of e, m (estimate).
const HEIGHT_SCALE_M: f64 = 3.0;
/// Largest upward component of a face's normal: the underside and the lower sides.
const MAX_UP: f64 = 0.1;
/// Minimum distance from the edges of a face, m. The faces of a cable approximate a round surface.
const MARGIN_M: f64 = 0.004;

/// Returns the places for corrosion of cables.
pub(super) fn places(structure: &Structure) -> Vec<Place> {
    let mut out = Vec::new();
    for (k, surface) in structure.surfaces.iter().enumerate() {
        let is_cable = structure.element(surface).group() == ElementGroup::Cable;
        if !is_cable || surface.face.normal.up() > MAX_UP {
            continue;
        }
        let run = structure.run(surface.member);
        let axes = FaceAxes::along(surface, surface.face.long_axis());
        let (length_m, width_m) = axes.size_m();
        if length_m < width_m {
            continue;
        }
        let middle_m = 0.5 * (axes.v_m.0 + axes.v_m.1);
        out.extend(spread(axes.u_m, SPACING_M).into_iter().map(|u_m| {
            let point_m = axes.point(u_m, middle_m);
            Place {
                jitter_m: [axes.u * (0.4 * SPACING_M), Vec3::zero()],
                max_width_m: width_m - 2.0 * MARGIN_M,
                margin_m: 0.5 * MARGIN_M,
                weight: math::exp(-(point_m.up() - run.extent.up_m.0) / HEIGHT_SCALE_M),
                ..Place::new(DefectCause::Cable, CORROSION, k, point_m, axes.u)
            }
        }));
    }
    out
}
