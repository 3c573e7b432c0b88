//! The series of condition states in the documentation (docs/src/reference/defects.md): every kind of defect in the states 2, 3 and 4, at
//! the same scale in each row. `SPANDREL_PICTURES=write` draws them anew.

use super::compare::{check_picture_at, difference, side_by_side};
use super::gallery::{girder_sight_line, wall_sight_line};
use spandrel_model::defect_codes::{
    ABRASION, CONNECTION, CORROSION, CRACK, EFFLORESCENCE, FATIGUE, MORTAR, REBAR, SPALL, SPLIT_STONE, SizeRanges, is_line,
    map_crack_size_ranges, open_fatigue_size_ranges, size_ranges,
};
use spandrel_model::elements::Element;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::{DefectCause, PlacedDefect, Scenario, Stain, StainSubstance};
use spandrel_model::time::SimTime;
use spandrel_testkit::studio::{Studio, at, masonry_job, sunny_job};
use spandrel_view::picture::Picture;
use spandrel_view::scene::DefectPatch;
use spandrel_view::scene::defects::{patch, stain_patch};
use std::path::Path;

/// Size of each picture, px.
const PICTURE_PX: (u32, u32) = (300, 225);
/// Condition states in a row.
pub(super) const STATES: [u8; 3] = [2, 3, 4];
/// Size of the defects in a row, between the smallest and the largest of their condition state.
const MEDIUM: f64 = 0.5;
/// Distance of the camera, m.
const DISTANCE_M: f64 = 1.6;

/// One row of the series.
pub(super) struct Series {
    pub(super) name: &'static str,
    pub(super) kind: u32,
    /// Whether the kind is drawn as a pattern of cracks.
    is_map: bool,
    cause: DefectCause,
    stain: Option<StainSubstance>,
    /// True if the defect runs down, false if it is level.
    down: bool,
    sight: (Vec3<Enu>, Vec3<Enu>),
    /// Width of the surface in the pictures, m.
    pub(super) width_m: f64,
}

/// Returns a line of sight to the underside of the arch bridge's deck.
fn soffit_sight_line() -> (Vec3<Enu>, Vec3<Enu>) {
    (at(30.0, 0.4, 27.0), at(30.0, 0.4, 40.0))
}

/// Returns a line of sight to the right spandrel wall of the masonry arch bridge, above the first pier: to a corner of three stones, or to
/// the middle of a stone.
fn masonry_sight_line(kind: u32) -> (Vec3<Enu>, Vec3<Enu>) {
    let (east_m, up_m) = if kind == MORTAR { (-9.2, 6.84) } else { (-9.0, 7.0) };
    (at(east_m, -12.0, up_m), at(east_m, 0.0, up_m))
}

/// Returns a row of level defects without stains.
fn series((name, kind, cause): (&'static str, u32, DefectCause), sight: (Vec3<Enu>, Vec3<Enu>), width_m: f64) -> Series {
    Series { name, kind, is_map: false, cause, stain: None, down: false, sight, width_m }
}

/// Returns the rows at the two bridges of steel and concrete.
pub(super) fn all_series() -> Vec<Series> {
    let row = |name, kind, cause, width_m| {
        let sight = if kind < SPALL { girder_sight_line() } else { wall_sight_line() };
        series((name, kind, cause), sight, width_m)
    };
    vec![
        Series { down: true, ..row("bending-crack", CRACK, DefectCause::Bending, 0.24) },
        Series {
            stain: Some(StainSubstance::Lime),
            sight: soffit_sight_line(),
            ..row("shrinkage-crack", CRACK, DefectCause::Shrinkage, 0.5)
        },
        Series { is_map: true, ..row("map-cracking", CRACK, DefectCause::Swelling, 1.3) },
        Series { stain: Some(StainSubstance::Rust), ..row("spall", SPALL, DefectCause::Reinforcement, 1.6) },
        Series { stain: Some(StainSubstance::Rust), ..row("exposed-rebar", REBAR, DefectCause::Reinforcement, 1.3) },
        Series { down: true, ..row("efflorescence", EFFLORESCENCE, DefectCause::LeakingJoint, 1.9) },
        row("abrasion", ABRASION, DefectCause::WaterLine, 1.2),
        row("corrosion", CORROSION, DefectCause::LeakingJoint, 1.0),
        Series { down: true, ..row("fatigue-crack", FATIGUE, DefectCause::Weld, 0.5) },
        row("connection", CONNECTION, DefectCause::Fasteners, 0.4),
    ]
}

/// Returns the rows at the masonry arch bridge.
pub(super) fn masonry_series() -> Vec<Series> {
    let row = |name, kind, cause, width_m| series((name, kind, cause), masonry_sight_line(kind), width_m);
    vec![row("mortar-breakdown", MORTAR, DefectCause::WaterLine, 1.9), row("split-stone", SPLIT_STONE, DefectCause::Frost, 1.0)]
}

fn ranges(series: &Series, state: u8) -> SizeRanges {
    match (series.kind, series.is_map) {
        (_, true) => map_crack_size_ranges(state),
        (FATIGUE, false) => open_fatigue_size_ranges(state),
        (kind, false) => size_ranges(kind, state),
    }
}

/// Returns a defect where the line of sight hits the bridge. `share` is its size between the smallest (0) and the largest (1) of its
/// condition state.
pub(super) fn defect(studio: &Studio, series: &Series, condition_state: u8, share: f64) -> PlacedDefect {
    let (from, to) = series.sight;
    let ray = (to - from).unit();
    let hit = studio.site.ray(from, ray, 200.0, SimTime::ZERO).unwrap();
    let member = &studio.site.members()[hit.object.0 as usize];
    let level = if hit.normal.up() < -0.8 { at(0.0, 1.0, 0.0) } else { at(0.0, 0.0, 1.0).cross(hit.normal).unit() };
    let sizes = ranges(series, condition_state);
    let between = |(low, high): (f64, f64)| low + share * (high - low);
    let length_m = between(sizes.length_m);
    let line = is_line(series.kind) && !series.is_map;
    let stain = series.stain.map(|substance| Stain {
        substance,
        length_m: if hit.normal.up() < -0.8 { 0.8 * length_m } else { 0.15 + 0.25 * f64::from(condition_state - 2) },
    });
    PlacedDefect {
        id: 3,
        element: match series.kind {
            ..SPALL => Element::SteelGirder,
            MORTAR | SPLIT_STONE => Element::MasonryArch,
            _ => Element::RcArch,
        },
        member: member.name.clone(),
        kind: series.kind,
        condition_state,
        position_m: from + ray * hit.distance_m,
        normal: hit.normal,
        along: if series.down { level.cross(hit.normal).unit() } else { level },
        length_m,
        width_m: between(sizes.width) * if line { 1.0 } else { length_m },
        line,
        cause: Some(series.cause),
        stain,
    }
}

/// Returns the drawings of a defect and its stain.
pub(super) fn patches(studio: &Studio, defect: &PlacedDefect) -> Vec<DefectPatch> {
    let bundle = spandrel_model::site::light::ray_bundle(64);
    let cast = |o, d, max_m| studio.site.geometry().ray(o, d, max_m);
    let sun = studio.site.light().daylight(studio.at).sun;
    let (sky, bounced) = studio.site.light().indirect_fractions(defect.position_m, defect.normal, sun, &bundle, &cast);
    let light = [sky as f32, bounced as f32];
    stain_patch(defect, light).into_iter().chain([patch(defect, light)]).collect()
}

/// Returns a picture of the place of a defect with these drawings, slightly from the side and from below; an underside is lit by the lamp.
pub(super) fn draw(
    studio: &mut Studio,
    series: &Series,
    (defect, patches): (&PlacedDefect, &[DefectPatch]),
    size_px: (u32, u32),
) -> Picture {
    let (gpu, renderer) = studio.renderer();
    renderer.set_patches(gpu, patches);
    let aside = if defect.normal.up() < -0.8 { at(1.0, 0.0, 0.0) } else { at(0.0, 0.0, 1.0).cross(defect.normal).unit() };
    let out = (defect.normal + aside * 0.2 - at(0.0, 0.0, 0.1)).unit();
    let hfov_deg = 2.0 * math::atan(0.5 * series.width_m / DISTANCE_M).to_degrees();
    let shot = studio.seen(defect.position_m + out * DISTANCE_M, defect.position_m, hfov_deg, defect.normal.up() < -0.8, size_px);
    studio.draw(&shot)
}

/// Every kind in three condition states, which differ from each other more than pictures of the same state may.
#[test]
fn regress_condition_states_of_every_kind() {
    assert_states_differ_and_match(sunny_job(), all_series());
}

#[test]
fn regress_condition_states_of_masonry() {
    assert_states_differ_and_match(masonry_job(), masonry_series());
}

fn assert_states_differ_and_match(job: Scenario, rows: Vec<Series>) {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("docs/src/images/defects");
    let mut studio = Studio::new(job, 7, "medium", SimTime::from_ms(95_000));
    let mut errors = Vec::new();
    for series in rows {
        let row = STATES.map(|state| {
            let defect = defect(&studio, &series, state, MEDIUM);
            let patches = patches(&studio, &defect);
            draw(&mut studio, &series, (&defect, &patches), PICTURE_PX)
        });
        for pair in row.windows(2) {
            let found = difference(&pair[0], &pair[1]).unwrap();
            if found.is_within_limits() {
                errors.push(format!("{}: two condition states look the same: {found:?}", series.name));
            }
        }
        let path = folder.join(format!("{}.jpg", series.name));
        if let Err(error) = check_picture_at(&path, &format!("state-{}", series.name), &side_by_side(&row)) {
            errors.push(error);
        }
    }
    assert!(errors.is_empty(), "{}", errors.join("\n"));
}
