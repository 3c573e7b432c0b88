//! Conversion of a drawing in meters to the px of an instrument.

use super::area::Area;
use super::site_outline::{Bounds, Point};

/// Scale of a drawing that fills an area as far as its shape allows, in the middle.
#[derive(Debug, Clone, Copy)]
pub(super) struct DrawingScale {
    middle_m: Point,
    middle_px: Point,
    pub px_per_m: f64,
    /// Overlap of neighboring shapes, so that no line shows between them, m.
    pub overlap_m: f64,
}

/// Overlap of neighboring shapes, relative to the shorter side of the area: about a pixel.
const OVERLAP_SHARE: f64 = 0.004;

impl DrawingScale {
    /// Fits the bounds of a drawing into the area.
    pub fn fit((low, high): Bounds, area: Area) -> Self {
        let (wide, tall) = ((high.0 - low.0).max(1.0), (high.1 - low.1).max(1.0));
        let px_per_m = (area.width / wide).min(area.height / tall);
        Self {
            middle_m: (0.5 * (low.0 + high.0), 0.5 * (low.1 + high.1)),
            middle_px: area.middle(),
            px_per_m,
            overlap_m: OVERLAP_SHARE * area.width.min(area.height) / px_per_m,
        }
    }

    /// Returns the place of a point, m right and up.
    pub fn place(&self, (right, up): Point) -> Point {
        let (x, y) = (right - self.middle_m.0, up - self.middle_m.1);
        (self.middle_px.0 + x * self.px_per_m, self.middle_px.1 - y * self.px_per_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_the_middle_stays_in_the_middle_and_up_is_up() {
        let area = Area { x: 10.0, y: 20.0, width: 100.0, height: 50.0 };
        let scale = DrawingScale::fit(((0.0, 0.0), (200.0, 50.0)), area);
        assert_eq!((scale.px_per_m, scale.place((100.0, 25.0))), (0.5, (60.0, 45.0)));
        assert_eq!(scale.place((0.0, 35.0)), (10.0, 40.0));
    }
}
