//! Battery display at the upper right: level bar, percentage, and status icon.

use super::icons::IconShape;
use super::metrics::{EDGE_MARGIN, MEDIUM_FONT_SIZE};
use super::pane::Pane;
use super::state::Hud;
use super::text_metrics::fitted;
use super::{DrawItem, HudColor, TextAlign};
use spandrel_text::text;

/// Width and height of the panel.
pub const PANEL_WIDTH: f64 = 0.27;
pub const PANEL_HEIGHT: f64 = 0.075;
/// Distance of the text from the edges.
const PADDING: f64 = 0.016;
/// Blink rate, Hz (noticeable, but well below rates that can trigger seizures).
const BLINK_RATE_HZ: f64 = 2.0;

/// Appearance of a battery level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChargeStyle {
    /// Color of all elements.
    pub color: HudColor,
    /// Icon shape.
    pub shape: IconShape,
    /// Whether a blinking element is currently off.
    pub blinked_off: bool,
}

/// Returns the appearance for a battery level in %.
pub fn charge_style(hud: &Hud, pct: f64) -> ChargeStyle {
    let (color, shape) = if pct >= hud.min_green_pct {
        (HudColor::Green, IconShape::Disc)
    } else if pct >= hud.min_yellow_pct {
        (HudColor::Yellow, IconShape::Triangle)
    } else {
        (HudColor::Red, IconShape::Octagon)
    };
    let dark = color == HudColor::Red && (hud.time_s * BLINK_RATE_HZ).rem_euclid(1.0) >= 0.5;
    ChargeStyle { color, shape, blinked_off: dark }
}

pub fn battery(hud: &Hud, pane: Pane) -> Vec<DrawItem> {
    let right = pane.width - EDGE_MARGIN;
    let (from, y) = (right - PANEL_WIDTH, EDGE_MARGIN + 0.5 * PANEL_HEIGHT);
    let words_at = (right - PADDING, y);
    let mut items = vec![pane.panel((from, EDGE_MARGIN), (right, EDGE_MARGIN + PANEL_HEIGHT))];
    let Some(pct) = hud.battery_pct else {
        let place = (words_at.0, EDGE_MARGIN + 0.037);
        let words = text!(hud.style.language, "flight-battery-no-data");
        let size = fitted(&words, MEDIUM_FONT_SIZE, PANEL_WIDTH - 2.0 * PADDING);
        items.push(pane.text(place, TextAlign::Right, size, HudColor::Gray, words));
        return items;
    };
    let ChargeStyle { color, shape, blinked_off: dark } = charge_style(hud, pct);
    if !dark {
        items.extend(pane.icon(shape, (from + 0.03, y), 0.036, color));
    }
    let filled = (!dark).then_some((pct / 100.0).clamp(0.0, 1.0));
    items.extend(battery_symbol(pane, (from + 0.062, y), filled, color));
    items.push(pane.text(words_at, TextAlign::Right, MEDIUM_FONT_SIZE, color, format!("{pct:.0}%")));
    items
}

/// Returns the outline of a battery with its left edge at the given position, filled to the given fraction.
fn battery_symbol(pane: Pane, (low, y): (f64, f64), filled: Option<f64>, color: HudColor) -> Vec<DrawItem> {
    let (high, half, inset) = (low + 0.08, 0.017, 0.004);
    let box_of =
        |(left, right): (f64, f64), half: f64| [(left, y - half), (right, y - half), (right, y + half), (left, y + half)];
    let outline = box_of((low, high), half);
    let closed = [outline[0], outline[1], outline[2], outline[3], outline[0]];
    let mut items =
        vec![pane.line(&closed, 0.003, HudColor::White), pane.fill(&box_of((high, high + 0.006), 0.007), HudColor::White)];
    if let Some(share) = filled {
        let left = low + inset;
        let end = left + (high - low - 2.0 * inset) * share;
        items.push(pane.fill(&box_of((left, end), half - inset), color));
    }
    items
}
