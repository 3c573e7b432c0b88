//! Writes a job at an imported bridge: level ground, a path along each side of the deck and, if there is room, one below it.
//!
//! The landing pad is beyond the start of the bridge, and the paths are flown in an order in which no way from one to the next, or back to
//! the pad, crosses another one. Otherwise, a task's window would also contain the flight along others.

use crate::elements::Element;
use crate::frames::Vec3;
use crate::mesh::part_shapes::PartShape;
use crate::mesh::plane_solid::PlaneSolid;
use crate::mesh::surface_mesh::SurfaceMesh;
use crate::mesh::vectors::Point;
use crate::scenario::MAX_TERRAIN_M;
use crate::scenario::bridges::model::{ModelExtent, ModelPart};
use crate::scenario::bridges::{Solid, SolidSurface};
use crate::site::member_shape::MemberShape;
use std::fmt::Write;

/// Name of the file with the parts in the folder of an imported bridge.
pub const MODEL_FILE: &str = "bridge.glb";
/// Name of the file with the elements.
pub const ELEMENTS_FILE: &str = "elements.toml";
/// Name of the job's file.
pub const SCENARIO_FILE: &str = "scenario.toml";
/// Distance of the paths from the outermost parts, m (estimate: 1 m more than the usual stand-off, because parts stick out).
const STAND_OFF_M: f64 = 5.0;
/// Distance of the landing pad from the stand-off at the start of the bridge, m (estimate).
const PAD_DISTANCE_M: f64 = 20.0;
/// Distance of the inspector from the landing pad, away from the bridge, m (estimate).
const INSPECTOR_DISTANCE_M: f64 = 4.0;
/// Minimum height of the paths above the ground, m (estimate).
const MIN_HEIGHT_M: f64 = 4.0;
/// Distance of the path below the deck from the lowest girder, m (the usual stand-off).
const BELOW_DECK_M: f64 = 4.0;
/// Distance that the camera looks ahead below the deck, m (estimate, as under girders).
const AHEAD_M: f64 = 0.3 * BELOW_DECK_M;
/// Minimum distance of the path below the deck from all parts, m (estimate: 1 m more than the too-close warning).
const MIN_CLEARANCE_M: f64 = 3.5;
/// Minimum height of the path below the deck above the ground, m (estimate: 0.5 m more than the too-close warning).
const MIN_HEIGHT_BELOW_DECK_M: f64 = 3.0;
/// Spacing of the points at which the path below the deck is tested, m.
const STEP_M: f64 = 0.5;
/// Minimum length of the path below the deck, m (estimate: a shorter one is no task).
const MIN_LENGTH_M: f64 = 6.0;
/// Depth of the lowest part's underside in the ground, m (estimate: so that no light passes below it).
const EMBEDMENT_M: f64 = 0.1;
/// Width of the ground around the bridge, m (estimate).
const SURROUNDINGS_M: f64 = 150.0;
/// Number of defects, if the simulator has any for the elements of the bridge.
const DEFECTS: usize = 6;

/// Returns the largest distance of the bridge, its paths and the landing pad from the origin of the bridge axes along x or y, m.
/// `low` and `high` are the corners of the bounding box of all parts in bridge axes.
fn reach_m(low: Point, high: Point) -> f64 {
    [low[0], low[1], high[0], high[1]].iter().fold(0.0_f64, |most, v| most.max(v.abs())) + STAND_OFF_M + PAD_DISTANCE_M
}

/// Checks that a bridge with this bounding box in bridge axes, the paths and the team fit on the largest terrain.
///
/// # Errors
/// Returns the distance from the origin and the allowed one.
pub(super) fn check_reach(low: Point, high: Point) -> Result<(), String> {
    let (reach_m, max_m) = (reach_m(low, high) + INSPECTOR_DISTANCE_M, 0.5 * MAX_TERRAIN_M);
    if reach_m <= max_m {
        return Ok(());
    }
    let words = "set --origin center, or divide the model into several";
    Err(format!("the bridge and the landing pad reach {reach_m:.1} m from the origin (allowed: at most {max_m:.1} m; {words})"))
}

/// Returns the text of the job. The bridge's x axis points east. `origin_m` is the point of the model at the origin of the bridge axes, if
/// it is not the middle of the deck's upper surface.
pub(super) fn scenario_toml(name: &str, parts: &[ModelPart], extent: &ModelExtent, origin_m: Option<Point>) -> String {
    let (low, high) = extent.whole;
    let center_up_m = -low[2] - EMBEDMENT_M;
    let west_m = low[0] - STAND_OFF_M - PAD_DISTANCE_M;
    let size_m = ((2.0 * (reach_m(low, high) + SURROUNDINGS_M) / 100.0).ceil() * 100.0).min(MAX_TERRAIN_M);
    let has_defects = parts.iter().any(|part| !part.element.permitted_defects().is_empty());
    let origin = origin_m.map_or_else(
        || "the middle of the deck's upper surface".to_owned(),
        |[x, y, z]| format!("the point {x:.3}, {y:.3}, {z:.3} of the model"),
    );
    let mut text = format!(
        "# A job at an imported bridge, written by `spandrel import`. Change it as you like; every key is described in the documentation.\n\
         format = 1\nname = \"{name}\"\ntitle = \"Inspection of {name}\"\n\n\
         # Place of the bridge: latitude and longitude of its origin (here, Purdue University).\n\
         [origin]\nlatitude_deg = 40.4237\nlongitude_deg = -86.9212\naltitude_m = 187.0\n\n\
         [terrain]\nsize_m = {size_m:.1}\nspacing_m = {spacing_m:.1}\nwater_level_m = -50.0\nsource = \"flat\"\nheight_m = -0.05\n\n\
         # The landing pad is beyond the start of the bridge, so that no flight to or from it crosses a path.\n\
         [ground_team]\npad_m = [{west_m:.2}, 0.0, 0.0]\ninspector_m = [{inspector_m:.2}, -6.0, -0.05]\n\
         truck_m = [{truck_m:.2}, -9.0, -0.05]\nhome_radius_m = 5.0\n\n\
         # The origin of the bridge axes is {origin}; x points along the deck, y to its left, z up.\n\
         [[bridges]]\nname = \"{name}\"\ntype = \"model\"\ncentre_m = [0.0, 0.0, {center_up_m:.3}]\nheading_deg = 90.0\n\n\
         [bridges.model]\nfile = \"{model}\"\nelements = \"{elements}\"\n",
        spacing_m = (size_m / 200.0).max(4.0),
        inspector_m = west_m - INSPECTOR_DISTANCE_M,
        truck_m = west_m + 3.0,
        model = MODEL_FILE,
        elements = ELEMENTS_FILE,
    );
    text.push_str("\n# Points are in the axes of the bridge; look_at_m is what the camera looks at from each of them.\n");
    let mut add_task = |words: &str, path: [[Point; 2]; 2], more: &str| {
        let [points, look_at] = path.map(|list| list.map(shown).join(", "));
        let _ = write!(
            text,
            "[[tasks]]\nname = \"{words} of the deck\"\nkind = \"free\"\npoints_relative_to = \"{name}\"\n{more}\
             points_m = [{points}]\nlook_at_m = [{look_at}]\n\n"
        );
    };
    let (right, mut left) = (side(extent, center_up_m, false), side(extent, center_up_m, true));
    let underside = underside(parts, extent, center_up_m);
    add_task("Right side", right, "threshold_m = 3.0\n");
    match underside {
        Some(path) => add_task("Underside", path, "threshold_m = 2.0\ndark = true\n"),
        None => left.iter_mut().for_each(|points| points.reverse()),
    }
    add_task("Left side", left, "threshold_m = 3.0\n");
    let defects = if has_defects { DEFECTS } else { 0 };
    let elements = defect_elements(parts);
    let _ = write!(
        text,
        "[defects]\ncount = {defects}\nelements = {elements:?}\n\n[wind]\nmodel = \"physical\"\nlevel = \"light\"\nfrom_deg = 250.0\n\
         turbulence = 0.5\n\n# Three hours after noon at this place, under light clouds.\n[light]\nstart_utc = \"2026-06-21T20:50:00Z\"\n\
         cloud_cover = 0.5\n\n[rules]\nafter_crash = \"respawn\"\nbattery = \"paper\"\n"
    );
    text
}

/// Returns the numbers of the elements that can have defects.
fn defect_elements(parts: &[ModelPart]) -> Vec<u16> {
    let can_have = |element: &Element| !element.permitted_defects().is_empty();
    let mut numbers: Vec<u16> = parts.iter().map(|part| part.element).filter(can_have).map(Element::number).collect();
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}

/// Returns a line along one side of the deck in the direction of the x axis, and the points of the deck's edge beside it.
fn side(extent: &ModelExtent, center_up_m: f64, is_left: bool) -> [[Point; 2]; 2] {
    let (low, high) = extent.whole;
    let (deck_low, deck_high) = extent.deck;
    let middle_z = 0.5 * (extent.superstructure.0[2].min(deck_low[2]) + deck_high[2]);
    let z = middle_z.max(MIN_HEIGHT_M - center_up_m);
    let (y, edge_y) = if is_left { (high[1] + STAND_OFF_M, deck_high[1]) } else { (low[1] - STAND_OFF_M, deck_low[1]) };
    let ends = [deck_low[0], deck_high[0]];
    [ends.map(|x| [x, y, z]), ends.map(|x| [x, edge_y, middle_z])]
}

/// Returns the longest line along the middle below the deck that is clear of all parts and of the ground, against the direction of the x
/// axis, and the points above and ahead of its ends; `None` if it would be too short.
fn underside(parts: &[ModelPart], extent: &ModelExtent, center_up_m: f64) -> Option<[[Point; 2]; 2]> {
    let (deck_low, deck_high) = extent.deck;
    let bottom_z = extent.superstructure.0[2].min(deck_low[2]);
    let (y, z) = (0.5 * (deck_low[1] + deck_high[1]), bottom_z - BELOW_DECK_M);
    if z + center_up_m < MIN_HEIGHT_BELOW_DECK_M {
        return None;
    }
    let clearances: Vec<Clearance> = parts.iter().map(Clearance::of).collect();
    let is_clear = |x: f64| !clearances.iter().any(|part| part.is_nearer([x, y, z], MIN_CLEARANCE_M));
    let steps = ((deck_high[0] - deck_low[0]) / STEP_M) as usize;
    let (mut best, mut first) = ((0, 0), None);
    for k in 0..=steps {
        first = is_clear(deck_low[0] + STEP_M * k as f64).then(|| first.unwrap_or(k));
        if let Some(first) = first.filter(|first| k - first > best.1 - best.0) {
            best = (first, k);
        }
    }
    let ends = [best.1, best.0].map(|k| deck_low[0] + STEP_M * k as f64);
    (ends[0] - ends[1] >= MIN_LENGTH_M).then(|| [ends.map(|x| [x, y, z]), ends.map(|x| [x - AHEAD_M, y, bottom_z])])
}

/// A part to which distances are measured.
enum Clearance {
    Convex(PlaneSolid),
    Any(MemberShape),
}

impl Clearance {
    fn of(part: &ModelPart) -> Self {
        match &part.shape {
            PartShape::Convex(solid) => Self::Convex(PlaneSolid::new(solid)),
            PartShape::Mesh(surface) => Self::Any(MemberShape::new(&surface_solid(surface))),
        }
    }

    fn is_nearer(&self, p: Point, limit_m: f64) -> bool {
        match self {
            Self::Convex(solid) => solid.distance_m(p) < limit_m,
            Self::Any(shape) => shape.nearest_within(Vec3::new(p[0], p[1], p[2]), limit_m).is_some(),
        }
    }
}

/// Returns a surface whose bridge axes are those of the site.
fn surface_solid(surface: &SurfaceMesh) -> Solid {
    let vertices_m = surface.mesh().vertices_m.iter().map(|p| Vec3::new(p[0], p[1], p[2])).collect();
    Solid { vertices_m, faces: Vec::new(), surface: Some(SolidSurface::of(surface)) }
}

fn shown([x, y, z]: Point) -> String {
    format!("[{x:.2}, {y:.2}, {z:.2}]")
}
