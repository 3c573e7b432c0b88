//! A site projection fitted to a drawing.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::site::outline::ParallelView;

/// Width of a drawing, in drawing units.
const WIDTH: f64 = 900.0;
pub(super) const MARGIN: f64 = 26.0;
/// Minimum and maximum height of a drawing, in drawing units.
const HEIGHT_RANGE: (f64, f64) = (110.0, 760.0);
/// Tolerance for simplifying a flight path, in drawing units.
pub(super) const TRACK_TOLERANCE: f64 = 0.35;

/// A projection scaled to the size of a drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlotMap {
    /// Projection of site coordinates to the drawing.
    pub view: ParallelView,
    /// Upper-left corner of the drawing in projected coordinates, m right and up.
    pub(super) corner_m: (f64, f64),
    /// Drawing units per meter.
    pub(super) scale: f64,
    /// Width and height, in drawing units.
    pub size: (f64, f64),
}

impl PlotMap {
    /// Creates a map that contains all points.
    #[must_use]
    pub fn around(view: ParallelView, points_m: &[Vec3<Enu>]) -> Self {
        let flat: Vec<(f64, f64)> = points_m.iter().map(|point| view.at(*point)).collect();
        let span = |f: fn(&(f64, f64)) -> f64| {
            let (low, high) = math::range(flat.iter().map(f));
            if low <= high { (low, high) } else { (-1.0, 1.0) }
        };
        let ((left, right), (low, high)) = (span(|p| p.0), span(|p| p.1));
        let (wide, tall) = ((right - left).max(10.0), (high - low).max(5.0));
        let scale = ((WIDTH - 2.0 * MARGIN) / wide).min((HEIGHT_RANGE.1 - 2.0 * MARGIN) / tall);
        let height = (tall * scale + 2.0 * MARGIN).max(HEIGHT_RANGE.0);
        // Content that does not fill the drawing is centered.
        let aside = (0.5 * (WIDTH / scale - (right - left)), 0.5 * (height / scale - (high - low)));
        Self { view, corner_m: (left - aside.0, high + aside.1), scale, size: (WIDTH, height) }
    }

    /// Returns the position of a site point in the drawing.
    #[must_use]
    pub fn at(&self, point_m: Vec3<Enu>) -> (f64, f64) {
        self.drawing_from_view(self.view.at(point_m))
    }

    pub(super) fn drawing_from_view(&self, (right_m, up_m): (f64, f64)) -> (f64, f64) {
        ((right_m - self.corner_m.0) * self.scale, (self.corner_m.1 - up_m) * self.scale)
    }

    /// Returns the projected coordinates of a place in the drawing, m right and up.
    pub(super) fn view_from_drawing(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (self.corner_m.0 + x / self.scale, self.corner_m.1 - y / self.scale)
    }

    /// Returns the projection matrix for the page's script: x = m0 e + m1 n + m2 u + m3, y = m4 e + m5 n + m6 u + m7.
    #[must_use]
    pub fn matrix(&self) -> String {
        let (r, u, k) = (self.view.right.array(), self.view.up.array(), self.scale);
        let rows = [[r[0] * k, r[1] * k, r[2] * k, -self.corner_m.0 * k], [-u[0] * k, -u[1] * k, -u[2] * k, self.corner_m.1 * k]];
        rows.iter().flatten().map(|value| format!("{value:.4}")).collect::<Vec<_>>().join(" ")
    }
}
