//! Reduced HUD for small pictures: speed, battery, and warnings in a legible font size. The unit is the font size.

use super::battery::{ChargeStyle, charge_style};
use super::icons::IconShape;
use super::messages::{ActiveCue, warnings};
use super::pane::Pane;
use super::speed::speed_text;
use super::state::Hud;
use super::status::alarm;
use super::text_metrics::text_width;
use super::{DrawItem, HudColor, TextAlign};
use spandrel_text::text;

/// Font size that is legible at a glance, px (estimate: capitals 8 px high).
const LEGIBLE_FONT_SIZE_PX: f64 = 12.0;
/// Font size as a fraction of the picture's height, used where it exceeds the legible size.
const FONT_FRACTION: f64 = 0.05;
/// Minimum width (speed and battery side by side) and minimum height (rows for a lost link and a crash), in units of
/// the font size. In smaller pictures, the font shrinks.
const MIN_WIDTH: f64 = 12.0;
const MIN_HEIGHT: f64 = 6.0;
/// Margin at the picture edges and gap between blocks.
const EDGE_MARGIN: f64 = 0.35;
const BLOCK_GAP: f64 = 0.15;
/// Height of a block, horizontal padding, width of its icon column, and height of the icon.
const ROW_HEIGHT: f64 = 1.5;
const PADDING: f64 = 0.4;
const ICON_COLUMN_WIDTH: f64 = 1.3;
const ICON_HEIGHT: f64 = 0.8;

/// Returns the HUD items for a picture of the given size in pixels.
pub fn essential_items(hud: &Hud, (width_px, height_px): (f64, f64)) -> Vec<DrawItem> {
    let wanted_px = (FONT_FRACTION * Pane::unit((width_px, height_px))).max(LEGIBLE_FONT_SIZE_PX) * hud.style.text_scale.factor();
    let type_px = wanted_px.min(width_px / MIN_WIDTH).min(height_px / MIN_HEIGHT);
    let pane = Pane { width: width_px / type_px, height: height_px / type_px };
    let (color, words) = speed_text(hud);
    let mut items = block(pane, (EDGE_MARGIN, EDGE_MARGIN), None, color, &words);
    items.extend(battery(hud, pane));
    let mut top = EDGE_MARGIN + ROW_HEIGHT + BLOCK_GAP;
    if let Some(words) = alarm(hud) {
        items.extend(block(pane, (EDGE_MARGIN, top), None, HudColor::Orange, &words));
        top += ROW_HEIGHT + BLOCK_GAP;
    }
    let rows = ((pane.height - EDGE_MARGIN - top + BLOCK_GAP) / (ROW_HEIGHT + BLOCK_GAP)).floor().max(0.0) as usize;
    for (k, ActiveCue { shape, color, warning }) in warnings(hud).into_iter().take(rows).enumerate() {
        let y = pane.height - EDGE_MARGIN - ROW_HEIGHT - (ROW_HEIGHT + BLOCK_GAP) * k as f64;
        items.extend(block(pane, (EDGE_MARGIN, y), Some((shape, true)), color, &warning.name));
    }
    items
}

fn battery(hud: &Hud, pane: Pane) -> Vec<DrawItem> {
    let Some(pct) = hud.battery_pct else {
        let words = text!(hud.style.language, "flight-battery-unknown");
        return block(pane, (pane.width - EDGE_MARGIN - width(&words, false), EDGE_MARGIN), None, HudColor::Gray, &words);
    };
    let ChargeStyle { color, shape, blinked_off: dark } = charge_style(hud, pct);
    let words = format!("{pct:.0}%");
    block(pane, (pane.width - EDGE_MARGIN - width(&words, true), EDGE_MARGIN), Some((shape, !dark)), color, &words)
}

fn width(words: &str, signed: bool) -> f64 {
    2.0 * PADDING + text_width(words, 1.0) + if signed { ICON_COLUMN_WIDTH } else { 0.0 }
}

/// Returns text on a background. The flag next to the optional icon is false while a blinking icon is off.
fn block(pane: Pane, (x, y): (f64, f64), sign: Option<(IconShape, bool)>, color: HudColor, words: &str) -> Vec<DrawItem> {
    let middle = y + 0.5 * ROW_HEIGHT;
    let mut items = vec![pane.panel((x, y), (x + width(words, sign.is_some()), y + ROW_HEIGHT))];
    if let Some((shape, true)) = sign {
        items.extend(pane.icon(shape, (x + PADDING + 0.5, middle), ICON_HEIGHT, color));
    }
    let from = x + PADDING + sign.map_or(0.0, |_| ICON_COLUMN_WIDTH);
    items.push(pane.text((from, middle), TextAlign::Left, 1.0, color, words));
    items
}
