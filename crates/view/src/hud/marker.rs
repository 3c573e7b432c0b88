//! Marker for the drone's position in the inspector's view.

use super::super::camera::PinholeCamera;
use super::style::DisplayStyle;
use super::text_metrics::text_width;
use super::{DrawItem, HudColor, ScreenPoint, TextAlign, at};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_text::text;

/// Minimum half-width of the bracket, as a fraction of the picture's height.
const MIN_HALF_SIZE: f64 = 0.022;
/// Normal font size, as a fraction of the picture's height.
const FONT_SIZE: f64 = 0.026;
/// Half-width of the bracket around the drone's center, m.
const BRACKET_HALF_SIZE_M: f64 = 0.6;

/// Returns a bracket around the drone with its distance: gray and dashed if an object hides the drone, and nothing if
/// the drone is outside the picture.
#[must_use]
pub fn marker((eye, aspect): (&PinholeCamera, f64), drone_m: Vec3<Enu>, hidden: bool, style: DisplayStyle) -> Vec<DrawItem> {
    let clip = eye.view_projection(aspect).apply(drone_m);
    let (x, y) = (clip[0] / clip[3], clip[1] / clip[3]);
    if clip[3] <= 0.0 || x.abs() > 0.95 || y.abs() > 0.95 {
        return Vec::new();
    }
    let middle = at(0.5 + 0.5 * x, 0.5 - 0.5 * y);
    let distance_m = (drone_m - eye.position_m).norm();
    let half = MIN_HALF_SIZE.max(0.5 * BRACKET_HALF_SIZE_M / (math::tan(0.5 * eye.hfov_rad) * clip[3]) * aspect);
    let corner = |right: f64, down: f64| -> Vec<Vec<ScreenPoint>> {
        let place = |a: f64, b: f64| at(middle.x + right * a * half / aspect, middle.y + down * b * half);
        let dash = |a: (f64, f64), b: (f64, f64)| vec![place(a.0, a.1), place(b.0, b.1)];
        if hidden {
            return vec![
                dash((0.4, 1.0), (0.6, 1.0)),
                dash((0.8, 1.0), (1.0, 1.0)),
                dash((1.0, 0.8), (1.0, 0.6)),
                dash((1.0, 0.4), (1.0, 0.2)),
            ];
        }
        vec![vec![place(0.5, 1.0), place(1.0, 1.0), place(1.0, 0.5)]]
    };
    let color = if hidden { HudColor::Gray } else { HudColor::White };
    let mut items: Vec<DrawItem> = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)]
        .into_iter()
        .flat_map(|(right, down)| corner(right, down))
        .map(|points| DrawItem::Line { points, width: 0.003, color })
        .collect();
    let distance = style.units.length(distance_m, 0);
    let words = if hidden { text!(style.language, "flight-marker-hidden", distance = distance) } else { distance };
    let scale = style.text_scale.factor();
    let font = FONT_SIZE * scale;
    // Below the bracket, and inside the picture.
    let width = 0.5 * (text_width(&words, font) + 0.4 * font) / aspect;
    let place = at(
        middle.x.clamp(width.min(0.5), (1.0 - width).max(0.5)),
        (middle.y + half + 0.009 + 0.5 * font).min(1.0 - 0.02 * scale),
    );
    // The background keeps the text legible against a bright sky.
    let ground = (width, 0.6 * font);
    let side = |sign: f64| at(place.x + sign * ground.0, place.y + sign * ground.1);
    items.push(DrawItem::Panel { from: side(-1.0), to: side(1.0), color: HudColor::TextBackground });
    items.push(DrawItem::Text { place, side: TextAlign::Center, height: font, color, words });
    items
}

#[cfg(test)]
mod tests {
    use super::super::contrast;
    use super::*;

    #[test]
    fn exact_bracket_surrounds_the_drone_only_in_front_of_the_camera() {
        let eye = PinholeCamera::at(Vec3::zero(), Vec3::new(0.0, 100.0, 0.0), 1.0, 1.5);
        let items = marker((&eye, 1.5), Vec3::new(0.0, 80.0, 0.0), false, DisplayStyle::default());
        let words = items.iter().find_map(|item| match item {
            DrawItem::Text { words, place, .. } => Some((words.clone(), place.x)),
            DrawItem::Panel { .. } | DrawItem::Fill { .. } | DrawItem::Line { .. } => None,
        });
        assert_eq!(words, Some(("80 m".to_owned(), 0.5)));
        assert_eq!(items.len(), 6);
        assert!(marker((&eye, 1.5), Vec3::new(0.0, -80.0, 0.0), false, DisplayStyle::default()).is_empty());
        let hidden = marker((&eye, 1.5), Vec3::new(0.0, 80.0, 0.0), true, DisplayStyle::default());
        let told =
            |item: &DrawItem| matches!(item, DrawItem::Text { words, color: HudColor::Gray, .. } if words == "80 m, hidden");
        assert!(hidden.len() > items.len() && hidden.iter().any(told), "the marker must be dashed and labeled");
        for (marks, name) in [(items, "marker"), (hidden, "hidden marker")] {
            contrast::check(&marks, 1.5, name);
        }
    }
}
