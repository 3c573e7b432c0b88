//! Side profile of the current task's bridge, with the ground, the water, the paths and the aircraft at its height.

use super::super::pane::Pane;
use super::super::state::Hud;
use super::super::{DrawItem, HudColor, TextAlign};
use super::area::Area;
use super::clip::{clamp_point, clip_polygon};
use super::scale::DrawingScale;
use super::site_outline::{Point, SideView, SiteOutline};

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
    let drone = clamp_point(scale.place(side.view.at(hud.position_m)), area.inside(0.6 * font));
    let level = [(area.x, drone.1), (area.x + area.width, drone.1)];
    items.push(pane.line(&level, 0.07 * font, HudColor::Gray));
    let size = 0.55 * font;
    let diamond =
        |at: Point, size: f64| [(0.0, -size), (size, 0.0), (0.0, size), (-size, 0.0)].map(|(x, y)| (at.0 + x, at.1 + y));
    if let Some(ghost) = hud.ghost {
        let here = clamp_point(scale.place(side.view.at(ghost.position_m)), area.inside(0.6 * font));
        items.push(pane.fill(&diamond(here, size), HudColor::Ghost));
    }
    items.push(pane.fill(&diamond(drone, 1.35 * size), HudColor::Black));
    items.push(pane.fill(&diamond(drone, size), HudColor::Yellow));
    // Above the line, at the side with more space.
    let left = drone.0 > area.x + 0.5 * area.width;
    let (x, side) =
        if left { (area.x + 0.4 * font, TextAlign::Left) } else { (area.x + area.width - 0.4 * font, TextAlign::Right) };
    let y = if drone.1 - area.y > 1.5 * font { drone.1 - 0.65 * font } else { drone.1 + 0.65 * font };
    items.push(pane.text((x, y), side, font, HudColor::White, hud.style.units.length(hud.height_m, 0)));
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
