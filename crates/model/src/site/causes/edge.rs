//! Spalls at edges: where bearings press on the edge of a pedestal or cap, and at the lower edges of a deck's sides, where water drips off
//! (FHWA Bridge Inspector's Reference Manual, 2012).

use super::place::{Anchor, FaceAxes, Place, spread};
use super::structure::{Structure, Surface, is_concrete};
use crate::defect_codes::SPALL;
use crate::elements::ElementGroup;
use crate::frames::{Enu, Vec3};
use crate::scenario::{DefectCause, StainSubstance};

/// Distance of the spall from the edge, m (the ragged outline of a spall needs it).
const MARGIN_M: f64 = 0.012;
/// Height between the top of a face and the bearing on it, m.
const BEARING_GAP_M: f64 = 0.05;
/// Horizontal distance of a bearing from the face below it, m (estimate: the load spreads at 45 degrees through the cover).
const BEARING_DISTANCE_M: f64 = 0.25;
/// Distance between places, m.
const SPACING_M: f64 = 0.2;
/// Frequency below bearings relative to a deck's edges (estimate).
const BEARING_WEIGHT: f64 = 8.0;
/// Maximum width, as a share of the face's height (estimate).
const MAX_HEIGHT_SHARE: f64 = 0.7;

/// Returns the places for spalls at edges.
pub(super) fn places(structure: &Structure) -> Vec<Place> {
    let sides = structure.surfaces.iter().enumerate().filter(|(_, one)| one.is_side() && is_concrete(structure.element(one)));
    sides.flat_map(|(k, surface)| of_surface(structure, k, surface)).collect()
}

fn of_surface(structure: &Structure, k: usize, surface: &Surface) -> Vec<Place> {
    let axes = FaceAxes::of_wall(surface);
    let (from_edge, edge_m, stain) = match structure.element(surface).group() {
        ElementGroup::Substructure => (-axes.v, axes.v_m.1, Some(StainSubstance::Rust)),
        ElementGroup::Deck => (axes.v, axes.v_m.0, None),
        ElementGroup::Superstructure
        | ElementGroup::Cable
        | ElementGroup::Joint
        | ElementGroup::Bearing
        | ElementGroup::ApproachSlab
        | ElementGroup::Railing
        | ElementGroup::Protection
        | ElementGroup::Unlisted => return Vec::new(),
    };
    let is_deck = stain.is_none();
    let bearings = bearings_above(structure, axes.point(0.0, edge_m).up());
    let points = spread(axes.u_m, SPACING_M).into_iter().map(|u_m| axes.point(u_m, edge_m));
    let loaded = points.filter(|point| is_deck || bearings.iter().any(|center| is_below(*point, *center)));
    loaded
        .map(|point| Place {
            anchor: Anchor::Side(from_edge),
            jitter_m: [axes.u * (0.5 * SPACING_M), Vec3::zero()],
            max_width_m: MAX_HEIGHT_SHARE * axes.size_m().1,
            margin_m: MARGIN_M,
            weight: if is_deck { 1.0 } else { BEARING_WEIGHT },
            stain,
            ..Place::new(DefectCause::Edge, SPALL, k, point, axes.u)
        })
        .collect()
}

/// Returns the center and the radius in plan of the bearings whose underside is at a height.
fn bearings_above(structure: &Structure, up_m: f64) -> Vec<(Vec3<Enu>, f64)> {
    let bearings = structure.members.iter().filter(|member| member.element.group() == ElementGroup::Bearing);
    bearings
        .filter_map(|member| {
            let vertices = &member.solid.vertices_m;
            let low_m = vertices.iter().map(|vertex| vertex.up()).fold(f64::INFINITY, f64::min);
            let center = vertices.iter().fold(Vec3::zero(), |sum, vertex| sum + *vertex) / vertices.len().max(1) as f64;
            let radius_m = vertices.iter().map(|vertex| (*vertex - center).horizontal_norm()).fold(0.0, f64::max);
            ((low_m - up_m).abs() < BEARING_GAP_M).then_some((center, radius_m))
        })
        .collect()
}

fn is_below(point_m: Vec3<Enu>, (center, radius_m): (Vec3<Enu>, f64)) -> bool {
    (point_m - center).horizontal_norm() < radius_m + BEARING_DISTANCE_M
}
