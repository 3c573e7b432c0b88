//! Rectangle of an instrument.

/// Largest margin relative to the shorter side, so that a rectangle remains.
const MAX_MARGIN_SHARE: f64 = 0.45;

/// Rectangle of an instrument (px), or of a drawing on a page (units of the page).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Area {
    pub x: f64,
    pub y: f64,
    pub width: f64,
    pub height: f64,
}

impl Area {
    pub(crate) fn middle(self) -> (f64, f64) {
        (self.x + 0.5 * self.width, self.y + 0.5 * self.height)
    }

    pub(crate) fn corner(self) -> (f64, f64) {
        (self.x + self.width, self.y + self.height)
    }

    /// Returns the rectangle without a margin on each side; the margin is smaller if nothing would remain.
    pub(crate) fn inside(self, margin: f64) -> Self {
        let margin = margin.min(MAX_MARGIN_SHARE * self.width.min(self.height));
        let (width, height) = (self.width - 2.0 * margin, self.height - 2.0 * margin);
        Self { x: self.x + margin, y: self.y + margin, width, height }
    }
}
