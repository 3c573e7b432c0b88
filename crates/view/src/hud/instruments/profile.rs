//! Side profile of the current task's bridge, with the ground, the water, the paths and the aircraft at its height.

use super::super::pane::Pane;
use super::super::state::Hud;
use super::super::text_metrics::text_width;
use super::super::{DrawItem, HudColor, TextAlign};
use super::area::Area;
use super::clip::{clamp_point, clip_polygon};
use super::map::{self, text_ground};
use super::scale::DrawingScale;
use super::site_outline::{Point, SideView, SiteOutline};

/// Steps of the scale of heights, in units of length, the smallest distance between two marks, and the size of their text, in font
/// sizes.
const HEIGHT_STEPS: [f64; 6] = [5.0, 10.0, 20.0, 50.0, 100.0, 200.0];
const MIN_STEP: f64 = 1.6;
const SCALE_FONT: f64 = 0.8;
/// Size of the aircraft's outline relative to the aircraft.
const OUTLINE: f64 = 1.35;

pub(super) fn profile(hud: &Hud, site: &SiteOutline, pane: Pane, area: Area, font: f64) -> Vec<DrawItem> {
    let mut items = vec![pane.panel((area.x, area.y), area.corner())];
    let current = hud.guidance.and_then(|guidance| guidance.task);
    let Some(side) = site.side(current) else { return items };
    let scale = DrawingScale::fit(side.bounds, area.inside(0.4 * font));
    items.extend(background(side, site.water_level_m, pane, area, &scale));
    for track in &hud.tracks {
        let color = if Some(track.id) == current { HudColor::Yellow } else { HudColor::Blue };
        items.extend(path(&track.path_m, track.closed, (side, &scale), pane, area, (0.14 * font, color)));
    }
    items.extend(map::flown(hud, &|point_m| scale.place(side.view.at(point_m)), pane, area, font));
    let size = 0.55 * font;
    let drone = clamp_point(scale.place(side.view.at(hud.position_m)), area.inside(OUTLINE * size));
    // The height of the aircraft stands at the side with more space, the scale at the other one.
    let left = drone.0 > area.x + 0.5 * area.width;
    items.extend(height_scale(hud, (side, &scale), pane, area, (font, !left)));
    let level = [(area.x, drone.1), (area.x + area.width, drone.1)];
    items.push(pane.line(&level, 0.07 * font, HudColor::Gray));
    let diamond =
        |at: Point, size: f64| [(0.0, -size), (size, 0.0), (0.0, size), (-size, 0.0)].map(|(x, y)| (at.0 + x, at.1 + y));
    if let Some(ghost) = hud.ghost {
        let here = clamp_point(scale.place(side.view.at(ghost.position_m)), area.inside(size));
        items.push(pane.fill(&diamond(here, size), HudColor::Ghost));
    }
    items.push(pane.fill(&diamond(drone, OUTLINE * size), HudColor::Black));
    items.push(pane.fill(&diamond(drone, size), HudColor::Yellow));
    // Above the line.
    let (x, side) =
        if left { (area.x + 0.4 * font, TextAlign::Left) } else { (area.x + area.width - 0.4 * font, TextAlign::Right) };
    let y = if drone.1 - area.y > 1.5 * font { drone.1 - 0.65 * font } else { drone.1 + 0.65 * font };
    let words = hud.style.units.length(hud.height_m, 0);
    let (half, width) = (0.55 * font, text_width(&words, font));
    let pad = 0.2 * font;
    let (from, to) = if left { (x - pad, x + width + pad) } else { (x - width - pad, x + pad) };
    items.push(text_ground(pane, (from, y - half), (to, y + half)));
    items.push(pane.text((x, y), side, font, HudColor::White, words));
    items
}

/// Returns marks with heights above the pad, at the left or right edge.
fn height_scale(
    hud: &Hud,
    (side, scale): (&SideView, &DrawingScale),
    pane: Pane,
    area: Area,
    (font, at_left): (f64, bool),
) -> Vec<DrawItem> {
    let (units, pad_m) = (hud.style.units, side.view.at(hud.pad_m).1);
    let steps_m = HEIGHT_STEPS.map(|step| step * units.length_unit_m());
    let Some(step_m) = steps_m.into_iter().find(|step_m| step_m * scale.px_per_m >= MIN_STEP * font) else { return Vec::new() };
    let ((across_m, low_m), (_, high_m)) = side.bounds;
    let (edge, inward) = if at_left { (area.x, 1.0) } else { (area.x + area.width, -1.0) };
    let align = if at_left { TextAlign::Left } else { TextAlign::Right };
    let inside = area.inside(0.6 * font);
    let (first, last) = (((low_m - pad_m) / step_m).ceil() as i32, ((high_m - pad_m) / step_m).floor() as i32);
    let mut items = Vec::new();
    for k in first..=last {
        let height_m = f64::from(k) * step_m;
        let (_, y) = scale.place((across_m, pad_m + height_m));
        if clamp_point((inside.x, y), inside).1 != y {
            continue;
        }
        let (words, font) = (units.length(height_m, 0), SCALE_FONT * font);
        let (tick, text) = (edge + 0.5 * inward * font, edge + 0.7 * inward * font);
        let end = text + inward * text_width(&words, font);
        let pad = 0.15 * font;
        items.push(text_ground(pane, (text.min(end) - pad, y - 0.55 * font), (text.max(end) + pad, y + 0.55 * font)));
        items.push(pane.line(&[(edge, y), (tick, y)], 0.12 * font, HudColor::White));
        items.push(pane.text((text, y), align, font, HudColor::White, words));
    }
    items
}

/// Returns the water, the ground and the bridge.
pub(super) fn background(side: &SideView, water_level_m: f64, pane: Pane, area: Area, scale: &DrawingScale) -> Vec<DrawItem> {
    let ((left, low), (right, _)) = side.bounds;
    let water = vec![(left, low), (right, low), (right, water_level_m), (left, water_level_m)];
    let ground = side.ground.windows(2).filter(|pair| pair[0].1 > low || pair[1].1 > low);
    let ground = ground.map(|pair| {
        let (from, to) = (pair[0].0, pair[1].0 + scale.overlap_m);
        vec![(from, low), (to, low), (to, pair[1].1.max(low)), (from, pair[0].1.max(low))]
    });
    let water = (water_level_m > low).then_some((water, HudColor::Water));
    let shapes = water.into_iter().chain(ground.map(|shape| (shape, HudColor::Earth)));
    let shapes = shapes.chain(side.members.iter().map(|shape| (shape.clone(), HudColor::Structure)));
    let drawn = shapes.filter_map(|(shape, color)| {
        let px: Vec<Point> = shape.into_iter().map(|point| scale.place(point)).collect();
        let cut = clip_polygon(&px, area);
        (cut.len() >= 3).then(|| pane.fill(&cut, color))
    });
    drawn.collect()
}

/// Returns the parts of a path inside the area.
fn path(
    path_m: &[spandrel_model::frames::Vec3<spandrel_model::frames::Enu>],
    closed: bool,
    (side, scale): (&SideView, &DrawingScale),
    pane: Pane,
    area: Area,
    (width, color): (f64, HudColor),
) -> Vec<DrawItem> {
    let ends = path_m.last().filter(|_| !closed).or(path_m.first());
    let points: Vec<Point> = path_m.iter().step_by(3).chain(ends).map(|point_m| scale.place(side.view.at(*point_m))).collect();
    let is_inside = |point: &Point| clamp_point(*point, area) == *point;
    points.split(|point| !is_inside(point)).filter(|part| part.len() >= 2).map(|part| pane.line(part, width, color)).collect()
}
