//! Paints the window's views, displays and texts.

use super::flight_view::SceneLoading;
use super::listener::TelemetryListener;
use super::panes::PaneContent;
use spandrel_clients::rc::keyboard::KeyBindings;
use spandrel_view::arrange::TextAnchor;
use spandrel_view::gpu::paint;

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

/// Returns the key help.
pub fn help(keys: &KeyBindings, flies: bool) -> String {
    let key = |name: &str| keys.label(name);
    let mut words = format!(
        "{} views    {} map    {} path    drag or {} {} look around    wheel zoom    {} follow the drone",
        key("swap"),
        key("map"),
        key("path"),
        key("look_left"),
        key("look_right"),
        key("follow")
    );
    if flies {
        words.push_str(&format!(
            "\n{} arm    {} take off    {} {} up and down    {} {} turn    {} {} {} {} fly    {} lamp    {} picture    {} land\n{} freeze    {} rewind 10 s",
            key("arm"),
            key("take_off"),
            key("up"),
            key("down"),
            key("turn_left"),
            key("turn_right"),
            key("forward"),
            key("back"),
            key("left"),
            key("right"),
            key("lamp"),
            key("snapshot"),
            key("land"),
            key("freeze"),
            key("rewind")
        ));
    }
    words
}

/// Returns the text for a frozen flight: how to continue, if the window can fly the vehicle.
pub fn frozen(keys: &KeyBindings, flies: bool) -> String {
    if flies {
        format!("Frozen. {}: continue    {}: rewind 10 s", keys.label("freeze"), keys.label("rewind"))
    } else {
        "Frozen.".to_owned()
    }
}

/// Paints a flight: both views with their displays, and the window's texts.
pub fn paint_flight(ui: &mut egui::Ui, shown: &[PaneContent], text: &WindowText, anchor: TextAnchor) {
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
    let size = 0.03 * area.height().max(300.0);
    if !text.waiting.is_empty() {
        let font = egui::FontId::proportional(1.2 * size);
        painter.text(area.center(), egui::Align2::CENTER_CENTER, &text.waiting, font, egui::Color32::from_gray(225));
    }
    let mut lines = text.lines.clone();
    if !text.help.is_empty() {
        lines.push(text.help.clone());
    }
    if !lines.is_empty() {
        let font = egui::FontId::proportional(0.75 * size);
        let corner = area.min + egui::vec2(anchor.left_edge as f32 * area.width(), anchor.edge as f32 * area.height());
        let room = anchor.width as f32 * area.width() - 1.2 * size;
        let galley = painter.layout(lines.join("\n"), font, egui::Color32::from_gray(235), room);
        let down = if anchor.extends_down { 0.6 * size } else { -0.6 * size - galley.size().y };
        let rect = egui::Rect::from_min_size(corner + egui::vec2(0.6 * size, down), galley.size());
        painter.rect_filled(rect.expand(0.3 * size), 0.2 * size, egui::Color32::from_black_alpha(160));
        painter.galley(rect.min, galley, egui::Color32::WHITE);
    }
}
