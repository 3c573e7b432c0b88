//! Water and ground in the background of a drawing.

use super::plot_map::PlotMap;
use super::{coord, line, simplify_polyline};
use maud::{Markup, html};
use spandrel_model::frames::Vec3;
use spandrel_model::scenario::{Bridge, Scenario};
use spandrel_model::site::Site;
use spandrel_model::site::outline::{GROUND_SAMPLE_SPACING_M, ground_profile, water_strips};

/// Draws the water in plan view as horizontal strips between the shores.
pub(super) fn lake(scenario: &Scenario, site: &Site, map: &PlotMap) -> Markup {
    let side = GROUND_SAMPLE_SPACING_M * map.scale;
    html! {
        g.lake {
            @for strip in water_strips(scenario, site) {
                @let (x0, y) = map.at(Vec3::new(strip.west_m, strip.north_m, 0.0));
                @let (x1, _) = map.at(Vec3::new(strip.east_m, strip.north_m, 0.0));
                @if y > -side && y < map.size.1 + side && x1 > 0.0 && x0 < map.size.0 {
                    rect x=(coord(x0)) y=(coord(y - 0.5 * side)) width=(coord(x1 - x0)) height=(coord(side + 0.5)) {}
                }
            }
        }
    }
}

/// Draws the background of a bridge's side view: the ground below the bridge axis and the water.
pub(super) fn ground(scenario: &Scenario, site: &Site, map: &PlotMap, bridge: &Bridge) -> Markup {
    let from = map.corner_m.0;
    let profile = ground_profile(scenario, site, &map.view, bridge.center_m, (from, from + map.size.0 / map.scale));
    let profile = profile.into_iter().map(|at| map.drawing_from_view(at));
    let mut corners = vec![(0.0, map.size.1)];
    corners.extend(profile.map(|(x, y)| (x, y.min(map.size.1))));
    corners.push((map.size.0, map.size.1));
    let (_, water) = map.drawing_from_view((0.0, scenario.terrain.water_level_m));
    html! {
        rect.water x="0" y=(coord(water)) width=(coord(map.size.0)) height=(coord((map.size.1 - water).max(0.0))) {}
        path.ground d=(line(&simplify_polyline(&corners, 0.3), true)) {}
    }
}
