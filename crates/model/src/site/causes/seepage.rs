//! Seepage through a masonry arch: rain enters the fill below the road, dissolves lime and washes the mortar out. It leaves through the barrel
//! and through the spandrel walls, most of all near their lower ends, where the fill collects it (FHWA Bridge Inspector's Reference Manual,
//! 2012; CIRIA C656, "Masonry Arch Bridges: Condition Appraisal and Remedial Treatment", 2006).

use super::place::{FaceAxes, Place, spread};
use super::structure::{Structure, Surface, is_masonry};
use crate::defect_codes::{EFFLORESCENCE, MORTAR};
use crate::elements::ElementGroup;
use crate::frames::Vec3;
use crate::scenario::{DefectCause, StainSubstance};

/// Distances between places, along the first and the second side of a face, m.
const SPACING_M: (f64, f64) = (0.4, 0.5);
/// Minimum height of a wall in which mortar is missing, m: the faces of voussoirs, which are lower, have no courses (estimate).
const MIN_WALL_M: f64 = 1.3;
/// Largest upward component of the normal of a face from which water drips.
const MAX_UP: f64 = -0.3;
/// Frequency at the foot of a wall relative to its top (estimate).
const FOOT_FACTOR: f64 = 3.0;

/// Returns the places for efflorescence and washed-out mortar.
pub(super) fn places(structure: &Structure) -> Vec<Place> {
    structure.surfaces.iter().enumerate().flat_map(|(k, surface)| of_surface(structure, k, surface)).collect()
}

fn of_surface(structure: &Structure, k: usize, surface: &Surface) -> Vec<Place> {
    let element = structure.element(surface);
    // Parapets stand above the fill, piers below it.
    if !is_masonry(element) || element.group() != ElementGroup::Superstructure {
        return Vec::new();
    }
    if surface.is_side() {
        on_wall(k, surface)
    } else if surface.face.normal.up() < MAX_UP {
        below_barrel(k, surface)
    } else {
        Vec::new()
    }
}

/// Returns the places on a spandrel wall: lime runs down from a joint, and the mortar is missing where water came out.
fn on_wall(k: usize, surface: &Surface) -> Vec<Place> {
    let axes = FaceAxes::of_wall(surface);
    let (low, high) = axes.v_m;
    let mut out = Vec::new();
    for u_m in spread(axes.u_m, SPACING_M.0) {
        for v_m in spread((low, high), SPACING_M.1) {
            let share = (v_m - low) / (high - low);
            let place = |kind| Place {
                jitter_m: [axes.u * (0.4 * SPACING_M.0), axes.v * (0.4 * SPACING_M.1)],
                max_width_m: axes.size_m().0,
                weight: 1.0 + (FOOT_FACTOR - 1.0) * (1.0 - share),
                ..Place::new(DefectCause::Seepage, kind, k, axes.point(u_m, v_m), -axes.v)
            };
            out.push(place(EFFLORESCENCE));
            if high - low > MIN_WALL_M {
                out.push(Place { stain: Some(StainSubstance::Lime), ..place(MORTAR) });
            }
        }
    }
    out
}

/// Returns the places below a barrel: lime at the joints between the voussoirs.
fn below_barrel(k: usize, surface: &Surface) -> Vec<Place> {
    let axes = FaceAxes::along(surface, surface.face.long_axis());
    let middle_m = 0.5 * (axes.v_m.0 + axes.v_m.1);
    spread(axes.u_m, SPACING_M.0)
        .into_iter()
        .map(|u_m| Place {
            jitter_m: [axes.u * (0.5 * SPACING_M.0), Vec3::zero()],
            max_width_m: axes.size_m().1,
            ..Place::new(DefectCause::Seepage, EFFLORESCENCE, k, axes.point(u_m, middle_m), axes.u)
        })
        .collect()
}
