//! Pause page of a practice session, end confirmation of an assessment, and the button that opens them.

use super::menu::{self, MenuRow};
use super::pipe::Purpose;
use super::sheet::{PageLayout, PageWriter, SMALL_TEXT_SIZE, TITLE_SIZE, text_width};
use super::{KeyPress, WindowFlow};
use crate::arrange::WindowShape;
use crate::hud::{HudColor, TextAlign};

/// Title and text of the pause page.
pub const PAUSE_TEXT: [&str; 2] = ["Paused", "The clock is stopped."];
/// Title and text of the end confirmation.
pub const END_TEXT: [&str; 2] = ["End the assessment?", "The clock is running. Tasks you don't fly count as not attempted."];

/// Draws the page over the flight, which stays visible.
pub fn page(mut pen: PageWriter, [head, means]: &[&str; 2], rows: &[MenuRow], focus: usize) -> PageLayout {
    let width = 0.95_f64.min(pen.width - 0.04);
    let left = 0.5 * (pen.width - width);
    pen.panel((left, 0.22), (width, 0.53), HudColor::PageBackground);
    pen.text((left + 0.05, 0.30), TextAlign::Left, TITLE_SIZE, HudColor::White, *head);
    pen.text((left + 0.05, 0.375), TextAlign::Left, SMALL_TEXT_SIZE, HudColor::Gray, *means);
    menu::draw(&mut pen, (left + 0.05, 0.42), width - 0.1, rows, focus);
    let help = "Up/down select, Enter confirm; or click.";
    pen.text((left + 0.05, 0.68), TextAlign::Left, SMALL_TEXT_SIZE, HudColor::Gray, help);
    pen.done()
}

/// Draws the button that pauses a practice session or ends an assessment.
pub fn button(flow: &WindowFlow, mut pen: PageWriter) -> PageLayout {
    // The button is in the inspector's view, because the HUD covers the edges of the camera view.
    let (across, down) = flow.arrangement.button(WindowShape { window: pen.width, camera: flow.camera_aspect });
    if let Some(flying) = &flow.flying {
        let words = match flying.choice.purpose {
            Purpose::Practice => flow.names.fill("Pause ({pause})"),
            Purpose::Assessment => flow.names.fill("End ({pause})"),
        };
        let (width, height) = (text_width(&words, SMALL_TEXT_SIZE) + 0.03, 0.045);
        let middle = pen.across(across);
        let (x, y) = (middle - 0.5 * width, down - 0.5 * height);
        pen.panel((x, y), (width, height), HudColor::TextBackground);
        pen.click_area((x, y), (width, height), KeyPress::Escape);
        pen.text((middle, down), TextAlign::Center, SMALL_TEXT_SIZE, HudColor::White, words);
    }
    pen.done()
}
