//! Layout of the HUD. Sizes and positions are in units of `Pane`: the picture's height, or less in a narrow picture.

use super::battery::battery;
use super::lesson_panel::lesson_panel;
use super::map::map;
use super::messages::messages;
use super::metrics::{EDGE_MARGIN, SMALL_FONT_SIZE};
use super::pane::Pane;
use super::small_view::essential_items;
use super::speed::speed;
use super::state::Hud;
use super::status::status;
use super::task_panel::task_panel;
use super::{DrawItem, HudColor, TextAlign};
use spandrel_model::math;

/// Smallest font size that is legible in flight, px (estimate: capitals 6.5 px high; the font size in a picture 360 px
/// high is 9.7 px).
const MIN_FONT_SIZE_PX: f64 = 9.5;
/// Central fraction of the picture in which a defect must be to count.
const CENTRAL_FRACTION: f64 = 0.8;

/// Returns all HUD items for a picture with the given aspect ratio (width over height).
#[must_use]
pub fn layout(hud: &Hud, aspect: f64) -> Vec<DrawItem> {
    let pane = Pane::of(aspect);
    let mut items = crosshair(hud, pane);
    items.extend(speed(hud, pane));
    items.extend(task_panel(hud, pane));
    items.extend(lesson_panel(hud, pane));
    items.extend(battery(hud, pane));
    items.extend(status(hud, pane));
    items.extend(readouts(hud, pane));
    items.extend(messages(hud, pane));
    items.extend(map(hud, pane));
    items
}

/// Returns the HUD items for a picture of the given size, in px (at standard pixel density). If the picture is too
/// small for all items, only the essential ones are included.
#[must_use]
pub fn layout_px(hud: &Hud, (width, height): (f64, f64)) -> Vec<DrawItem> {
    let size_px = (width.max(1.0), height.max(1.0));
    if SMALL_FONT_SIZE * Pane::unit(size_px) >= MIN_FONT_SIZE_PX {
        layout(hud, size_px.0 / size_px.1)
    } else {
        essential_items(hud, size_px)
    }
}

/// Returns the crosshair and the corner marks of the area where a defect counts. They are drawn below all other items.
fn crosshair(hud: &Hud, pane: Pane) -> Vec<DrawItem> {
    let mut items = Vec::new();
    let (low, high, arm) = (0.5 - 0.5 * CENTRAL_FRACTION, 0.5 + 0.5 * CENTRAL_FRACTION, 0.035);
    let color = if hud.shutter { HudColor::Yellow } else { HudColor::Gray };
    for (x, right) in [(low * pane.width, arm), (high * pane.width, -arm)] {
        for (y, down) in [(low * pane.height, arm), (high * pane.height, -arm)] {
            items.push(pane.line(&[(x + right, y), (x, y), (x, y + down)], 0.003, color));
        }
    }
    let (x, y, cross) = (0.5 * pane.width, 0.5 * pane.height, 0.018);
    items.push(pane.line(&[(x - cross, y), (x + cross, y)], 0.0025, HudColor::White));
    items.push(pane.line(&[(x, y - cross), (x, y + cross)], 0.0025, HudColor::White));
    if let Some(way_back) = hud.way_back {
        items.extend(way_back_arrow(pane, (x, y), way_back.direction_rad));
    }
    items
}

/// Returns an arrow beside the crosshair that points back to the path.
fn way_back_arrow(pane: Pane, (x, y): (f64, f64), direction_rad: f64) -> Vec<DrawItem> {
    /// Distance of the tip from the crosshair, length of the arrow, and half the width of its head.
    const TIP: f64 = 0.17;
    const LENGTH: f64 = 0.09;
    const HEAD: f64 = 0.03;
    let (sin, cos) = math::sin_cos(direction_rad);
    let at = |ahead: f64, right: f64| (x + ahead * sin + right * cos, y - ahead * cos + right * sin);
    let shapes = [vec![at(TIP - LENGTH, 0.0), at(TIP, 0.0)], vec![at(TIP - HEAD, -HEAD), at(TIP, 0.0), at(TIP - HEAD, HEAD)]];
    // The dark outline keeps the arrow visible against a bright sky.
    let strokes = [(0.014, HudColor::Black), (0.008, HudColor::Blue)];
    strokes.iter().flat_map(|(width, color)| shapes.iter().map(|shape| pane.line(shape, *width, *color))).collect()
}

/// Returns the values below the battery: height, distance from home, gimbal, time, lamp, pictures.
fn readouts(hud: &Hud, pane: Pane) -> Vec<DrawItem> {
    let (right, top) = (pane.width - EDGE_MARGIN, EDGE_MARGIN + 0.085);
    let left = hud.remaining_s.max(0.0);
    let mut lines = vec![
        ("height", format!("{:.1} m", hud.height_m)),
        ("home", format!("{:.0} m", hud.home_distance_m)),
        ("gimbal", format!("{:+.0}°", hud.gimbal_rad.to_degrees())),
        ("time left", format!("{}:{:02}", (left / 60.0).floor(), (left % 60.0).floor())),
        ("lamp", if hud.lamp { "on".into() } else { "off".into() }),
        ("pictures", hud.pictures.to_string()),
    ];
    if hud.zoom > 1.01 {
        lines.push(("zoom", format!("{:.1} x", hud.zoom)));
    }
    let step = 0.037;
    let from = right - 0.225;
    let bottom = top + step * lines.len() as f64 + 0.012;
    let mut items = vec![pane.panel((from, top), (right, bottom))];
    for (k, (name, value)) in lines.into_iter().enumerate() {
        let y = top + 0.006 + step * (k as f64 + 0.5);
        let lit = name == "lamp" && hud.lamp;
        items.push(pane.text((from + 0.012, y), TextAlign::Left, SMALL_FONT_SIZE, HudColor::Gray, name));
        let color = if lit { HudColor::Yellow } else { HudColor::White };
        items.push(pane.text((right - 0.012, y), TextAlign::Right, SMALL_FONT_SIZE, color, value));
    }
    items
}
