//! Defect school: a picture, the question what it shows, and the verdict.

use super::menu::{self, MenuAction, MenuRow};
use super::pipe::SchoolPage;
use super::sheet::{PageWriter, PictureSource, SMALL_TEXT_SIZE, TEXT_SIZE};
use crate::hud::HudColor;
use spandrel_text::{Language, text};

/// Left margin.
const LEFT: f64 = 0.04;
/// Top of the picture and of the text beside it.
const TOP: f64 = 0.15;
/// Aspect ratio of the pictures: that of the cameras' sensors.
const PICTURE_ASPECT: f64 = 4.0 / 3.0;
/// Largest share of the page's width that a picture takes.
const PICTURE_SHARE: f64 = 0.56;
/// Smallest distance of the picture from the lower edge.
const BOTTOM: f64 = 0.04;
/// Distance between two lines of text, and between the text and the rows.
const GAP: f64 = 0.012;

/// Returns the menu rows: the answers, or what comes next.
pub fn rows(shown: &SchoolPage, language: Language) -> Vec<MenuRow> {
    let answers = shown.answers.iter().enumerate().map(|(k, words)| MenuRow::button(MenuAction::Answer(k), words.clone()));
    let mut rows: Vec<MenuRow> = answers.collect();
    if shown.over {
        rows.push(MenuRow::button(MenuAction::School, text!(language, "window-school-another")));
    } else if rows.is_empty() {
        rows.push(MenuRow::button(MenuAction::ContinueSchool, text!(language, "window-school-next")));
    }
    let leave = if shown.over { text!(language, "window-school-start-page") } else { text!(language, "window-school-stop") };
    rows.push(MenuRow::button(MenuAction::LeaveSchool, leave));
    rows
}

/// Draws the page.
pub fn page(pen: &mut PageWriter, shown: &SchoolPage, rows: &[MenuRow], focus: usize) {
    let whole = pen.width - 2.0 * LEFT;
    pen.title((LEFT, 0.08), whole, &shown.title);
    let (mut x, mut y) = (LEFT, TOP + 0.02);
    if let Some(picture) = &shown.picture {
        // In a narrow window, the text stands below the picture.
        let narrow = pen.is_narrow();
        let share = if narrow { whole } else { PICTURE_SHARE * pen.width };
        let width = share.min(PICTURE_ASPECT * (1.0 - TOP - BOTTOM));
        let height = width / PICTURE_ASPECT;
        pen.picture_from(PictureSource::File(picture.clone()), (LEFT, TOP), (width, height));
        (x, y) = if narrow { (LEFT, TOP + height + 0.04) } else { (x + width + LEFT, y) };
    }
    let width = pen.width - x - LEFT;
    for (k, words) in shown.lines.iter().enumerate() {
        // The verdict stands out.
        let (size, color) = match (k, shown.right) {
            (0, Some(true)) => (TEXT_SIZE, HudColor::Green),
            (0, Some(false)) => (TEXT_SIZE, HudColor::Yellow),
            _ => (SMALL_TEXT_SIZE, HudColor::White),
        };
        y = pen.lines((x, y), width, size, color, words) + GAP;
    }
    menu::draw(pen, (x, y + GAP), width, rows, focus);
}
