//! The head-up display of the camera view: a pure function from what telemetry says to things to draw, placed as
//! docs/src/reference/assessment.md, "Feedback during the flight", has them (speed upper left, battery upper right, messages
//! lower left). Whoever draws needs to know nothing of what they mean.

mod battery;
mod icons;
pub mod layout;
mod map;
mod marker;
mod messages;
#[cfg(test)]
mod overlap;
mod pane;
mod small_view;
pub mod state;
mod status;
#[cfg(test)]
mod tests;
mod text_metrics;

pub use layout::{layout, layout_px};
pub use marker::marker;
pub use state::{GnssStatus, Hud, MapPath};
pub use status::SILENT_S;

/// A place in the picture: 0..1 to the right and down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScreenPoint {
    /// To the right.
    pub x: f64,
    /// Down.
    pub y: f64,
}

/// A place.
#[must_use]
pub const fn at(x: f64, y: f64) -> ScreenPoint {
    ScreenPoint { x, y }
}

/// Colours: safe to tell apart for the colour-blind (after Okabe and Ito), and never the only sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HudColor {
    /// Text and lines.
    White,
    /// Lesser text.
    Grey,
    /// Behind text; half transparent.
    Shade,
    /// All is well.
    Green,
    /// Take care.
    Yellow,
    /// Act now.
    Red,
    /// Worth knowing.
    Blue,
    /// Too close.
    Orange,
    /// Outlines of symbols.
    Black,
    /// The ground of a page.
    Night,
    /// A field on it.
    Card,
    /// The field that the keys act on.
    Focus,
}

impl HudColor {
    /// Red, green, blue, opacity in sRGB.
    #[must_use]
    pub const fn rgba(self) -> [u8; 4] {
        match self {
            Self::White => [245, 245, 245, 255],
            Self::Grey => [200, 204, 208, 255],
            Self::Shade => [12, 14, 18, 150],
            Self::Green => [0, 190, 130, 255],
            Self::Yellow => [240, 228, 66, 255],
            Self::Red => [235, 60, 40, 255],
            Self::Blue => [86, 180, 233, 255],
            Self::Orange => [240, 150, 20, 255],
            Self::Black => [0, 0, 0, 255],
            Self::Night => [20, 24, 30, 255],
            Self::Card => [42, 49, 60, 255],
            Self::Focus => [20, 92, 140, 255],
        }
    }
}

/// Which end of a text stands at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextAlign {
    /// Its left end.
    Left,
    /// Its middle.
    Middle,
    /// Its right end.
    Right,
}

/// One thing to draw, in the order of drawing. Heights and widths of strokes are shares of the picture's height.
#[derive(Debug, Clone, PartialEq)]
pub enum DrawItem {
    /// A rectangle with rounded corners.
    Panel {
        /// Upper left.
        from: ScreenPoint,
        /// Lower right.
        to: ScreenPoint,
        /// Fill.
        colour: HudColor,
    },
    /// A line of text, centred upright on its place.
    Text {
        /// Where.
        place: ScreenPoint,
        /// Which end is there.
        side: TextAlign,
        /// Height of the type.
        height: f64,
        /// Colour.
        colour: HudColor,
        /// What it says.
        words: String,
    },
    /// A filled convex outline.
    Fill {
        /// Corners.
        points: Vec<ScreenPoint>,
        /// Fill.
        colour: HudColor,
    },
    /// A line through points.
    Line {
        /// Points.
        points: Vec<ScreenPoint>,
        /// Width of the stroke.
        width: f64,
        /// Colour.
        colour: HudColor,
    },
}
