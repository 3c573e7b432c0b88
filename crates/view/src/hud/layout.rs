//! Layout of the HUD. Sizes and positions are in units of `Pane`: the picture's height, or less in a narrow picture.

use super::battery::{self, battery};
use super::lesson_panel::lesson_panel;
use super::map::{self, map};
use super::messages::{MIN_RIGHT_EDGE, messages};
use super::metrics::{BLOCK_GAP, EDGE_MARGIN, SMALL_FONT_SIZE};
use super::pane::Pane;
use super::small_view::essential_items;
use super::speed::speed;
use super::state::Hud;
use super::status::{alarm_line, status};
use super::style::TextScale;
use super::task_panel::{self, PanelDetail, task_panel};
use super::{DrawItem, HudColor, ScreenPoint};
use spandrel_model::math;
use spandrel_text::text;

/// Smallest font size that is legible in flight, px (estimate: capitals 6.5 px high; the font size in a picture 360 px
/// high is 9.7 px).
const MIN_FONT_SIZE_PX: f64 = 9.5;
/// Central fraction of the picture in which a defect must be to count.
const CENTRAL_FRACTION: f64 = 0.8;

/// Returns all HUD items for a picture with the given aspect ratio (width over height). Where larger text leaves no room for
/// everything, the most important items stay.
#[must_use]
pub fn layout(hud: &Hud, aspect: f64) -> Vec<DrawItem> {
    let mut items = crosshair(hud, Pane::of(aspect, TextScale::Normal));
    let pane = Pane::of(aspect, hud.style.text_scale);
    let blocks = contents(hud).map(|contents| blocks(hud, pane, contents)).find(|blocks| is_clear(blocks));
    items.extend(blocks.unwrap_or_else(|| essential_items(hud, (REFERENCE_HEIGHT_PX * aspect, REFERENCE_HEIGHT_PX))));
    items
}

/// Height of the picture in which the essential items are laid out if the picture's size is unknown, px.
const REFERENCE_HEIGHT_PX: f64 = 720.0;
/// Numbers of readouts, of which the largest that fits is shown: all, height and distance, none.
const READOUT_COUNTS: [usize; 3] = [usize::MAX, 2, 0];

/// Contents of the HUD besides speed, battery and warnings.
#[derive(Debug, Clone, Copy)]
struct Contents {
    panel: PanelDetail,
    readouts: usize,
    /// Whether mode, satellites and link are shown; otherwise only an alarm.
    status: bool,
    /// Whether the warnings stand below the panel instead of at its left.
    below_panel: bool,
    map: bool,
}

/// Returns the possible contents, the best first. With normal text, there is room for everything.
fn contents(hud: &Hud) -> impl Iterator<Item = Contents> {
    let details: &[PanelDetail] = if hud.guidance.is_some() || hud.lesson.is_some() {
        &[PanelDetail::Full, PanelDetail::Brief, PanelDetail::None]
    } else {
        &[PanelDetail::None]
    };
    let yes_no = [true, false];
    details.iter().flat_map(move |panel| {
        READOUT_COUNTS.into_iter().flat_map(move |readouts| {
            yes_no.into_iter().flat_map(move |status| {
                yes_no.into_iter().flat_map(move |map| {
                    let one = move |below_panel| Contents { panel: *panel, readouts, status, below_panel, map };
                    [false, true].map(one)
                })
            })
        })
    })
}

/// Returns the blocks, or nothing if there is no room for the warnings.
fn blocks(hud: &Hud, pane: Pane, contents: Contents) -> Vec<DrawItem> {
    let map_left = map::left(hud, pane).filter(|_| contents.map);
    let panel_left = task_panel::left(hud, pane).filter(|_| contents.panel != PanelDetail::None && !contents.below_panel);
    let limit = map_left.into_iter().chain(panel_left).reduce(f64::min);
    if limit.is_some_and(|limit| limit < MIN_RIGHT_EDGE) {
        return Vec::new();
    }
    let (readouts, bottom) = readouts(hud, pane, contents.readouts);
    let top = if hud.style.text_scale == TextScale::Normal { task_panel::TOP } else { bottom + BLOCK_GAP };
    let mut items = speed(hud, pane);
    items.extend(task_panel(hud, pane, (contents.panel, top)));
    items.extend(lesson_panel(hud, pane, (contents.panel, top)));
    items.extend(battery(hud, pane));
    items.extend(if contents.status { status(hud, pane) } else { alarm_line(hud, pane) });
    items.extend(readouts);
    items.extend(messages(hud, pane, limit));
    if contents.map {
        items.extend(map(hud, pane));
    }
    items
}

/// Returns whether there are blocks, all inside the picture, and none covers another.
fn is_clear(items: &[DrawItem]) -> bool {
    /// Tolerance for rounding errors.
    const TOLERANCE: f64 = 1e-9;
    let panels = items.iter().filter_map(|item| match item {
        DrawItem::Panel { from, to, .. } => Some((*from, *to)),
        DrawItem::Text { .. } | DrawItem::Fill { .. } | DrawItem::Line { .. } => None,
    });
    let panels: Vec<(ScreenPoint, ScreenPoint)> = panels.collect();
    let inside = |(from, to): &(ScreenPoint, ScreenPoint)| from.x.min(from.y) >= -TOLERANCE && to.x.max(to.y) <= 1.0 + TOLERANCE;
    let apart = |(from, to): &(ScreenPoint, ScreenPoint), (other_from, other_to): &(ScreenPoint, ScreenPoint)| {
        let gaps = [from.x - other_to.x, other_from.x - to.x, from.y - other_to.y, other_from.y - to.y];
        gaps.iter().any(|gap| *gap >= -TOLERANCE)
    };
    !panels.is_empty()
        && panels.iter().enumerate().all(|(k, one)| inside(one) && panels[..k].iter().all(|other| apart(one, other)))
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

/// Returns the first `count` values below the battery (height, distance from home, gimbal, time, lamp, pictures), and their
/// lower edge.
fn readouts(hud: &Hud, pane: Pane, count: usize) -> (Vec<DrawItem>, f64) {
    let (right, top) = (pane.width - EDGE_MARGIN, EDGE_MARGIN + battery::PANEL_HEIGHT + BLOCK_GAP);
    if count == 0 {
        return (Vec::new(), top - BLOCK_GAP);
    }
    let mut lines = readout_lines(hud);
    lines.truncate(count);
    let step = 0.037;
    let from = right - 0.225;
    let bottom = top + step * lines.len() as f64 + 0.012;
    let mut items = vec![pane.panel((from, top), (right, bottom))];
    for (k, Readout { name, value, color }) in lines.into_iter().enumerate() {
        let y = top + 0.006 + step * (k as f64 + 0.5);
        items.extend(pane.name_and_value((from + 0.012, right - 0.012), y, SMALL_FONT_SIZE, (name, value, color)));
    }
    (items, bottom)
}

/// A line below the battery.
struct Readout {
    name: String,
    value: String,
    color: HudColor,
}

fn readout_lines(hud: &Hud) -> Vec<Readout> {
    let (language, units) = (hud.style.language, hud.style.units);
    let white = |name: String, value: String| Readout { name, value, color: HudColor::White };
    let left = hud.remaining_s.max(0.0);
    let mut lines = vec![
        white(text!(language, "flight-readout-height"), units.length(hud.height_m, 1)),
        white(text!(language, "flight-readout-home"), units.length(hud.home_distance_m, 0)),
        white(text!(language, "flight-readout-gimbal"), format!("{:+.0}°", hud.gimbal_rad.to_degrees().round() + 0.0)),
        white(text!(language, "flight-readout-time-left"), format!("{}:{:02}", (left / 60.0).floor(), (left % 60.0).floor())),
        lamp_readout(hud),
        white(text!(language, "flight-readout-pictures"), hud.pictures.to_string()),
    ];
    if hud.zoom > 1.01 {
        lines.push(white(text!(language, "flight-readout-zoom"), format!("{:.1} x", hud.zoom)));
    }
    lines
}

fn lamp_readout(hud: &Hud) -> Readout {
    let language = hud.style.language;
    let (value, color) = if hud.lamp {
        (text!(language, "flight-readout-lamp-on"), HudColor::Yellow)
    } else {
        (text!(language, "flight-readout-lamp-off"), HudColor::White)
    };
    Readout { name: text!(language, "flight-readout-lamp"), value, color }
}
