//! Margins and font sizes of the HUD, as fractions of the height.

/// Margin between blocks and the edges of the picture.
pub(super) const EDGE_MARGIN: f64 = 0.025;
/// Minimum gap between blocks.
pub(super) const BLOCK_GAP: f64 = 0.01;
/// Font sizes: large, medium, and small.
pub(super) const LARGE_FONT_SIZE: f64 = 0.052;
pub(super) const MEDIUM_FONT_SIZE: f64 = 0.034;
pub(super) const SMALL_FONT_SIZE: f64 = 0.027;
