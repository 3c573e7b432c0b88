//! Fatigue cracks at the ends of the welds that connect stiffeners and connection plates to webs: along the weld's toe, near the flange in
//! tension (Dexter and Ocel, "Manual for Repair and Retrofit of Fatigue Cracks in Steel Bridges", FHWA-IF-13-020, 2013).

use super::frame::overlap_m;
use super::place::{Anchor, FaceAxes, Place};
use super::structure::{Structure, Surface};
use crate::defect_codes::FATIGUE;
use crate::elements::{ElementGroup, ElementMaterial};
use crate::frames::{Enu, Vec3};
use crate::math;
use crate::scenario::DefectCause;
use crate::scenario::bridges::Member;

/// Maximum thickness of a plate that is welded to a web, m.
const MAX_PLATE_M: f64 = 0.05;
/// Minimum length of the weld, m.
const MIN_WELD_M: f64 = 0.3;
/// Distance of the crack from the plate, m: the leg of the weld and a little more (estimate).
const TOE_M: f64 = 0.012;
/// Minimum distance of the crack from other surfaces, m.
const MARGIN_M: f64 = 0.006;
/// Distance of the crack's start from the end of the plate, m (estimate: welds stop short of the flange).
const END_M: f64 = 0.02;
/// Maximum gap between plate and web, m.
const GAP_M: f64 = 0.002;
/// Minimum share of the largest moment at a crack (estimate).
const MIN_MOMENT_SHARE: f64 = 0.3;

/// Returns the places for fatigue cracks.
pub(super) fn places(structure: &Structure) -> Vec<Place> {
    let mut out = Vec::new();
    for (k, surface) in structure.surfaces.iter().enumerate() {
        let element = structure.element(surface);
        let is_web = element.group() == ElementGroup::Superstructure && element.material() == ElementMaterial::Steel;
        if !is_web || !surface.is_side() || structure.run(surface.member).beam.is_none() {
            continue;
        }
        let axes = FaceAxes::of_wall(surface);
        if axes.size_m().0.min(axes.size_m().1) >= MIN_WELD_M {
            out.extend(
                plates(structure, surface, &axes).into_iter().flat_map(|plate| at_plate(structure, (k, surface), &axes, plate)),
            );
        }
    }
    out
}

/// A plate on a web, in the axes of the web's face: its sides and its lower and upper end, m.
#[derive(Debug, Clone, Copy)]
struct Plate {
    u_m: (f64, f64),
    v_m: (f64, f64),
}

fn plates(structure: &Structure, surface: &Surface, axes: &FaceAxes) -> Vec<Plate> {
    let normal = surface.face.normal;
    let web_m = surface.face.point_m.dot(normal);
    let of_member = |member: &Member| {
        let range = |direction: Vec3<Enu>| math::range(member.solid.vertices_m.iter().map(|vertex| vertex.dot(direction)));
        let (u_m, v_m, n_m) = (range(axes.u), range(axes.v), range(normal));
        let touches = (n_m.0 - web_m).abs() < GAP_M && n_m.1 > web_m + MAX_PLATE_M;
        let is_plate = u_m.1 - u_m.0 < MAX_PLATE_M && overlap_m(v_m, axes.v_m) >= MIN_WELD_M;
        (touches && is_plate && overlap_m(u_m, axes.u_m) > -GAP_M).then_some(Plate { u_m, v_m })
    };
    structure.members.iter().filter(|member| member.element.material() == ElementMaterial::Steel).filter_map(of_member).collect()
}

/// Returns the places at one plate: beside both of its sides, at the end that is in tension.
fn at_plate(structure: &Structure, (k, surface): (usize, &Surface), axes: &FaceAxes, plate: Plate) -> Vec<Place> {
    let run = structure.run(surface.member);
    let Some((beam, peaks)) = &run.beam else { return Vec::new() };
    let moment = beam.moment(axes.point(plate.u_m.0, plate.v_m.0).dot(run.frame.along));
    let share = peaks.share(moment);
    if share < MIN_MOMENT_SHARE {
        return Vec::new();
    }
    let (end_m, inward) = if moment > 0.0 { (plate.v_m.0 + END_M, axes.v) } else { (plate.v_m.1 - END_M, -axes.v) };
    let end_m = end_m.clamp(axes.v_m.0 + END_M, axes.v_m.1 - END_M);
    let sides = [(plate.u_m.0 - TOE_M, axes.u), (plate.u_m.1 + TOE_M, -axes.u)];
    sides
        .into_iter()
        .map(|(u_m, to_plate)| {
            // The weld is drawn on the side of the crack that is opposite to normal × along, so the direction is chosen for it to be at
            // the plate.
            let weld_side = -surface.face.normal.cross(inward);
            let (along, anchor) = if weld_side.dot(to_plate) > 0.0 { (inward, Anchor::Start) } else { (-inward, Anchor::End) };
            Place {
                anchor,
                margin_m: MARGIN_M,
                weight: share,
                max_length_m: 0.5 * (axes.v_m.1 - axes.v_m.0),
                ..Place::new(DefectCause::Weld, FATIGUE, k, axes.point(u_m, end_m), along)
            }
        })
        .collect()
}
