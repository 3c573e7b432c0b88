//! Instruments beside the camera view: a navigation display, a map and a side profile of the site.

mod area;
mod clip;
mod job_drawing;
mod large_map;
mod map;
mod navigation;
mod profile;
mod scale;
mod site_outline;
#[cfg(test)]
mod tests;

pub(crate) use area::Area;
pub use job_drawing::JobDrawing;
pub use large_map::large_map;
pub(super) use map::{MapDetail, map as site_map};
pub use site_outline::SiteOutline;

use super::DrawItem;
use super::pane::Pane;
use super::state::Hud;

/// Normal font size relative to the shorter side of the instruments' area.
const FONT_RATIO: f64 = 0.045;
/// Smallest normal font size, px at standard pixel density.
const MIN_FONT_PX: f64 = 10.0;
/// Gap between the instruments, px.
const GAP_PX: f64 = 6.0;
/// Areas that are higher than wide show the instruments one below the other, with these shares of the height for navigation,
/// map and profile; other areas show them side by side.
const HEIGHT_SHARES: [f64; 3] = [0.37, 0.40, 0.23];
/// Largest share of the width for the navigation display, and the map's share of the rest.
const MAX_NAVIGATION_SHARE: f64 = 0.35;
const MAP_SHARE: f64 = 0.55;

/// Returns the instruments for an area of the given size, px at standard pixel density. Without reference paths, as in an
/// assessment, there is only the navigation display.
#[must_use]
pub fn instruments(hud: &Hud, site: &SiteOutline, (width, height): (f64, f64)) -> Vec<DrawItem> {
    let pane = Pane { width: width.max(1.0), height: height.max(1.0) };
    let font = (FONT_RATIO * pane.width.min(pane.height)).max(MIN_FONT_PX) * hud.style.text_scale.factor();
    let whole = Area { x: 0.0, y: 0.0, width: pane.width, height: pane.height };
    if hud.tracks.is_empty() {
        return navigation::navigation(hud, pane, whole.inside(GAP_PX), font);
    }
    let [first, second, third] = areas(whole);
    let mut items = navigation::navigation(hud, pane, first, font);
    items.extend(map::map(hud, site, pane, second, (font, MapDetail::Small)));
    items.extend(profile::profile(hud, site, pane, third, font));
    items
}

fn areas(whole: Area) -> [Area; 3] {
    let parts = if whole.height > whole.width {
        let mut y = 0.0;
        HEIGHT_SHARES.map(|share| {
            let part = Area { y, height: share * whole.height, ..whole };
            y += part.height;
            part
        })
    } else {
        let first = whole.height.min(MAX_NAVIGATION_SHARE * whole.width);
        let second = MAP_SHARE * (whole.width - first);
        let part = |x: f64, width: f64| Area { x, width, ..whole };
        [part(0.0, first), part(first, second), part(first + second, whole.width - first - second)]
    };
    parts.map(|part| part.inside(0.5 * GAP_PX))
}
