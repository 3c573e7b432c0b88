//! Menu rows: buttons, choices, and text fields, operated with keys or clicks.

use super::KeyPress;
use super::settings::Setting;
use super::sheet::{LINE_SPACING, PageWriter, SMALL_TEXT_SIZE, TEXT_SIZE, fitted, text_width, wrap_text};
use crate::hud::{HudColor, TextAlign};

/// Usual and smallest row height, and usual row spacing.
const ROW_HEIGHT: f64 = 0.06;
const MIN_ROW_HEIGHT: f64 = 0.052;
pub const ROW_SPACING: f64 = 0.07;
/// Smallest gap between two rows.
const MIN_ROW_GAP: f64 = 0.004;

/// Action of a menu row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MenuAction {
    /// Select the trainee.
    Trainee,
    /// Select the job.
    Scenario,
    /// Select the aircraft.
    Aircraft,
    /// Select practice or assessment.
    Purpose,
    /// Continue to the controller check.
    CheckController,
    /// Open the tutorial.
    OpenTutorial,
    /// Start a round of the defect school.
    School,
    /// Select a moment of the flight and open the report there.
    Moment,
    /// Give the answer with this number in the defect school.
    Answer(usize),
    /// Continue in the defect school.
    ContinueSchool,
    /// Leave the defect school.
    LeaveSchool,
    /// Open the settings.
    Settings,
    /// Select the value of a setting.
    Setting(Setting),
    /// Open the list of keys.
    Keys,
    /// Bind a key to the function with this index.
    Key(usize),
    /// Restore the default keys.
    RestoreKeys,
    /// Restore all default settings.
    RestoreSettings,
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
    /// Open the briefing as a page to print.
    PrintBriefing,
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
    /// Activated with Enter or a click; the value is the name of a key.
    KeyBinding,
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
    pub fn choice(action: MenuAction, label: impl Into<String>, value: impl Into<String>) -> Self {
        Self { action, kind: RowKind::Choice, label: label.into(), value: value.into() }
    }

    /// Creates a row with a text value.
    pub fn text_field(action: MenuAction, label: impl Into<String>, value: impl Into<String>) -> Self {
        Self { kind: RowKind::TextField, ..Self::choice(action, label, value) }
    }
}

/// Draws the rows from top to bottom and returns the y position below the last one.
pub fn draw(pen: &mut PageWriter, (x, y): (f64, f64), width: f64, rows: &[MenuRow], focus: usize) -> f64 {
    draw_part(pen, (x, y), width, rows, (0, focus), (ROW_HEIGHT, ROW_SPACING - ROW_HEIGHT))
}

/// Like [`draw`], with smaller gaps and lower rows if the rows would otherwise not end above `bottom`.
pub fn draw_above(pen: &mut PageWriter, (x, y): (f64, f64), (width, bottom): (f64, f64), rows: &[MenuRow], focus: usize) -> f64 {
    let count = rows.len().max(1) as f64;
    let spacing = (bottom - y) / count;
    let height = (spacing - MIN_ROW_GAP).clamp(MIN_ROW_HEIGHT, ROW_HEIGHT);
    let gap = (spacing - height).clamp(MIN_ROW_GAP, ROW_SPACING - ROW_HEIGHT);
    draw_part(pen, (x, y), width, rows, (0, focus), (height, gap))
}

/// Draws the rows in columns, each from top to bottom, and returns the y position below the longest one.
pub fn draw_columns(pen: &mut PageWriter, (x, y): (f64, f64), width: f64, rows: &[MenuRow], focus: usize) -> f64 {
    let (column, length) = column_of(width, rows.len());
    let mut bottom = y;
    for (k, part) in rows.chunks(length).enumerate() {
        let left = x + (column + COLUMN_GAP) * k as f64;
        let sizes = (ROW_HEIGHT, ROW_SPACING - ROW_HEIGHT);
        bottom = draw_part(pen, (left, y), column, part, (k * length, focus), sizes).max(bottom);
    }
    bottom
}

/// Returns the height of the rows that [`draw_columns`] draws, with a gap below them.
pub fn columns_height(width: f64, rows: &[MenuRow]) -> f64 {
    let (column, length) = column_of(width, rows.len());
    let row_height = |row| RowShape::of(row, (column, ROW_HEIGHT), false).height + ROW_SPACING - ROW_HEIGHT;
    rows.chunks(length).map(|part| part.iter().map(row_height).sum()).fold(0.0, f64::max)
}

/// Returns the width of a column, and the number of rows in the longest one.
fn column_of(width: f64, rows: usize) -> (f64, usize) {
    let count = ((width + COLUMN_GAP) / (MIN_COLUMN_WIDTH + COLUMN_GAP)).floor().max(1.0);
    ((width + COLUMN_GAP) / count - COLUMN_GAP, rows.div_ceil(count as usize).max(1))
}

/// Draws rows of a height, of which the first has the number `first`.
fn draw_part(
    pen: &mut PageWriter,
    (x, y): (f64, f64),
    width: f64,
    rows: &[MenuRow],
    (first, focus): (usize, usize),
    (line_height, gap): (f64, f64),
) -> f64 {
    let mut y = y;
    for (k, row) in (first..).zip(rows) {
        let shape = RowShape::of(row, (width, line_height), k == focus);
        draw_row(pen, (x, y), width, row, (k, &shape));
        y += shape.height + gap;
    }
    y
}

/// How a row is laid out in its width.
struct RowShape {
    is_focused: bool,
    /// Height of a row with one line.
    line_height: f64,
    height: f64,
    label: Vec<String>,
    label_size: f64,
    value: String,
    /// Left edge of the value, from the row's left edge.
    value_start: f64,
    /// Whether the value stands below the label.
    is_stacked: bool,
}

impl RowShape {
    fn of(row: &MenuRow, (width, line_height): (f64, f64), is_focused: bool) -> Self {
        let value = if row.kind == RowKind::TextField && is_focused { format!("{}_", row.value) } else { row.value.clone() };
        let label_width = text_width(&row.label, TEXT_SIZE).max(1e-9);
        let whole = width - 2.0 * PADDING;
        let value_start = value_start(width, label_width, &value);
        let (room, can_stack) = match row.kind {
            RowKind::Button => (whole, false),
            RowKind::Choice | RowKind::TextField => (value_start - PADDING, true),
            RowKind::KeyBinding => (whole - PADDING - text_width(&value, TEXT_SIZE), true),
        };
        let is_stacked = can_stack && MIN_SHRINK * label_width > room;
        let room = if is_stacked { whole } else { room };
        let label =
            if MIN_SHRINK * label_width <= room { vec![row.label.clone()] } else { wrap_text(&row.label, whole, TEXT_SIZE) };
        let label_size = if label.len() > 1 { TEXT_SIZE } else { TEXT_SIZE.min(TEXT_SIZE * room / label_width) };
        let lines = label.len() + usize::from(is_stacked);
        let height = line_height + LINE_SPACING * TEXT_SIZE * (lines - 1) as f64;
        let value_start = if is_stacked { 0.0 } else { value_start };
        Self { is_focused, line_height, height, label, label_size, value, value_start, is_stacked }
    }
}

/// Returns the left edge of a value: the usual one, or farther right if that leaves room for a long label and the value.
fn value_start(width: f64, label_width: f64, value: &str) -> f64 {
    let usual = VALUE_START * width;
    let most = width - text_width(value, TEXT_SIZE) - 2.0 * ARROW_WIDTH;
    let (shrunk, whole) = (MIN_SHRINK * label_width + PADDING, label_width + PADDING);
    if shrunk > usual && shrunk <= most { whole.min(most) } else { usual }
}

fn draw_row(pen: &mut PageWriter, (x, y): (f64, f64), width: f64, row: &MenuRow, (k, shape): (usize, &RowShape)) {
    let ground = if shape.is_focused { HudColor::FocusedField } else { HudColor::InputField };
    pen.panel((x, y), (width, shape.height), ground);
    pen.click_area((x, y), (width, shape.height), KeyPress::Row(k));
    if shape.is_focused {
        // A bar at the edge marks the focus in addition to the color.
        pen.panel((x - 0.014, y), (0.008, shape.height), HudColor::White);
    }
    let color = if row.kind == RowKind::Button { HudColor::White } else { HudColor::Gray };
    let line = |k: usize| y + 0.5 * shape.line_height + LINE_SPACING * TEXT_SIZE * k as f64;
    for (k, words) in shape.label.iter().enumerate() {
        pen.text((x + PADDING, line(k)), TextAlign::Left, shape.label_size, color, words.clone());
    }
    let middle = if shape.is_stacked { line(shape.label.len()) } else { line(0) };
    let from = x + shape.value_start;
    match row.kind {
        RowKind::Button => {}
        RowKind::KeyBinding => {
            let height = fitted(&shape.value, TEXT_SIZE, width - 2.0 * PADDING);
            pen.text((x + width - PADDING, middle), TextAlign::Right, height, HudColor::White, shape.value.clone());
        }
        RowKind::Choice | RowKind::TextField => draw_value(pen, (from, x + width), middle, shape, k),
    }
}

/// Draws a value between its arrows.
fn draw_value(pen: &mut PageWriter, (from, to): (f64, f64), middle: f64, shape: &RowShape, k: usize) {
    let (words, line_height) = (shape.value.as_str(), shape.line_height);
    let height = fitted(words, TEXT_SIZE, to - from - 2.0 * ARROW_WIDTH).max(0.6 * SMALL_TEXT_SIZE);
    pen.text((0.5 * (from + to), middle), TextAlign::Center, height, HudColor::White, words);
    for (edge, way, on) in [(from, -1.0, false), (to - ARROW_WIDTH, 1.0, true)] {
        let tip = edge + 0.5 * ARROW_WIDTH + way * 0.011;
        let base = edge + 0.5 * ARROW_WIDTH - way * 0.011;
        pen.fill(&[(tip, middle), (base, middle - 0.014), (base, middle + 0.014)], HudColor::White);
        pen.click_area((edge, middle - 0.5 * line_height), (ARROW_WIDTH, line_height), KeyPress::Step(k, on));
    }
}

/// Horizontal position of the value, as a fraction of the row's width, and the width of its arrows.
const VALUE_START: f64 = 0.3;
const ARROW_WIDTH: f64 = 0.06;
/// Horizontal padding of a row.
const PADDING: f64 = 0.02;
/// Smallest size of a label relative to normal text; longer labels have several lines.
const MIN_SHRINK: f64 = 0.7;
/// Smallest width of a column of rows, and gap between columns.
const MIN_COLUMN_WIDTH: f64 = 0.48;
const COLUMN_GAP: f64 = 0.03;
