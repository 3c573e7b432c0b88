//! A flight that stands still, and the button that stops it.

use super::menu::{self, Row};
use super::pipe::Purpose;
use super::sheet::{Pen, SMALL, Sheet, TITLE};
use super::{Flow, Press};
use crate::view::hud::{Colour, Side};

/// Over the flight, which is still seen.
pub fn page(mut pen: Pen, rows: &[Row], focus: usize) -> Sheet {
    let width = 0.95_f64.min(pen.width - 0.04);
    let left = 0.5 * (pen.width - width);
    pen.panel((left, 0.22), (width, 0.53), Colour::Night);
    pen.text((left + 0.05, 0.30), Side::Left, TITLE, Colour::White, "Paused");
    pen.text((left + 0.05, 0.375), Side::Left, SMALL, Colour::Grey, "Time stands still; it does not count.");
    menu::draw(&mut pen, (left + 0.05, 0.42), width - 0.1, rows, focus);
    let help = "Up, down, Enter; or click.";
    pen.text((left + 0.05, 0.68), Side::Left, SMALL, Colour::Grey, help);
    pen.done()
}

/// A practice can be paused by a click, too.
pub fn button(flow: &Flow, mut pen: Pen) -> Sheet {
    let middle = 0.5 * pen.width;
    if flow.flying.as_ref().is_some_and(|flying| flying.choice.purpose == Purpose::Practice) {
        let (x, y) = (middle - 0.09, 0.945);
        pen.panel((x, y), (0.18, 0.045), Colour::Shade);
        pen.spot((x, y), (0.18, 0.045), Press::Escape);
        pen.text((middle, y + 0.0225), Side::Middle, SMALL, Colour::White, "Pause (Esc)");
    }
    pen.done()
}
