//! Transverse cracks in decks on girders, which restrain the deck when it shrinks and cools: the most frequent cracks in bridge decks, 1 to
//! 3 m apart, through the whole slab, so that water leaves lime beside them on the underside (NCHRP Report 380, "Transverse Cracking in
//! Newly Constructed Bridge Decks", 1996).

use super::place::{FaceAxes, Place, crack_code, spread};
use super::structure::{Structure, is_concrete};
use crate::elements::ElementGroup;
use crate::scenario::{DefectCause, StainSubstance};

/// Distances between places along and across the bridge, m.
const SPACING_M: (f64, f64) = (1.0, 0.6);
/// Maximum length, m (estimate: the width of a bay).
const MAX_LENGTH_M: f64 = 2.5;

/// Returns the places for cracks from shrinkage.
pub(super) fn places(structure: &Structure) -> Vec<Place> {
    let mut out = Vec::new();
    for (k, surface) in structure.surfaces.iter().enumerate() {
        let element = structure.element(surface);
        if element.group() != ElementGroup::Deck || !is_concrete(element) || !surface.is_underside() {
            continue;
        }
        let axes = FaceAxes::along(surface, structure.run(surface.member).frame.along);
        let points = spread(axes.u_m, SPACING_M.0)
            .into_iter()
            .flat_map(|u_m| spread(axes.v_m, SPACING_M.1).into_iter().map(move |v_m| (u_m, v_m)));
        out.extend(points.map(|(u_m, v_m)| Place {
            jitter_m: [axes.u * (0.5 * SPACING_M.0), axes.v * (0.5 * SPACING_M.1)],
            max_length_m: MAX_LENGTH_M,
            stain: Some(StainSubstance::Lime),
            ..Place::new(DefectCause::Shrinkage, crack_code(element), k, axes.point(u_m, v_m), axes.v)
        }));
    }
    out
}
