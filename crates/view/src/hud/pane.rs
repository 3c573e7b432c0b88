//! Coordinate system of the HUD: the origin is the upper left corner, and both axes use the same unit.

use super::icons::{self, IconShape};
use super::style::TextScale;
use super::text_metrics::fitted;
use super::{DrawItem, HudColor, ScreenPoint, TextAlign, at};

/// Minimum aspect ratio (width over height) for all blocks to fit at full size; in narrower pictures, everything scales
/// with the width.
const MIN_FULL_SIZE_ASPECT: f64 = 4.0 / 3.0;

/// Size of a picture in HUD units. Positions increase to the right and down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pane {
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

impl Pane {
    /// Creates the pane for an aspect ratio. The unit is the picture's height, or less if the picture is narrow. With larger
    /// text, the unit is larger.
    pub fn of(aspect: f64, text_scale: TextScale) -> Self {
        let unit = (aspect / MIN_FULL_SIZE_ASPECT).min(1.0) * text_scale.factor();
        Self { width: aspect / unit, height: 1.0 / unit }
    }

    /// Returns the unit of [`Self::of`] with normal text for a picture size, in the units of that size.
    pub fn unit((width, height): (f64, f64)) -> f64 {
        height.min(width / MIN_FULL_SIZE_ASPECT)
    }

    /// Converts a size to a fraction of the picture's height.
    pub fn share(self, size: f64) -> f64 {
        size / self.height
    }

    /// Converts a position to fractions of the picture.
    pub fn at(self, (x, y): (f64, f64)) -> ScreenPoint {
        at(x / self.width, y / self.height)
    }

    /// Returns the background of a block from its upper left to its lower right corner.
    pub fn panel(self, from: (f64, f64), to: (f64, f64)) -> DrawItem {
        DrawItem::Panel { from: self.at(from), to: self.at(to), color: HudColor::TextBackground }
    }

    /// Returns a line of text.
    pub fn text(self, place: (f64, f64), side: TextAlign, size: f64, color: HudColor, words: impl Into<String>) -> DrawItem {
        DrawItem::Text { place: self.at(place), side, height: self.share(size), color, words: words.into() }
    }

    /// Returns a gray name at the left and a value at the right of a line, between two edges. They shrink to fit.
    pub fn name_and_value(
        self,
        (from, to): (f64, f64),
        y: f64,
        size: f64,
        (name, value, color): (String, String, HudColor),
    ) -> [DrawItem; 2] {
        let size = fitted(&format!("{name} {value}"), size, to - from);
        [
            self.text((from, y), TextAlign::Left, size, HudColor::Gray, name),
            self.text((to, y), TextAlign::Right, size, color, value),
        ]
    }

    /// Returns a filled convex polygon.
    pub fn fill(self, points: &[(f64, f64)], color: HudColor) -> DrawItem {
        DrawItem::Fill { points: self.all(points), color }
    }

    /// Returns a polyline.
    pub fn line(self, points: &[(f64, f64)], width: f64, color: HudColor) -> DrawItem {
        DrawItem::Line { points: self.all(points), width: self.share(width), color }
    }

    /// Returns an icon with a dark outline.
    pub fn icon(self, shape: IconShape, middle: (f64, f64), size: f64, color: HudColor) -> Vec<DrawItem> {
        icons::icon(shape, self.at(middle), self.share(size), self.width / self.height, color)
    }

    fn all(self, points: &[(f64, f64)]) -> Vec<ScreenPoint> {
        points.iter().map(|place| self.at(*place)).collect()
    }
}
