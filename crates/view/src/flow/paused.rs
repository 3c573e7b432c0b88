//! Pause page of a practice session, end confirmation of an assessment, and the button that opens them.

use super::menu::{self, MenuRow};
use super::pipe::Purpose;
use super::sheet::{PageLayout, PageWriter, SMALL_TEXT_SIZE, TITLE_SIZE, fitted, text_width};
use super::{KeyPress, WindowFlow};
use crate::arrange::WindowShape;
use crate::hud::{HudColor, TextAlign};
use spandrel_text::{Language, text};

/// Returns the title and the text of the pause page.
pub fn pause_text(language: Language) -> [String; 2] {
    [text!(language, "window-paused-title"), text!(language, "window-paused-text")]
}

/// Returns the title and the text of the end confirmation.
pub fn end_text(language: Language) -> [String; 2] {
    [text!(language, "window-paused-confirm-title"), text!(language, "window-paused-confirm-text")]
}

/// Draws the page over the flight, which stays visible.
pub fn page(mut pen: PageWriter, [head, means]: &[String; 2], rows: &[MenuRow], focus: usize) -> PageLayout {
    let width = 0.95_f64.min(pen.width - 0.04);
    let inside = (0.5 * (pen.width - width) + MARGIN, width - 2.0 * MARGIN);
    let mut draft = PageWriter::new(pen.window_aspect(), pen.style());
    let height = contents(&mut draft, (inside, 0.0), [head, means], (rows, focus));
    let top = (0.5 * (pen.height - height)).max(MARGIN);
    pen.panel((inside.0 - MARGIN, top - MARGIN), (width, height + 2.0 * MARGIN), HudColor::PageBackground);
    contents(&mut pen, (inside, top), [head, means], (rows, focus));
    pen.done()
}

/// Distance of the contents from the edge of the dialog.
const MARGIN: f64 = 0.045;

/// Writes the dialog's contents and returns the y position below them.
fn contents(
    pen: &mut PageWriter,
    ((left, width), top): ((f64, f64), f64),
    [head, means]: [&str; 2],
    (rows, focus): (&[MenuRow], usize),
) -> f64 {
    let language = pen.style().language;
    pen.title((left, top + 0.5 * TITLE_SIZE), width, head);
    let y = pen.lines((left, top + 0.11), width, SMALL_TEXT_SIZE, HudColor::Gray, means);
    let y = menu::draw(pen, (left, y + 0.01), width, rows, focus);
    pen.lines((left, y + 0.025), width, SMALL_TEXT_SIZE, HudColor::Gray, &text!(language, "window-help-dialog"))
}

/// Draws the button that pauses a practice session or ends an assessment.
pub fn button(flow: &WindowFlow, mut pen: PageWriter) -> PageLayout {
    // The button is in the inspector's view, because the HUD covers the edges of the camera view.
    let (across, down) = flow.arrangement.button(WindowShape { window: pen.window_aspect(), camera: flow.camera_aspect });
    if let Some(flying) = &flow.flying {
        let pause = flow.names.name("pause");
        let words = match flying.choice.purpose {
            Purpose::Practice => text!(flow.language(), "window-paused-pause-button", pause = pause),
            Purpose::Assessment => text!(flow.language(), "window-paused-end-button", pause = pause),
        };
        let (middle, down) = pen.from_window((across, down));
        // The inspector's view, in whose middle the button is, may be narrow.
        let size = fitted(&words, SMALL_TEXT_SIZE, 2.0 * (middle - pen.from_window((0.0, 0.0)).0) - 0.04);
        let (width, height) = (text_width(&words, size) + 0.03, 0.045);
        // Larger text must not leave the window at its upper edge.
        let down = down.max(0.5 * height + 0.008);
        let (x, y) = (middle - 0.5 * width, down - 0.5 * height);
        pen.panel((x, y), (width, height), HudColor::TextBackground);
        pen.click_area((x, y), (width, height), KeyPress::Escape);
        pen.text((middle, down), TextAlign::Center, size, HudColor::White, words);
    }
    pen.done()
}
