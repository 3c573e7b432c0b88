//! Speed of the aircraft, upper left.

use super::metrics::{EDGE, LARGE, M_S_PER_MPH, SMALL};
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
    let inner = EDGE + 0.016;
    let mph = |m_s: f64| m_s / M_S_PER_MPH;
    let (speed_mph, limit_mph) = (mph(hud.speed_m_s), mph(hud.limit_m_s));
    let over = hud.speed_m_s > hud.limit_m_s;
    let shown = if over { format_with_limit(speed_mph, limit_mph, 0) } else { format!("{speed_mph:.0}") };
    let limit = format!("{shown} mph, limit {limit_mph:.0}");
    let (color, words) = speed_text(hud);
    vec![
        pane.panel((EDGE, EDGE), (EDGE + 0.25, EDGE + 0.105)),
        pane.text((inner, EDGE + 0.037), TextAlign::Left, LARGE, color, words),
        pane.text((inner, EDGE + 0.081), TextAlign::Left, SMALL, HudColor::Gray, limit),
    ]
}
