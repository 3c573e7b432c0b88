//! A flight that stands still, one that is to end, and the button for both.

use super::menu::{self, MenuRow};
use super::pipe::Purpose;
use super::sheet::{PageLayout, PageWriter, SMALL, TITLE, width_of};
use super::{KeyPress, WindowFlow};
use crate::hud::{HudColor, TextAlign};

/// A practice's head: what it says, and what that means.
pub const STANDS: [&str; 2] = ["Paused", "Time stands still; it does not count."];
/// An assessment's.
pub const GOES_ON: [&str; 2] = ["End the assessment?", "Time goes on. Tasks that are not flown count as that."];

/// Over the flight, which is still seen.
pub fn page(mut pen: PageWriter, [head, means]: &[&str; 2], rows: &[MenuRow], focus: usize) -> PageLayout {
    let width = 0.95_f64.min(pen.width - 0.04);
    let left = 0.5 * (pen.width - width);
    pen.panel((left, 0.22), (width, 0.53), HudColor::Night);
    pen.text((left + 0.05, 0.30), TextAlign::Left, TITLE, HudColor::White, *head);
    pen.text((left + 0.05, 0.375), TextAlign::Left, SMALL, HudColor::Grey, *means);
    menu::draw(&mut pen, (left + 0.05, 0.42), width - 0.1, rows, focus);
    let help = "Up, down, Enter; or click.";
    pen.text((left + 0.05, 0.68), TextAlign::Left, SMALL, HudColor::Grey, help);
    pen.done()
}

/// A practice is paused by a click, too, and an assessment ended.
pub fn button(flow: &WindowFlow, mut pen: PageWriter) -> PageLayout {
    // In the inspector's view: the camera's has its display at all edges.
    let (across, down) = flow.arrangement.button();
    if let Some(flying) = &flow.flying {
        let words = match flying.choice.purpose {
            Purpose::Practice => flow.names.fill("Pause ({pause})"),
            Purpose::Assessment => flow.names.fill("End ({pause})"),
        };
        let (width, height) = (width_of(&words, SMALL) + 0.03, 0.045);
        let middle = pen.across(across);
        let (x, y) = (middle - 0.5 * width, down - 0.5 * height);
        pen.panel((x, y), (width, height), HudColor::Shade);
        pen.spot((x, y), (width, height), KeyPress::Escape);
        pen.text((middle, down), TextAlign::Middle, SMALL, HudColor::White, words);
    }
    pen.done()
}
