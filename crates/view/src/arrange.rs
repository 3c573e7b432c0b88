//! Layout of the views in the window.

/// A view of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ViewKind {
    /// The inspector's view.
    Inspector,
    /// The aircraft camera's view.
    Camera,
}

/// How the views share the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ViewLayout {
    /// Side by side: inspector on the left, camera on the right, as in the TASBID paper.
    #[default]
    SideBySide,
    /// Camera large, inspector inset.
    Camera,
    /// Inspector large, camera inset.
    Inspector,
}

/// Rectangle of a view, as fractions of the window's width and height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewRect {
    /// The view shown in the rectangle.
    pub which: ViewKind,
    /// Left edge.
    pub left: f64,
    /// Top edge.
    pub top: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

/// Position of a text block, as fractions of the window's width and height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextAnchor {
    /// Left edge.
    pub left_edge: f64,
    /// Top edge if `extends_down` is set, otherwise bottom edge.
    pub edge: f64,
    /// Maximum text width.
    pub width: f64,
    /// Whether the text extends down from the top edge instead of up from the bottom edge.
    pub extends_down: bool,
}

/// Side of the inset view as a fraction of the window's width or height.
const INSET_SIZE: f64 = 0.3;
/// Top edge of the inset view, as a fraction of the window's height: below the speed readout, even for a wide picture
/// in a narrow window.
const INSET_TOP: f64 = 0.23;

impl ViewRect {
    /// Returns the largest centered rectangle of the given `aspect` ratio (width over height) in a window with the
    /// `window` aspect ratio. This way, the view never shows more than the camera's sensor covers.
    #[must_use]
    pub fn fit_aspect(self, aspect: f64, window: f64) -> Self {
        let own = self.width / self.height * window;
        let (width, height) =
            if own > aspect { (self.width * aspect / own, self.height) } else { (self.width, self.height * own / aspect) };
        let (left, top) = (self.left + 0.5 * (self.width - width), self.top + 0.5 * (self.height - height));
        Self { left, top, width, height, ..self }
    }
}

/// Returns the largest picture size with the given aspect ratio (width over height) that fits into a size, in px. Both
/// sides are even, as video requires, and at least 2 px.
#[must_use]
pub fn largest_even_size_px((width, height): (u32, u32), aspect: f64) -> (u32, u32) {
    let (width, height) = ((width & !1).max(2), (height & !1).max(2));
    let (w, h) = (f64::from(width), f64::from(height));
    let even = |px: f64, most: u32| (2 * (0.5 * px).round() as u32).clamp(2, most);
    if w / h > aspect { (even(h * aspect, width), height) } else { (width, even(w / aspect, height)) }
}

impl ViewLayout {
    /// Returns the layout to which the Tab key switches next.
    #[must_use]
    pub fn next(self) -> Self {
        match self {
            Self::SideBySide => Self::Camera,
            Self::Camera => Self::Inspector,
            Self::Inspector => Self::SideBySide,
        }
    }

    /// Returns the position of the status text in the window, which never overlaps the HUD warnings.
    #[must_use]
    pub fn words(self) -> TextAnchor {
        match self {
            Self::SideBySide => TextAnchor { left_edge: 0.0, edge: 1.0, width: 0.5, extends_down: false },
            // Between the inset view and the HUD readouts on the right, above the center of the picture.
            Self::Camera => TextAnchor { left_edge: INSET_SIZE, edge: INSET_TOP, width: 0.35, extends_down: true },
            // Left of the inset view.
            Self::Inspector => TextAnchor { left_edge: 0.0, edge: 1.0, width: 0.5 - 0.5 * INSET_SIZE, extends_down: false },
        }
    }

    /// Returns the center of the button in the inspector's view, as fractions of the window's width and height.
    #[must_use]
    pub fn button(self) -> (f64, f64) {
        match self {
            Self::SideBySide => (0.25, 0.04),
            Self::Camera => (0.5 * INSET_SIZE, INSET_TOP + 0.0325),
            Self::Inspector => (0.5, 0.04),
        }
    }

    /// Returns both views in drawing order.
    #[must_use]
    pub fn view_rects(self) -> [ViewRect; 2] {
        let half = |which, left| ViewRect { which, left, top: 0.0, width: 0.5, height: 1.0 };
        let whole = |which| ViewRect { which, left: 0.0, top: 0.0, width: 1.0, height: 1.0 };
        let small = |which, (left, top)| ViewRect { which, left, top, width: INSET_SIZE, height: INSET_SIZE };
        match self {
            Self::SideBySide => [half(ViewKind::Inspector, 0.0), half(ViewKind::Camera, 0.5)],
            // The HUD has text in all corners and along the top, and its warnings extend far along the bottom. The
            // inset view goes between the speed readout and the warnings.
            Self::Camera => [whole(ViewKind::Camera), small(ViewKind::Inspector, (0.0, INSET_TOP))],
            Self::Inspector => [whole(ViewKind::Inspector), small(ViewKind::Camera, (0.5 - 0.5 * INSET_SIZE, 1.0 - INSET_SIZE))],
        }
    }
}

/// Returns the render size, in px, for a view of the given screen size, limited to `most` pixels. Keeps the aspect
/// ratio; both sides are even, as video requires.
#[must_use]
pub fn render_size_px((width, height): (f64, f64), most: Option<f64>) -> (u32, u32) {
    let shrink = most.map_or(1.0, |most| (most / (width * height).max(1.0)).sqrt().min(1.0));
    let side = |px: f64| 2 * (0.5 * px * shrink).round().max(8.0) as u32;
    (side(width), side(height))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_tab_cycles_through_layouts_that_show_both_views() {
        let mut seen = ViewLayout::default();
        for _ in 0..3 {
            let [a, b] = seen.view_rects();
            assert_ne!(a.which, b.which);
            for place in [a, b] {
                assert!(place.left >= 0.0 && place.left + place.width <= 1.0 && place.top + place.height <= 1.0 + 1e-12);
            }
            seen = seen.next();
        }
        assert_eq!(seen, ViewLayout::SideBySide);
        let [left, right] = seen.view_rects();
        assert_eq!((left.which, left.left, right.left), (ViewKind::Inspector, 0.0, 0.5));
    }

    #[test]
    fn exact_camera_view_keeps_the_aspect_ratio_of_the_sensor() {
        let whole = ViewRect { which: ViewKind::Camera, left: 0.5, top: 0.0, width: 0.5, height: 1.0 };
        let near = |place: ViewRect, left: f64, top: f64, width: f64, height: f64| {
            let off = [place.left - left, place.top - top, place.width - width, place.height - height];
            assert!(off.iter().all(|off| off.abs() < 1e-12), "{place:?}");
        };
        // Half of a 1920 x 1080 px window is narrower than 4:3; the whole window is wider.
        near(whole.fit_aspect(4.0 / 3.0, 16.0 / 9.0), 0.5, 1.0 / 6.0, 0.5, 2.0 / 3.0);
        near(ViewRect { left: 0.0, width: 1.0, ..whole }.fit_aspect(4.0 / 3.0, 16.0 / 9.0), 0.125, 0.0, 0.75, 1.0);
        assert_eq!(largest_even_size_px((1280, 720), 4.0 / 3.0), (960, 720));
        assert_eq!(largest_even_size_px((640, 1001), 16.0 / 9.0), (640, 360));
        assert_eq!(largest_even_size_px((4000, 3000), 4.0 / 3.0), (4000, 3000));
        assert_eq!(largest_even_size_px((641, 361), 4.0 / 3.0), (480, 360));
        assert_eq!(largest_even_size_px((1, 1), 16.0 / 9.0), (2, 2));
    }

    #[test]
    fn exact_pixel_limit_keeps_the_aspect_ratio() {
        assert_eq!(render_size_px((1600.0, 900.0), None), (1600, 900));
        assert_eq!(render_size_px((640.0, 360.0), Some(640.0 * 360.0)), (640, 360));
        let (w, h) = render_size_px((1920.0, 1080.0), Some(640.0 * 360.0));
        assert_eq!((w, h), (640, 360));
        assert_eq!(render_size_px((0.0, 0.0), Some(1.0)), (16, 16));
    }
}
