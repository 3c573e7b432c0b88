//! Reduced HUD for small pictures: speed, battery and warnings in a legible font size. The unit is the font size.

use super::battery::{ChargeStyle, charge};
use super::icons::IconShape;
use super::messages::{ActiveCue, warnings};
use super::pane::Pane;
use super::speed::speed_words;
use super::state::Hud;
use super::status::alarm;
use super::text_metrics::width_of;
use super::{DrawItem, HudColor, TextAlign};

/// Font size that is legible at a glance, px (estimate: capitals of 8 px).
const LEGIBLE_PX: f64 = 12.0;
/// Font size as a fraction of the picture's height, where that is larger.
const SHARE: f64 = 0.05;
/// Width of speed and battery next to each other, and height of the rows of a lost link and a crash, in units of the font
/// size; in smaller pictures the font shrinks.
const MOST_WIDE: f64 = 12.0;
const LEAST_HIGH: f64 = 6.0;
/// Margin at the edges of the picture, and gap between blocks.
const EDGE: f64 = 0.35;
const GAP: f64 = 0.15;
/// Height of a block, horizontal padding, width and height of its icon.
const ROW: f64 = 1.5;
const INSET: f64 = 0.4;
const SIGN: f64 = 1.3;
const SYMBOL: f64 = 0.8;

/// Returns the HUD items for a picture of this size, px.
pub fn brief(hud: &Hud, (width_px, height_px): (f64, f64)) -> Vec<DrawItem> {
    let wanted_px = (SHARE * Pane::unit((width_px, height_px))).max(LEGIBLE_PX);
    let type_px = wanted_px.min(width_px / MOST_WIDE).min(height_px / LEAST_HIGH);
    let pane = Pane { width: width_px / type_px, height: height_px / type_px };
    let (colour, words) = speed_words(hud);
    let mut items = block(pane, (EDGE, EDGE), None, colour, &words);
    items.extend(battery(hud, pane));
    let mut top = EDGE + ROW + GAP;
    if let Some(words) = alarm(hud) {
        items.extend(block(pane, (EDGE, top), None, HudColor::Orange, &words));
        top += ROW + GAP;
    }
    let rows = ((pane.height - EDGE - top + GAP) / (ROW + GAP)).floor().max(0.0) as usize;
    for (k, ActiveCue { shape, colour, text: words, .. }) in warnings(hud).into_iter().take(rows).enumerate() {
        let y = pane.height - EDGE - ROW - (ROW + GAP) * k as f64;
        items.extend(block(pane, (EDGE, y), Some((shape, true)), colour, words));
    }
    items
}

fn battery(hud: &Hud, pane: Pane) -> Vec<DrawItem> {
    let Some(pct) = hud.battery_pct else {
        let words = "battery ?";
        return block(pane, (pane.width - EDGE - width(words, false), EDGE), None, HudColor::Grey, words);
    };
    let ChargeStyle { colour, shape, dark } = charge(hud, pct);
    let words = format!("{pct:.0} %");
    block(pane, (pane.width - EDGE - width(&words, true), EDGE), Some((shape, !dark)), colour, &words)
}

fn width(words: &str, signed: bool) -> f64 {
    2.0 * INSET + width_of(words, 1.0) + if signed { SIGN } else { 0.0 }
}

/// Draws text on a background, after an optional icon that may currently be off (blinking).
fn block(pane: Pane, (x, y): (f64, f64), sign: Option<(IconShape, bool)>, colour: HudColor, words: &str) -> Vec<DrawItem> {
    let middle = y + 0.5 * ROW;
    let mut items = vec![pane.panel((x, y), (x + width(words, sign.is_some()), y + ROW))];
    if let Some((shape, true)) = sign {
        items.extend(pane.symbol(shape, (x + INSET + 0.5, middle), SYMBOL, colour));
    }
    let from = x + INSET + sign.map_or(0.0, |_| SIGN);
    items.push(pane.text((from, middle), TextAlign::Left, 1.0, colour, words));
    items
}
