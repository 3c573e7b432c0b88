//! Which view stands where in the window.

/// A view.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ViewKind {
    /// The inspector's.
    Inspector,
    /// The camera's.
    Camera,
}

/// How the views share the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ViewLayout {
    /// The inspector's left, the camera's right, as the paper has them.
    #[default]
    Beside,
    /// The camera's large, the inspector's in it.
    Camera,
    /// The inspector's large, the camera's in it.
    Inspector,
}

/// A view's place in the window: shares of its width and height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewRect {
    /// Which view.
    pub which: ViewKind,
    /// Left edge.
    pub left: f64,
    /// Upper edge.
    pub top: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

/// Where words stand, shares of the window's width and height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextAnchor {
    /// Left edge.
    pub left_aligned: f64,
    /// Lower edge, or the upper one.
    pub edge: f64,
    /// Greatest width.
    pub width: f64,
    /// They hang from the upper edge; otherwise they stand on the lower one.
    pub hang: bool,
}

/// Width of the small view as a share of the window's.
const SMALL: f64 = 0.3;
/// From the upper edge to the small view below the display's speed, a share of the window's height; enough for a wide picture in a narrow window.
const UNDER_SPEED: f64 = 0.23;

impl ViewRect {
    /// The largest place of this shape (width over height) in the middle of this one, in a window of that shape: what a camera's sensor does
    /// not see is not shown as if it did.
    #[must_use]
    pub fn fit_aspect(self, aspect: f64, window: f64) -> Self {
        let own = self.width / self.height * window;
        let (width, height) =
            if own > aspect { (self.width * aspect / own, self.height) } else { (self.width, self.height * own / aspect) };
        let (left, top) = (self.left + 0.5 * (self.width - width), self.top + 0.5 * (self.height - height));
        Self { left, top, width, height, ..self }
    }
}

/// The largest picture of this shape (width over height) within a size, px; even, as video needs it, and 2 px at least.
#[must_use]
pub fn fitted_px((width, height): (u32, u32), aspect: f64) -> (u32, u32) {
    let (width, height) = ((width & !1).max(2), (height & !1).max(2));
    let (w, h) = (f64::from(width), f64::from(height));
    let even = |px: f64, most: u32| (2 * (0.5 * px).round() as u32).clamp(2, most);
    if w / h > aspect { (even(h * aspect, width), height) } else { (width, even(w / aspect, height)) }
}

impl ViewLayout {
    /// The one that Tab gives next.
    #[must_use]
    pub fn next(self) -> Self {
        match self {
            Self::Beside => Self::Camera,
            Self::Camera => Self::Inspector,
            Self::Inspector => Self::Beside,
        }
    }

    /// Where the window's own words stand. Never over the display's warnings.
    #[must_use]
    pub fn words(self) -> TextAnchor {
        match self {
            Self::Beside => TextAnchor { left_aligned: 0.0, edge: 1.0, width: 0.5, hang: false },
            // Between the small view and what the display tells at the right, over the middle of the picture.
            Self::Camera => TextAnchor { left_aligned: SMALL, edge: UNDER_SPEED, width: 0.35, hang: true },
            // Left of the small view.
            Self::Inspector => TextAnchor { left_aligned: 0.0, edge: 1.0, width: 0.5 - 0.5 * SMALL, hang: false },
        }
    }

    /// Where a button in the inspector's view stands: its middle, shares of the window's width and height.
    #[must_use]
    pub fn button(self) -> (f64, f64) {
        match self {
            Self::Beside => (0.25, 0.04),
            Self::Camera => (0.5 * SMALL, UNDER_SPEED + 0.0325),
            Self::Inspector => (0.5, 0.04),
        }
    }

    /// Both views in the order of drawing.
    #[must_use]
    pub fn places(self) -> [ViewRect; 2] {
        let half = |which, left| ViewRect { which, left, top: 0.0, width: 0.5, height: 1.0 };
        let whole = |which| ViewRect { which, left: 0.0, top: 0.0, width: 1.0, height: 1.0 };
        let small = |which, (left, top)| ViewRect { which, left, top, width: SMALL, height: SMALL };
        match self {
            Self::Beside => [half(ViewKind::Inspector, 0.0), half(ViewKind::Camera, 0.5)],
            // The display has words in all corners and at the upper edge, and its warnings reach far along the lower one: the small view
            // stands between speed and warnings.
            Self::Camera => [whole(ViewKind::Camera), small(ViewKind::Inspector, (0.0, UNDER_SPEED))],
            Self::Inspector => [whole(ViewKind::Inspector), small(ViewKind::Camera, (0.5 - 0.5 * SMALL, 1.0 - SMALL))],
        }
    }
}

/// Size, px, in which a view of that size on the screen is drawn, when no more than `most` pixels can be afforded. Its shape is kept, to even
/// numbers of pixels, which video needs.
#[must_use]
pub fn drawn_px((width, height): (f64, f64), most: Option<f64>) -> (u32, u32) {
    let shrink = most.map_or(1.0, |most| (most / (width * height).max(1.0)).sqrt().min(1.0));
    let side = |px: f64| 2 * (0.5 * px * shrink).round().max(8.0) as u32;
    (side(width), side(height))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_tab_goes_round_and_both_views_are_always_there() {
        let mut seen = ViewLayout::default();
        for _ in 0..3 {
            let [a, b] = seen.places();
            assert_ne!(a.which, b.which);
            for place in [a, b] {
                assert!(place.left >= 0.0 && place.left + place.width <= 1.0 && place.top + place.height <= 1.0 + 1e-12);
            }
            seen = seen.next();
        }
        assert_eq!(seen, ViewLayout::Beside);
        let [left, right] = seen.places();
        assert_eq!((left.which, left.left, right.left), (ViewKind::Inspector, 0.0, 0.5));
    }

    #[test]
    fn exact_a_camera_keeps_the_shape_of_its_sensor() {
        let whole = ViewRect { which: ViewKind::Camera, left: 0.5, top: 0.0, width: 0.5, height: 1.0 };
        let near = |place: ViewRect, left: f64, top: f64, width: f64, height: f64| {
            let off = [place.left - left, place.top - top, place.width - width, place.height - height];
            assert!(off.iter().all(|off| off.abs() < 1e-12), "{place:?}");
        };
        // Half of a window of 1920 x 1080 px is higher than 4:3, a whole one is wider.
        near(whole.fit_aspect(4.0 / 3.0, 16.0 / 9.0), 0.5, 1.0 / 6.0, 0.5, 2.0 / 3.0);
        near(ViewRect { left: 0.0, width: 1.0, ..whole }.fit_aspect(4.0 / 3.0, 16.0 / 9.0), 0.125, 0.0, 0.75, 1.0);
        assert_eq!(fitted_px((1280, 720), 4.0 / 3.0), (960, 720));
        assert_eq!(fitted_px((640, 1001), 16.0 / 9.0), (640, 360));
        assert_eq!(fitted_px((4000, 3000), 4.0 / 3.0), (4000, 3000));
        assert_eq!(fitted_px((641, 361), 4.0 / 3.0), (480, 360));
        assert_eq!(fitted_px((1, 1), 16.0 / 9.0), (2, 2));
    }

    #[test]
    fn exact_a_slow_machine_draws_fewer_pixels_of_the_same_shape() {
        assert_eq!(drawn_px((1600.0, 900.0), None), (1600, 900));
        assert_eq!(drawn_px((640.0, 360.0), Some(640.0 * 360.0)), (640, 360));
        let (w, h) = drawn_px((1920.0, 1080.0), Some(640.0 * 360.0));
        assert_eq!((w, h), (640, 360));
        assert_eq!(drawn_px((0.0, 0.0), Some(1.0)), (16, 16));
    }
}
