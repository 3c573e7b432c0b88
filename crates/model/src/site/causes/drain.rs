//! Damage beside deck drains: corrosion of the girder beside a pipe, which leaks and splashes, and efflorescence on the deck's underside
//! around its inlet (FHWA Bridge Inspector's Reference Manual, 2012).

use super::place::{FaceAxes, Place, spread};
use super::structure::{Structure, Surface, WaterSource, is_concrete};
use crate::defect_codes::{CORROSION, EFFLORESCENCE};
use crate::elements::{ElementGroup, ElementMaterial};
use crate::math;
use crate::scenario::DefectCause;

/// Horizontal distance from the drain up to which steel corrodes, m (estimate: splashing water).
const STEEL_REACH_M: f64 = 0.9;
/// Horizontal distance from the inlet up to which the deck leaks, m (estimate).
const DECK_REACH_M: f64 = 0.6;
/// Distance between places, m.
const SPACING_M: f64 = 0.15;
/// Frequency of corrosion relative to efflorescence (estimate).
const STEEL_WEIGHT: f64 = 0.5;

/// Returns the places for damage beside drains.
pub(super) fn places(structure: &Structure) -> Vec<Place> {
    structure.surfaces.iter().enumerate().flat_map(|(k, surface)| of_surface(structure, k, surface)).collect()
}

fn of_surface(structure: &Structure, k: usize, surface: &Surface) -> Vec<Place> {
    let element = structure.element(surface);
    let is_deck = element.group() == ElementGroup::Deck && is_concrete(element) && surface.is_underside();
    let is_girder = element.group() == ElementGroup::Superstructure && element.material() == ElementMaterial::Steel;
    let (code, reach_m, weight) = match (is_deck, is_girder && (surface.is_side() || surface.is_underside())) {
        (true, _) => (EFFLORESCENCE, DECK_REACH_M, 1.0),
        (false, true) => (CORROSION, STEEL_REACH_M, STEEL_WEIGHT),
        (false, false) => return Vec::new(),
    };
    let axes = FaceAxes::along(surface, structure.run(surface.member).frame.along);
    let radius_m = 0.5 * math::hypot(axes.size_m().0, axes.size_m().1);
    let reachable = |drain: &&WaterSource| drain.level_distance_m(surface.face.point_m) <= radius_m + reach_m;
    let near: Vec<&WaterSource> = structure.drains.iter().filter(reachable).collect();
    if near.is_empty() {
        return Vec::new();
    }
    let points = spread(axes.u_m, SPACING_M)
        .into_iter()
        .flat_map(|u_m| spread(axes.v_m, SPACING_M).into_iter().map(move |v_m| axes.point(u_m, v_m)));
    // The pipe begins at the deck's underside, so that the height doesn't matter there.
    let wet = points.filter(|point| near.iter().any(|drain| drain.level_distance_m(*point) <= reach_m));
    wet.map(|point| Place {
        jitter_m: [axes.u * (0.5 * SPACING_M), axes.v * (0.5 * SPACING_M)],
        weight,
        ..Place::new(DefectCause::Drain, code, k, point, axes.u)
    })
    .collect()
}
