//! Strength of the control and video links as rising bars, as pilots know them from other displays. Only in jobs that simulate the
//! links.

use super::metrics::SMALL_FONT_SIZE;
use super::pane::Pane;
use super::text_metrics::text_width;
use super::{DrawItem, HudColor, TextAlign};
use spandrel_mavlink::contract::hazards::RadioMargins;
use spandrel_model::radio::{DEGRADATION_DB, delivered_share};
use spandrel_text::{Language, text};

/// Number of bars.
const BARS: usize = 4;
/// Margin per bar beyond the one at which all data arrives, dB: half the distance in free space.
const BAR_STEP_DB: f64 = 6.0;
/// Width of a bar, the gap to the next one, the height of the first one, and how much each is higher than the one before.
const BAR_WIDTH: f64 = 0.007;
const BAR_GAP: f64 = 0.004;
const BAR_HEIGHT: f64 = 0.010;
const BAR_RISE: f64 = 0.005;
/// Height of a bar that the signal does not reach.
const STUB_HEIGHT: f64 = 0.003;
/// Gap between a name and its bars, between two links, and at the ends of the row.
const NAME_GAP: f64 = 0.010;
const LINK_GAP: f64 = 0.030;
const PADDING: f64 = 0.014;

/// A link as it is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct RadioLink {
    name: String,
    bars: usize,
}

impl RadioLink {
    /// Returns the control link and the video link.
    pub fn both(margins: &RadioMargins, language: Language) -> [Self; 2] {
        [
            Self { name: text!(language, "flight-status-signal-control"), bars: bars(margins.control_db) },
            Self { name: text!(language, "flight-status-signal-video"), bars: bars(margins.video_db) },
        ]
    }

    fn width(&self) -> f64 {
        text_width(&self.name, SMALL_FONT_SIZE) + NAME_GAP + BARS_WIDTH
    }

    fn color(&self) -> HudColor {
        match self.bars {
            0 | 1 => HudColor::Orange,
            2 => HudColor::Yellow,
            _ => HudColor::White,
        }
    }
}

/// Width of all bars.
const BARS_WIDTH: f64 = BARS as f64 * BAR_WIDTH + (BARS - 1) as f64 * BAR_GAP;

/// Returns the number of bars at a margin in dB: none if no data arrives, one if some is lost.
fn bars(margin_db: f64) -> usize {
    if delivered_share(margin_db) <= 0.0 {
        0
    } else if delivered_share(margin_db) < 1.0 {
        1
    } else {
        // Not negative: all data arrives.
        (((margin_db - DEGRADATION_DB) / BAR_STEP_DB).floor() as usize).saturating_add(2).min(BARS)
    }
}

/// Returns whether a link with this margin in dB loses data.
pub fn is_weak(margin_db: f64) -> bool {
    bars(margin_db) < 2
}

/// Returns the width of a row with these links; 0 without links.
pub fn row_width(links: &[RadioLink]) -> f64 {
    if links.is_empty() {
        return 0.0;
    }
    2.0 * PADDING + links.iter().map(RadioLink::width).sum::<f64>() + LINK_GAP * (links.len() - 1) as f64
}

/// Draws a row of links from its left end and the height of its middle.
pub fn row(pane: Pane, (left, y): (f64, f64), links: &[RadioLink]) -> Vec<DrawItem> {
    let mut items = Vec::new();
    let mut x = left + PADDING;
    for link in links {
        items.push(pane.text((x, y), TextAlign::Left, SMALL_FONT_SIZE, link.color(), link.name.clone()));
        x += text_width(&link.name, SMALL_FONT_SIZE) + NAME_GAP;
        for k in 0..BARS {
            let at = x + (BAR_WIDTH + BAR_GAP) * k as f64;
            items.push(bar(pane, (at, y), (k, k < link.bars), link.color()));
        }
        x += BARS_WIDTH + LINK_GAP;
    }
    items
}

/// Draws a bar, or the stub of one that the signal does not reach: the number of bars is visible without colors.
fn bar(pane: Pane, (left, y): (f64, f64), (k, is_reached): (usize, bool), color: HudColor) -> DrawItem {
    let bottom = y + 0.5 * (BAR_HEIGHT + BAR_RISE * (BARS - 1) as f64);
    let (height, color) = if is_reached { (BAR_HEIGHT + BAR_RISE * k as f64, color) } else { (STUB_HEIGHT, HudColor::Gray) };
    let right = left + BAR_WIDTH;
    pane.fill(&[(left, bottom - height), (right, bottom - height), (right, bottom), (left, bottom)], color)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_bars_fall_with_the_margin() {
        let steps = [(-20.0, 0), (-3.0, 0), (-2.9, 1), (2.9, 1), (3.0, 2), (8.9, 2), (9.0, 3), (14.9, 3), (15.0, 4), (90.0, 4)];
        for (margin_db, expected) in steps {
            assert_eq!(bars(margin_db), expected, "{margin_db} dB");
        }
        assert_eq!((bars(f64::NEG_INFINITY), bars(f64::INFINITY)), (0, BARS));
    }
}
