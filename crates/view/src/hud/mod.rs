//! The head-up display of the camera view: a pure function from what telemetry says to things to draw, placed as
//! docs/src/reference/assessment.md, "Feedback during the flight", has them (speed upper left, battery upper right, messages
//! lower left). Whoever draws needs to know nothing of what they mean.

#[cfg(test)]
mod apart;
mod battery;
mod brief;
mod icons;
pub mod layout;
mod letters;
mod map;
mod marker;
mod messages;
mod pane;
pub mod state;
mod status;
#[cfg(test)]
mod tests;

pub use layout::{layout, layout_px};
pub use marker::marker;
pub use state::{Gnss, Hud, Track};
pub use status::SILENT_S;

/// A place in the picture: 0..1 to the right and down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// To the right.
    pub x: f64,
    /// Down.
    pub y: f64,
}

/// A place.
#[must_use]
pub const fn at(x: f64, y: f64) -> Point {
    Point { x, y }
}

/// Colours: safe to tell apart for the colour-blind (after Okabe and Ito), and never the only sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colour {
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

impl Colour {
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
pub enum Side {
    /// Its left end.
    Left,
    /// Its middle.
    Middle,
    /// Its right end.
    Right,
}

/// One thing to draw, in the order of drawing. Heights and widths of strokes are shares of the picture's height.
#[derive(Debug, Clone, PartialEq)]
pub enum Item {
    /// A rectangle with rounded corners.
    Panel {
        /// Upper left.
        from: Point,
        /// Lower right.
        to: Point,
        /// Fill.
        colour: Colour,
    },
    /// A line of text, centred upright on its place.
    Text {
        /// Where.
        place: Point,
        /// Which end is there.
        side: Side,
        /// Height of the type.
        height: f64,
        /// Colour.
        colour: Colour,
        /// What it says.
        words: String,
    },
    /// A filled convex outline.
    Fill {
        /// Corners.
        points: Vec<Point>,
        /// Fill.
        colour: Colour,
    },
    /// A line through points.
    Line {
        /// Points.
        points: Vec<Point>,
        /// Width of the stroke.
        width: f64,
        /// Colour.
        colour: Colour,
    },
}
