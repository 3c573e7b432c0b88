//! Which view stands where in the window.

/// A view.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Which {
    /// The inspector's.
    Inspector,
    /// The camera's.
    Camera,
}

/// How the views share the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Arrangement {
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
pub struct Place {
    /// Which view.
    pub which: Which,
    /// Left edge.
    pub left: f64,
    /// Upper edge.
    pub top: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

/// Width of the small view as a share of the window's.
const SMALL: f64 = 0.3;

impl Arrangement {
    /// The one that Tab gives next.
    #[must_use]
    pub fn next(self) -> Self {
        match self {
            Self::Beside => Self::Camera,
            Self::Camera => Self::Inspector,
            Self::Inspector => Self::Beside,
        }
    }

    /// Both views in the order of drawing.
    #[must_use]
    pub fn places(self) -> [Place; 2] {
        let half = |which, left| Place { which, left, top: 0.0, width: 0.5, height: 1.0 };
        let whole = |which| Place { which, left: 0.0, top: 0.0, width: 1.0, height: 1.0 };
        // The display has words in all corners and at the upper edge: the small view stands in the middle of the lower one.
        let small = |which| Place { which, left: 0.5 - 0.5 * SMALL, top: 1.0 - SMALL, width: SMALL, height: SMALL };
        match self {
            Self::Beside => [half(Which::Inspector, 0.0), half(Which::Camera, 0.5)],
            Self::Camera => [whole(Which::Camera), small(Which::Inspector)],
            Self::Inspector => [whole(Which::Inspector), small(Which::Camera)],
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
        let mut seen = Arrangement::default();
        for _ in 0..3 {
            let [a, b] = seen.places();
            assert_ne!(a.which, b.which);
            for place in [a, b] {
                assert!(place.left >= 0.0 && place.left + place.width <= 1.0 && place.top + place.height <= 1.0 + 1e-12);
            }
            seen = seen.next();
        }
        assert_eq!(seen, Arrangement::Beside);
        let [left, right] = seen.places();
        assert_eq!((left.which, left.left, right.left), (Which::Inspector, 0.0, 0.5));
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
