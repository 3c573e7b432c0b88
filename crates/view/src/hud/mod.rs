//! Head-up display of the camera view: a pure function from telemetry to draw items, laid out as in
//! docs/src/reference/assessment.md, "Feedback during the flight" (speed upper left, battery upper right, messages
//! lower left). Renderers draw the items without interpreting them.

mod battery;
#[cfg(test)]
pub(crate) mod contrast;
mod icons;
pub mod instruments;
pub mod layout;
mod lesson_panel;
pub mod lesson_words;
mod map;
mod marker;
mod messages;
mod metrics;
#[cfg(test)]
mod overlap;
mod pane;
mod signal;
mod small_view;
mod speed;
pub mod state;
mod status;
mod style;
mod task_panel;
#[cfg(test)]
pub(crate) mod tests;
pub(crate) mod text_metrics;

pub(crate) use instruments::Area;
pub use instruments::{JobDrawing, SiteOutline, instruments, large_map};
pub use layout::{layout, layout_px};
pub use marker::marker;
pub(crate) use pane::Pane;
pub use state::{GnssStatus, Hud, InspectorMarks, LessonDisplay, MapPath, Obstacles, TaskNames, UNKNOWN_MODE, WayBack};
pub use status::{LINK_TIMEOUT_S, StatusAlarm, StatusAlarms};
pub use style::{DisplayStyle, DisplayUnits, TextScale};

/// A position in the picture, as fractions of its width and height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScreenPoint {
    /// From the left edge.
    pub x: f64,
    /// From the top edge.
    pub y: f64,
}

/// Creates a position from fractions of the picture's width and height.
#[must_use]
pub const fn at(x: f64, y: f64) -> ScreenPoint {
    ScreenPoint { x, y }
}

/// HUD colors. They remain distinguishable with color vision deficiency (after Okabe and Ito), and no meaning depends
/// on color alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HudColor {
    /// Text and lines.
    White,
    /// Secondary text.
    Gray,
    /// Background of text; translucent, but dark enough for all text colors in front of a bright sky.
    TextBackground,
    /// Normal.
    Green,
    /// Caution.
    Yellow,
    /// Immediate action required.
    Red,
    /// Information.
    Blue,
    /// Too close.
    Orange,
    /// Icon outlines.
    Black,
    /// Background of a page.
    PageBackground,
    /// Input field on a page.
    InputField,
    /// Focused field.
    FocusedField,
    /// Path in the picture; translucent.
    Ribbon,
    /// Path behind an object; translucent.
    RibbonHidden,
    /// Ghost of an earlier flight; translucent.
    Ghost,
    /// Ghost behind an object; translucent.
    GhostHidden,
    /// Bridges on a map.
    Structure,
    /// Water on a map.
    Water,
    /// Sky in the artificial horizon.
    Sky,
    /// Ground in the artificial horizon and in a profile.
    Earth,
}

impl HudColor {
    /// Returns the red, green, blue, and opacity components (sRGB).
    #[must_use]
    pub const fn rgba(self) -> [u8; 4] {
        match self {
            Self::White => [245, 245, 245, 255],
            Self::Gray => [206, 210, 214, 255],
            Self::TextBackground => [12, 14, 18, 220],
            Self::Green => [0, 190, 130, 255],
            Self::Yellow => [240, 228, 66, 255],
            Self::Red => [255, 112, 96, 255],
            Self::Blue => [86, 180, 233, 255],
            Self::Orange => [240, 150, 20, 255],
            Self::Black => [0, 0, 0, 255],
            Self::PageBackground => [20, 24, 30, 255],
            Self::InputField => [42, 49, 60, 255],
            Self::FocusedField => [20, 92, 140, 255],
            Self::Ribbon => [86, 180, 233, 110],
            Self::RibbonHidden => [200, 204, 208, 45],
            Self::Ghost => [204, 121, 167, 170],
            Self::GhostHidden => [204, 121, 167, 70],
            Self::Structure => [150, 150, 148, 255],
            Self::Water => [44, 88, 122, 255],
            Self::Sky => [74, 132, 182, 255],
            Self::Earth => [112, 84, 56, 255],
        }
    }
}

/// Horizontal alignment of a text at its position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextAlign {
    /// Left-aligned.
    Left,
    /// Centered.
    Center,
    /// Right-aligned.
    Right,
}

/// An item to draw, in drawing order. Font sizes and stroke widths are fractions of the picture's height.
#[derive(Debug, Clone, PartialEq)]
pub enum DrawItem {
    /// A rectangle with rounded corners.
    Panel {
        /// Upper left corner.
        from: ScreenPoint,
        /// Lower right corner.
        to: ScreenPoint,
        /// Fill color.
        color: HudColor,
    },
    /// A line of text, vertically centered on its position.
    Text {
        /// Position.
        place: ScreenPoint,
        /// Horizontal alignment.
        side: TextAlign,
        /// Font size.
        height: f64,
        /// Color.
        color: HudColor,
        /// Text.
        words: String,
    },
    /// A filled convex polygon.
    Fill {
        /// Corners of the polygon.
        points: Vec<ScreenPoint>,
        /// Fill color.
        color: HudColor,
    },
    /// A polyline.
    Line {
        /// Points of the polyline.
        points: Vec<ScreenPoint>,
        /// Stroke width.
        width: f64,
        /// Color.
        color: HudColor,
    },
}
