//! Paints the window's views, displays and texts.

use super::flight_view::SceneLoading;
use super::listener::TelemetryListener;
use super::panes::PaneContent;
use spandrel_model::site::inspector_path::InspectorPosition;
use spandrel_text::{Language, MessageId, message_id, text};
use spandrel_view::arrange::TextAnchor;
use spandrel_view::flow::KeyNames;
use spandrel_view::gpu::paint;
use spandrel_view::hud::{DisplayStyle, TextScale};

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
pub fn waiting(scene: &SceneLoading, heard: bool, listener: &TelemetryListener, language: Language) -> String {
    match scene {
        SceneLoading::Ready(_) => String::new(),
        SceneLoading::Building(step, _) => step.words(language),
        SceneLoading::Waiting if heard => text!(language, "window-flight-waiting-seed"),
        SceneLoading::Waiting => {
            text!(language, "window-flight-waiting-vehicle", address = listener.vehicle().to_string())
        }
    }
}

/// Returns the key help. Where larger text leaves no room for all keys, there are only the most important ones.
pub fn help(names: &KeyNames, flies: bool, style: DisplayStyle) -> String {
    let fill = |id| names.fill(style.language, id);
    match (style.text_scale, flies) {
        (TextScale::Normal, false) => fill(VIEW_KEYS),
        (TextScale::Normal, true) => format!("{}\n{}", fill(VIEW_KEYS), fill(message_id!("window-flight-keys-flight"))),
        (TextScale::Larger | TextScale::Large | TextScale::Double, false) => fill(message_id!("window-flight-keys-short-view")),
        (TextScale::Larger | TextScale::Large | TextScale::Double, true) => fill(message_id!("window-flight-keys-short")),
    }
}

/// Keys of the views.
const VIEW_KEYS: MessageId = message_id!("window-flight-keys-view");

/// Returns the text for a frozen flight: how to continue, if the window can fly the vehicle.
pub fn frozen(names: &KeyNames, flies: bool, language: Language) -> String {
    if flies { names.fill(language, message_id!("window-flight-frozen-keys")) } else { text!(language, "window-flight-frozen") }
}

/// Returns where the inspector walks and for how long; `None` while the inspector stands.
pub fn walk(inspector: &InspectorPosition, language: Language) -> Option<String> {
    let seconds = format!("{:.0}", inspector.remaining_s.ceil());
    inspector.walks().then(|| text!(language, "window-flight-walk", place = inspector.place, seconds = seconds))
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
        if let Some(picture) = &view.picture {
            painter.add(picture.shape(rect));
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

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_clients::rc::keyboard::KeyBindings;
    use spandrel_mavlink::contract::lesson::LessonTask;
    use spandrel_model::frames::Vec3;
    use spandrel_view::flow::{ControlNames, ControllerStatus};
    use spandrel_view::hud::lesson_words::how_to;

    #[test]
    fn exact_every_key_in_the_help_is_bound() {
        let keys = KeyBindings::default();
        for language in Language::ALL {
            let label = |(binding, _): (&'static str, String)| (binding, keys.label(binding, language));
            let names = KeyNames::new(KeyBindings::functions(language).map(label).collect());
            let pad = ControllerStatus { calibrated: true, ..ControllerStatus::default() };
            let mut texts: Vec<String> = [ControllerStatus::default(), pad]
                .iter()
                .flat_map(|controller| {
                    LessonTask::ALL.map(|task| how_to(task, language, &ControlNames::new(&names, controller, language)))
                })
                .collect();
            for (text_scale, flies) in TextScale::ALL.into_iter().flat_map(|scale| [(scale, false), (scale, true)]) {
                texts.push(help(&names, flies, DisplayStyle { language, text_scale, ..DisplayStyle::default() }));
                texts.push(frozen(&names, flies, language));
            }
            for page in ["tutorial-views-text", "tutorial-defects-text", "tutorial-light-text", "tutorial-light-keys"] {
                texts.push(names.fill(language, MessageId::new(page)));
            }
            // A binding that does not exist is in braces.
            assert!(texts.iter().all(|text| !text.contains('{')), "{texts:?}");
        }
    }

    #[test]
    fn exact_walk_is_shown_until_the_arrival() {
        let standing = InspectorPosition {
            feet_m: Vec3::zero(),
            forward: Vec3::new(1.0, 0.0, 0.0),
            velocity_m_s: Vec3::zero(),
            place: 2,
            remaining_s: 0.0,
        };
        let walking = InspectorPosition { remaining_s: 34.2, ..standing };
        assert_eq!(walk(&walking, Language::English).as_deref(), Some("Inspector: walking to place 2, 35 s"));
        assert!(walk(&walking, Language::German).is_some_and(|words| words.contains("Standort 2")));
        assert_eq!(walk(&standing, Language::English), None);
    }
}
