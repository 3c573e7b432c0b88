//! Wear at the water line: ice, debris and sand wear the concrete of piers between low and high water, and wash the mortar out of masonry (FHWA
//! Bridge Inspector's Reference Manual, 2012).

use super::place::{FaceAxes, Place, spread};
use super::structure::{Structure, is_concrete, is_masonry};
use crate::defect_codes::{ABRASION, MORTAR};
use crate::elements::ElementGroup;
use crate::scenario::DefectCause;

/// Heights above the water between which concrete and masonry wear, m (estimate: waves and changes of the water level; below, it is not visible).
const BAND_M: (f64, f64) = (0.1, 1.1);
/// Distances between places, level and up, m.
const SPACING_M: (f64, f64) = (0.4, 0.25);

/// Returns the places for abrasion and washed-out mortar.
pub(super) fn places(structure: &Structure) -> Vec<Place> {
    let mut out = Vec::new();
    for (k, surface) in structure.surfaces.iter().enumerate() {
        let element = structure.element(surface);
        let kind = if is_concrete(element) { ABRASION } else { MORTAR };
        let wears = is_concrete(element) || is_masonry(element);
        if !surface.is_side() || !wears || element.group() != ElementGroup::Substructure {
            continue;
        }
        let axes = FaceAxes::of_wall(surface);
        // Walls are steep, so that the second coordinate differs from the height by a constant.
        let offset_m = axes.v_m.0 - axes.point(axes.u_m.0, axes.v_m.0).up();
        let in_water = axes.v_m.0 < structure.water_up_m + offset_m;
        let band = (structure.water_up_m + offset_m + BAND_M.0, axes.v_m.1.min(structure.water_up_m + offset_m + BAND_M.1));
        if !in_water || band.1 - band.0 < SPACING_M.1 {
            continue;
        }
        for u_m in spread(axes.u_m, SPACING_M.0) {
            out.extend(spread(band, SPACING_M.1).into_iter().map(|v_m| Place {
                jitter_m: [axes.u * (0.5 * SPACING_M.0), axes.v * (0.5 * SPACING_M.1)],
                max_width_m: BAND_M.1 - BAND_M.0,
                ..Place::new(DefectCause::WaterLine, kind, k, axes.point(u_m, v_m), axes.u)
            }));
        }
    }
    out
}
