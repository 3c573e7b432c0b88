//! Paints the window's views, displays and texts.

use super::flight_view::SceneLoading;
use super::listener::TelemetryListener;
use super::panes::PaneContent;
use spandrel_view::arrange::TextAnchor;
use spandrel_view::flow::KeyNames;
use spandrel_view::gpu::paint;
use spandrel_view::hud::TextScale;

/// The window's texts.
#[derive(Default)]
pub struct WindowText {
    /// Status to show while the scene is not ready.
    pub waiting: String,
    /// Recent messages, shown for a few seconds.
    pub lines: Vec<String>,
    /// Key help.
    pub help: String,
}

/// Returns the status while the scene is not ready.
pub fn waiting(scene: &SceneLoading, heard: bool, listener: &TelemetryListener) -> String {
    match scene {
        SceneLoading::Ready(_) => String::new(),
        SceneLoading::Building(step, _) => {
            let (pct, what) = step.progress();
            format!("Loading {what} ... {pct}%")
        }
        SceneLoading::Waiting if heard => "Connected to the vehicle. Waiting for the session's seed ...".to_owned(),
        SceneLoading::Waiting => format!("Waiting for the vehicle at {} ...", listener.vehicle()),
    }
}

/// Help on all keys; `{binding}` stands for the name of a key.
const VIEW_HELP: &str = "{swap} views    {map} map    {path} path    drag or {look_left} {look_right} look around    wheel zoom    \
                         {follow} follow the drone";
const FLIGHT_HELP: &str = "{arm} arm    {take_off} take off    {up} {down} up and down    {turn_left} {turn_right} turn    {forward} \
                           {back} {left} {right} fly    {lamp} lamp    {snapshot} picture    {land} land\n{freeze} freeze    {rewind} rewind 10 s";
/// Help where larger text leaves no room for all keys.
const SHORT_HELP: &str = "{arm} arm    {take_off} take off    {pause} pause; see the keys there";
const SHORT_VIEW_HELP: &str = "{swap} views    {map} map    {follow} follow the drone";

/// Returns the key help.
pub fn help(names: &KeyNames, flies: bool, text_scale: TextScale) -> String {
    let words = match (text_scale, flies) {
        (TextScale::Normal, false) => VIEW_HELP.to_owned(),
        (TextScale::Normal, true) => format!("{VIEW_HELP}\n{FLIGHT_HELP}"),
        (TextScale::Larger | TextScale::Large | TextScale::Double, false) => SHORT_VIEW_HELP.to_owned(),
        (TextScale::Larger | TextScale::Large | TextScale::Double, true) => SHORT_HELP.to_owned(),
    };
    names.fill(&words)
}

/// Returns the text for a frozen flight: how to continue, if the window can fly the vehicle.
pub fn frozen(names: &KeyNames, flies: bool) -> String {
    if flies { names.fill("Frozen. {freeze}: continue    {rewind}: rewind 10 s") } else { "Frozen.".to_owned() }
}

/// Paints a flight: both views with their displays, and the window's texts.
pub fn paint_flight(ui: &mut egui::Ui, shown: &[PaneContent], text: &WindowText, (anchor, text_scale): (TextAnchor, TextScale)) {
    let area = ui.ctx().content_rect();
    let painter = ui.ctx().layer_painter(egui::LayerId::background());
    for view in shown {
        let at = |x: f64, y: f64| area.min + egui::vec2(x as f32 * area.width(), y as f32 * area.height());
        let view_rect = &view.view_rect;
        let rect = egui::Rect::from_min_max(
            at(view_rect.left, view_rect.top),
            at(view_rect.left + view_rect.width, view_rect.top + view_rect.height),
        );
        let whole = egui::Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
        if let Some(picture) = view.picture {
            painter.image(picture, rect, whole, egui::Color32::WHITE);
        }
        paint(&painter.with_clip_rect(rect), &view.items, rect);
        let edge = egui::Stroke::new(1.0, egui::Color32::from_gray(20));
        painter.rect_stroke(rect, 0.0, edge, egui::StrokeKind::Inside);
    }
    let size = FONT_SIZE * text_scale.factor() as f32 * area.height().max(MIN_FONT_HEIGHT_PX);
    if !text.waiting.is_empty() {
        let font = egui::FontId::proportional(1.2 * size);
        let galley = painter.layout(text.waiting.clone(), font, egui::Color32::from_gray(225), 0.9 * area.width());
        painter.galley(area.center() - 0.5 * galley.size(), galley, egui::Color32::WHITE);
    }
    let mut lines = text.lines.clone();
    if !text.help.is_empty() {
        lines.push(text.help.clone());
    }
    if !lines.is_empty() {
        paint_lines(&painter, area, &lines.join("\n"), (anchor, size));
    }
}

/// Font size relative to the window's height, and smallest height for it, px.
const FONT_SIZE: f32 = 0.03;
const MIN_FONT_HEIGHT_PX: f32 = 300.0;
/// Factor by which text shrinks until it fits, and smallest font size, px.
const SHRINK: f32 = 0.9;
const MIN_FONT_PX: f32 = 9.0;

/// Paints text at its anchor. Text that is too high shrinks.
fn paint_lines(painter: &egui::Painter, area: egui::Rect, words: &str, (anchor, size): (TextAnchor, f32)) {
    let room = egui::vec2(anchor.width as f32 * area.width(), anchor.height as f32 * area.height());
    let mut size = size;
    let galley = loop {
        let font = egui::FontId::proportional(0.75 * size);
        let galley = painter.layout(words.to_owned(), font, egui::Color32::from_gray(235), room.x - 1.2 * size);
        if galley.size().y + 0.6 * size <= room.y || SHRINK * size < MIN_FONT_PX {
            break galley;
        }
        size *= SHRINK;
    };
    let corner = area.min + egui::vec2(anchor.left_edge as f32 * area.width(), anchor.edge as f32 * area.height());
    let down = if anchor.extends_down { 0.6 * size } else { -0.6 * size - galley.size().y };
    let rect = egui::Rect::from_min_size(corner + egui::vec2(0.6 * size, down), galley.size());
    painter.rect_filled(rect.expand(0.3 * size), 0.2 * size, egui::Color32::from_black_alpha(160));
    painter.galley(rect.min, galley, egui::Color32::WHITE);
}
