//! The flight on the site in a parallel projection: member silhouettes, reference paths, the flight path in one of
//! three color modes, marks for pictures, crashes and defects, and the drone, which follows the page's slider.

use super::backdrop::{ground, lake};
use super::colors::{COLOR_MODES, track};
use super::plot_map::{PlotMap, TRACK_TOLERANCE};
use super::{coord, line, simplify_polyline, svg_figure};
use crate::report::Review;
use crate::report::formatting;
use crate::report::line_of_sight::flown_walks;
use crate::terms::contact_title;
use maud::{Markup, html};
use spandrel_mavlink::telemetry::Frame;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::{Bridge, Scenario, Task};
use spandrel_model::site::Site;
use spandrel_model::site::inspector_walks::Walk;
use spandrel_model::site::outline::{ParallelView, outlines};
use spandrel_monitor::measures::crash::Crash;
use spandrel_text::{Language, text};

/// Minimum size of a shape, in drawing units; smaller shapes are omitted.
const MIN_SHAPE_SIZE: f64 = 1.6;
/// Maximum distance from a bridge's axis at which a frame is drawn in the bridge's side view, m.
const MAX_SIDE_DISTANCE_M: f64 = 45.0;
/// Maximum number of pictures with numbered marks; more get small, unnumbered marks.
const MAX_NUMBERED_PICTURES: usize = 40;

/// Draws the plan view of a flight.
#[must_use]
pub fn plan(review: &Review) -> Markup {
    let map = PlotMap::around(ParallelView::plan(), &bounding_points(review));
    let all = |_: &Frame| true;
    let body = html! {
        (lake(&review.scenario, &review.site, &map))
        (structure(&review.site, &map, None))
        (places(&review.scenario, &map, review.metadata.language))
        (walks(review, &map))
        (job(review, &map, None, &all))
        (north(&map, review.metadata.language))
    };
    svg_figure(map.size, &text!(review.metadata.language, "plot-flight-plan"), "map", &body)
}

/// Draws the oblique view of a flight.
#[must_use]
pub fn oblique(review: &Review) -> Markup {
    let map = PlotMap::around(ParallelView::oblique(25.0, 22.0), &bounding_points(review));
    let all = |_: &Frame| true;
    svg_figure(
        map.size,
        &text!(review.metadata.language, "plot-flight-oblique"),
        "map",
        &html! {
            (structure(&review.site, &map, None))
            (job(review, &map, None, &all))
        },
    )
}

/// Draws one bridge from the side with the nearby flight path.
#[must_use]
pub fn elevation(review: &Review, bridge: &Bridge) -> Markup {
    let near = is_near_bridge(bridge);
    let map = side_view_map(&review.scenario, &review.site, bridge, review.frames.iter().filter(|frame| near(frame)));
    let prefix = format!("{}/", bridge.name);
    let title = text!(review.metadata.language, "plot-flight-side", bridge = bridge.name.as_str());
    svg_figure(
        map.size,
        &title,
        "map",
        &html! {
            (ground(&review.scenario, &review.site, &map, bridge))
            (structure(&review.site, &map, Some(&prefix)))
            (job(review, &map, Some(bridge), &near))
        },
    )
}

/// Returns the values that the page's script uses to decide whether the drone is near a bridge: the center's east and
/// north, the axis's east and north, and the limits along and across the bridge, m.
pub(super) fn near_bridge_data(bridge: &Bridge) -> String {
    let axis = ParallelView::side(bridge).right;
    let half_m = 0.5 * bridge.deck_length_m() + 25.0;
    [bridge.center_m.east(), bridge.center_m.north(), axis.east(), axis.north(), half_m, MAX_SIDE_DISTANCE_M]
        .map(|value| format!("{value:.3}"))
        .join(" ")
}

/// Returns a function that decides whether a frame belongs in this bridge's side view.
pub(in crate::report) fn is_near_bridge(bridge: &Bridge) -> impl Fn(&Frame) -> bool + use<> {
    let (view, center_m) = (ParallelView::side(bridge), bridge.center_m);
    let (axis, towards) = (view.right, view.toward_viewer());
    let half_m = 0.5 * bridge.deck_length_m() + 25.0;
    move |frame: &Frame| {
        let to = frame.position_m - center_m;
        to.dot(axis).abs() < half_m && to.dot(towards).abs() < MAX_SIDE_DISTANCE_M
    }
}

/// Fits a bridge's side view, including these frames, to a drawing.
pub(super) fn side_view_map<'a>(
    scenario: &Scenario,
    site: &Site,
    bridge: &Bridge,
    flown: impl Iterator<Item = &'a Frame>,
) -> PlotMap {
    let prefix = format!("{}/", bridge.name);
    let members = site.members().iter().filter(|member| member.name.starts_with(&prefix));
    let mut points: Vec<Vec3<Enu>> = members.flat_map(|member| member.solid.vertices_m.iter().copied()).collect();
    points.extend(flown.map(|frame| frame.position_m));
    let water_m = scenario.terrain.water_level_m;
    // Deep foundations would make the rest of the drawing too small.
    points.retain(|point| point.up() > water_m - 6.0);
    points.push(Vec3::new(bridge.center_m.east(), bridge.center_m.north(), water_m - 4.0));
    PlotMap::around(ParallelView::side(bridge), &points)
}

/// Draws a job without bridges from the south.
#[must_use]
pub fn south_elevation(review: &Review) -> Markup {
    let map = PlotMap::around(ParallelView::from_south(), &bounding_points(review));
    let all = |_: &Frame| true;
    svg_figure(
        map.size,
        &text!(review.metadata.language, "plot-flight-south"),
        "map",
        &html! { (structure(&review.site, &map, None)) (job(review, &map, None, &all)) },
    )
}

/// Draws one bridge with its found and missed defects.
#[must_use]
pub fn findings(review: &Review, bridge: &Bridge, view: ParallelView, title: &str) -> Markup {
    let (prefix, language) = (format!("{}/", bridge.name), review.metadata.language);
    let water_m = review.scenario.terrain.water_level_m;
    let members = review.site.members().iter().filter(|member| member.name.starts_with(&prefix));
    let points: Vec<Vec3<Enu>> = members.flat_map(|member| member.solid.vertices_m.iter().copied()).collect();
    let map = PlotMap::around(view, &points.into_iter().filter(|point| point.up() > water_m - 6.0).collect::<Vec<_>>());
    let mine = review.defects.iter().filter(|defect_outcome| defect_outcome.defect.member.starts_with(&prefix));
    svg_figure(
        map.size,
        title,
        "map",
        &html! {
            (structure(&review.site, &map, Some(&prefix)))
            @for defect_outcome in mine {
                @let (x, y) = map.at(defect_outcome.defect.position_m);
                g transform={ "translate(" (coord(x)) " " (coord(y)) ")" } {
                    title { (text!(language, "plot-defect", defect = defect_outcome.defect.id, outcome = defect_outcome.description(language))) }
                    @if defect_outcome.found_by.is_some() { circle.found r="9" {} } @else { path.missed d="M0 -12L12 0L0 12L-12 0Z" {} }
                    text.mark y="4" text-anchor="middle" { (defect_outcome.defect.id) }
                }
            }
        },
    )
}

/// Draws the numbers of the places to which the inspector can walk; nothing in a job with only one place.
pub(super) fn places(scenario: &Scenario, map: &PlotMap, language: Language) -> Markup {
    let team = &scenario.ground_team;
    html! {
        @if team.can_walk() {
            @for (number, place_m) in (1..).zip(team.inspector_places_m()) {
                @let (x, y) = map.at(place_m);
                g.place transform={ "translate(" (coord(x)) " " (coord(y)) ")" } {
                    path d="M-8 -8H8V8H-8Z" {}
                    text.mark y="4" text-anchor="middle" { (number) }
                    title { (text!(language, "plot-place", place = number)) }
                }
            }
        }
    }
}

/// Draws the walks of the inspector up to the end of the flight.
fn walks(review: &Review, map: &PlotMap) -> Markup {
    let language = review.metadata.language;
    let lift_off = review.frames.first().map_or(0.0, |frame| frame.time.s());
    let moment = |walk: &Walk| formatting::clock((walk.at.s() - lift_off).max(0.0));
    html! {
        g.walk {
            @for (walk, from_m, to_m) in flown_walks(&review.site, &review.frames) {
                path d=(line(&[map.at(from_m), map.at(to_m)], false)) {
                    title { (text!(language, "plot-walk", place = walk.to, moment = moment(walk))) }
                }
            }
        }
    }
}

pub(super) fn bounding_points(review: &Review) -> Vec<Vec3<Enu>> {
    let mut all = extent(&review.scenario, &review.site);
    let water_m = review.scenario.terrain.water_level_m;
    all.extend(review.frames.iter().map(|frame| frame.position_m).filter(|point| point.up() > water_m - 6.0));
    all
}

/// Returns the points that bound a job, excluding deep foundations.
pub(super) fn extent(scenario: &Scenario, site: &Site) -> Vec<Vec3<Enu>> {
    let water_m = scenario.terrain.water_level_m;
    let members = site.members().iter().flat_map(|member| member.solid.vertices_m.iter().copied());
    let paths = scenario.tasks.iter().flat_map(|task| task.path_m.iter().copied());
    let team = &scenario.ground_team;
    members
        .chain(paths)
        .chain([team.pad_m])
        .chain(team.inspector_places_m().filter(|_| team.can_walk()))
        .filter(|point| point.up() > water_m - 6.0)
        .collect()
}

pub(super) fn structure(site: &Site, map: &PlotMap, prefix: Option<&str>) -> Markup {
    let of = |name: &str| prefix.is_none_or(|prefix| name.starts_with(prefix));
    let members = site.members().iter().filter(|member| of(&member.name));
    let shapes = outlines(members, &map.view, MIN_SHAPE_SIZE / map.scale);
    html! {
        g.structure {
            @for shape in &shapes {
                path d=(line(&shape.corners.iter().map(|corner| map.drawing_from_view(*corner)).collect::<Vec<_>>(), true)) {}
            }
        }
    }
}

/// Draws the reference paths (of one bridge or of all bridges), the flight path, marks, drone and scale.
fn job(review: &Review, map: &PlotMap, bridge: Option<&Bridge>, shown: &dyn Fn(&Frame) -> bool) -> Markup {
    html! {
        (reference_paths(&review.scenario, map, bridge.map(|bridge| bridge.name.as_str()), review.metadata.language))
        @for (layer, class) in COLOR_MODES.iter().enumerate() {
            g class={ "flown " (class) } {
                @for (color, data) in track(review, map, layer, shown) { path class=(color) d=(data) {} }
            }
        }
        (marks(review, map, shown))
        g.drone data-matrix=(map.matrix()) data-near=[bridge.map(near_bridge_data)] { circle r="7" {} circle.core r="2.5" {} }
        (scale(map))
    }
}

/// Returns the tasks at one bridge or at all bridges. Free paths belong to every bridge.
fn tasks_at<'a>(scenario: &'a Scenario, bridge: Option<&'a str>) -> impl Iterator<Item = &'a Task> {
    scenario.tasks.iter().filter(move |task| {
        let own = task.bridge.and_then(|k| scenario.bridges.get(k)).map(|own| own.name.as_str());
        bridge.is_none() || own.is_none() || own == bridge
    })
}

/// Distance along a path that determines the direction of the arrow at its start, in drawing units.
const ARROW_BASE: f64 = 16.0;
/// Distance of the arrow's tip from the start, in drawing units: just outside the number's circle.
const ARROW_TIP: f64 = 22.0;

/// Draws the number of each task at the start of its path, with an arrow along an open path.
pub(super) fn task_numbers(scenario: &Scenario, map: &PlotMap, bridge: Option<&str>) -> Markup {
    html! {
        @for task in tasks_at(scenario, bridge).filter(|task| !task.path_m.is_empty()) {
            @let start = map.at(task.path_m[0]);
            g.start transform={ "translate(" (coord(start.0)) " " (coord(start.1)) ")" } {
                @if let Some(angle_deg) = start_direction_deg(task, map, start) {
                    path transform={ "rotate(" (coord(angle_deg)) ")" } d={ "M" (coord(ARROW_TIP)) " 0L10 -6L10 6Z" } {}
                }
                circle r="9" {}
                text.mark y="4" text-anchor="middle" { (task.id) }
            }
        }
    }
}

/// Returns the direction of an open path at its start, clockwise from the right; `None` if it is closed or too short.
fn start_direction_deg(task: &Task, map: &PlotMap, start: (f64, f64)) -> Option<f64> {
    let away = |point: &(f64, f64)| math::hypot(point.0 - start.0, point.1 - start.1) >= ARROW_BASE;
    let next = task.path_m.iter().map(|point| map.at(*point)).find(away).filter(|_| !task.closed)?;
    Some(math::atan2(next.1 - start.1, next.0 - start.0).to_degrees())
}

/// Draws the reference paths of one bridge or of all bridges.
pub(super) fn reference_paths(scenario: &Scenario, map: &PlotMap, bridge: Option<&str>, language: Language) -> Markup {
    let reference = |task: &Task| {
        let points: Vec<(f64, f64)> = task.path_m.iter().map(|point| map.at(*point)).collect();
        line(&simplify_polyline(&points, TRACK_TOLERANCE), task.closed)
    };
    html! {
        g.reference { @for task in tasks_at(scenario, bridge) { path d=(reference(task)) { title { (text!(language, "plot-reference", task = task.id)) } } } }
    }
}

fn marks(review: &Review, map: &PlotMap, shown: &dyn Fn(&Frame) -> bool) -> Markup {
    let place = |point: Vec3<Enu>| {
        let (x, y) = map.at(point);
        format!("translate({} {})", coord(x), coord(y))
    };
    let language = review.metadata.language;
    let crash_title = |crash: &Crash| {
        let (object, moment) = (contact_title(crash.with.label(), language), formatting::clock(review.t_s(crash.frame)));
        text!(language, "plot-crash", object = object, moment = moment)
    };
    html! {
        (pad(&review.scenario, map, language))
        @for crash in review.crashes.iter().filter(|crash| shown(&review.frames[crash.frame])) {
            g.crash transform=(place(review.frames[crash.frame].position_m)) {
                path d="M-5 -5L5 5M5 -5L-5 5" {}
                title { (crash_title(crash)) }
            }
        }
        @for picture in &review.pictures {
            @let frame = &review.frames[(picture.frame as usize - 1).min(review.frames.len() - 1)];
            @if shown(frame) {
                g class={ "picture " (picture.verdict.class()) } transform=(place(frame.position_m)) {
                    @if review.pictures.len() > MAX_NUMBERED_PICTURES { circle r="4.5" {} } @else {
                        circle r="8.5" {}
                        text.mark y="3.8" text-anchor="middle" { (picture.number) }
                    }
                    title { (text!(language, "plot-picture", picture = picture.number, verdict = picture.verdict.name(language))) }
                }
            }
        }
    }
}

/// Draws a square at the landing pad.
pub(super) fn pad(scenario: &Scenario, map: &PlotMap, language: Language) -> Markup {
    let (x, y) = map.at(scenario.ground_team.pad_m);
    html! { g.pad transform={ "translate(" (coord(x)) " " (coord(y)) ")" } { path d="M-6 -6H6V6H-6Z" {} title { (text!(language, "plot-pad")) } } }
}

pub(super) fn north(map: &PlotMap, language: Language) -> Markup {
    html! {
        g.north transform={ "translate(" (coord(map.size.0 - 24.0)) " 34)" } {
            path d="M0 -18L7 6L0 1L-7 6Z" {}
            text.tick y="22" text-anchor="middle" { (text!(language, "plot-north")) }
        }
    }
}

pub(super) fn scale(map: &PlotMap) -> Markup {
    let length_m = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0].into_iter().rfind(|m| m * map.scale <= 160.0).unwrap_or(1.0);
    let y = map.size.1 - 14.0;
    html! {
        g.scale {
            path d=(line(&[(16.0, y - 5.0), (16.0, y), (16.0 + length_m * map.scale, y), (16.0 + length_m * map.scale, y - 5.0)], false)) {}
            text.tick x=(coord(22.0 + length_m * map.scale)) y=(coord(y)) { (formatting::number(length_m, 0)) " m" }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::plot_map::MARGIN;
    use super::*;

    #[test]
    fn exact_map_fits_points_with_uniform_scale() {
        let corners = [Vec3::new(-50.0, 10.0, 0.0), Vec3::new(50.0, 60.0, 20.0)];
        let map = PlotMap::around(ParallelView::plan(), &corners);
        for point in corners {
            let (x, y) = map.at(point);
            assert!(x >= MARGIN - 1e-9 && x <= map.size.0 - MARGIN + 1e-9, "{x}");
            assert!(y >= MARGIN - 1e-9 && y <= map.size.1 - MARGIN + 1e-9, "{y}");
            let m: Vec<f64> = map.matrix().split(' ').map(|value| value.parse().unwrap()).collect();
            let [e, n, u] = point.array();
            // The matrix elements have four decimals, and coordinates are at most 60 m.
            assert!((m[0] * e + m[1] * n + m[2] * u + m[3] - x).abs() < 0.02);
            assert!((m[4] * e + m[5] * n + m[6] * u + m[7] - y).abs() < 0.02);
        }
        let (a, b) = (map.at(corners[0]), map.at(corners[1]));
        assert!(((b.0 - a.0) / 100.0 - (a.1 - b.1) / 50.0).abs() < 1e-9, "one scale for both axes; north is up");
    }
}
