//! Briefing page before the flight: tasks, hazards, and the site check, which the user acknowledges to start.

use super::menu::{self, MenuAction, MenuRow};
use super::pipe::{JobBriefing, JobOffer};
use super::sheet::{LINE_SPACING, PageWriter, SMALL_TEXT_SIZE, wrap_text};
use crate::hud::{HudColor, TextAlign};
use spandrel_text::{Language, text};

/// Left margin, and gap between the columns.
const LEFT: f64 = 0.04;
const COLUMN_GAP: f64 = 0.06;
/// Top of the columns, and of the menu.
const TOP: f64 = 0.15;
const MENU_TOP: f64 = 0.82;
/// Smallest font size, relative to secondary text, before the page is scrolled instead.
const MIN_SIZE_RATIO: f64 = 0.55;
/// Space between two paragraphs and before a heading, in lines.
const PARAGRAPH_GAP: f64 = 0.35;
const HEADING_GAP: f64 = 0.6;

/// Returns the menu rows.
pub fn rows(language: Language) -> Vec<MenuRow> {
    vec![
        MenuRow::button(MenuAction::Acknowledge, text!(language, "window-briefing-acknowledge")),
        MenuRow::button(MenuAction::Back, text!(language, "window-back")),
    ]
}

/// A block of the page: a heading and its paragraphs.
type Block<'a> = (String, &'a [String]);

pub fn page(pen: &mut PageWriter, job: &JobOffer, rows: &[MenuRow], focus: usize) {
    let whole = pen.width - 2.0 * LEFT;
    let language = pen.style().language;
    pen.title((LEFT, 0.08), whole, &text!(language, "window-briefing-title", job = job.title.as_str()));
    let columns = columns(&job.briefing, language);
    let width = if pen.is_narrow() { whole } else { 0.5 * (whole - COLUMN_GAP) };
    // A page that fits has its menu at the bottom; otherwise, it is scrolled.
    let fits = fitting_size(&columns, width).filter(|_| !pen.is_narrow() && pen.height >= 1.0);
    let mut bottom = TOP;
    for (k, column) in columns.iter().enumerate() {
        let (x, top) = if pen.is_narrow() { (LEFT, bottom) } else { (LEFT + (width + COLUMN_GAP) * k as f64, TOP) };
        bottom = draw_column(pen, ((x, top), width), column, fits.unwrap_or(SMALL_TEXT_SIZE)).max(bottom);
    }
    let menu_top = if fits.is_some() { MENU_TOP } else { bottom + 0.02 };
    menu::draw(pen, (LEFT, menu_top), whole, rows, focus);
}

fn columns(briefing: &JobBriefing, language: Language) -> [Vec<Block<'_>>; 2] {
    let left: Vec<Block<'_>> = vec![
        (text!(language, "window-briefing-site-check"), &briefing.site_check),
        (text!(language, "window-briefing-tasks"), &briefing.tasks),
    ];
    let right: Vec<Block<'_>> = vec![
        (text!(language, "window-briefing-hazards"), &briefing.hazards),
        (text!(language, "window-briefing-notes"), &briefing.notes),
    ];
    [left, right].map(|column| column.into_iter().filter(|(_, lines)| !lines.is_empty()).collect())
}

/// Returns the largest font size at which both columns fit above the menu, if there is one.
fn fitting_size(columns: &[Vec<Block<'_>>; 2], width: f64) -> Option<f64> {
    let fits = |size: &f64| columns.iter().all(|column| column_height(column, width, *size) <= MENU_TOP - TOP - 0.02);
    (0..=9).map(|k| SMALL_TEXT_SIZE * (1.0 - (1.0 - MIN_SIZE_RATIO) * f64::from(k) / 9.0)).find(fits)
}

fn column_height(column: &[Block<'_>], width: f64, size: f64) -> f64 {
    let paragraph = |words: &String| wrap_text(words, width, size).len() as f64 + PARAGRAPH_GAP;
    let block = |(_, lines): &Block<'_>| 1.0 + HEADING_GAP + lines.iter().map(paragraph).sum::<f64>();
    LINE_SPACING * size * column.iter().map(block).sum::<f64>()
}

/// Draws a column and returns the y position below it.
fn draw_column(pen: &mut PageWriter, ((x, top), width): ((f64, f64), f64), column: &[Block<'_>], size: f64) -> f64 {
    let line = LINE_SPACING * size;
    let mut y = top + 0.5 * line;
    for (heading, paragraphs) in column {
        pen.text((x, y), TextAlign::Left, size, HudColor::Yellow, heading.clone());
        y += line;
        for words in *paragraphs {
            y = pen.lines((x, y), width, size, HudColor::White, words) + PARAGRAPH_GAP * line;
        }
        y += HEADING_GAP * line;
    }
    y
}
