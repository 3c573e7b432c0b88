//! Inset map of the site, in the lower right corner of the camera view.

use super::DrawItem;
use super::instruments::{Area, MapDetail, site_map};
use super::pane::Pane;
use super::state::Hud;

/// Half the side length of the map.
const HALF_SIZE: f64 = 0.135;
/// Distance of the map's center from the right and bottom edges.
const CENTER_OFFSET: f64 = 0.16;
/// Font size.
const FONT_SIZE: f64 = 0.02;

/// Checks whether the map is shown. The panel of a lesson needs its place.
fn is_shown(hud: &Hud) -> bool {
    !hud.tracks.is_empty() && hud.lesson.is_none()
}

/// Returns the left edge of the map, or `None` if it is hidden.
pub fn left(hud: &Hud, pane: Pane) -> Option<f64> {
    is_shown(hud).then_some(pane.width - CENTER_OFFSET - HALF_SIZE)
}

/// Returns the items of the map.
pub fn map(hud: &Hud, pane: Pane) -> Vec<DrawItem> {
    if !is_shown(hud) {
        return Vec::new();
    }
    let (x, y) = (pane.width - CENTER_OFFSET - HALF_SIZE, pane.height - CENTER_OFFSET - HALF_SIZE);
    site_map(hud, &hud.site, pane, Area { x, y, width: 2.0 * HALF_SIZE, height: 2.0 * HALF_SIZE }, (FONT_SIZE, MapDetail::Small))
}
