//! Icons that differ in shape as well as color, for users with color vision deficiency.

use super::{DrawItem, HudColor, ScreenPoint, at};
use spandrel_model::math;

/// Icon shapes in order of severity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IconShape {
    /// Normal or informational.
    Disc,
    /// Caution.
    Triangle,
    /// Imminent danger.
    Diamond,
    /// Stop immediately.
    Octagon,
}

/// Returns an icon with a dark outline; `size` is a fraction of the picture's height.
pub fn icon(shape: IconShape, middle: ScreenPoint, size: f64, aspect: f64, color: HudColor) -> Vec<DrawItem> {
    let ring = |count: u32, turn: f64, radius: f64| -> Vec<ScreenPoint> {
        (0..count)
            .map(|k| {
                let (s, c) = math::sin_cos(turn + math::TAU * f64::from(k) / f64::from(count));
                at(middle.x + radius * s / aspect, middle.y - radius * c)
            })
            .collect()
    };
    let outline = |grown: f64| match shape {
        IconShape::Disc => ring(16, 0.0, 0.46 * size * grown),
        IconShape::Triangle => ring(3, 0.0, 0.58 * size * grown),
        IconShape::Diamond => ring(4, 0.0, 0.55 * size * grown),
        IconShape::Octagon => ring(8, math::PI / 8.0, 0.52 * size * grown),
    };
    vec![DrawItem::Fill { points: outline(1.18), color: HudColor::Black }, DrawItem::Fill { points: outline(1.0), color }]
}
