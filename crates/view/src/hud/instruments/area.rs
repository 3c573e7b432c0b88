//! Rectangle of an instrument.

/// Rectangle of an instrument, px.
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

    /// Returns the rectangle without a margin on each side.
    pub(crate) fn inside(self, margin: f64) -> Self {
        let (width, height) = ((self.width - 2.0 * margin).max(1.0), (self.height - 2.0 * margin).max(1.0));
        Self { x: self.x + margin, y: self.y + margin, width, height }
    }
}
