//! Speed of the aircraft, upper left.

use super::metrics::{EDGE_MARGIN, LARGE_FONT_SIZE, M_S_PER_MPH, SMALL_FONT_SIZE};
use super::pane::Pane;
use super::state::Hud;
use super::{DrawItem, HudColor, TextAlign};
use spandrel_mavlink::contract::cue;
use spandrel_model::numbers::format_with_limit;

/// Returns the speed as text, and its color.
pub(super) fn speed_text(hud: &Hud) -> (HudColor, String) {
    let fast = hud.cues & cue::SPEEDING != 0;
    (if fast { HudColor::Yellow } else { HudColor::White }, format!("{:.1} m/s", hud.speed_m_s))
}

/// Returns the speed block in the upper left corner.
pub(super) fn speed(hud: &Hud, pane: Pane) -> Vec<DrawItem> {
    let inner = EDGE_MARGIN + 0.016;
    let mph = |m_s: f64| m_s / M_S_PER_MPH;
    let (speed_mph, limit_mph) = (mph(hud.speed_m_s), mph(hud.limit_m_s));
    let over = hud.speed_m_s > hud.limit_m_s;
    let shown = if over { format_with_limit(speed_mph, limit_mph, 0) } else { format!("{speed_mph:.0}") };
    let limit = format!("{shown} mph, limit {limit_mph:.0}");
    let (color, words) = speed_text(hud);
    vec![
        pane.panel((EDGE_MARGIN, EDGE_MARGIN), (EDGE_MARGIN + 0.25, EDGE_MARGIN + 0.105)),
        pane.text((inner, EDGE_MARGIN + 0.037), TextAlign::Left, LARGE_FONT_SIZE, color, words),
        pane.text((inner, EDGE_MARGIN + 0.081), TextAlign::Left, SMALL_FONT_SIZE, HudColor::Gray, limit),
    ]
}
