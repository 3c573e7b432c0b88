//! The mean air around a bridge in a plane: its speed in the plane as color, its direction as arrows, and where the bridge makes it turbulent, with the
//! structure that the plane cuts, the flown path, and the places where the air was disturbed most.

use super::colors::plain_color;
use super::map::{is_near_bridge, near_bridge_data, scale};
use super::plot_map::PlotMap;
use super::speed_scale::{CLASSES, SpeedScale};
use super::{coord, line, simplify_polyline, svg_figure};
use crate::report::disturbed_air::DisturbedPlace;
use crate::report::{Review, formatting};
use maud::{Markup, html};
use spandrel_mavlink::telemetry::Frame;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::Bridge;
use spandrel_model::site::mean_air::{AirSample, MeanAir};
use spandrel_model::site::outline::{ParallelView, ground_profile};
use spandrel_model::site::section_cut::{SectionCut, section_cut};
use spandrel_text::{Language, text};

/// Side of a colored square, in drawing units.
const CELL: f64 = 7.2;
/// Number of squares between two arrows, and between two marks of turbulence, in both directions.
const ARROW_CELLS: usize = 5;
const TURBULENCE_CELLS: usize = 2;
/// Length of an arrow at the highest speed of the scale, relative to the distance between two arrows.
const ARROW_SHARE: f64 = 0.9;
/// Shorter arrows are dots, in drawing units.
const MIN_ARROW: f64 = 2.5;
/// Turbulence relative to the free wind from which it is marked once and twice.
pub const TURBULENCE_LEVELS: [f64; 2] = [0.1, 0.2];
/// Half the length of the projection of such a mark, in drawing units.
const TURBULENCE_MARK: f64 = 2.2;
/// Distance from the plane within which the path is drawn with a strong line, m: above and below a level plane, and along the bridge.
const NEAR_PLANE_M: [f64; 2] = [5.0, 10.0];
/// Overlap of the squares, which hides the seams between them, in drawing units.
const OVERLAP: f64 = 0.4;
/// Margins around the flown path and the deck, m, largest distance beside the deck, m, and smallest extent along the bridge, m.
const MARGIN_M: f64 = 12.0;
const MAX_BESIDE_M: f64 = 30.0;
const MIN_LENGTH_M: f64 = 40.0;
/// Margin above the flown path or the deck, and below the surface, in an upright plane, m.
const UPRIGHT_MARGIN_M: (f64, f64) = (6.0, 2.0);

/// Direction of the plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AirPlane {
    /// Level, seen from above, with the bridge's heading to the right.
    Level,
    /// Upright across the bridge, seen along its heading.
    Across,
}

/// An arrow of a drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AirArrow {
    /// Position in the site, m.
    pub position_m: Vec3<Enu>,
    /// Middle in the drawing.
    pub middle: (f64, f64),
    /// Air at the position.
    pub air: AirSample,
}

/// The air in a plane around a bridge.
#[derive(Debug, Clone, PartialEq)]
pub struct AirSection {
    /// Direction of the plane.
    pub plane: AirPlane,
    /// A point of the plane, m.
    pub through_m: Vec3<Enu>,
    map: PlotMap,
    /// Upper-left and lower-right corner of the colored part of the drawing.
    corners: [(f64, f64); 2],
    /// Air in the middle of each square, row by row from above; `None` in water and ground.
    cells: Vec<Vec<Option<AirSample>>>,
    /// Size of a square, in drawing units.
    cell: (f64, f64),
}

impl AirSection {
    /// Computes the air at the height or at the station of a bridge where it was flown. `flown_m` are the positions near the bridge.
    #[must_use]
    pub fn new(plane: AirPlane, at_m: f64, bridge: &Bridge, flown_m: &[Vec3<Enu>], air: &mut MeanAir) -> Self {
        let (view, through_m, corners_m) = match plane {
            AirPlane::Level => level_plane(at_m, bridge, flown_m),
            AirPlane::Across => upright_plane(at_m, bridge, flown_m, air),
        };
        let map = PlotMap::around(view, &corners_m);
        let ends = corners_m.map(|corner| map.at(corner));
        let (left, right) = math::range(ends.iter().map(|end| end.0));
        let (top, bottom) = math::range(ends.iter().map(|end| end.1));
        let count = |length: f64| (length / CELL).round().max(1.0);
        let (columns, rows) = (count(right - left), count(bottom - top));
        let cell = ((right - left) / columns, (bottom - top) / rows);
        let mut section = Self { plane, through_m, map, corners: [(left, top), (right, bottom)], cells: Vec::new(), cell };
        section.cells = (0..rows as usize)
            .map(|row| (0..columns as usize).map(|column| section.air_in_cell(row, column, air)).collect())
            .collect();
        section
    }

    /// Returns the middle of a square in the drawing.
    fn middle(&self, row: usize, column: usize) -> (f64, f64) {
        let [(left, top), _] = self.corners;
        (left + (column as f64 + 0.5) * self.cell.0, top + (row as f64 + 0.5) * self.cell.1)
    }

    /// Returns the point of the plane at a place of the drawing, m.
    fn point_m(&self, (x, y): (f64, f64)) -> Vec3<Enu> {
        let view = &self.map.view;
        let ((right_m, up_m), toward) = (self.map.view_from_drawing((x, y)), view.toward_viewer());
        view.right * right_m + view.up * up_m + toward * self.through_m.dot(toward)
    }

    /// Returns the air in the middle of a square, or just above the surface that crosses an upright one.
    fn air_in_cell(&self, row: usize, column: usize, air: &mut MeanAir) -> Option<AirSample> {
        let mut point_m = self.point_m(self.middle(row, column));
        let below_m = air.surface_up_m(point_m) - point_m.up();
        if below_m > 0.0 {
            let is_crossed = self.plane == AirPlane::Across && below_m < 0.5 * self.cell.1 / self.map.scale;
            is_crossed.then_some(())?;
            point_m += Vec3::new(0.0, 0.0, below_m);
        }
        Some(air.sample(point_m))
    }

    /// Returns the speed of the air in the plane, m/s.
    #[must_use]
    pub fn speed_m_s(&self, air: &AirSample) -> f64 {
        let (right_m_s, up_m_s) = self.map.view.at(air.velocity_m_s);
        math::hypot(right_m_s, up_m_s)
    }

    /// Returns the lowest and highest speed in the plane, m/s.
    #[must_use]
    pub fn speed_range_m_s(&self) -> (f64, f64) {
        math::range(self.cells.iter().flatten().flatten().map(|air| self.speed_m_s(air)))
    }

    /// Returns every `step`-th square in both directions, from the middle of the first one.
    fn spaced(&self, step: usize) -> impl Iterator<Item = AirArrow> {
        let places = (step / 2..self.cells.len())
            .step_by(step)
            .flat_map(move |row| (step / 2..self.cells[row].len()).step_by(step).map(move |column| (row, column)));
        places.filter_map(|(row, column)| {
            let middle = self.middle(row, column);
            Some(AirArrow { position_m: self.point_m(middle), middle, air: self.cells[row][column]? })
        })
    }

    /// Returns the arrows.
    pub fn arrows(&self) -> impl Iterator<Item = AirArrow> {
        self.spaced(ARROW_CELLS)
    }

    /// Returns the length of an arrow at the highest speed of the scale, in drawing units.
    #[must_use]
    pub fn longest_arrow(&self) -> f64 {
        ARROW_SHARE * ARROW_CELLS as f64 * self.cell.0
    }

    /// Returns an arrow's extent in the drawing, right and down.
    #[must_use]
    pub fn extent(&self, arrow: &AirArrow, speeds: SpeedScale) -> (f64, f64) {
        let length = self.longest_arrow() / speeds.top_m_s();
        let (right_m_s, up_m_s) = self.map.view.at(arrow.air.velocity_m_s);
        (right_m_s * length, -up_m_s * length)
    }

    /// Returns the distance of a position from the plane, m.
    fn distance_m(&self, position_m: Vec3<Enu>) -> f64 {
        (position_m - self.through_m).dot(self.map.view.toward_viewer()).abs()
    }

    /// Returns whether a position is so close to the plane that it is drawn with strong lines.
    fn is_near(&self, position_m: Vec3<Enu>) -> bool {
        let [level_m, across_m] = NEAR_PLANE_M;
        self.distance_m(position_m) <= if self.plane == AirPlane::Level { level_m } else { across_m }
    }

    /// Returns whether a position is in the colored part of the drawing.
    fn contains(&self, position_m: Vec3<Enu>) -> bool {
        let ([(left, top), (right, bottom)], (x, y)) = (self.corners, self.map.at(position_m));
        (left..=right).contains(&x) && (top..=bottom).contains(&y)
    }

    /// Draws the section.
    #[must_use]
    pub fn drawing(&self, review: &Review, bridge: &Bridge, speeds: SpeedScale, title: &str) -> Markup {
        let is_near_bridge = is_near_bridge(bridge);
        let is_shown = |frame: &Frame| is_near_bridge(frame) && self.contains(frame.position_m);
        let is_strong = |frame: &Frame| is_shown(frame) && self.is_near(frame.position_m);
        let is_faint = |frame: &Frame| is_shown(frame) && !self.is_near(frame.position_m);
        let strong = plain_color(review, &self.map, &is_strong);
        let body = html! {
            (self.colors(speeds))
            @if self.plane == AirPlane::Across { (self.ground(review)) }
            path.turbulence d=(self.turbulence()) {}
            path.air-arrows d=(self.arrow_path(speeds)) {}
            (self.structure(review, bridge))
            @if self.plane == AirPlane::Level { path.air-flown.far d=(plain_color(review, &self.map, &is_faint)) {} }
            path.air-flown.edge d=(strong) {}
            path.air-flown d=(strong) {}
            (self.places(review, bridge))
            @if self.plane == AirPlane::Level { (self.compass(review.metadata.language)) }
            g.drone data-matrix=(self.map.matrix()) data-near=(near_bridge_data(bridge)) { circle r="7" {} circle.core r="2.5" {} }
            (scale(&self.map))
        };
        svg_figure(self.map.size, title, "map", &body)
    }

    /// Draws the speeds: runs of squares of one class as rectangles.
    fn colors(&self, speeds: SpeedScale) -> Markup {
        let class = |cell: &Option<AirSample>| cell.map_or(CLASSES, |air| speeds.class(self.speed_m_s(&air)));
        let mut paths = vec![String::new(); CLASSES + 1];
        for (row, cells) in self.cells.iter().enumerate() {
            let mut from = 0;
            for run in cells.chunk_by(|a, b| class(a) == class(b)) {
                let (x, y) = self.middle(row, from);
                let (width, height) = (run.len() as f64 * self.cell.0 + OVERLAP, self.cell.1 + OVERLAP);
                let [x, y] = [x - 0.5 * self.cell.0, y - 0.5 * self.cell.1].map(coord);
                let [width, height] = [width, height].map(coord);
                paths[class(&run[0])].push_str(&format!("M{x} {y}h{width}v{height}h-{width}z"));
                from += run.len();
            }
        }
        let ground = paths.pop().unwrap_or_default();
        html! {
            g.air {
                @for (class, path) in paths.iter().enumerate().filter(|(_, path)| !path.is_empty()) { path class={ "air-" (class) } d=(path) {} }
                @if self.plane == AirPlane::Level && !ground.is_empty() { path.ground d=(ground) {} }
            }
        }
    }

    /// Draws ground and water in an upright plane.
    fn ground(&self, review: &Review) -> Markup {
        let [(left, _), (right, bottom)] = self.corners;
        let [from, to] = [left, right].map(|x| self.map.view_from_drawing((x, 0.0)).0);
        let profile = ground_profile(&review.scenario, &review.site, &self.map.view, self.through_m, (from, to));
        let mut corners = vec![(left, bottom)];
        corners.extend(profile.into_iter().map(|at| self.map.drawing_from_view(at)).map(|(x, y)| (x.min(right), y.min(bottom))));
        corners.push((right, bottom));
        let (_, water) = self.map.drawing_from_view((0.0, review.scenario.terrain.water_level_m));
        html! {
            rect.water x=(coord(left)) y=(coord(water)) width=(coord(right - left)) height=(coord((bottom - water).max(0.0))) {}
            path.ground d=(line(&simplify_polyline(&corners, 0.3), true)) {}
        }
    }

    /// Returns the marks of turbulence: one stroke from the first level, two from the second.
    fn turbulence(&self) -> String {
        let mut path = String::new();
        let size = coord(2.0 * TURBULENCE_MARK);
        for place in self.spaced(TURBULENCE_CELLS) {
            let intensity = place.air.turbulence_m_s / place.air.free_m_s.norm();
            let [x, low, high] =
                [place.middle.0 - TURBULENCE_MARK, place.middle.1 + TURBULENCE_MARK, place.middle.1 - TURBULENCE_MARK].map(coord);
            if intensity >= TURBULENCE_LEVELS[0] {
                path.push_str(&format!("M{x} {low}l{size} -{size}"));
            }
            if intensity >= TURBULENCE_LEVELS[1] {
                path.push_str(&format!("M{x} {high}l{size} {size}"));
            }
        }
        path
    }

    fn arrow_path(&self, speeds: SpeedScale) -> String {
        let mut path = String::new();
        for arrow in self.arrows() {
            let (dx, dy) = self.extent(&arrow, speeds);
            let length = math::hypot(dx, dy);
            let (x, y) = arrow.middle;
            if length < MIN_ARROW {
                path.push_str(&format!("M{} {}h0", coord(x), coord(y)));
                continue;
            }
            // The head's sides are a third of the arrow, 30 degrees off its shaft.
            let head = (0.35 * length).min(6.0) / length;
            let side = |turn: f64| (-head * (0.87 * dx - turn * 0.5 * dy), -head * (0.87 * dy + turn * 0.5 * dx));
            let ((ax, ay), (bx, by)) = (side(1.0), side(-1.0));
            let points = [x - 0.5 * dx, y - 0.5 * dy, dx, dy, ax, ay, -ax, -ay, bx, by].map(coord);
            let [x, y, dx, dy, ax, ay, cx, cy, bx, by] = points;
            path.push_str(&format!("M{x} {y}l{dx} {dy}l{ax} {ay}m{cx} {cy}l{bx} {by}"));
        }
        path
    }

    /// Draws the members that the plane cuts, and above or below a level plane the edges of the deck.
    fn structure(&self, review: &Review, bridge: &Bridge) -> Markup {
        let prefix = format!("{}/", bridge.name);
        let members = review.site.members().iter().filter(|member| member.name.starts_with(&prefix));
        let drawn = |points: &[(f64, f64)]| points.iter().map(|at| self.map.drawing_from_view(*at)).collect::<Vec<_>>();
        let path = |cut: SectionCut| match cut {
            SectionCut::Area(corners) => line(&drawn(&corners), true),
            SectionCut::Lines(lines) => lines.iter().map(|ends| line(&drawn(ends), false)).collect(),
        };
        let (half_length_m, half_width_m) = (0.5 * bridge.deck_length_m(), 0.5 * bridge.deck_width_m());
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let corner = |(x, y): (f64, f64)| self.map.at(bridge.placement().point([x * half_length_m, y * half_width_m, 0.0]));
        html! {
            @if self.plane == AirPlane::Level { path.air-deck d=(line(&corners.map(corner), true)) {} }
            g.structure {
                @for cut in members.filter_map(|member| section_cut(member, &self.map.view, self.through_m)) { path d=(path(cut)) {} }
            }
        }
    }

    /// Draws the numbers of the places where the air was disturbed most.
    fn places(&self, review: &Review, bridge: &Bridge) -> Markup {
        let language = review.metadata.language;
        let is_shown = |place: &DisturbedPlace| {
            let own =
                place.zone.and_then(|zone| review.scenario.bridges.get(zone.bridge)).is_some_and(|own| own.name == bridge.name);
            own && self.contains(place.position_m) && (self.plane == AirPlane::Level || self.is_near(place.position_m))
        };
        let title = |number: usize, place: &DisturbedPlace| {
            let (moment, speed) = (formatting::clock(place.at_s), formatting::number(place.added_m_s.norm(), 1));
            text!(language, "plot-air-place", number = number, moment = moment, speed = speed)
        };
        html! {
            @for (number, place) in (1..).zip(&review.air.places).filter(|(_, place)| is_shown(place)) {
                @let (x, y) = self.map.at(place.position_m);
                g.air-place transform={ "translate(" (coord(x)) " " (coord(y)) ")" } {
                    circle r="10" {}
                    text.mark y="4.2" text-anchor="middle" { (number) }
                    title { (title(number, place)) }
                }
            }
        }
    }

    /// Draws a needle toward the north.
    fn compass(&self, language: Language) -> Markup {
        let (east, up) = self.map.view.at(Vec3::new(0.0, 1.0, 0.0));
        let turn_deg = math::bearing_deg(east, up);
        let (x, y) = (12.0 * math::sin(turn_deg.to_radians()), -12.0 * math::cos(turn_deg.to_radians()));
        html! {
            g.air-compass transform={ "translate(" (coord(self.corners[1].0 - 26.0)) " " (coord(self.corners[0].1 + 26.0)) ")" } {
                circle r="20" {}
                path transform={ "rotate(" (coord(turn_deg)) ")" } d="M0 4L4 9L0 -6L-4 9Z" {}
                text.mark x=(coord(x)) y=(coord(y + 4.0)) text-anchor="middle" { (text!(language, "plot-north")) }
            }
        }
    }
}

/// Returns the view, a point and two opposite corners of a level plane at a height, m above the origin.
fn level_plane(up_m: f64, bridge: &Bridge, flown_m: &[Vec3<Enu>]) -> (ParallelView, Vec3<Enu>, [Vec3<Enu>; 2]) {
    let placement = bridge.placement();
    let (right, up) = (placement.direction([1.0, 0.0, 0.0]), placement.direction([0.0, 1.0, 0.0]));
    let is_beside = |local: &[f64; 3]| local[1].abs() <= 0.5 * bridge.deck_width_m() + MAX_BESIDE_M;
    let local = || flown_m.iter().map(|at| placement.local(*at));
    // Farther beside, a flight near the bridge leaves the drawing, but still determines its length.
    let beside = local().filter(is_beside).map(|local| local[0]);
    let (from_m, to_m) =
        if local().any(|local| is_beside(&local)) { math::range(beside) } else { math::range(local().map(|local| local[0])) };
    let lacking_m = (0.5 * (MIN_LENGTH_M - (to_m - from_m + 2.0 * MARGIN_M))).max(0.0);
    let (low_m, high_m) = beside_deck(bridge, flown_m);
    let z_m = up_m - bridge.center_m.up();
    let corners = [[from_m - MARGIN_M - lacking_m, low_m, z_m], [to_m + MARGIN_M + lacking_m, high_m, z_m]];
    (ParallelView { right, up }, placement.point([0.0, 0.0, z_m]), corners.map(|corner| placement.point(corner)))
}

/// Returns the view, a point and two opposite corners of an upright plane across a bridge at a distance from its middle, m.
fn upright_plane(
    along_m: f64,
    bridge: &Bridge,
    flown_m: &[Vec3<Enu>],
    air: &MeanAir,
) -> (ParallelView, Vec3<Enu>, [Vec3<Enu>; 2]) {
    let placement = bridge.placement();
    let (right, up) = (placement.direction([0.0, -1.0, 0.0]), Vec3::new(0.0, 0.0, 1.0));
    let through_m = placement.point([along_m, 0.0, 0.0]);
    let near: Vec<Vec3<Enu>> =
        flown_m.iter().copied().filter(|at| (placement.local(*at)[0] - along_m).abs() <= NEAR_PLANE_M[1]).collect();
    let (low_m, high_m) = beside_deck(bridge, &near);
    let top_m = near.iter().map(|at| placement.local(*at)[2]).fold(bridge.fascia_z_m().1, f64::max) + UPRIGHT_MARGIN_M.0;
    let bottom_m = air.surface_up_m(through_m) - bridge.center_m.up() - UPRIGHT_MARGIN_M.1;
    let corners = [[along_m, low_m, bottom_m], [along_m, high_m, top_m]];
    (ParallelView { right, up }, through_m, corners.map(|corner| placement.point(corner)))
}

/// Returns the range across a bridge that contains the deck and the flown positions, with margins, m to its left.
fn beside_deck(bridge: &Bridge, flown_m: &[Vec3<Enu>]) -> (f64, f64) {
    let placement = bridge.placement();
    let half_m = 0.5 * bridge.deck_width_m();
    let (low_m, high_m) = math::range(flown_m.iter().map(|at| placement.local(*at)[1]).chain([-half_m, half_m]));
    let most_m = half_m + MAX_BESIDE_M;
    ((low_m - MARGIN_M).max(-most_m), (high_m + MARGIN_M).min(most_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::{scenario, shipped};

    #[test]
    fn exact_a_hover_far_beside_a_bridge_still_has_a_level_plane() {
        let job = scenario::read("two-bridges.toml", shipped::TWO_BRIDGES, &|_| Err("none".into())).unwrap();
        for bridge in &job.bridges {
            let far_m = 0.5 * bridge.deck_width_m() + MAX_BESIDE_M + 5.0;
            let hover_m = bridge.placement().point([3.0, far_m, 0.0]);
            let (_, _, corners_m) = level_plane(hover_m.up(), bridge, &[hover_m; 3]);
            let [from, to] = corners_m.map(|corner| bridge.placement().local(corner));
            assert!((to[0] - from[0] - MIN_LENGTH_M).abs() < 1e-9 && from[0] < 3.0 && 3.0 < to[0], "{from:?} {to:?}");
        }
    }
}
