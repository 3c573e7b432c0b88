//! Margins and font sizes of the HUD, as fractions of the height.

/// Margin between blocks and the edges of the picture.
pub(super) const EDGE: f64 = 0.025;
/// Minimum gap between blocks.
pub(super) const GAP: f64 = 0.01;
/// Font sizes: large, medium, and small.
pub(super) const LARGE: f64 = 0.052;
pub(super) const MIDDLE: f64 = 0.034;
pub(super) const SMALL: f64 = 0.027;
/// Meters per second in one mile per hour.
pub(super) const M_S_PER_MPH: f64 = spandrel_model::math::M_S_PER_MPH;
