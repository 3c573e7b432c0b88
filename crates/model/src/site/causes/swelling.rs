//! Map cracking of concrete that swells: alkali-silica reaction or frost. Both need water, so it is most frequent below joints and drains,
//! and on parts in the rain: walls, barriers, caps and columns (FHWA-HIF-09-004, "Report on the Diagnosis, Prognosis, and Mitigation of
//! Alkali-Silica Reaction in Transportation Structures", 2010).

use super::place::{FaceAxes, Place, crack_code, spread};
use super::structure::{Structure, is_concrete};
use crate::elements::ElementGroup;
use crate::scenario::DefectCause;

/// Distance between places, m.
const SPACING_M: f64 = 0.5;
/// Horizontal distance from a joint or drain up to which concrete is wet, m (estimate).
const WET_M: f64 = 1.5;
/// Frequency on wet concrete, relative to concrete in the rain (estimate).
const WET_FACTOR: f64 = 4.0;
/// Minimum side length of a pattern, m: fewer than a few cells don't make a map.
const MIN_SIDE_M: f64 = 0.35;

/// Returns the places for map cracking.
pub(super) fn places(structure: &Structure) -> Vec<Place> {
    let mut out = Vec::new();
    for (k, surface) in structure.surfaces.iter().enumerate() {
        let element = structure.element(surface);
        let outdoors = matches!(element.group(), ElementGroup::Substructure | ElementGroup::Railing);
        let axes = FaceAxes::of_wall(surface);
        let (u_m, v_m) = axes.size_m();
        if !outdoors || !is_concrete(element) || !surface.is_side() || u_m.min(v_m) < MIN_SIDE_M {
            continue;
        }
        for at in spread(axes.u_m, SPACING_M) {
            for height in spread(axes.v_m, SPACING_M) {
                let point_m = axes.point(at, height);
                out.push(Place {
                    line: false,
                    jitter_m: [axes.u * (0.5 * SPACING_M), axes.v * (0.5 * SPACING_M)],
                    weight: if structure.is_wet(point_m, WET_M) { WET_FACTOR } else { 1.0 },
                    ..Place::new(DefectCause::Swelling, crack_code(element), k, point_m, axes.u)
                });
            }
        }
    }
    out
}
