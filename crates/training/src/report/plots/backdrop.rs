//! Water and ground in the background of a drawing.

use super::plot_map::PlotMap;
use super::{coord, line, simplify_polyline};
use maud::{Markup, html};
use spandrel_model::frames::Vec3;
use spandrel_model::scenario::{Bridge, Scenario};
use spandrel_model::site::Site;

/// Distance between samples of water and ground, m.
const GROUND_SAMPLE_SPACING_M: f64 = 5.0;

/// Draws the water in plan view as horizontal strips between the shores.
pub(super) fn lake(scenario: &Scenario, site: &Site, map: &PlotMap) -> Markup {
    let terrain = &scenario.terrain;
    let half = 0.5 * terrain.size_m;
    let count = (terrain.size_m / GROUND_SAMPLE_SPACING_M).floor().clamp(1.0, 400.0) as usize;
    let coordinate = |k: usize| -half + (k as f64 + 0.5) * 2.0 * half / count as f64;
    let mut strips = Vec::new();
    for row in 0..count {
        let n = coordinate(row);
        let depth = |column: usize| terrain.water_level_m - site.ground_up_m(coordinate(column), n);
        let mut wet: Option<f64> = None;
        for column in 0..count {
            let (now, e) = (depth(column), coordinate(column));
            let shore = if column == 0 { e } else { crossing((coordinate(column - 1), depth(column - 1)), (e, now)) };
            match wet {
                None if now > 0.0 => wet = Some(shore),
                Some(from) if now <= 0.0 => {
                    strips.push((from, shore, n));
                    wet = None;
                }
                None | Some(_) => {}
            }
        }
        strips.extend(wet.map(|from| (from, half, n)));
    }
    let side = GROUND_SAMPLE_SPACING_M * map.scale;
    html! {
        g.lake {
            @for (from, to, n) in strips {
                @let (x0, y) = map.at(Vec3::new(from, n, 0.0));
                @let (x1, _) = map.at(Vec3::new(to, n, 0.0));
                @if y > -side && y < map.size.1 + side && x1 > 0.0 && x0 < map.size.0 {
                    rect x=(coord(x0)) y=(coord(y - 0.5 * side)) width=(coord(x1 - x0)) height=(coord(side + 0.5)) {}
                }
            }
        }
    }
}

/// Returns the zero crossing between two samples.
fn crossing(a: (f64, f64), b: (f64, f64)) -> f64 {
    if (a.1 > 0.0) == (b.1 > 0.0) { b.0 } else { a.0 + (b.0 - a.0) * a.1 / (a.1 - b.1) }
}

/// Draws the background of a bridge's side view: the ground below the bridge axis and the water.
pub(super) fn ground(scenario: &Scenario, site: &Site, map: &PlotMap, bridge: &Bridge) -> Markup {
    let axis = map.view.right;
    let middle = map.view.at(bridge.center_m).0;
    let from = map.corner_m.0;
    let to = from + map.size.0 / map.scale;
    let count = ((to - from) / GROUND_SAMPLE_SPACING_M).ceil().clamp(1.0, 400.0) as usize;
    let half = 0.5 * scenario.terrain.size_m;
    let profile = (0..=count).map(|k| {
        let along = from + (to - from) * k as f64 / count as f64;
        let at = bridge.center_m + axis * (along - middle);
        let up = site.ground_up_m(at.east().clamp(-half, half), at.north().clamp(-half, half));
        map.drawing_from_view((along, up))
    });
    let mut corners = vec![(0.0, map.size.1)];
    corners.extend(profile.map(|(x, y)| (x, y.min(map.size.1))));
    corners.push((map.size.0, map.size.1));
    let (_, water) = map.drawing_from_view((0.0, scenario.terrain.water_level_m));
    html! {
        rect.water x="0" y=(coord(water)) width=(coord(map.size.0)) height=(coord((map.size.1 - water).max(0.0))) {}
        path.ground d=(line(&simplify_polyline(&corners, 0.3), true)) {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_shore_is_at_zero_depth() {
        assert_eq!(crossing((0.0, 1.0), (10.0, -4.0)), 2.0);
    }
}
