//! Inset map: reference paths, landing pad, and drone, north up.

use super::pane::Pane;
use super::state::Hud;
use super::{DrawItem, HudColor, TextAlign};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_text::text;

/// Half the side length of the map.
const HALF_SIZE: f64 = 0.135;
/// Distance of the map's center from the right and bottom edges.
const CENTER_OFFSET: f64 = 0.16;
/// Font size, height, and width of a label.
const FONT_SIZE: f64 = 0.022;
const LABEL_HEIGHT: f64 = 0.02;
const LABEL_WIDTH: f64 = 0.018;
/// Factor that leaves a margin around the displayed content.
const MARGIN_FACTOR: f64 = 1.12;
/// Minimum distance shown from the center, m.
const MIN_RANGE_M: f64 = 20.0;

/// Checks whether the map is shown. The panel of a lesson needs its place.
fn is_shown(hud: &Hud) -> bool {
    !hud.tracks.is_empty() && hud.lesson.is_none()
}

/// Returns the left edge of the map, or `None` if it is hidden.
pub fn left(hud: &Hud, pane: Pane) -> Option<f64> {
    is_shown(hud).then_some(pane.width - CENTER_OFFSET - HALF_SIZE)
}

/// Returns the items of the map.
pub fn map(hud: &Hud, pane: Pane) -> Vec<DrawItem> {
    if !is_shown(hud) {
        return Vec::new();
    }
    let (x, y) = (pane.width - CENTER_OFFSET, pane.height - CENTER_OFFSET);
    let place = scale(hud, (x, y));
    let mut items = vec![pane.panel((x - HALF_SIZE, y - HALF_SIZE), (x + HALF_SIZE, y + HALF_SIZE))];
    let mut labels: Vec<(f64, f64)> = Vec::new();
    for track in &hud.tracks {
        let mut points: Vec<(f64, f64)> = track.path_m.iter().step_by(3).map(|p| place(*p)).collect();
        points.extend(track.path_m.last().filter(|_| !track.closed).or(track.path_m.first()).map(|p| place(*p)));
        let start = points[0];
        items.push(pane.line(&points, 0.004, HudColor::Blue));
        let label = free_label_position(&labels, (start.0, start.1 - 0.014), x + HALF_SIZE - 0.5 * LABEL_WIDTH);
        items.push(pane.text(label, TextAlign::Center, FONT_SIZE, HudColor::Gray, format!("{}", track.id)));
        labels.push(label);
    }
    let (pad, side) = (place(hud.pad_m), 0.007);
    let square = [(-side, -side), (side, -side), (side, side), (-side, side)];
    items.push(pane.fill(&square.map(|(right, down)| (pad.0 + right, pad.1 + down)), HudColor::White));
    if let Some(ghost) = hud.ghost {
        items.push(pane.fill(&arrow(place(ghost.position_m), ghost.ned_from_frd.yaw_rad()), HudColor::Ghost));
    }
    items.push(pane.fill(&arrow(place(hud.position_m), hud.heading_rad), HudColor::Yellow));
    items.push(pane.text(
        (x, y - HALF_SIZE + 0.016),
        TextAlign::Center,
        FONT_SIZE,
        HudColor::Gray,
        text!(hud.style.language, "flight-compass-north"),
    ));
    items
}

/// Returns the projection from world to map coordinates that fits all content.
fn scale(hud: &Hud, (x, y): (f64, f64)) -> impl Fn(Vec3<Enu>) -> (f64, f64) {
    let shown = hud
        .tracks
        .iter()
        .flat_map(|t| t.path_m.iter().copied())
        .chain([hud.pad_m, hud.position_m])
        .chain(hud.ghost.map(|ghost| ghost.position_m));
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for p in shown {
        for (k, meters) in [p.east(), p.north()].into_iter().enumerate() {
            low[k] = low[k].min(meters);
            high[k] = high[k].max(meters);
        }
    }
    let middle = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
    let reach = (0.5 * (high[0] - low[0]).max(high[1] - low[1]) * MARGIN_FACTOR).max(MIN_RANGE_M);
    let share = move |meters: f64, k: usize| (meters - middle[k]) / reach * HALF_SIZE * 0.94;
    move |p| (x + share(p.east(), 0), y - share(p.north(), 1))
}

/// Returns a label position that does not overlap other labels: `place`, or a position to its right (to its left at the
/// edge of the map).
fn free_label_position(labels: &[(f64, f64)], place: (f64, f64), right_most: f64) -> (f64, f64) {
    let covered = |here: (f64, f64)| {
        let covers =
            |there: &(f64, f64)| (there.0 - here.0).abs() < LABEL_WIDTH - 1e-9 && (there.1 - here.1).abs() < LABEL_HEIGHT;
        labels.iter().any(covers)
    };
    let walk = |step: f64| {
        let mut here = place;
        while covered(here) {
            here.0 += step;
        }
        here
    };
    let right = walk(LABEL_WIDTH);
    if right.0 <= right_most { right } else { walk(-LABEL_WIDTH) }
}

/// Returns an arrowhead that points along the heading.
fn arrow(tip: (f64, f64), heading_rad: f64) -> [(f64, f64); 3] {
    let (s, c) = math::sin_cos(heading_rad);
    [(0.0, 0.016), (0.010, -0.011), (-0.010, -0.011)].map(|(x, y): (f64, f64)| (tip.0 + (x * c + y * s), tip.1 - (y * c - x * s)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_labels_of_paths_with_the_same_start_do_not_overlap() {
        let mut labels = Vec::new();
        for _ in 0..3 {
            labels.push(free_label_position(&labels, (0.9, 0.8), 1.0));
        }
        let gaps: Vec<f64> = labels.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
        assert!(gaps.iter().all(|gap| (gap - LABEL_WIDTH).abs() < 1e-9), "{gaps:?}");
        assert_eq!(free_label_position(&labels, (0.9, 0.7), 1.0), (0.9, 0.7), "a free position must be kept");
        let inside = free_label_position(&labels, (0.9, 0.8), 0.95);
        assert!((inside.0 - (0.9 - LABEL_WIDTH)).abs() < 1e-9, "at the edge of the map, the label must move left: {inside:?}");
    }
}
