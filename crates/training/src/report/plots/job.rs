//! Drawings of a job without a flight, used on the scenario page and as the background of the live page.

use super::backdrop::{ground, lake};
use super::map::{extent, near_bridge_data, north, pad, places, reference_paths, scale, structure, task_numbers};
use super::plot_map::PlotMap;
use super::{coord, svg_figure};
use crate::terms::defect_title;
use maud::{Markup, html};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::{Bridge, Scenario};
use spandrel_model::site::Site;
use spandrel_model::site::outline::ParallelView;
use spandrel_text::{Language, text};

/// Margin beyond each end of a bridge in its side view, m.
const END_MARGIN_M: f64 = 25.0;
/// Margin above a bridge, m, so that a drone above the deck stays inside the drawing.
const TOP_MARGIN_M: f64 = 15.0;

/// Margin around a job in the plan of the scenario editor, m: room for new places.
const EDITOR_MARGIN_M: f64 = 50.0;

/// Draws the plan view with north up.
#[must_use]
pub fn job_plan(scenario: &Scenario, site: &Site, language: Language) -> Markup {
    let map = PlotMap::around(ParallelView::plan(), &extent(scenario, site));
    plan(scenario, site, &map, &html! {}, language)
}

/// Draws the plan view for the scenario editor: with a margin, the inspector, the truck and the defects that the scenario places.
#[must_use]
pub fn editor_plan(scenario: &Scenario, site: &Site, language: Language) -> Markup {
    let team = &scenario.ground_team;
    let mut points = extent(scenario, site);
    points.extend([team.inspector_m, team.truck_m]);
    let corners: Vec<Vec3<Enu>> = points
        .iter()
        .flat_map(|point| [-EDITOR_MARGIN_M, EDITOR_MARGIN_M].map(|margin_m| *point + Vec3::new(margin_m, margin_m, 0.0)))
        .collect();
    let map = PlotMap::around(ParallelView::plan(), &corners);
    let place = |(x, y): (f64, f64)| format!("translate({} {})", coord(x), coord(y));
    let marks = html! {
        g.crew transform=(place(map.at(team.inspector_m))) { circle r="4" {} text.tick x="-2" y="20" { (text!(language, "plot-inspector")) } }
        g.crew transform=(place(map.at(team.truck_m))) { path d="M-7 -4H7V4H-7Z" {} text.tick x="-7" y="-10" { (text!(language, "plot-truck")) } }
        g.crew transform=(place(map.at(team.pad_m))) { text.tick x="11" y="4" { (text!(language, "plot-pad")) } }
        (defect_marks(scenario, &map, None, language))
    };
    plan(scenario, site, &map, &marks, language)
}

fn plan(scenario: &Scenario, site: &Site, map: &PlotMap, marks: &Markup, language: Language) -> Markup {
    svg_figure(
        map.size,
        &text!(language, "plot-job-plan"),
        "map",
        &html! {
            (lake(scenario, site, map))
            (structure(site, map, None))
            (reference_paths(scenario, map, None, language))
            (task_numbers(scenario, map, None))
            (pad(scenario, map, language))
            (places(scenario, map, language))
            (marks)
            (north(map, language))
            (inspector(scenario, map))
            (drone(map, None))
            (scale(map))
        },
    )
}

/// Draws the side view of one bridge.
#[must_use]
pub fn job_side(scenario: &Scenario, site: &Site, bridge: &Bridge, language: Language) -> Markup {
    side(scenario, site, bridge, (&side_map(scenario, site, bridge), &html! {}), language)
}

/// Draws the side view of one bridge for the scenario editor: with the defects that the scenario places on it.
#[must_use]
pub fn editor_side(scenario: &Scenario, site: &Site, bridge: &Bridge, language: Language) -> Markup {
    let map = side_map(scenario, site, bridge);
    let marks = defect_marks(scenario, &map, Some(bridge), language);
    side(scenario, site, bridge, (&map, &marks), language)
}

/// Draws the defects that the scenario places, on one bridge or on all.
fn defect_marks(scenario: &Scenario, map: &PlotMap, bridge: Option<&Bridge>, language: Language) -> Markup {
    let prefix = bridge.map(|bridge| format!("{}/", bridge.name)).unwrap_or_default();
    let placed = scenario.defects.placed.iter().flatten().filter(|defect| defect.member.starts_with(&prefix));
    html! {
        @for defect in placed {
            @let (x, y) = map.at(defect.position_m);
            @let kind = defect_title(defect.kind, language);
            g.placed-defect transform={ "translate(" (coord(x)) " " (coord(y)) ")" } {
                title { (text!(language, "placing-mark", number = defect.id, kind = kind, state = defect.condition_state)) }
                circle r="8" {}
                text.mark y="4" text-anchor="middle" { (defect.id) }
            }
        }
    }
}

fn side_map(scenario: &Scenario, site: &Site, bridge: &Bridge) -> PlotMap {
    let view = ParallelView::side(bridge);
    let water_m = scenario.terrain.water_level_m;
    let prefix = format!("{}/", bridge.name);
    let members = site.members().iter().filter(|member| member.name.starts_with(&prefix));
    let mut points: Vec<Vec3<Enu>> = members.flat_map(|member| member.solid.vertices_m.iter().copied()).collect();
    points.retain(|point| point.up() > water_m - 6.0);
    let top_m = points.iter().map(|point| point.up()).fold(water_m, f64::max);
    let half_m = 0.5 * bridge.deck_length_m() + END_MARGIN_M;
    for along_m in [-half_m, half_m] {
        let end = bridge.center_m + view.right * along_m;
        points.push(Vec3::new(end.east(), end.north(), water_m - 4.0));
        points.push(Vec3::new(end.east(), end.north(), top_m + TOP_MARGIN_M));
    }
    PlotMap::around(view, &points)
}

fn side(scenario: &Scenario, site: &Site, bridge: &Bridge, (map, marks): (&PlotMap, &Markup), language: Language) -> Markup {
    let prefix = format!("{}/", bridge.name);
    let title = text!(language, "plot-job-side", bridge = bridge.name.as_str());
    svg_figure(
        map.size,
        &title,
        "map",
        &html! {
            (ground(scenario, site, map, bridge))
            (structure(site, map, Some(&prefix)))
            (reference_paths(scenario, map, Some(&bridge.name), language))
            (task_numbers(scenario, map, Some(&bridge.name)))
            (marks)
            (drone(map, Some(bridge)))
            (scale(map))
        },
    )
}

/// Draws a job without bridges from the south.
#[must_use]
pub fn job_south(scenario: &Scenario, site: &Site, language: Language) -> Markup {
    let pad_m = scenario.ground_team.pad_m;
    let mut points = extent(scenario, site);
    points.push(Vec3::new(pad_m.east() - END_MARGIN_M, pad_m.north(), pad_m.up()));
    points.push(Vec3::new(pad_m.east() + END_MARGIN_M, pad_m.north(), pad_m.up() + TOP_MARGIN_M));
    let map = PlotMap::around(ParallelView::from_south(), &points);
    let body = html! {
        (structure(site, &map, None))
        (reference_paths(scenario, &map, None, language))
        (task_numbers(scenario, &map, None))
        (pad(scenario, &map, language))
        (drone(&map, None))
        (scale(&map))
    };
    svg_figure(map.size, &text!(language, "plot-job-south"), "map", &body)
}

/// Draws the inspector, which a script moves; nothing in a job with only one place.
fn inspector(scenario: &Scenario, map: &PlotMap) -> Markup {
    html! {
        @if scenario.ground_team.can_walk() { g.walker data-matrix=(map.matrix()) { circle r="5" {} circle.core r="2.5" {} } }
    }
}

/// Draws the drone and its trail, which a script updates. They are hidden until the script runs and, in a bridge's side
/// view, while the drone is far from that bridge.
fn drone(map: &PlotMap, bridge: Option<&Bridge>) -> Markup {
    html! {
        path.trail data-matrix=(map.matrix()) data-near=[bridge.map(near_bridge_data)] d="" {}
        g.drone data-matrix=(map.matrix()) data-near=[bridge.map(near_bridge_data)] { circle r="7" {} circle.core r="2.5" {} }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::scenario::read;

    fn job(text: &str) -> (Scenario, Site) {
        let scenario = read("job.toml", text, &|_| Err("none".into())).unwrap();
        let site = Site::build(&scenario, 1);
        (scenario, site)
    }

    /// Trainees see the drawings without these marks.
    #[test]
    fn exact_only_the_drawings_of_the_editor_show_placed_defects() {
        let base = include_str!("../../../../../scenarios/two-bridges.toml");
        let (scenario, site) = job(base);
        let defect = site.defects()[0].clone();
        let (text, _) = spandrel_model::scenario::edit::with_placed_defect(base, &defect).unwrap();
        let (scenario, site) = (job(&text).0, Site::without_defects(&scenario));
        let marks = |drawing: Markup| drawing.into_string().matches("class=\"placed-defect\"").count();
        let language = Language::English;
        assert_eq!(marks(editor_plan(&scenario, &site, language)), 1);
        assert_eq!(marks(job_plan(&scenario, &site, language)), 0);
        for bridge in &scenario.bridges {
            let is_own = defect.member.starts_with(&format!("{}/", bridge.name));
            assert_eq!(marks(editor_side(&scenario, &site, bridge, language)), usize::from(is_own), "{}", bridge.name);
            assert_eq!(marks(job_side(&scenario, &site, bridge, language)), 0);
        }
    }

    #[test]
    fn exact_job_drawings_contain_members_paths_and_drone() {
        let (scenario, site) = job(include_str!("../../../../../scenarios/two-bridges.toml"));
        let language = Language::English;
        let plan = job_plan(&scenario, &site, language).into_string();
        assert_eq!((plan.matches("reference path of task").count(), plan.matches("data-near").count()), (4, 0));
        assert_eq!(plan.matches("class=\"start\"").count(), 4, "each path has its number");
        assert!(plan.contains("class=\"lake\"") && plan.contains("class=\"structure\""));
        let count = plan.matches("class=\"place\"").count();
        assert_eq!((count, plan.matches("class=\"walker\"").count()), (scenario.ground_team.places_m.len() + 1, 1));
        let wide = editor_plan(&scenario, &site, language).into_string();
        assert!(wide.contains("inspector") && wide.contains("truck") && wide.contains("data-matrix") && wide != plan);
        for bridge in &scenario.bridges {
            let side = job_side(&scenario, &site, bridge, language).into_string();
            assert!(side.contains("class=\"ground\"") && side.contains("data-matrix"));
            assert_eq!(side.matches("data-near=").count(), 2, "the drone and trail are limited to this bridge");
            assert!(side.matches("reference path of task").count() < 4, "only the paths at this bridge are drawn");
        }
        let (scenario, site) = job(include_str!("../../../../../scenarios/drill-hover.toml"));
        assert!(job_south(&scenario, &site, language).into_string().contains("data-matrix"));
        let plan = job_plan(&scenario, &site, language).into_string();
        assert!(!plan.contains("class=\"place\"") && !plan.contains("walker"), "a job with only one place");
    }
}
