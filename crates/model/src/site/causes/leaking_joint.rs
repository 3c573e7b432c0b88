//! Damage below leaking deck joints: efflorescence and rust stains that run down caps and abutments, and corrosion with section loss at the
//! ends of girders, on their webs just above the bottom flange, and on bearings (FHWA Bridge Inspector's Reference Manual, 2012; the ends
//! of beams corrode most within about their depth from the joint: Tzortzinis et al., "Development of Load Rating Procedures for
//! Deteriorated Steel Beam Ends", MassDOT 19-008, 2019).

use super::place::{Anchor, FaceAxes, Place, spread};
use super::structure::{Structure, Surface, WaterSource, is_concrete};
use crate::defect_codes::{CORROSION, EFFLORESCENCE};
use crate::elements::{ElementGroup, ElementMaterial};
use crate::frames::Vec3;
use crate::scenario::DefectCause;

/// Horizontal distance from the joint up to which water runs down concrete, m (estimate: to the front of the seat).
const CONCRETE_REACH_M: f64 = 2.0;
/// Horizontal distance from the joint up to which steel corrodes, in girder depths.
const STEEL_REACH_DEPTHS: f64 = 1.2;
/// Minimum of that distance, m, for bearings and shallow beams.
const MIN_STEEL_REACH_M: f64 = 1.0;
/// Share of a web's height, from below, in which it corrodes: splash and debris on the bottom flange keep it wet (estimate).
const WEB_SHARE: f64 = 0.35;
/// Distance between places, m.
const SPACING_M: f64 = 0.3;
/// Frequency of corrosion relative to stains (estimate; there are fewer places for it).
const STEEL_WEIGHT: f64 = 4.0;

/// Returns the places for damage below joints.
pub(super) fn places(structure: &Structure) -> Vec<Place> {
    let mut out = Vec::new();
    for (k, surface) in structure.surfaces.iter().enumerate() {
        for joint in &structure.joints {
            out.extend(of_surface(structure, joint, (k, surface)));
        }
    }
    out
}

fn of_surface(structure: &Structure, joint: &WaterSource, (k, surface): (usize, &Surface)) -> Vec<Place> {
    let element = structure.element(surface);
    let is_steel = element.material() == ElementMaterial::Steel && element.group() != ElementGroup::Railing;
    if surface.is_side() && is_concrete(element) && element.group() == ElementGroup::Substructure {
        on_wall(joint, (k, surface))
    } else if is_steel && surface.is_side() {
        on_web(structure, joint, (k, surface))
    } else if is_steel && surface.is_underside() {
        on_flange(structure, joint, (k, surface))
    } else {
        Vec::new()
    }
}

/// Returns the places for stains that begin at the top of a wall.
fn on_wall(joint: &WaterSource, (k, surface): (usize, &Surface)) -> Vec<Place> {
    let axes = FaceAxes::of_wall(surface);
    let starts = spread(axes.u_m, SPACING_M).into_iter().map(|u_m| axes.point(u_m, axes.v_m.1));
    let wet = starts.filter(|start| joint.is_above(*start, CONCRETE_REACH_M));
    wet.map(|start| Place {
        anchor: Anchor::Start,
        jitter_m: [axes.u * (0.5 * SPACING_M), Vec3::zero()],
        max_length_m: axes.size_m().1,
        ..Place::new(DefectCause::LeakingJoint, EFFLORESCENCE, k, start, -axes.v)
    })
    .collect()
}

fn steel_reach_m(structure: &Structure, surface: &Surface) -> f64 {
    let extent = structure.run(surface.member).extent;
    (STEEL_REACH_DEPTHS * (extent.up_m.1 - extent.up_m.0)).max(MIN_STEEL_REACH_M)
}

fn on_web(structure: &Structure, joint: &WaterSource, (k, surface): (usize, &Surface)) -> Vec<Place> {
    let axes = FaceAxes::of_wall(surface);
    let (low, high) = axes.v_m;
    let heights = spread((low, low + WEB_SHARE * (high - low)), SPACING_M);
    let points = spread(axes.u_m, SPACING_M).into_iter().flat_map(|u_m| heights.iter().map(move |v_m| axes.point(u_m, *v_m)));
    let reach_m = steel_reach_m(structure, surface);
    let near = points.filter(|point| joint.is_above(*point, reach_m));
    near.map(|point| Place {
        jitter_m: [axes.u * (0.5 * SPACING_M), axes.v * (0.3 * SPACING_M)],
        max_width_m: WEB_SHARE * (high - low),
        weight: STEEL_WEIGHT,
        ..Place::new(DefectCause::LeakingJoint, CORROSION, k, point, axes.u)
    })
    .collect()
}

fn on_flange(structure: &Structure, joint: &WaterSource, (k, surface): (usize, &Surface)) -> Vec<Place> {
    let axes = FaceAxes::along(surface, structure.run(surface.member).frame.along);
    let middle_m = 0.5 * (axes.v_m.0 + axes.v_m.1);
    let reach_m = steel_reach_m(structure, surface);
    let near = spread(axes.u_m, SPACING_M).into_iter().map(|u_m| axes.point(u_m, middle_m));
    near.filter(|point| joint.is_above(*point, reach_m))
        .map(|point| Place {
            jitter_m: [axes.u * (0.5 * SPACING_M), axes.v * (0.2 * axes.size_m().1)],
            weight: STEEL_WEIGHT,
            ..Place::new(DefectCause::LeakingJoint, CORROSION, k, point, axes.u)
        })
        .collect()
}
