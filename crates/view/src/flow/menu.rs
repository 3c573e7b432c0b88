//! Rows of a page: what can be chosen, typed and done, by keys as by clicks.

use super::KeyPress;
use super::sheet::{PageWriter, SMALL, TEXT, width_of};
use crate::hud::{HudColor, TextAlign};

/// Height of a row, and of the step to the next.
const HIGH: f64 = 0.06;
pub const STEP: f64 = 0.07;

/// What a row does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MenuAction {
    /// Whose session it is.
    Trainee,
    /// Which job.
    Scenario,
    /// Practice or assessment.
    Purpose,
    /// On to the controller.
    Check,
    /// Read the tutorial.
    Learn,
    /// Sound on or off.
    Sound,
    /// That was all.
    Quit,
    /// Look for a controller again.
    Look,
    /// Calibrate it.
    Calibrate,
    /// Which stick does what.
    Mode,
    /// How much about the centre counts as centred.
    DeadBand,
    /// How much flatter the middle is.
    Expo,
    /// On to the flight.
    Fly,
    /// Back to the flight that went on.
    Stay,
    /// Where one came from.
    Back,
    /// The next page.
    Next,
    /// Past the tutorial.
    Skip,
    /// The wizard's Enter.
    Confirm,
    /// Leave the wizard.
    Cancel,
    /// Fly on.
    Resume,
    /// This attempt ends, a new one begins.
    Restart,
    /// This session ends.
    End,
    /// The same once more.
    Again,
    /// Choose anew.
    Other,
    /// Open the report.
    Report,
    /// Open the questionnaire.
    Questions,
}

/// How a row is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowKind {
    /// Enter or a click does it.
    Button,
    /// Left and right change its value.
    Choice,
    /// Signs change its value, left and right take a known one.
    Typed,
}

/// A row.
#[derive(Debug, Clone, PartialEq)]
pub struct MenuRow {
    /// What it does.
    pub deed: MenuAction,
    /// How it is used.
    pub kind: RowKind,
    /// Its name.
    pub label: String,
    /// Its value.
    pub value: String,
}

impl MenuRow {
    /// Something to do.
    pub fn button(deed: MenuAction, label: impl Into<String>) -> Self {
        Self { deed, kind: RowKind::Button, label: label.into(), value: String::new() }
    }

    /// Something to choose.
    pub fn choice(deed: MenuAction, label: &str, value: impl Into<String>) -> Self {
        Self { deed, kind: RowKind::Choice, label: label.to_owned(), value: value.into() }
    }

    /// Something to type.
    pub fn typed_row(deed: MenuAction, label: &str, value: impl Into<String>) -> Self {
        Self { kind: RowKind::Typed, ..Self::choice(deed, label, value) }
    }
}

/// Draws rows one below the other; gives where the next thing would stand.
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
        // Not by colour alone: a bar at the edge says the same.
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

/// A value begins at this share of its row; its arrows have this width.
const VALUE: f64 = 0.3;
const ARROW: f64 = 0.06;
