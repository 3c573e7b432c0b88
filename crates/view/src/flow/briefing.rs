//! Briefing page before the flight: tasks, hazards, and the site check, which the user acknowledges to start.

use super::menu::{self, MenuAction, MenuRow};
use super::pipe::{JobBriefing, JobOffer};
use super::sheet::{LINE_SPACING, PageWriter, SMALL_TEXT_SIZE, TITLE_SIZE, text_width, wrap_text};
use crate::hud::{HudColor, TextAlign};

/// Left margin, and gap between the columns.
const LEFT: f64 = 0.04;
const COLUMN_GAP: f64 = 0.06;
/// Top of the columns, and of the menu.
const TOP: f64 = 0.15;
const MENU_TOP: f64 = 0.82;
/// Smallest font size, relative to secondary text. Longer briefings end with a reference to the complete one.
const MIN_SIZE_RATIO: f64 = 0.55;
/// Space between two paragraphs and before a heading, in lines.
const PARAGRAPH_GAP: f64 = 0.35;
const HEADING_GAP: f64 = 0.6;

/// Returns the menu rows.
pub fn rows() -> Vec<MenuRow> {
    vec![
        MenuRow::button(MenuAction::Acknowledge, "I have read this and checked the site: fly"),
        MenuRow::button(MenuAction::Back, "Back (Esc)"),
    ]
}

/// A block of the page: a heading and its paragraphs.
type Block<'a> = (&'static str, &'a [String]);

pub fn page(pen: &mut PageWriter, job: &JobOffer, rows: &[MenuRow], focus: usize) {
    let title = format!("Briefing: {}", job.title);
    let height = TITLE_SIZE.min((pen.width - 2.0 * LEFT) / text_width(&title, 1.0));
    pen.text((LEFT, 0.08), TextAlign::Left, height, HudColor::White, title);
    let width = 0.5 * (pen.width - 2.0 * LEFT - COLUMN_GAP);
    let columns = columns(&job.briefing);
    let size = fitting_size(&columns, width);
    for (k, column) in columns.iter().enumerate() {
        draw_column(pen, (LEFT + (width + COLUMN_GAP) * k as f64, width), column, size);
    }
    menu::draw(pen, (LEFT, MENU_TOP), pen.width - 2.0 * LEFT, rows, focus);
}

fn columns(briefing: &JobBriefing) -> [Vec<Block<'_>>; 2] {
    let left: Vec<Block<'_>> = vec![("Site check", &briefing.site_check), ("Tasks, in this order", &briefing.tasks)];
    let right: Vec<Block<'_>> = vec![("Hazards", &briefing.hazards), ("From your instructor", &briefing.notes)];
    [left, right].map(|column| column.into_iter().filter(|(_, lines)| !lines.is_empty()).collect())
}

/// Returns the largest font size at which both columns fit.
fn fitting_size(columns: &[Vec<Block<'_>>; 2], width: f64) -> f64 {
    let fits = |size: f64| columns.iter().all(|column| column_height(column, width, size) <= MENU_TOP - TOP - 0.02);
    let sizes = (0..=9).map(|k| SMALL_TEXT_SIZE * (1.0 - (1.0 - MIN_SIZE_RATIO) * f64::from(k) / 9.0));
    sizes.into_iter().find(|size| fits(*size)).unwrap_or(MIN_SIZE_RATIO * SMALL_TEXT_SIZE)
}

fn column_height(column: &[Block<'_>], width: f64, size: f64) -> f64 {
    let paragraph = |words: &String| wrap_text(words, width, size).len() as f64 + PARAGRAPH_GAP;
    let block = |(_, lines): &Block<'_>| 1.0 + HEADING_GAP + lines.iter().map(paragraph).sum::<f64>();
    LINE_SPACING * size * column.iter().map(block).sum::<f64>()
}

/// Text at the end of a column in which not everything fits.
const MORE: &str = "More: see the briefing on the web pages, or run spandrel brief.";

/// Draws a column. If it does not fit even at the smallest size, it ends with a reference to the complete briefing.
fn draw_column(pen: &mut PageWriter, (x, width): (f64, f64), column: &[Block<'_>], size: f64) {
    let line = LINE_SPACING * size;
    let mut y = TOP + 0.5 * line;
    for (heading, paragraphs) in column {
        pen.text((x, y), TextAlign::Left, size, HudColor::Yellow, *heading);
        y += line;
        for words in *paragraphs {
            let lines = wrap_text(words, width, size);
            if y + line * (lines.len() + 1) as f64 > MENU_TOP {
                pen.lines((x, y), width, size, HudColor::Yellow, MORE);
                return;
            }
            y = pen.lines((x, y), width, size, HudColor::White, words) + PARAGRAPH_GAP * line;
        }
        y += HEADING_GAP * line;
    }
}
