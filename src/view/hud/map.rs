//! The small map: reference paths, pad and drone, north up.

use super::state::Hud;
use super::{Colour, Item, Point, Side, at};
use crate::base::frames::{Enu, Vec3};
use crate::base::math;

/// Half the map's side as a share of the picture's height.
const HALF: f64 = 0.135;
/// Middle of the map, as shares of the height from the right and lower edges.
const FROM_EDGE: f64 = 0.16;
/// Room around what is shown, as a share.
const ROOM: f64 = 1.12;
/// The map shows at least this far from its middle, m.
const LEAST_M: f64 = 20.0;

/// The map's items.
pub fn map(hud: &Hud, aspect: f64) -> Vec<Item> {
    if hud.tracks.is_empty() {
        return Vec::new();
    }
    let shown = hud.tracks.iter().flat_map(|t| t.path_m.iter().copied()).chain([hud.pad_m, hud.position_m]);
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for p in shown {
        for (k, x) in [p.east(), p.north()].into_iter().enumerate() {
            low[k] = low[k].min(x);
            high[k] = high[k].max(x);
        }
    }
    let middle = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
    let reach = (0.5 * (high[0] - low[0]).max(high[1] - low[1]) * ROOM).max(LEAST_M);
    let centre = at(1.0 - FROM_EDGE / aspect, 1.0 - FROM_EDGE);
    let place = |p: Vec3<Enu>| -> Point {
        let share = |x: f64, k: usize| (x - middle[k]) / reach * HALF * 0.94;
        at(centre.x + share(p.east(), 0) / aspect, centre.y - share(p.north(), 1))
    };
    let mut items = vec![Item::Panel {
        from: at(centre.x - HALF / aspect, centre.y - HALF),
        to: at(centre.x + HALF / aspect, centre.y + HALF),
        colour: Colour::Shade,
    }];
    let mut labels: Vec<Point> = Vec::new();
    for track in &hud.tracks {
        let mut points: Vec<Point> = track.path_m.iter().step_by(3).map(|p| place(*p)).collect();
        points.extend(track.path_m.last().filter(|_| !track.closed).or(track.path_m.first()).map(|p| place(*p)));
        let start = points[0];
        items.push(Item::Line { points, width: 0.004, colour: Colour::Blue });
        let label = beside(&labels, at(start.x, start.y - 0.014), aspect);
        items.push(text(label, format!("{}", track.id)));
        labels.push(label);
    }
    let pad = place(hud.pad_m);
    let side = 0.007;
    let square = [(-side, -side), (side, -side), (side, side), (-side, side)];
    items.push(Item::Fill {
        points: square.iter().map(|(x, y)| at(pad.x + x / aspect, pad.y + y)).collect(),
        colour: Colour::White,
    });
    items.push(Item::Fill { points: arrow(place(hud.position_m), hud.heading_rad, aspect), colour: Colour::Yellow });
    items.push(text(at(centre.x, centre.y - HALF + 0.016), "N".into()));
    items
}

/// The place of a label: where it belongs, or to the right of those that stand there.
fn beside(labels: &[Point], place: Point, aspect: f64) -> Point {
    const HIGH: f64 = 0.02;
    const WIDE: f64 = 0.018;
    let covers = |there: &Point, here: Point| (there.x - here.x).abs() * aspect < WIDE - 1e-9 && (there.y - here.y).abs() < HIGH;
    let mut here = place;
    while labels.iter().any(|there| covers(there, here)) {
        here = at(here.x + WIDE / aspect, here.y);
    }
    here
}

fn text(place: Point, words: String) -> Item {
    Item::Text { place, side: Side::Middle, height: 0.022, colour: Colour::Grey, words }
}

/// A dart that points along the heading.
fn arrow(tip: Point, heading_rad: f64, aspect: f64) -> Vec<Point> {
    let (s, c) = math::sin_cos(heading_rad);
    let turned = |x: f64, y: f64| at(tip.x + (x * c + y * s) / aspect, tip.y - (y * c - x * s));
    vec![turned(0.0, 0.016), turned(0.010, -0.011), turned(-0.010, -0.011)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_labels_of_paths_that_begin_at_one_place_stand_beside_each_other() {
        let mut labels = Vec::new();
        for _ in 0..3 {
            labels.push(beside(&labels, at(0.9, 0.8), 2.0));
        }
        let gaps: Vec<f64> = labels.windows(2).map(|pair| 2.0 * (pair[1].x - pair[0].x)).collect();
        assert!(gaps.iter().all(|gap| (gap - 0.018).abs() < 1e-9), "{gaps:?}");
        assert_eq!(beside(&labels, at(0.9, 0.7), 2.0), at(0.9, 0.7), "elsewhere there is room");
    }
}
