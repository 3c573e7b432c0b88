//! Menu rows: buttons, choices, and text fields, operated with keys or clicks.

use super::KeyPress;
use super::sheet::{PageWriter, SMALL_TEXT_SIZE, TEXT_SIZE, text_width};
use crate::hud::{HudColor, TextAlign};

/// Row height and row spacing.
const ROW_HEIGHT: f64 = 0.06;
pub const ROW_SPACING: f64 = 0.07;

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
    CheckController,
    /// Open the tutorial.
    OpenTutorial,
    /// Start a round of the defect school.
    School,
    /// Give the answer with this number in the defect school.
    Answer(usize),
    /// Continue in the defect school.
    ContinueSchool,
    /// Leave the defect school.
    LeaveSchool,
    /// Turn sound on or off.
    Sound,
    /// Quit the program.
    Quit,
    /// Search for a controller.
    FindController,
    /// Calibrate the controller.
    Calibrate,
    /// Select the stick mode.
    Mode,
    /// Set the dead band.
    DeadBand,
    /// Set the expo.
    Expo,
    /// Continue to the flight.
    Fly,
    /// Acknowledge the briefing and start the flight.
    Acknowledge,
    /// Return to the running flight.
    KeepFlying,
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
    FlyAgain,
    /// Watch the synthetic expert fly the job.
    WatchExpert,
    /// Fly the recommended job.
    FlyNext,
    /// Choose another job.
    ChooseOther,
    /// Open the report.
    Report,
    /// Open the questionnaire.
    OpenQuestionnaire,
}

/// Interaction of a menu row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowKind {
    /// Activated with Enter or a click.
    Button,
    /// The left and right keys change the value.
    Choice,
    /// Typing changes the value; the left and right keys select a known value.
    TextField,
}

/// A menu row.
#[derive(Debug, Clone, PartialEq)]
pub struct MenuRow {
    /// Action of the row.
    pub action: MenuAction,
    /// Interaction of the row.
    pub kind: RowKind,
    /// Label of the row.
    pub label: String,
    /// Current value; empty for a button.
    pub value: String,
}

impl MenuRow {
    /// Creates a button.
    pub fn button(action: MenuAction, label: impl Into<String>) -> Self {
        Self { action, kind: RowKind::Button, label: label.into(), value: String::new() }
    }

    /// Creates a row with a choice of values.
    pub fn choice(action: MenuAction, label: &str, value: impl Into<String>) -> Self {
        Self { action, kind: RowKind::Choice, label: label.to_owned(), value: value.into() }
    }

    /// Creates a row with a text value.
    pub fn text_field(action: MenuAction, label: &str, value: impl Into<String>) -> Self {
        Self { kind: RowKind::TextField, ..Self::choice(action, label, value) }
    }
}

/// Draws the rows from top to bottom and returns the y position below the last one.
pub fn draw(pen: &mut PageWriter, (x, y): (f64, f64), width: f64, rows: &[MenuRow], focus: usize) -> f64 {
    for (k, row) in rows.iter().enumerate() {
        draw_row(pen, (x, y + ROW_SPACING * k as f64), width, row, (k, k == focus));
    }
    y + ROW_SPACING * rows.len() as f64
}

fn draw_row(pen: &mut PageWriter, (x, y): (f64, f64), width: f64, row: &MenuRow, (k, lit): (usize, bool)) {
    let middle = y + 0.5 * ROW_HEIGHT;
    pen.panel((x, y), (width, ROW_HEIGHT), if lit { HudColor::FocusedField } else { HudColor::InputField });
    pen.click_area((x, y), (width, ROW_HEIGHT), KeyPress::Row(k));
    if lit {
        // A bar at the edge marks the focus in addition to the color.
        pen.panel((x - 0.014, y), (0.008, ROW_HEIGHT), HudColor::White);
    }
    let label = if row.kind == RowKind::Button { HudColor::White } else { HudColor::Gray };
    // The title of a job may be longer than the row.
    let room = if row.kind == RowKind::Button { width - 0.04 } else { VALUE_START * width };
    let height = TEXT_SIZE.min(TEXT_SIZE * room / text_width(&row.label, TEXT_SIZE).max(1e-9));
    pen.text((x + 0.02, middle), TextAlign::Left, height, label, row.label.clone());
    if row.kind == RowKind::Button {
        return;
    }
    let (from, to) = (x + VALUE_START * width, x + width);
    let words = if row.kind == RowKind::TextField && lit { format!("{}_", row.value) } else { row.value.clone() };
    let room = to - from - 2.0 * ARROW_WIDTH;
    let height = TEXT_SIZE.min(TEXT_SIZE * room / text_width(&words, TEXT_SIZE).max(1e-9)).max(0.6 * SMALL_TEXT_SIZE);
    pen.text((0.5 * (from + to), middle), TextAlign::Center, height, HudColor::White, words);
    for (edge, way, on) in [(from, -1.0, false), (to - ARROW_WIDTH, 1.0, true)] {
        let tip = edge + 0.5 * ARROW_WIDTH + way * 0.011;
        let base = edge + 0.5 * ARROW_WIDTH - way * 0.011;
        pen.fill(&[(tip, middle), (base, middle - 0.014), (base, middle + 0.014)], HudColor::White);
        pen.click_area((edge, y), (ARROW_WIDTH, ROW_HEIGHT), KeyPress::Step(k, on));
    }
}

/// Horizontal position of the value, as a fraction of the row's width, and the width of its arrows.
const VALUE_START: f64 = 0.3;
const ARROW_WIDTH: f64 = 0.06;
