//! Contrast of texts (WCAG 2.1) over everything that is drawn behind them, in front of white and of black scenery.

use super::text_metrics::text_width;
use super::{DrawItem, HudColor, ScreenPoint, TextAlign, at};
use spandrel_model::math;

/// Smallest contrast of normal text (WCAG 2.1, level AA).
const MIN_CONTRAST: f64 = 4.5;
/// Brightest and darkest scenery.
const SCENERY: [[f64; 3]; 2] = [[255.0; 3], [0.0; 3]];
/// Number of points across and down a text at which its background is determined.
const SAMPLES: (u32, u32) = (7, 3);

/// Returns the relative luminance of a color with components from 0 to 255 (WCAG 2.1).
fn luminance(rgb: [f64; 3]) -> f64 {
    let linear = rgb.map(|value| {
        let share = value / 255.0;
        if share <= 0.040_45 { share / 12.92 } else { math::pow((share + 0.055) / 1.055, 2.4) }
    });
    0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
}

fn ratio(one: [f64; 3], other: [f64; 3]) -> f64 {
    let (one, other) = (luminance(one), luminance(other));
    (one.max(other) + 0.05) / (one.min(other) + 0.05)
}

/// Returns a color over another one, blended as the painter does, in sRGB.
fn over(color: HudColor, behind: [f64; 3]) -> [f64; 3] {
    let [red, green, blue, opacity] = color.rgba().map(f64::from);
    let mut mixed = [red, green, blue];
    mixed.iter_mut().zip(behind).for_each(|(own, behind)| *own = (*own * opacity + behind * (255.0 - opacity)) / 255.0);
    mixed
}

/// Returns whether a convex polygon contains a point.
fn polygon_contains(points: &[ScreenPoint], point: ScreenPoint) -> bool {
    let next = points.iter().cycle().skip(1);
    let sides =
        points.iter().zip(next).map(|(from, to)| (to.x - from.x) * (point.y - from.y) - (to.y - from.y) * (point.x - from.x));
    let (low, high) = sides.fold((0.0, 0.0), |(low, high): (f64, f64), side| (low.min(side), high.max(side)));
    (low >= 0.0) != (high <= 0.0)
}

/// Returns the color behind a point: the scenery, with the areas over it. Lines are too thin to count.
fn behind(items: &[DrawItem], scenery: [f64; 3], point: ScreenPoint) -> [f64; 3] {
    items.iter().fold(scenery, |behind, item| match item {
        DrawItem::Panel { from, to, color } => {
            let inside = (from.x..=to.x).contains(&point.x) && (from.y..=to.y).contains(&point.y);
            if inside { over(*color, behind) } else { behind }
        }
        DrawItem::Fill { points, color } if polygon_contains(points, point) => over(*color, behind),
        DrawItem::Fill { .. } | DrawItem::Text { .. } | DrawItem::Line { .. } => behind,
    })
}

/// Returns points on a text that are inside the picture.
fn samples(place: ScreenPoint, side: TextAlign, (width, height): (f64, f64)) -> Vec<ScreenPoint> {
    let left = place.x
        - width
            * match side {
                TextAlign::Left => 0.0,
                TextAlign::Center => 0.5,
                TextAlign::Right => 1.0,
            };
    // Letters do not reach the upper and lower edge of a line.
    let (columns, rows) = SAMPLES;
    let all = (0..columns * rows).map(|k| {
        let (across, down) = (f64::from(k % columns) / f64::from(columns - 1), f64::from(k / columns) / f64::from(rows - 1));
        at(left + width * across, place.y + height * (0.6 * down - 0.3))
    });
    all.filter(|point| (0.0..=1.0).contains(&point.x) && (0.0..=1.0).contains(&point.y)).collect()
}

/// Checks all texts of a picture with the given aspect ratio (width over height).
pub fn check(items: &[DrawItem], aspect: f64, what: &str) {
    for (k, item) in items.iter().enumerate() {
        let DrawItem::Text { place, side, height, color, words } = item else { continue };
        let [red, green, blue, _] = color.rgba().map(f64::from);
        for point in samples(*place, *side, (text_width(words, *height) / aspect, *height)) {
            for scenery in SCENERY {
                let ground = behind(&items[..k], scenery, point);
                let found = ratio([red, green, blue], ground);
                assert!(found >= MIN_CONTRAST, "{what}: {color:?} '{words}' on {ground:.0?}: contrast {found:.2}");
            }
        }
    }
}

#[test]
fn exact_contrast_of_known_colors() {
    // Published examples: 21 for black on white, 4.54 for #767676 on white.
    const ROUNDING: f64 = 0.005;
    for (gray, expected) in [(0.0, 21.0), (118.0, 4.54), (255.0, 1.0)] {
        assert!((ratio([gray; 3], [255.0; 3]) - expected).abs() < ROUNDING, "{gray}: {}", ratio([gray; 3], [255.0; 3]));
    }
    let text =
        |y: f64, color| DrawItem::Text { place: at(0.5, y), side: TextAlign::Center, height: 0.1, color, words: "A".into() };
    let panel = DrawItem::Panel { from: at(0.0, 0.0), to: at(1.0, 0.5), color: HudColor::PageBackground };
    check(&[panel.clone(), text(0.2, HudColor::White)], 1.0, "white on a dark panel");
    for bad in [text(0.8, HudColor::White), text(0.2, HudColor::Water)] {
        let caught = std::panic::catch_unwind(|| check(&[panel.clone(), bad], 1.0, "text"));
        assert!(caught.is_err(), "text outside the panel, or too dark");
    }
}
