//! Layout of the views in the window.

use super::hud::TextScale;

/// A view of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ViewKind {
    /// The inspector's view.
    Inspector,
    /// The aircraft camera's view.
    Camera,
    /// The instruments.
    Instruments,
    /// The map with the side profile.
    Map,
}

/// How the views share the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ViewLayout {
    /// Camera large, with the inspector's view and the instruments beside it or below it.
    #[default]
    Camera,
    /// Inspector large, camera inset.
    Inspector,
    /// Side by side: inspector on the left, camera on the right, as in the TASBID paper.
    SideBySide,
    /// Only the inspector's view, for a second screen.
    InspectorOnly,
    /// Map large, with the camera's view, the inspector's view and the navigation display beside it or below it.
    Map,
}

/// Aspect ratios (width over height) of the window and of the camera's picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindowShape {
    /// Of the window.
    pub window: f64,
    /// Of the camera's picture.
    pub camera: f64,
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
    /// Maximum text height.
    pub height: f64,
    /// Whether the text extends down from the top edge instead of up from the bottom edge.
    pub extends_down: bool,
}

/// Width of the column beside the large map relative to the window's width, and its smallest and largest values relative to the
/// window's height.
const MAP_COLUMN_SHARE: f64 = 0.25;
const MAP_COLUMN_WIDTH: (f64, f64) = (0.42, 0.5);
/// Smallest aspect ratio of a window with this column; in others, there is a strip below the map.
const MIN_MAP_COLUMN_ASPECT: f64 = 1.25;
/// Largest share of the camera's view of the strip's width, and bounds of the strip's height, relative to the window's height.
const MAP_STRIP_CAMERA_SHARE: f64 = 0.4;
const MAP_STRIP_HEIGHT: (f64, f64) = (0.2, 0.3);
/// Side of the inset view as a fraction of the window's width or height.
const INSET_SIZE: f64 = 0.3;
/// Smallest width of the column beside the camera view, and smallest height of the strip below it, relative to the window's
/// height.
const MIN_COLUMN_WIDTH: f64 = 0.36;
const MIN_STRIP_HEIGHT: f64 = 0.26;
/// Aspect ratio of the inspector's view in the column and in the strip, and its largest share of them.
const INSPECTOR_ASPECT: f64 = 4.0 / 3.0;
const MAX_INSPECTOR_SHARE: f64 = 0.55;
/// Distance of the status text from the top of the camera view, and its largest width, relative to the camera view: below the
/// speed readout and left of the other readouts.
const STATUS_TEXT_TOP: f64 = 0.145;
const STATUS_TEXT_WIDTH: f64 = 0.6;
/// Aspect ratio of the narrowest window whose camera view has room for the status text between the parts of the HUD.
const MIN_STATUS_TEXT_ASPECT: f64 = 1.5;
/// Largest share of the inspector's view for larger status text, below the button.
const LARGE_TEXT_HEIGHT: f64 = 0.7;
/// Height of the button in the inspector's view above its middle, relative to the window.
const BUTTON_DOWN: f64 = 0.0325;

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

impl WindowShape {
    /// Returns the rectangle from a position and size relative to the window's height.
    fn rect(self, which: ViewKind, (x, y): (f64, f64), (width, height): (f64, f64)) -> ViewRect {
        ViewRect { which, left: x / self.window, top: y, width: width / self.window, height }
    }

    /// Returns the camera view with the other views in a column at its left.
    fn with_column(self) -> [ViewRect; 3] {
        let column = (self.window - self.camera).max(MIN_COLUMN_WIDTH).min(0.5 * self.window);
        let width = (self.window - column).min(self.camera);
        let height = width / self.camera;
        let inspector = (column / INSPECTOR_ASPECT).min(MAX_INSPECTOR_SHARE);
        [
            self.rect(ViewKind::Camera, (column, 0.5 * (1.0 - height)), (width, height)),
            self.rect(ViewKind::Inspector, (0.0, 0.0), (column, inspector)),
            self.rect(ViewKind::Instruments, (0.0, inspector), (column, 1.0 - inspector)),
        ]
    }

    /// Returns the camera view with the other views in a strip below it.
    fn with_strip(self) -> [ViewRect; 3] {
        let strip = (1.0 - self.window / self.camera).clamp(MIN_STRIP_HEIGHT, 0.5);
        let height = 1.0 - strip;
        let width = (height * self.camera).min(self.window);
        let inspector = (strip * INSPECTOR_ASPECT).min(MAX_INSPECTOR_SHARE * self.window);
        [
            self.rect(ViewKind::Camera, (0.5 * (self.window - width), 0.0), (width, width / self.camera)),
            self.rect(ViewKind::Inspector, (0.0, height), (inspector, strip)),
            self.rect(ViewKind::Instruments, (inspector, height), (self.window - inspector, strip)),
        ]
    }

    /// Returns the map with the other views in a column at its left, or in a strip below it in a narrow window.
    fn with_map(self) -> [ViewRect; 4] {
        if self.window < MIN_MAP_COLUMN_ASPECT {
            return self.with_map_above_strip();
        }
        let column = (MAP_COLUMN_SHARE * self.window).clamp(MAP_COLUMN_WIDTH.0, MAP_COLUMN_WIDTH.1);
        let camera = column / self.camera;
        let inspector = (column / INSPECTOR_ASPECT).min(0.5 * (1.0 - camera));
        let below = camera + inspector;
        [
            self.rect(ViewKind::Map, (column, 0.0), (self.window - column, 1.0)),
            self.rect(ViewKind::Camera, (0.0, 0.0), (column, camera)),
            self.rect(ViewKind::Inspector, (0.0, camera), (column, inspector)),
            self.rect(ViewKind::Instruments, (0.0, below), (column, 1.0 - below)),
        ]
    }

    fn with_map_above_strip(self) -> [ViewRect; 4] {
        let most = MAP_STRIP_CAMERA_SHARE * self.window;
        let strip = (most / self.camera).clamp(MAP_STRIP_HEIGHT.0, MAP_STRIP_HEIGHT.1);
        let camera = (strip * self.camera).min(most);
        let (top, other) = (1.0 - strip, 0.5 * (self.window - camera));
        [
            self.rect(ViewKind::Map, (0.0, 0.0), (self.window, top)),
            self.rect(ViewKind::Camera, (0.0, top), (camera, strip)),
            self.rect(ViewKind::Inspector, (camera, top), (other, strip)),
            self.rect(ViewKind::Instruments, (camera + other, top), (other, strip)),
        ]
    }

    /// Returns the arrangement with the larger camera view.
    fn with_instruments(self) -> [ViewRect; 3] {
        let (column, strip) = (self.with_column(), self.with_strip());
        if column[0].width >= strip[0].width { column } else { strip }
    }
}

impl ViewLayout {
    /// All layouts with their names on the command line.
    pub const ALL: [(&'static str, Self); 5] = [
        ("camera", Self::Camera),
        ("inspector", Self::Inspector),
        ("side-by-side", Self::SideBySide),
        ("inspector-only", Self::InspectorOnly),
        ("map", Self::Map),
    ];

    /// Returns the layout to which the Tab key switches next.
    #[must_use]
    pub fn next(self) -> Self {
        match self {
            Self::Camera => Self::Inspector,
            Self::Inspector => Self::SideBySide,
            Self::SideBySide | Self::InspectorOnly | Self::Map => Self::Camera,
        }
    }

    /// Returns the position of the status text in the window, which never overlaps the HUD. With larger text and in narrow windows, it
    /// is in the inspector's view, because the HUD then fills the camera view. Beside the large map, it always is.
    #[must_use]
    pub fn words(self, shape: WindowShape, text_scale: TextScale) -> TextAnchor {
        let in_inspector = |inspector: ViewRect| TextAnchor {
            left_edge: inspector.left,
            edge: inspector.top + inspector.height,
            width: inspector.width,
            height: (LARGE_TEXT_HEIGHT * inspector.height).min(inspector.height - 2.0 * BUTTON_DOWN),
            extends_down: false,
        };
        match self {
            Self::Camera if text_scale != TextScale::Normal || shape.window < MIN_STATUS_TEXT_ASPECT => {
                let [_, inspector, _] = shape.with_instruments();
                in_inspector(inspector)
            }
            Self::Map => {
                let [_, _, inspector, _] = shape.with_map();
                in_inspector(inspector)
            }
            Self::Camera => {
                let [camera, ..] = shape.with_instruments();
                TextAnchor {
                    left_edge: camera.left,
                    edge: camera.top + STATUS_TEXT_TOP * camera.height,
                    width: STATUS_TEXT_WIDTH * camera.width,
                    height: 1.0 - camera.top - STATUS_TEXT_TOP * camera.height,
                    extends_down: true,
                }
            }
            // Left of the inset view.
            Self::Inspector | Self::InspectorOnly => {
                TextAnchor { left_edge: 0.0, edge: 1.0, width: 0.5 - 0.5 * INSET_SIZE, height: 0.9, extends_down: false }
            }
            Self::SideBySide => TextAnchor { left_edge: 0.0, edge: 1.0, width: 0.5, height: 0.9, extends_down: false },
        }
    }

    /// Returns the center of the button in the inspector's view, as fractions of the window's width and height.
    #[must_use]
    pub fn button(self, shape: WindowShape) -> (f64, f64) {
        match self {
            Self::Camera => {
                let [_, inspector, _] = shape.with_instruments();
                (inspector.left + 0.5 * inspector.width, inspector.top + BUTTON_DOWN)
            }
            Self::Map => {
                let [_, _, inspector, _] = shape.with_map();
                (inspector.left + 0.5 * inspector.width, inspector.top + BUTTON_DOWN)
            }
            Self::Inspector | Self::InspectorOnly => (0.5, 0.04),
            Self::SideBySide => (0.25, 0.04),
        }
    }

    /// Returns the views in drawing order.
    #[must_use]
    pub fn view_rects(self, shape: WindowShape) -> Vec<ViewRect> {
        let half = |which, left| ViewRect { which, left, top: 0.0, width: 0.5, height: 1.0 };
        let whole = |which| ViewRect { which, left: 0.0, top: 0.0, width: 1.0, height: 1.0 };
        match self {
            Self::Camera => shape.with_instruments().to_vec(),
            Self::Inspector => {
                let (left, top) = (0.5 - 0.5 * INSET_SIZE, 1.0 - INSET_SIZE);
                let inset = ViewRect { which: ViewKind::Camera, left, top, width: INSET_SIZE, height: INSET_SIZE };
                vec![whole(ViewKind::Inspector), inset]
            }
            Self::InspectorOnly => vec![whole(ViewKind::Inspector)],
            Self::Map => shape.with_map().to_vec(),
            Self::SideBySide => vec![half(ViewKind::Inspector, 0.0), half(ViewKind::Camera, 0.5)],
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

    /// Largest difference that rounding explains.
    const ROUNDING_ERROR: f64 = 1e-12;

    #[test]
    fn prop_views_fill_their_places_without_overlap_in_any_window() {
        let windows = (0..30).map(|k| 0.7 + 0.08 * f64::from(k));
        for window in windows.chain([4.0 / 3.0, 16.0 / 9.0, 21.0 / 9.0]) {
            for camera in [4.0 / 3.0, 3.0 / 2.0, 16.0 / 9.0] {
                let shape = WindowShape { window, camera };
                let [large, inspector, instruments] = shape.with_instruments();
                let [map, small_camera, small_inspector, navigation] = shape.with_map();
                let is_apart = |a: &ViewRect, b: &ViewRect| {
                    a.left + a.width <= b.left + ROUNDING_ERROR
                        || b.left + b.width <= a.left + ROUNDING_ERROR
                        || a.top + a.height <= b.top + ROUNDING_ERROR
                        || b.top + b.height <= a.top + ROUNDING_ERROR
                };
                let all = [large, inspector, instruments];
                let with_map = [map, small_camera, small_inspector, navigation];
                for (all, (k, place)) in
                    [&all[..], &with_map[..]].into_iter().flat_map(|all| all.iter().enumerate().map(move |one| (all, one)))
                {
                    let (right, bottom) = (place.left + place.width, place.top + place.height);
                    assert!(place.left >= 0.0 && place.top >= -ROUNDING_ERROR, "{shape:?}: {place:?}");
                    assert!(right <= 1.0 + ROUNDING_ERROR && bottom <= 1.0 + ROUNDING_ERROR, "{shape:?}: {place:?}");
                    assert!(all[..k].iter().all(|other| is_apart(place, other)), "{shape:?}: {all:?}");
                }
                assert!((large.width * window / large.height - camera).abs() < 1e-9, "{shape:?}: {large:?}");
                let area = |place: &ViewRect| place.width * place.height;
                let has_space = area(&map) > 0.5 && with_map[1..].iter().all(|place| area(place) > 0.04);
                assert!(has_space, "{shape:?}: {with_map:?}");
                assert!(area(&large) > 0.3 && area(&large) > area(&inspector), "{shape:?}: {all:?}");
            }
        }
    }

    #[test]
    fn exact_tab_cycles_through_layouts_that_show_both_views() {
        let shape = WindowShape { window: 16.0 / 9.0, camera: 4.0 / 3.0 };
        let mut seen = ViewLayout::default();
        let [camera, ..] = shape.with_instruments();
        assert!((camera.height - 1.0).abs() < ROUNDING_ERROR, "the camera view has the window's height: {camera:?}");
        for _ in 0..3 {
            let kinds: Vec<ViewKind> = seen.view_rects(shape).iter().map(|place| place.which).collect();
            assert!(kinds.contains(&ViewKind::Camera) && kinds.contains(&ViewKind::Inspector), "{seen:?}");
            seen = seen.next();
        }
        assert_eq!(seen, ViewLayout::Camera);
    }

    #[test]
    fn exact_second_screen_shows_only_the_inspectors_view_until_tab_is_pressed() {
        let shape = WindowShape { window: 16.0 / 9.0, camera: 4.0 / 3.0 };
        let places = ViewLayout::InspectorOnly.view_rects(shape);
        assert!(matches!(places[..], [ViewRect { which: ViewKind::Inspector, width: 1.0, height: 1.0, .. }]), "{places:?}");
        assert_eq!(ViewLayout::InspectorOnly.next(), ViewLayout::Camera);
    }

    #[test]
    fn prop_words_and_button_beside_the_large_map_are_in_the_inspectors_view() {
        for window in [0.7, 1.0, 1.24, 1.25, 16.0 / 9.0, 21.0 / 9.0] {
            for camera in [4.0 / 3.0, 3.0 / 2.0, 16.0 / 9.0] {
                let shape = WindowShape { window, camera };
                let places = ViewLayout::Map.view_rects(shape);
                let inspector = places.iter().find(|place| place.which == ViewKind::Inspector).unwrap();
                let (right, bottom) = (inspector.left + inspector.width, inspector.top + inspector.height);
                let words = ViewLayout::Map.words(shape, TextScale::Normal);
                assert_eq!(
                    (words.left_edge, words.width, words.edge, words.extends_down),
                    (inspector.left, inspector.width, bottom, false)
                );
                assert!(words.height < inspector.height, "{shape:?}: {words:?}");
                let (x, y) = ViewLayout::Map.button(shape);
                assert!(x > inspector.left && x < right && y > inspector.top, "{shape:?}: {x}, {y}");
                assert!(y + BUTTON_DOWN <= bottom - words.height + ROUNDING_ERROR, "{shape:?}: the button is above the words");
            }
        }
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
