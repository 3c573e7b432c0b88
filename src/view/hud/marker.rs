//! In the inspector's view: where the drone is, small as it may look.

use super::super::camera::Eye;
use super::{Colour, Item, Point, Side, at};
use crate::base::frames::{Enu, Vec3};
use crate::base::math;

/// Half the bracket's side as a share of the picture's height, at least.
const LEAST: f64 = 0.022;
/// The bracket is this much wider than the drone, m from its centre.
const ROOM_M: f64 = 0.6;

/// A bracket around the drone with its distance; nothing when it is outside the picture.
#[must_use]
pub fn marker(eye: &Eye, aspect: f64, drone_m: Vec3<Enu>) -> Vec<Item> {
    let clip = eye.view_projection(aspect).apply(drone_m);
    let (x, y) = (clip[0] / clip[3], clip[1] / clip[3]);
    if clip[3] <= 0.0 || x.abs() > 0.95 || y.abs() > 0.95 {
        return Vec::new();
    }
    let middle = at(0.5 + 0.5 * x, 0.5 - 0.5 * y);
    let distance_m = (drone_m - eye.position_m).norm();
    let half = LEAST.max(0.5 * ROOM_M / (math::tan(0.5 * eye.hfov_rad) * clip[3]) * aspect);
    let corner = |right: f64, down: f64| -> Vec<Point> {
        let place = |a: f64, b: f64| at(middle.x + right * a * half / aspect, middle.y + down * b * half);
        vec![place(0.5, 1.0), place(1.0, 1.0), place(1.0, 0.5)]
    };
    let mut items: Vec<Item> = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)]
        .into_iter()
        .map(|(right, down)| Item::Line { points: corner(right, down), width: 0.003, colour: Colour::White })
        .collect();
    items.push(Item::Text {
        place: at(middle.x, (middle.y + half + 0.02).min(0.98)),
        side: Side::Middle,
        height: 0.026,
        colour: Colour::White,
        words: format!("{distance_m:.0} m"),
    });
    items
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_the_bracket_lies_around_the_drone_and_nowhere_behind() {
        let eye = Eye::at(Vec3::zero(), Vec3::new(0.0, 100.0, 0.0), 1.0, 1.5);
        let items = marker(&eye, 1.5, Vec3::new(0.0, 80.0, 0.0));
        let words = items.iter().find_map(|item| match item {
            Item::Text { words, place, .. } => Some((words.clone(), place.x)),
            Item::Panel { .. } | Item::Fill { .. } | Item::Line { .. } => None,
        });
        assert_eq!(words, Some(("80 m".to_owned(), 0.5)));
        assert_eq!(items.len(), 5);
        assert!(marker(&eye, 1.5, Vec3::new(0.0, -80.0, 0.0)).is_empty());
    }
}
