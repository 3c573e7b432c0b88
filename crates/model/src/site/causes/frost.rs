//! Stones that frost splits: water in their pores and beds freezes. Stones in the rain, such as those of parapets, and stones in the splash
//! zone are wet most often (CIRIA C656, "Masonry Arch Bridges: Condition Appraisal and Remedial Treatment", 2006).

use super::place::{FaceAxes, Place, spread};
use super::structure::{Structure, is_masonry};
use crate::defect_codes::SPLIT_STONE;
use crate::elements::ElementGroup;
use crate::scenario::DefectCause;

/// Distance between places, m.
const SPACING_M: f64 = 0.4;
/// Height of the splash zone above the water, m (estimate).
const SPLASH_M: f64 = 1.5;
/// Frequency on parapets and in the splash zone, relative to other walls (estimate).
const WET_FACTOR: f64 = 4.0;

/// Returns the places for split and spalled stones.
pub(super) fn places(structure: &Structure) -> Vec<Place> {
    let mut out = Vec::new();
    for (k, surface) in structure.surfaces.iter().enumerate() {
        let element = structure.element(surface);
        if !is_masonry(element) || !surface.is_side() {
            continue;
        }
        let axes = FaceAxes::of_wall(surface);
        for u_m in spread(axes.u_m, SPACING_M) {
            for v_m in spread(axes.v_m, SPACING_M) {
                let point_m = axes.point(u_m, v_m);
                let over_m = point_m.up() - structure.water_up_m;
                let is_wet = element.group() == ElementGroup::Railing || over_m < SPLASH_M;
                // The displacement from the grid does not lead below the water.
                if over_m < 0.5 * SPACING_M {
                    continue;
                }
                out.push(Place {
                    jitter_m: [axes.u * (0.5 * SPACING_M), axes.v * (0.5 * SPACING_M)],
                    weight: if is_wet { WET_FACTOR } else { 1.0 },
                    ..Place::new(DefectCause::Frost, SPLIT_STONE, k, point_m, axes.u)
                });
            }
        }
    }
    out
}
