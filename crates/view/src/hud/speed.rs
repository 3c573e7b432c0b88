//! Speed of the aircraft, upper left.

use super::metrics::{EDGE_MARGIN, LARGE_FONT_SIZE, SMALL_FONT_SIZE};
use super::pane::Pane;
use super::state::Hud;
use super::text_metrics::fitted;
use super::{DrawItem, HudColor, TextAlign};
use spandrel_mavlink::contract::cue;
use spandrel_text::text;

/// Width and height of the panel.
const PANEL_WIDTH: f64 = 0.25;
pub(super) const PANEL_HEIGHT: f64 = 0.105;
/// Distance of the texts from the edges.
const PADDING: f64 = 0.016;

/// Returns the speed as text, and its color.
pub(super) fn speed_text(hud: &Hud) -> (HudColor, String) {
    let fast = hud.cues & cue::SPEEDING != 0;
    let words = hud.style.units.speed(hud.speed_m_s, hud.limit_m_s);
    (if fast { HudColor::Yellow } else { HudColor::White }, words)
}

/// Returns the speed block in the upper left corner.
pub(super) fn speed(hud: &Hud, pane: Pane) -> Vec<DrawItem> {
    let (language, inner) = (hud.style.language, EDGE_MARGIN + PADDING);
    let limit = text!(language, "flight-speed-limit", limit = hud.style.units.speed_limit(hud.limit_m_s));
    let (color, words) = speed_text(hud);
    let limit_size = fitted(&limit, SMALL_FONT_SIZE, PANEL_WIDTH - 2.0 * PADDING);
    vec![
        pane.panel((EDGE_MARGIN, EDGE_MARGIN), (EDGE_MARGIN + PANEL_WIDTH, EDGE_MARGIN + PANEL_HEIGHT)),
        pane.text((inner, EDGE_MARGIN + 0.037), TextAlign::Left, LARGE_FONT_SIZE, color, words),
        pane.text((inner, EDGE_MARGIN + 0.081), TextAlign::Left, limit_size, HudColor::Gray, limit),
    ]
}
