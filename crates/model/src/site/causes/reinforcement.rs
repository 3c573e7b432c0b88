//! Damage by rusting reinforcement: cracks along bars, spalls over bars and exposed bars. They follow the grid of the bars, and are most
//! frequent where chlorides come with water from the deck (ACI 222R, "Guide to Protection of Reinforcing Steel in Concrete against
//! Corrosion").

use super::place::{FaceAxes, Place, crack_code, spread};
use super::structure::{Structure, Surface, is_concrete};
use crate::defect_codes::{REBAR, SPALL};
use crate::elements::{ElementGroup, ElementMaterial};
use crate::scenario::{DefectCause, StainSubstance};

/// Distance of the first bar's axis from the edge of a face, m (estimate: 2 in of cover and half a bar).
pub(super) const FIRST_BAR_M: f64 = 0.06;
/// Distance between bars, m (docs/src/reference/domain.md, "Defects": 0.1 to 0.3 m).
pub(super) const BAR_SPACING_M: f64 = 0.2;
/// Distance between places along a bar, m.
const SPACING_M: f64 = 0.6;
/// Number of bars from one with places to the next.
const BAR_STEP: i32 = 2;
/// Horizontal distance from a joint or drain up to which chlorides reach concrete, m (estimate).
const WET_M: f64 = 2.0;
/// Frequency on wet concrete relative to dry concrete (estimate).
const WET_FACTOR: f64 = 5.0;

/// Returns the places for damage by rusting reinforcement.
pub(super) fn places(structure: &Structure) -> Vec<Place> {
    structure.surfaces.iter().enumerate().flat_map(|(k, surface)| of_surface(structure, k, surface)).collect()
}

fn of_surface(structure: &Structure, k: usize, surface: &Surface) -> Vec<Place> {
    let element = structure.element(surface);
    let has_bars = !matches!(element.group(), ElementGroup::ApproachSlab | ElementGroup::Protection);
    if !is_concrete(element) || !has_bars || !(surface.is_side() || surface.is_underside()) {
        return Vec::new();
    }
    let axes = bar_axes(structure, surface);
    let count = ((axes.size_m().1 - 2.0 * FIRST_BAR_M) / BAR_SPACING_M).floor() as i32;
    let bars = (0..=count).step_by(BAR_STEP as usize).map(|bar| axes.v_m.0 + FIRST_BAR_M + BAR_SPACING_M * f64::from(bar));
    let points = bars.flat_map(|v_m| spread(axes.u_m, SPACING_M).into_iter().map(move |u_m| axes.point(u_m, v_m)));
    let mut out = Vec::new();
    for point_m in points {
        let weight = if structure.is_wet(point_m, WET_M) { WET_FACTOR } else { 1.0 };
        let stain = surface.is_side().then_some(StainSubstance::Rust);
        let place = |kind| Place {
            jitter_m: [axes.u * (0.5 * SPACING_M), axes.v * 0.0],
            weight,
            stain,
            ..Place::new(DefectCause::Reinforcement, kind, k, point_m, axes.u)
        };
        out.push(place(SPALL));
        out.push(place(REBAR));
        if element.material() == ElementMaterial::ReinforcedConcrete {
            out.push(Place { weight: 0.5 * weight, ..place(crack_code(element)) });
        }
    }
    out
}

/// Returns the axes of a face with its outer bars along the first one: across a deck, along a beam, and level in a wall.
fn bar_axes(structure: &Structure, surface: &Surface) -> FaceAxes {
    let frame = structure.run(surface.member).frame;
    let is_deck = structure.element(surface).group() == ElementGroup::Deck;
    if surface.is_side() {
        FaceAxes::of_wall(surface)
    } else if is_deck {
        FaceAxes::along(surface, frame.across)
    } else {
        FaceAxes::along(surface, frame.along)
    }
}
