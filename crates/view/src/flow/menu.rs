//! Menu rows for choosing, typing and starting actions, with keys or clicks.

use super::KeyPress;
use super::sheet::{PageWriter, SMALL, TEXT, width_of};
use crate::hud::{HudColor, TextAlign};

/// Height of a row, and distance between rows.
const HIGH: f64 = 0.06;
pub const STEP: f64 = 0.07;

/// Action of a menu row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MenuAction {
    /// Select the trainee.
    Trainee,
    /// Select the job.
    Scenario,
    /// Select practice or assessment.
    Purpose,
    /// Continue to the controller check.
    Check,
    /// Open the tutorial.
    Learn,
    /// Toggle sound.
    Sound,
    /// Quit.
    Quit,
    /// Search for a controller.
    Look,
    /// Calibrate the controller.
    Calibrate,
    /// Select the stick mode.
    Mode,
    /// Set the dead band.
    DeadBand,
    /// Set the expo.
    Expo,
    /// Start the flight.
    Fly,
    /// Return to the running flight.
    Stay,
    /// Return to the previous page.
    Back,
    /// Go to the next page.
    Next,
    /// Skip the tutorial.
    Skip,
    /// Confirm a wizard step.
    Confirm,
    /// Cancel the wizard.
    Cancel,
    /// Resume the flight.
    Resume,
    /// Restart the attempt.
    Restart,
    /// End the session.
    End,
    /// Fly the same job again.
    Again,
    /// Choose another job.
    Other,
    /// Open the report.
    Report,
    /// Open the questionnaire.
    Questions,
}

/// Interaction of a menu row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowKind {
    /// Activated with Enter or a click.
    Button,
    /// The left and right keys change the value.
    Choice,
    /// Typing changes the value; the left and right keys select a known one.
    Typed,
}

/// A menu row.
#[derive(Debug, Clone, PartialEq)]
pub struct MenuRow {
    /// Action of the row.
    pub deed: MenuAction,
    /// Interaction of the row.
    pub kind: RowKind,
    /// Label.
    pub label: String,
    /// Current value.
    pub value: String,
}

impl MenuRow {
    /// Creates a button.
    pub fn button(deed: MenuAction, label: impl Into<String>) -> Self {
        Self { deed, kind: RowKind::Button, label: label.into(), value: String::new() }
    }

    /// Creates a row with a choice of values.
    pub fn choice(deed: MenuAction, label: &str, value: impl Into<String>) -> Self {
        Self { deed, kind: RowKind::Choice, label: label.to_owned(), value: value.into() }
    }

    /// Creates a row with a text value.
    pub fn typed_row(deed: MenuAction, label: &str, value: impl Into<String>) -> Self {
        Self { kind: RowKind::Typed, ..Self::choice(deed, label, value) }
    }
}

/// Draws the rows below one another and returns the y position below the last.
pub fn draw(pen: &mut PageWriter, (x, y): (f64, f64), width: f64, rows: &[MenuRow], focus: usize) -> f64 {
    for (k, row) in rows.iter().enumerate() {
        one(pen, (x, y + STEP * k as f64), width, row, (k, k == focus));
    }
    y + STEP * rows.len() as f64
}

fn one(pen: &mut PageWriter, (x, y): (f64, f64), width: f64, row: &MenuRow, (k, lit): (usize, bool)) {
    let middle = y + 0.5 * HIGH;
    pen.panel((x, y), (width, HIGH), if lit { HudColor::Focus } else { HudColor::Card });
    pen.spot((x, y), (width, HIGH), KeyPress::Row(k));
    if lit {
        // A bar at the edge marks the focus in addition to the color.
        pen.panel((x - 0.014, y), (0.008, HIGH), HudColor::White);
    }
    let label = if row.kind == RowKind::Button { HudColor::White } else { HudColor::Grey };
    pen.text((x + 0.02, middle), TextAlign::Left, TEXT, label, row.label.clone());
    if row.kind == RowKind::Button {
        return;
    }
    let (from, to) = (x + VALUE * width, x + width);
    let words = if row.kind == RowKind::Typed && lit { format!("{}_", row.value) } else { row.value.clone() };
    let room = to - from - 2.0 * ARROW;
    let height = TEXT.min(TEXT * room / width_of(&words, TEXT).max(1e-9)).max(0.6 * SMALL);
    pen.text((0.5 * (from + to), middle), TextAlign::Middle, height, HudColor::White, words);
    for (edge, way, on) in [(from, -1.0, false), (to - ARROW, 1.0, true)] {
        let tip = edge + 0.5 * ARROW + way * 0.011;
        let base = edge + 0.5 * ARROW - way * 0.011;
        pen.fill(&[(tip, middle), (base, middle - 0.014), (base, middle + 0.014)], HudColor::White);
        pen.spot((edge, y), (ARROW, HIGH), KeyPress::Step(k, on));
    }
}

/// Start of the value as a fraction of the row's width, and width of its arrows.
const VALUE: f64 = 0.3;
const ARROW: f64 = 0.06;
