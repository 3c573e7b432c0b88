//! A flight that stands still, one that is to end, and the button for both.

use super::menu::{self, Row};
use super::pipe::Purpose;
use super::sheet::{Pen, SMALL, Sheet, TITLE, width_of};
use super::{Flow, Press};
use crate::hud::{Colour, Side};

/// A practice's head: what it says, and what that means.
pub const STANDS: [&str; 2] = ["Paused", "Time stands still; it does not count."];
/// An assessment's.
pub const GOES_ON: [&str; 2] = ["End the assessment?", "Time goes on. Tasks that are not flown count as that."];

/// Over the flight, which is still seen.
pub fn page(mut pen: Pen, [head, means]: &[&str; 2], rows: &[Row], focus: usize) -> Sheet {
    let width = 0.95_f64.min(pen.width - 0.04);
    let left = 0.5 * (pen.width - width);
    pen.panel((left, 0.22), (width, 0.53), Colour::Night);
    pen.text((left + 0.05, 0.30), Side::Left, TITLE, Colour::White, *head);
    pen.text((left + 0.05, 0.375), Side::Left, SMALL, Colour::Grey, *means);
    menu::draw(&mut pen, (left + 0.05, 0.42), width - 0.1, rows, focus);
    let help = "Up, down, Enter; or click.";
    pen.text((left + 0.05, 0.68), Side::Left, SMALL, Colour::Grey, help);
    pen.done()
}

/// A practice is paused by a click, too, and an assessment ended.
pub fn button(flow: &Flow, mut pen: Pen) -> Sheet {
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
        pen.panel((x, y), (width, height), Colour::Shade);
        pen.spot((x, y), (width, height), Press::Escape);
        pen.text((middle, down), Side::Middle, SMALL, Colour::White, words);
    }
    pen.done()
}
