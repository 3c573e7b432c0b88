//! Reference paths of tasks at beam bridges, in bridge axes. They are level unless the beams' depth varies, and keep the stand-off to every member.

use super::beam_layout::BeamLayout;
use super::path::{LocalPath, PathPlace, SPACING_M, TaskKind, equal_steps, rectangle_loop};
use super::solid::LocalPoint;
use crate::math;

/// Minimum radius of the turn between two passes under the girders, m (estimate: a turn that a slow aircraft can follow).
const MIN_TURN_RADIUS_M: f64 = 2.5;
/// Minimum number of steps of the turn, so that the direction changes by at most 13 degrees per step.
const MIN_TURN_STEPS: f64 = 14.0;
/// Number of points after which the view under the girders has panned over both sides.
const PAN_PERIOD_POINTS: f64 = 30.0;
/// Distance that the camera looks ahead under the girders, as a share of the stand-off (estimate, as under an arch).
const AHEAD_SHARE: f64 = 0.3;

/// Slope of the view of the bearings, as a share of the steepest one (estimate, so that edges don't touch the line of sight).
const SIGHT_MARGIN: f64 = 0.9;

/// Returns the path of a task kind; `None` if beam bridges have no such path.
pub(super) fn of_kind(
    layout: &BeamLayout,
    kind: TaskKind,
    stand_off_m: f64,
    place: &PathPlace,
) -> Option<Result<LocalPath, String>> {
    match kind {
        TaskKind::SlabSide => Some(slab_side(layout, stand_off_m)),
        TaskKind::GirderSoffit => Some(girder_soffit(layout, stand_off_m, place)),
        TaskKind::BearingLine => Some(bearing_line(layout, stand_off_m, place)),
        TaskKind::PierCap => Some(pier_cap(layout, stand_off_m, place)),
        TaskKind::ArchBottom
        | TaskKind::Interlayer
        | TaskKind::PierCircle
        | TaskKind::TrussPanel
        | TaskKind::FloorSystem
        | TaskKind::BarrelSoffit
        | TaskKind::ArchRing
        | TaskKind::StayCable
        | TaskKind::Free => None,
    }
}

/// Returns a straight line along the right side of the deck, halfway between the road surface and the girders' undersides at the
/// abutments, facing the outer beam.
pub(super) fn slab_side(layout: &BeamLayout, stand_off_m: f64) -> Result<LocalPath, String> {
    let half = layout.abutment_front_x_m() - stand_off_m;
    if half <= 0.0 {
        return Err("a bridge that is longer than 2 stand_off_m".into());
    }
    let (y, z) = (-0.5 * layout.deck.width_m - stand_off_m, 0.5 * layout.lines.abutment_bottom_z_m);
    let points: Vec<LocalPoint> = equal_steps(-half, half).into_iter().map(|x| [x, y, z]).collect();
    Ok(LocalPath { viewing_directions: vec![[0.0, 1.0, 0.0]; points.len()], points, closed: false })
}

/// Returns the path under the girders of a span, between the stand-offs from its supports. If there is room to turn, it goes out below
/// the left half of the bridge and back below the right half; otherwise, it is one line along the middle. The camera looks up at the
/// bays and slightly ahead.
pub(super) fn girder_soffit(layout: &BeamLayout, stand_off_m: f64, place: &PathPlace) -> Result<LocalPath, String> {
    below_beams(layout, stand_off_m, place, (0.25 * layout.beam_group_m(), 0.5 * layout.lines.spacing_m))
}

/// Returns the path under the beams of a span, with the radius of the turn between the passes below the halves of the bridge, and the
/// distance to which the view pans to both sides at the height of the slab.
pub(super) fn below_beams(
    layout: &BeamLayout,
    stand_off_m: f64,
    place: &PathPlace,
    (radius_m, pan_m): (f64, f64),
) -> Result<LocalPath, String> {
    below_soffit(layout, stand_off_m, place, (radius_m, pan_m), &|_| layout.lines.bottom_z_m - stand_off_m)
}

/// Returns the path under the beams of a span at a height that varies along the bridge.
pub(super) fn below_soffit(
    layout: &BeamLayout,
    stand_off_m: f64,
    place: &PathPlace,
    (radius_m, pan_m): (f64, f64),
    height_m: &dyn Fn(f64) -> f64,
) -> Result<LocalPath, String> {
    let (from, to) = span_between_stand_offs(layout, stand_off_m, place)?;
    let is_wide = radius_m >= MIN_TURN_RADIUS_M && to - from > 2.0 * radius_m;
    let course = if is_wide { out_and_back((from, to), radius_m) } else { straight((from, to), middle_bay_y_m(layout)) };
    let points = course.iter().map(|(at, _)| [at[0], at[1], height_m(at[0])]).collect();
    let view = |(k, (at, ahead)): (usize, &([f64; 2], [f64; 2]))| {
        let aside_m = pan_m * math::sin(math::TAU * k as f64 / PAN_PERIOD_POINTS);
        let ahead_m = AHEAD_SHARE * stand_off_m;
        let rise_m = -layout.deck.slab_m - height_m(at[0]);
        [ahead_m * ahead[0] - aside_m * ahead[1], ahead_m * ahead[1] + aside_m * ahead[0], rise_m]
    };
    let viewing_directions = course.iter().enumerate().map(view).collect();
    Ok(LocalPath { points, viewing_directions, closed: false })
}

/// Returns the number of a task's span, from 1.
pub(super) fn span_number(layout: &BeamLayout, place: &PathPlace) -> Result<usize, String> {
    let count = layout.span_lengths_m().len();
    let number = place.span.unwrap_or(count / 2 + 1);
    if (1..=count).contains(&number) { Ok(number) } else { Err(format!("span_number = 1 to {count}")) }
}

/// Returns the start and the end of the path under a span.
pub(super) fn span_between_stand_offs(layout: &BeamLayout, stand_off_m: f64, place: &PathPlace) -> Result<(f64, f64), String> {
    let supports = layout.support_positions();
    let (count, number) = (supports.len() - 1, span_number(layout, place)?);
    let pier_m = pier_reach_m(layout, stand_off_m);
    let from = if number == 1 { -layout.abutment_front_x_m() } else { supports[number - 1] + pier_m };
    let to = if number == count { layout.abutment_front_x_m() } else { supports[number] - pier_m };
    let ends = (from + stand_off_m, to - stand_off_m);
    if ends.0 < ends.1 { Ok(ends) } else { Err("a span that is longer than 2 stand_off_m".into()) }
}

/// Returns the distance from a pier's axis to its outermost parts along the bridge, at the height of the paths under the beams: those of
/// the cap, or of a footing that is less than the stand-off below the path.
fn pier_reach_m(layout: &BeamLayout, stand_off_m: f64) -> f64 {
    let is_near_footing = layout.lines.bottom_z_m - 2.0 * stand_off_m < layout.footing_top_z_m();
    let cap_m = 0.5 * layout.supports.cap_width_m;
    if is_near_footing { cap_m.max(layout.footing_half_width_m()) } else { cap_m }
}

/// Returns the position of the middle of the bay that is nearest to the centerline.
fn middle_bay_y_m(layout: &BeamLayout) -> f64 {
    let lines = layout.beam_lines();
    let left = (lines.len() - 1) / 2;
    0.5 * (lines[left] + lines[left + 1])
}

/// Returns points on a line along the bridge, each with the direction of flight.
fn straight((from, to): (f64, f64), y: f64) -> Vec<([f64; 2], [f64; 2])> {
    let ahead = [(to - from).signum(), 0.0];
    equal_steps(from, to).into_iter().map(|x| ([x, y], ahead)).collect()
}

/// Returns points on a line out, a semicircle and a line back, each with the direction of flight.
pub(super) fn out_and_back((from, to): (f64, f64), radius_m: f64) -> Vec<([f64; 2], [f64; 2])> {
    let turn_x = to - radius_m;
    let steps = (math::PI * radius_m / SPACING_M).ceil().max(MIN_TURN_STEPS);
    let on_turn = |k: i32| {
        let (s, c) = math::sin_cos(math::PI * f64::from(k) / steps);
        ([turn_x + radius_m * s, radius_m * c], [c, -s])
    };
    let mut out = straight((from, turn_x), radius_m);
    out.extend((1..steps as i32).map(on_turn));
    out.extend(straight((turn_x, from), -radius_m));
    out
}

/// Returns a line along the bearings of a support, from the left to the right, facing them. It is as high as the stand-off from the
/// girders allows, and far enough from the support for the bearings to be visible above the edge of the cap or abutment.
pub(super) fn bearing_line(layout: &BeamLayout, stand_off_m: f64, place: &PathPlace) -> Result<LocalPath, String> {
    let supports = layout.support_positions();
    let last = supports.len() - 1;
    let support = place.support.unwrap_or(usize::from(last > 1));
    if support > last {
        return Err(format!("support_number = 0 to {last}"));
    }
    let rise_m = stand_off_m - 0.5 * layout.bearings.height_m;
    let visible_m = rise_m / (SIGHT_MARGIN * layout.bearing_sight_slope(support));
    let away_m = visible_m.max(layout.bearing_setback_m(support) + stand_off_m);
    // The bearings of the first abutment are seen from the first span, all others from the span before them.
    let (toward, span) = if support == 0 { (-1.0, 1) } else { (1.0, support) };
    let x = layout.bearing_front_x_m(support) - toward * away_m;
    let (from, to) = span_between_stand_offs(layout, stand_off_m, &PathPlace { span: Some(span), support: None })?;
    if !(from..=to).contains(&x) {
        return Err("a longer span, higher bearings and pedestals or a smaller stand_off_m".into());
    }
    let (half, z) = (0.5 * layout.beam_group_m(), layout.beam_bottom_z_m(support) - stand_off_m);
    let points: Vec<LocalPoint> = equal_steps(half, -half).into_iter().map(|y| [x, y, z]).collect();
    let viewing_directions = vec![[toward * away_m, 0.0, rise_m]; points.len()];
    Ok(LocalPath { points, viewing_directions, closed: false })
}

/// Returns one loop around the cap of a pier at the stand-off distance from its sides, facing the middle of the cap. It is at the height
/// of the cap's middle, or lower if the stand-off from the girders requires it.
pub(super) fn pier_cap(layout: &BeamLayout, stand_off_m: f64, place: &PathPlace) -> Result<LocalPath, String> {
    let supports = layout.support_positions();
    let last = supports.len() - 1;
    let pier = place.support.unwrap_or(1);
    if last < 2 {
        return Err("a bridge with piers".into());
    }
    if !(1..last).contains(&pier) {
        return Err(format!("support_number = 1 to {} (a pier)", last - 1));
    }
    let middle_z = 0.5 * (layout.cap_top_z_m() + layout.cap_bottom_z_m());
    let z = middle_z.min(layout.lines.bottom_z_m - stand_off_m);
    if z - stand_off_m < layout.footing_top_z_m() {
        return Err("columns that extend to stand_off_m below the path".into());
    }
    let half_m = (0.5 * layout.supports.cap_width_m, 0.5 * layout.cap_length_m());
    let (points, normals) = rectangle_loop((supports[pier], z), half_m, stand_off_m);
    let viewing_directions = normals.into_iter().map(|[nx, ny]| [-nx * stand_off_m, -ny * stand_off_m, middle_z - z]).collect();
    Ok(LocalPath { points, viewing_directions, closed: true })
}
