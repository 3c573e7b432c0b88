//! The next step of the job, at the right between the readouts and the map: task, way, position relative to the path,
//! stand-off, time.

use super::metrics::{EDGE_MARGIN, SMALL_FONT_SIZE};
use super::pane::Pane;
use super::state::Hud;
use super::style::{DisplayStyle, DisplayUnits};
use super::text_metrics::{fitted, text_width, wrap_text};
use super::{DrawItem, HudColor, TextAlign};
use spandrel_mavlink::contract::guidance::{DetourKind, Guidance, GuidanceStep, PathDeviation, StandOffReading, TurnTo, WayTo};
use spandrel_model::math;
use spandrel_text::terms::capitalized;
use spandrel_text::{Language, text};

/// Top of the panel with normal text: just above the map, below the status text of the window.
pub(super) const TOP: f64 = 0.455;
/// Width of the panel, height of a line, and padding.
pub(super) const WIDTH: f64 = 0.42;
pub(super) const LINE_HEIGHT: f64 = 0.037;
pub(super) const PADDING: f64 = 0.012;
/// Number of lines for which there is room above the map.
const MAX_ROWS: usize = 6;
/// Largest number of lines for how a step is done.
const MAX_HOW_LINES: usize = 3;
/// Width of the arrow's column, and the arrow's half length.
const ARROW_COLUMN: f64 = 0.045;
const ARROW_SIZE: f64 = 0.015;

/// Between two items of a line.
pub(super) const SEPARATOR: &str = "  ·  ";

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
    let (way, first) = (guidance.first_way(), guidance.detour.map(|detour| first_words(detour.kind, hud.style.language)));
    let lines = match detail {
        PanelDetail::Full => details(guidance, hud.style),
        PanelDetail::Brief if first.is_some() => Vec::new(),
        PanelDetail::Brief => details(guidance, hud.style).into_iter().take(usize::from(way.is_some())).collect(),
        PanelDetail::None => return Vec::new(),
    };
    let how = if detail == PanelDetail::Full { how_lines(&hud.guidance_how) } else { Vec::new() };
    let rows = 1 + how.len() + usize::from(first.is_some()) + usize::from(way.is_some()) + lines.len();
    let name = guidance.task.and_then(|task| hud.tasks.title(task, hud.style.language));
    let name = name.filter(|_| detail == PanelDetail::Full && rows < MAX_ROWS);
    let rows = rows + usize::from(name.is_some());
    let (left, right) = (pane.width - EDGE_MARGIN - WIDTH, pane.width - EDGE_MARGIN);
    let middle = |row: usize| top + PADDING + LINE_HEIGHT * (row as f64 + 0.5);
    let mut items = vec![pane.panel((left, top), (right, top + 2.0 * PADDING + LINE_HEIGHT * rows as f64))];
    let (from, to) = (left + PADDING, right - PADDING);
    let progress = guidance.progress.map(|progress| format!("{:.0}%", (100.0 * progress).floor())).unwrap_or_default();
    let title = title(guidance, hud.style.language);
    let room = to - from - text_width(&format!("{progress} "), SMALL_FONT_SIZE);
    let size = fitted(&title, SMALL_FONT_SIZE, room);
    let color = if guidance.is_return() { HudColor::Yellow } else { HudColor::White };
    items.push(pane.text((from, middle(0)), TextAlign::Left, size, color, title));
    if !progress.is_empty() {
        items.push(pane.text((to, middle(0)), TextAlign::Right, SMALL_FONT_SIZE, HudColor::White, progress));
    }
    let mut row = 1;
    for words in how {
        items.push(pane.text((from, middle(row)), TextAlign::Left, SMALL_FONT_SIZE, HudColor::Gray, words));
        row += 1;
    }
    if let Some(name) = name {
        let size = fitted(&name, SMALL_FONT_SIZE, to - from);
        items.push(pane.text((from, middle(row)), TextAlign::Left, size, HudColor::Gray, name));
        row += 1;
    }
    if let Some(first) = first {
        let size = fitted(&first, SMALL_FONT_SIZE, to - from);
        items.push(pane.text((from, middle(row)), TextAlign::Left, size, HudColor::Yellow, first));
        row += 1;
    }
    if let Some(way) = &way {
        items.extend(way_items(way, hud.style, pane, (from, to, middle(row))));
        row += 1;
    }
    for (k, PanelLine { name, color, value }) in lines.into_iter().enumerate() {
        items.extend(pane.name_and_value((from, to), middle(row + k), SMALL_FONT_SIZE, (name, value, color)));
    }
    items
}

/// Returns how the step is done, in lines that fit into the panel.
fn how_lines(how: &str) -> Vec<String> {
    let fits = |line: &str| text_width(line, SMALL_FONT_SIZE) <= WIDTH - 2.0 * PADDING;
    if how.is_empty() { Vec::new() } else { wrap_text(how, MAX_HOW_LINES, fits) }
}

fn title(guidance: &Guidance, language: Language) -> String {
    let tasks = guidance.tasks;
    match (guidance.step, guidance.task) {
        (GuidanceStep::TakeOff, _) => text!(language, "flight-step-take-off"),
        (GuidanceStep::FlyToTask, Some(task)) if guidance.is_return() => {
            text!(language, "flight-step-return-to-task", task = task, tasks = tasks)
        }
        (GuidanceStep::FlyToTask, Some(task)) => text!(language, "flight-step-fly-to-task", task = task, tasks = tasks),
        (GuidanceStep::FlyToTask, None) => text!(language, "flight-step-fly-to"),
        (GuidanceStep::FollowPath, Some(task)) => text!(language, "flight-step-inspect-task", task = task, tasks = tasks),
        (GuidanceStep::FollowPath, None) => text!(language, "flight-step-inspect"),
        (GuidanceStep::FlyHome, _) => text!(language, "flight-step-fly-home"),
        (GuidanceStep::Land, _) => text!(language, "flight-step-land"),
        (GuidanceStep::Over, _) => text!(language, "flight-step-over"),
        (GuidanceStep::HoldPosition, Some(task)) => text!(language, "flight-step-hold-task", task = task, tasks = tasks),
        (GuidanceStep::HoldPosition, None) => text!(language, "flight-step-hold"),
    }
}

/// Returns the next step, and below it the way or the position on the path, as two lines; `None` without guidance.
pub(super) fn step_lines(hud: &Hud) -> Option<[(String, HudColor); 2]> {
    let (guidance, style) = (hud.guidance.as_ref()?, hud.style);
    let progress = guidance.progress.map(|progress| format!("{:.0}%", (100.0 * progress).floor()));
    let name = guidance.task.and_then(|task| hud.tasks.title(task, style.language));
    let step: Vec<String> = [title(guidance, style.language)].into_iter().chain(name).chain(progress).collect();
    let first = guidance.detour.map(|detour| first_words(detour.kind, style.language));
    let color = if first.is_some() { HudColor::Yellow } else { HudColor::White };
    let way = guidance.first_way().map(|way| way_words(&way, style));
    let rest = details(guidance, style).into_iter().map(|PanelLine { name, value, .. }| format!("{name}: {value}"));
    let how = Some(hud.guidance_how.clone()).filter(|how| !how.is_empty());
    let details: Vec<String> = how.into_iter().chain(first).chain(way).chain(rest).collect();
    let step_color = if guidance.is_return() { HudColor::Yellow } else { HudColor::White };
    Some([(step.join(SEPARATOR), step_color), (details.join(SEPARATOR), color)])
}

/// Returns the first maneuver if the straight way is blocked.
fn first_words(kind: DetourKind, language: Language) -> String {
    capitalized(&match kind {
        DetourKind::OutFromUnder => text!(language, "flight-detour-out-from-under"),
        DetourKind::Climb => text!(language, "flight-detour-climb"),
        DetourKind::Descend => text!(language, "flight-detour-descend"),
        DetourKind::Around => text!(language, "flight-detour-around"),
    })
}

/// Returns an arrow in the direction of a place, and the way in words.
pub(super) fn way_items(way: &WayTo, style: DisplayStyle, pane: Pane, (left, right, middle): (f64, f64, f64)) -> [DrawItem; 2] {
    let (words, from) = (way_words(way, style), left + ARROW_COLUMN);
    let size = fitted(&words, SMALL_FONT_SIZE, right - from);
    [
        pane.fill(&arrow((left + 0.5 * ARROW_COLUMN, middle), way.bearing_rad), HudColor::Yellow),
        pane.text((from, middle), TextAlign::Left, size, HudColor::White, words),
    ]
}

/// Returns the horizontal way in words.
pub(super) fn way_words(way: &WayTo, style: DisplayStyle) -> String {
    let (language, distance) = (style.language, style.units.length(way.distance_m.round(), 0));
    let angle = |turn_deg: f64| format!("{turn_deg:.0}°");
    match way.turn() {
        TurnTo::Ahead => text!(language, "flight-way-ahead", distance = distance),
        TurnTo::Behind => text!(language, "flight-way-behind", distance = distance),
        TurnTo::Left(turn_deg) => text!(language, "flight-way-left", distance = distance, angle = angle(turn_deg)),
        TurnTo::Right(turn_deg) => text!(language, "flight-way-right", distance = distance, angle = angle(turn_deg)),
    }
}

fn details(guidance: &Guidance, style: DisplayStyle) -> Vec<PanelLine> {
    let language = style.language;
    let white = |name: String, value: String| PanelLine { name, color: HudColor::White, value };
    let mut lines = Vec::new();
    if let Some(way) = guidance.first_way() {
        lines.push(white(text!(language, "flight-panel-height"), height_words(way.up_m, style)));
    }
    // On the way around an obstacle, the path and the surface do not matter yet.
    let on_straight_way = guidance.detour.is_none();
    if let Some(deviation) = guidance.deviation.as_ref().filter(|_| on_straight_way) {
        lines.push(white(text!(language, "flight-panel-path"), deviation_words(deviation, style)));
    }
    if let Some(reading) = guidance.stand_off.as_ref().filter(|_| on_straight_way) {
        let off = (reading.actual_m - reading.recommended_m).abs() > reading.tolerance_m;
        let color = if off { HudColor::Yellow } else { HudColor::White };
        let name = text!(language, "flight-panel-stand-off");
        lines.push(PanelLine { name, color, value: stand_off_words(reading, style.units) });
    }
    let minutes = |seconds: f64| {
        let whole = seconds.max(0.0).round();
        format!("{:.0}:{:02.0}", (whole / 60.0).floor(), whole % 60.0)
    };
    if guidance.flown_s > 0.0 {
        let (flown, needed) = (minutes(guidance.flown_s), minutes(guidance.needed_s));
        let value = text!(language, "flight-panel-time-of", flown = flown, needed = needed);
        lines.push(white(text!(language, "flight-panel-time"), value));
    }
    lines
}

/// Returns the height of the next place in words.
pub(super) fn height_words(up_m: f64, style: DisplayStyle) -> String {
    let (language, meters) = (style.language, up_m.abs().round());
    let height = style.units.length(meters, 0);
    match up_m {
        _ if meters < 1.0 => text!(language, "flight-height-level"),
        down if down < 0.0 => text!(language, "flight-height-down", height = height),
        _ => text!(language, "flight-height-up", height = height),
    }
}

fn deviation_words(deviation: &PathDeviation, style: DisplayStyle) -> String {
    let (language, units) = (style.language, style.units);
    let (distance, height) = (units.length(deviation.distance_m, 1), units.length(deviation.above_m.abs(), 1));
    if deviation.above_m < 0.0 {
        text!(language, "flight-deviation-below", distance = distance, height = height)
    } else {
        text!(language, "flight-deviation-above", distance = distance, height = height)
    }
}

fn stand_off_words(reading: &StandOffReading, units: DisplayUnits) -> String {
    let lengths_m = [reading.actual_m.max(0.0), reading.recommended_m, reading.tolerance_m];
    let [actual, recommended, tolerance] = units.length_numbers(lengths_m, 1);
    format!("{actual} {} ({recommended} ± {tolerance})", units.length_symbol())
}

/// Returns an arrowhead that points up for straight ahead.
fn arrow((x, y): (f64, f64), bearing_rad: f64) -> [(f64, f64); 3] {
    let (sin, cos) = math::sin_cos(bearing_rad);
    [(0.0, 1.0), (0.7, -0.8), (-0.7, -0.8)].map(|(right, ahead): (f64, f64)| {
        (x + ARROW_SIZE * (right * cos + ahead * sin), y - ARROW_SIZE * (ahead * cos - right * sin))
    })
}
