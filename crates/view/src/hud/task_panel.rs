//! The next step of the job, at the right between the readouts and the map: task, way, position relative to the path,
//! stand-off, time.

use super::metrics::{EDGE_MARGIN, SMALL_FONT_SIZE};
use super::pane::Pane;
use super::state::Hud;
use super::style::DisplayUnits;
use super::{DrawItem, HudColor, TextAlign};
use spandrel_mavlink::contract::guidance::{Guidance, GuidanceStep, PathDeviation, StandOffReading, WayTo};
use spandrel_model::math;
use spandrel_model::numbers::format_limit;

/// Top of the panel with normal text: just above the map, below the status text of the window.
pub(super) const TOP: f64 = 0.455;
/// Width of the panel, height of a line, and padding.
pub(super) const WIDTH: f64 = 0.42;
pub(super) const LINE_HEIGHT: f64 = 0.037;
pub(super) const PADDING: f64 = 0.012;
/// Width of the arrow's column, and the arrow's half length.
const ARROW_COLUMN: f64 = 0.045;
const ARROW_SIZE: f64 = 0.015;

/// How much of the panel is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PanelDetail {
    /// Everything.
    Full,
    /// The step and the way.
    Brief,
    /// Nothing.
    None,
}

/// Returns the left edge of the panel, or `None` without guidance.
pub(super) fn left(hud: &Hud, pane: Pane) -> Option<f64> {
    (hud.guidance.is_some() || hud.lesson.is_some()).then_some(pane.width - EDGE_MARGIN - WIDTH)
}

/// A line of the panel: a gray name at the left, and a value at the right.
struct PanelLine {
    name: String,
    color: HudColor,
    value: String,
}

/// Returns the panel with its upper edge at `top`; empty without guidance.
pub(super) fn task_panel(hud: &Hud, pane: Pane, (detail, top): (PanelDetail, f64)) -> Vec<DrawItem> {
    // A lesson has a panel of its own.
    let Some(guidance) = hud.guidance.as_ref().filter(|_| hud.lesson.is_none()) else { return Vec::new() };
    let lines = match detail {
        PanelDetail::Full => details(guidance, hud.style.units),
        PanelDetail::Brief => details(guidance, hud.style.units).into_iter().take(usize::from(guidance.way.is_some())).collect(),
        PanelDetail::None => return Vec::new(),
    };
    let rows = 1 + usize::from(guidance.way.is_some()) + lines.len();
    let (left, right) = (pane.width - EDGE_MARGIN - WIDTH, pane.width - EDGE_MARGIN);
    let middle = |row: usize| top + PADDING + LINE_HEIGHT * (row as f64 + 0.5);
    let mut items = vec![pane.panel((left, top), (right, top + 2.0 * PADDING + LINE_HEIGHT * rows as f64))];
    let (from, to) = (left + PADDING, right - PADDING);
    items.push(pane.text((from, middle(0)), TextAlign::Left, SMALL_FONT_SIZE, HudColor::White, title(guidance)));
    if let Some(progress) = guidance.progress {
        let words = format!("{:.0}%", (100.0 * progress).floor());
        items.push(pane.text((to, middle(0)), TextAlign::Right, SMALL_FONT_SIZE, HudColor::White, words));
    }
    let mut row = 1;
    if let Some(way) = &guidance.way {
        let words = WayTo { up_m: 0.0, ..*way };
        items.extend(way_items(&words, hud.style.units, pane, (from, middle(row))));
        row += 1;
    }
    for (k, PanelLine { name, color, value }) in lines.into_iter().enumerate() {
        items.push(pane.text((from, middle(row + k)), TextAlign::Left, SMALL_FONT_SIZE, HudColor::Gray, name));
        items.push(pane.text((to, middle(row + k)), TextAlign::Right, SMALL_FONT_SIZE, color, value));
    }
    items
}

fn title(guidance: &Guidance) -> String {
    let task = guidance.task.map_or_else(String::new, |task| format!(" task {task} of {}", guidance.tasks));
    match guidance.step {
        GuidanceStep::TakeOff => "Take off".to_owned(),
        GuidanceStep::FlyToTask => format!("Fly to{task}"),
        GuidanceStep::FollowPath => format!("Inspect{task}"),
        GuidanceStep::FlyHome => "Fly home".to_owned(),
        GuidanceStep::Land => "Land on the pad".to_owned(),
        GuidanceStep::Over => "Session over".to_owned(),
        GuidanceStep::HoldPosition => format!("Hold position:{task}"),
    }
}

/// Returns an arrow in the direction of a place, and the way in words. Unlike in a text message, there is a degree sign.
pub(super) fn way_items(way: &WayTo, units: DisplayUnits, pane: Pane, (left, middle): (f64, f64)) -> [DrawItem; 2] {
    let words = units.words(&way.words()).replace(" deg", "°");
    [
        pane.fill(&arrow((left + 0.5 * ARROW_COLUMN, middle), way.bearing_rad), HudColor::Yellow),
        pane.text((left + ARROW_COLUMN, middle), TextAlign::Left, SMALL_FONT_SIZE, HudColor::White, words),
    ]
}

fn details(guidance: &Guidance, units: DisplayUnits) -> Vec<PanelLine> {
    let white = |name: &str, value: String| PanelLine { name: name.to_owned(), color: HudColor::White, value };
    let mut lines = Vec::new();
    if let Some(way) = &guidance.way {
        lines.push(white("height", height_words(way.up_m, units)));
    }
    if let Some(deviation) = &guidance.deviation {
        lines.push(white("path", deviation_words(deviation, units)));
    }
    if let Some(reading) = &guidance.stand_off {
        let off = (reading.actual_m - reading.recommended_m).abs() > reading.tolerance_m;
        let color = if off { HudColor::Yellow } else { HudColor::White };
        lines.push(PanelLine { name: "stand-off".to_owned(), color, value: stand_off_words(reading, units) });
    }
    let minutes = |seconds: f64| {
        let whole = seconds.max(0.0).round();
        format!("{:.0}:{:02.0}", (whole / 60.0).floor(), whole % 60.0)
    };
    if guidance.flown_s > 0.0 {
        lines.push(white("time", format!("{} of {}", minutes(guidance.flown_s), minutes(guidance.needed_s))));
    }
    lines
}

/// Returns the height of the next place in words.
pub(super) fn height_words(up_m: f64, units: DisplayUnits) -> String {
    let meters = up_m.abs().round();
    match up_m {
        _ if meters < 1.0 => "level".to_owned(),
        down if down < 0.0 => format!("{} down", units.length(meters, 0)),
        _ => format!("{} up", units.length(meters, 0)),
    }
}

fn deviation_words(deviation: &PathDeviation, units: DisplayUnits) -> String {
    let side = if deviation.above_m < 0.0 { "below" } else { "above" };
    format!("{}, {} {side}", units.length(deviation.distance_m, 1), units.length(deviation.above_m.abs(), 1))
}

fn stand_off_words(reading: &StandOffReading, units: DisplayUnits) -> String {
    let limit = |length_m: f64| match units {
        DisplayUnits::Metric => format_limit(length_m),
        DisplayUnits::UsCustomary => units.length_number(length_m, 1),
    };
    let (recommended, tolerance) = (limit(reading.recommended_m), limit(reading.tolerance_m));
    format!("{} ({recommended} ± {tolerance})", units.length(reading.actual_m.max(0.0), 1))
}

/// Returns an arrowhead that points up for straight ahead.
fn arrow((x, y): (f64, f64), bearing_rad: f64) -> [(f64, f64); 3] {
    let (sin, cos) = math::sin_cos(bearing_rad);
    [(0.0, 1.0), (0.7, -0.8), (-0.7, -0.8)].map(|(right, ahead): (f64, f64)| {
        (x + ARROW_SIZE * (right * cos + ahead * sin), y - ARROW_SIZE * (ahead * cos - right * sin))
    })
}
