//! Symbols that tell by their shape alone: who cannot tell the colours apart reads the same.

use super::{DrawItem, HudColor, ScreenPoint, at};
use spandrel_model::math;

/// Shapes, from harmless to grave.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IconShape {
    /// All is well, or worth knowing.
    Disc,
    /// Take care.
    Triangle,
    /// Danger near.
    Diamond,
    /// Stop.
    Octagon,
}

/// A symbol with a dark rim; `size` is its height as a share of the picture's.
pub fn symbol(shape: IconShape, middle: ScreenPoint, size: f64, aspect: f64, colour: HudColor) -> Vec<DrawItem> {
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
    vec![DrawItem::Fill { points: outline(1.18), colour: HudColor::Black }, DrawItem::Fill { points: outline(1.0), colour }]
}
