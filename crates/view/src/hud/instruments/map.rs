//! Map of the site, north up: water, bridges, paths, landing pad, inspector, aircraft, and a scale.

use super::super::pane::Pane;
use super::super::state::{Hud, InspectorMarks};
use super::super::style::DisplayStyle;
use super::super::text_metrics::text_width;
use super::super::{DrawItem, HudColor, MapPath, TextAlign};
use super::area::Area;
use super::clip::{clamp_point, clip_polygon};
use super::scale::DrawingScale;
use super::site_outline::{Point, SiteOutline};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::site::outline::GROUND_SAMPLE_SPACING_M;
use spandrel_text::text;

/// Size of the aircraft with its outline, in font sizes.
const ARROW_SIZE: f64 = 1.15;
/// Width of the line from a number to its place, in font sizes.
const LEADER_WIDTH: f64 = 0.12;
/// Largest share of the map's width for the scale.
const MAX_SCALE_SHARE: f64 = 0.35;
/// Lengths of the scale, in units of length.
const SCALE_LENGTHS: [f64; 9] = [5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1_000.0, 2_000.0];

/// Returns the place of a point on the map.
pub(super) fn place(scale: &DrawingScale, point_m: Vec3<Enu>) -> Point {
    scale.place((point_m.east(), point_m.north()))
}

/// How much a map shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in super::super) enum MapDetail {
    /// The site, the tasks, the landing pad, the inspector and the aircraft.
    Small,
    /// Also the flown path, the directions of the tasks' paths and the sign of the landing pad.
    Large,
}

pub(in super::super) fn map(
    hud: &Hud,
    site: &SiteOutline,
    pane: Pane,
    area: Area,
    (font, detail): (f64, MapDetail),
) -> Vec<DrawItem> {
    let is_large = detail == MapDetail::Large;
    let scale = DrawingScale::fit(site.bounds, area.inside(0.5 * font));
    let mut items = vec![pane.panel((area.x, area.y), area.corner())];
    items.extend(ground(site, pane, area, &scale));
    let current = hud.guidance.and_then(|guidance| guidance.task);
    let paths = Paths { tracks: &hud.tracks, current, place: &|point_m| place(&scale, point_m) };
    let mut labels = legend_texts(hud.style, area, (&scale, font));
    items.extend(paths.lines(pane, font));
    let drone = clamp_point(place(&scale, hud.position_m), area.inside(ARROW_SIZE * font));
    let home = clamp_point(place(&scale, hud.pad_m), area.inside(0.8 * font));
    if is_large {
        items.extend(paths.directions(pane, area, font));
        items.extend(flown(hud, &|point_m| place(&scale, point_m), pane, area, font));
        labels.extend([home, drone]);
    }
    items.extend(paths.numbers(pane, area, font, &mut labels));
    if let Some(marks) = &hud.inspector {
        items.extend(inspector(marks, pane, area, (&scale, font), &mut labels));
    }
    if is_large {
        items.extend(pad_sign(pane, home, font));
    } else {
        items.push(pad(pane, place(&scale, hud.pad_m), area, font));
    }
    if let Some(ghost) = hud.ghost {
        let here = clamp_point(place(&scale, ghost.position_m), area.inside(ARROW_SIZE * font));
        items.push(pane.fill(&arrow(here, ghost.ned_from_frd.yaw_rad(), font), HudColor::Ghost));
    }
    items.push(pane.fill(&arrow(drone, hud.heading_rad, ARROW_SIZE * font), HudColor::Black));
    items.push(pane.fill(&arrow(drone, hud.heading_rad, 0.85 * font), HudColor::Yellow));
    items.extend(legend(hud.style, pane, area, (&scale, font)));
    items
}

/// Returns the water and the bridges.
pub(super) fn ground(site: &SiteOutline, pane: Pane, area: Area, scale: &DrawingScale) -> Vec<DrawItem> {
    // Strips overlap, so that no line shows between them.
    let half_m = 0.5 * GROUND_SAMPLE_SPACING_M + scale.overlap_m;
    let strip = |west: f64, east: f64, north: f64| {
        [(west, north - half_m), (east, north - half_m), (east, north + half_m), (west, north + half_m)]
    };
    let water = site.water.iter().map(|water| strip(water.west_m, water.east_m, water.north_m).to_vec());
    let shapes = water.map(|shape| (shape, HudColor::Water));
    let shapes = shapes.chain(site.members.iter().map(|shape| (shape.clone(), HudColor::Structure)));
    let drawn = shapes.filter_map(|(shape, color)| {
        let px: Vec<Point> = shape.into_iter().map(|point| scale.place(point)).collect();
        let cut = clip_polygon(&px, area);
        (cut.len() >= 3).then(|| pane.fill(&cut, color))
    });
    drawn.collect()
}

/// Returns the sign of a landing pad: a square with the letter H.
fn pad_sign(pane: Pane, at: Point, font: f64) -> [DrawItem; 2] {
    let sign = pane.text(at, TextAlign::Center, 0.9 * font, HudColor::Black, "H");
    [square(pane, at, 0.62 * font, HudColor::White), sign]
}

/// Returns the flown path in a drawing, as far as it is inside.
pub(super) fn flown(hud: &Hud, place: &dyn Fn(Vec3<Enu>) -> Point, pane: Pane, area: Area, font: f64) -> Vec<DrawItem> {
    let parts = hud.flown.parts().map(|part| part.into_iter().map(place).collect::<Vec<Point>>());
    let lines = parts.flat_map(|part| {
        let inside = part.split(|point| clamp_point(*point, area) != *point).filter(|run| run.len() >= 2);
        inside.map(|run| pane.line(run, 0.1 * font, HudColor::White)).collect::<Vec<_>>()
    });
    lines.collect()
}

/// Returns the landing pad, at the edge of the area if it is outside.
pub(super) fn pad(pane: Pane, at: Point, area: Area, font: f64) -> DrawItem {
    square(pane, clamp_point(at, area.inside(0.5 * font)), 0.35 * font, HudColor::White)
}

/// The tasks' paths in a drawing.
pub(super) struct Paths<'a> {
    pub tracks: &'a [MapPath],
    /// The current task, which is highlighted.
    pub current: Option<u32>,
    /// Returns the place of a point in the drawing.
    pub place: &'a dyn Fn(Vec3<Enu>) -> Point,
}

impl Paths<'_> {
    fn points(&self, track: &MapPath) -> Vec<Point> {
        let end = track.path_m.last().filter(|_| !track.closed).or(track.path_m.first());
        track.path_m.iter().step_by(3).chain(end).map(|point_m| (self.place)(*point_m)).collect()
    }

    /// Returns the paths as lines.
    pub fn lines(&self, pane: Pane, font: f64) -> Vec<DrawItem> {
        let line = |track: &MapPath| {
            let is_current = Some(track.id) == self.current;
            let (color, width) = if is_current { (HudColor::Yellow, 0.28) } else { (HudColor::Blue, 0.16) };
            pane.line(&self.points(track), width * font, color)
        };
        // The current path is above the others, which may be in the same place.
        let (current, others): (Vec<_>, Vec<_>) = self.tracks.iter().partition(|track| Some(track.id) == self.current);
        others.into_iter().chain(current).map(line).collect()
    }

    /// Returns the tasks' numbers beside the starts of their paths, each with a line to its start, because a number that finds no room
    /// there may be nearer to another start. Adds their places to those that labels take.
    pub fn numbers(&self, pane: Pane, area: Area, font: f64, taken: &mut Vec<Point>) -> Vec<DrawItem> {
        let (mut items, mut signs) = (Vec::new(), Vec::new());
        for track in self.tracks {
            let Some(start_m) = track.path_m.first() else { continue };
            let start = (self.place)(*start_m);
            let (wanted, inside) = ((start.0, start.1 - 0.9 * font), area.inside(0.7 * font));
            let label = free_place(wanted, taken, inside, font).unwrap_or_else(|| clamp_point(wanted, inside));
            let is_current = Some(track.id) == self.current;
            let (ground, color) =
                if is_current { (HudColor::Yellow, HudColor::Black) } else { (HudColor::Black, HudColor::White) };
            items.push(pane.line(&[clamp_point(start, area), label], LEADER_WIDTH * font, ground));
            signs.push(disc(pane, label, 0.62 * font, ground));
            signs.push(pane.text(label, TextAlign::Center, 0.9 * font, color, track.id.to_string()));
            taken.push(label);
        }
        items.append(&mut signs);
        items
    }

    /// Returns an arrowhead on each path that shows its direction.
    pub fn directions(&self, pane: Pane, area: Area, font: f64) -> Vec<DrawItem> {
        let arrows = self.tracks.iter().filter_map(|track| direction(&self.points(track)));
        let inside = area.inside(0.7 * font);
        arrows
            .map(|(at, heading_rad)| pane.fill(&arrow(clamp_point(at, inside), heading_rad, 0.7 * font), HudColor::White))
            .collect()
    }
}

/// Returns the middle of the longest part of a path, and its direction in the drawing, rad clockwise from up. A path that is seen
/// end-on has no direction.
fn direction(points: &[Point]) -> Option<(Point, f64)> {
    let length2 = |pair: &&[Point]| {
        let (x, y) = (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
        x * x + y * y
    };
    let longest = points.windows(2).max_by(|a, b| length2(a).total_cmp(&length2(b)))?;
    let (from, to) = (longest[0], longest[1]);
    let middle = (0.5 * (from.0 + to.0), 0.5 * (from.1 + to.1));
    (length2(&longest) > 0.0).then(|| (middle, math::atan2(to.0 - from.0, from.1 - to.1)))
}

/// Returns the inspector, and squares with the numbers of the places. Adds their places to those that labels take.
pub(super) fn inspector(
    marks: &InspectorMarks,
    pane: Pane,
    area: Area,
    (scale, font): (&DrawingScale, f64),
    taken: &mut Vec<Point>,
) -> Vec<DrawItem> {
    let at = clamp_point(place(scale, marks.position_m), area.inside(0.6 * font));
    let mut items = vec![disc(pane, at, 0.5 * font, HudColor::Black), disc(pane, at, 0.34 * font, HudColor::White)];
    taken.push(at);
    let mut signs = Vec::new();
    for (number, place_m) in (1_u8..).zip(&marks.places_m) {
        let here = place(scale, *place_m);
        let Some(label) = free_place(here, taken, area.inside(0.7 * font), font) else {
            // With large text, a small map has no room for all numbers.
            signs.push(square(pane, clamp_point(here, area.inside(0.5 * font)), 0.3 * font, HudColor::Gray));
            continue;
        };
        items.push(pane.line(&[clamp_point(here, area), label], LEADER_WIDTH * font, HudColor::Gray));
        signs.push(square(pane, label, 0.58 * font, HudColor::Gray));
        signs.push(pane.text(label, TextAlign::Center, 0.9 * font, HudColor::Black, number.to_string()));
        taken.push(label);
    }
    items.append(&mut signs);
    items
}

/// Returns the place for a number: the wanted one, or the next free one to the right and down; `None` if there is none nearby.
fn free_place(wanted: Point, taken: &[Point], area: Area, font: f64) -> Option<Point> {
    let step = 1.3 * font;
    let is_free = |here: &Point| {
        taken.iter().all(|other| (here.0 - other.0).abs() >= 0.99 * step || (here.1 - other.1).abs() >= 0.99 * step)
    };
    let offsets =
        [(0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (2.0, 0.0), (-2.0, 0.0), (0.0, 2.0), (0.0, -2.0)];
    let places = offsets.map(|(right, down)| clamp_point((wanted.0 + right * step, wanted.1 + down * step), area));
    places.into_iter().find(is_free)
}

fn square(pane: Pane, (x, y): Point, half: f64, color: HudColor) -> DrawItem {
    let corners = [(-half, -half), (half, -half), (half, half), (-half, half)];
    pane.fill(&corners.map(|(right, down)| (x + right, y + down)), color)
}

fn disc(pane: Pane, (x, y): Point, radius: f64, color: HudColor) -> DrawItem {
    let corner = |k: u32| {
        let (sin, cos) = math::sin_cos(math::TAU * f64::from(k) / 16.0);
        (x + radius * cos, y + radius * sin)
    };
    pane.fill(&(0..16).map(corner).collect::<Vec<_>>(), color)
}

/// Returns the length of the scale, m.
fn scale_length_m(style: DisplayStyle, area: Area, scale: &DrawingScale) -> f64 {
    let most_m = MAX_SCALE_SHARE * area.width / scale.px_per_m;
    let lengths_m = SCALE_LENGTHS.map(|length| length * style.units.length_unit_m());
    lengths_m.into_iter().rev().find(|length_m| *length_m <= most_m).unwrap_or(lengths_m[0])
}

/// Returns points on the texts of the legend, which other texts must not cover.
pub(super) fn legend_texts(style: DisplayStyle, area: Area, (scale, font): (&DrawingScale, f64)) -> Vec<Point> {
    let words = style.units.length(scale_length_m(style, area, scale), 0);
    let (left, y) = (area.x + 0.8 * font, area.y + area.height - 1.75 * font);
    let count = (text_width(&words, font) / font).ceil() as u32;
    let scale_text = (0..=count).map(|k| (left + f64::from(k) * font, y));
    scale_text.chain([(area.x + area.width - 1.1 * font, area.y + 2.3 * font)]).collect()
}

/// Returns the ground of a text that may be over a bridge.
pub(super) fn text_ground(pane: Pane, (left, top): Point, (right, bottom): Point) -> DrawItem {
    pane.fill(&[(left, top), (right, top), (right, bottom), (left, bottom)], HudColor::TextBackground)
}

/// Returns the north arrow and the scale.
pub(super) fn legend(style: DisplayStyle, pane: Pane, area: Area, (scale, font): (&DrawingScale, f64)) -> Vec<DrawItem> {
    let (units, length_m) = (style.units, scale_length_m(style, area, scale));
    let (left, bottom) = (area.x + 0.8 * font, area.y + area.height - 0.8 * font);
    let right = left + length_m * scale.px_per_m;
    let bar = [(left, bottom - 0.4 * font), (left, bottom), (right, bottom), (right, bottom - 0.4 * font)];
    let north = (area.x + area.width - 1.1 * font, area.y + 1.2 * font);
    let (words, pad) = (units.length(length_m, 0), 0.3 * font);
    let end = right.max(left + text_width(&words, font));
    vec![
        text_ground(pane, (left - pad, bottom - 1.5 * font), (end + pad, bottom + pad)),
        text_ground(pane, (north.0 - 0.8 * font, north.1 - font), (north.0 + 0.8 * font, north.1 + 1.7 * font)),
        pane.line(&bar, 0.14 * font, HudColor::White),
        pane.text((left, bottom - 0.95 * font), TextAlign::Left, font, HudColor::White, words),
        pane.fill(&arrow((north.0, north.1 - 0.2 * font), 0.0, 0.7 * font), HudColor::White),
        pane.text(
            (north.0, north.1 + 1.1 * font),
            TextAlign::Center,
            font,
            HudColor::White,
            text!(style.language, "flight-compass-north"),
        ),
    ]
}

/// Returns an arrowhead that points along the heading.
fn arrow((x, y): Point, heading_rad: f64, size: f64) -> [Point; 3] {
    let (sin, cos) = math::sin_cos(heading_rad);
    [(0.0, 1.0), (0.65, -0.7), (-0.65, -0.7)]
        .map(|(right, ahead): Point| (x + size * (right * cos + ahead * sin), y - size * (ahead * cos - right * sin)))
}
