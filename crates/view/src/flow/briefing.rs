//! Briefing page before the flight: drawings of the site with the tasks, conditions, hazards, what counts, the instructor's words and
//! pictures, and the site check, which the user acknowledges to start.

use super::menu::{self, MenuAction, MenuRow};
use super::pipe::{BriefingImage, JobBriefing, JobOffer};
use super::sheet::{LINE_SPACING, PageWriter, PictureSource, SMALL_TEXT_SIZE, fitted, wrap_text};
use crate::hud::{HudColor, JobDrawing, TextAlign};
use spandrel_text::{Language, text};
use std::sync::Arc;

/// Left margin, and gap between the columns.
const LEFT: f64 = 0.04;
const COLUMN_GAP: f64 = 0.06;
/// Top of the columns, or of the menu above them; gap between both, and below a menu at the bottom.
const TOP: f64 = 0.15;
const MENU_GAP: f64 = 0.03;
/// Smallest font size, relative to secondary text, before the page is scrolled instead.
const MIN_SIZE_RATIO: f64 = 0.55;
/// Share of the width for the drawings of the site.
const DRAWINGS_SHARE: f64 = 0.36;
/// Smallest and largest height of a drawing, relative to its width.
const DRAWING_HEIGHTS: (f64, f64) = (0.25, 0.8);
const DRAWING_GAP: f64 = 0.015;
/// Font size of the drawings' captions.
const CAPTION_SIZE: f64 = 0.8 * SMALL_TEXT_SIZE;
/// Maximum number of the instructor's pictures beside each other, their largest height, and the gap between them.
const PICTURES_PER_ROW: usize = 3;
const MAX_PICTURE_HEIGHT: f64 = 0.5;
const PICTURE_GAP: f64 = 0.03;
/// Gap between a picture and its caption.
const PICTURE_CAPTION_GAP: f64 = 0.008;
/// Space between two paragraphs and before a heading, in lines.
const PARAGRAPH_GAP: f64 = 0.35;
const HEADING_GAP: f64 = 0.6;

/// Returns the menu rows.
pub fn rows(language: Language) -> Vec<MenuRow> {
    vec![
        MenuRow::button(MenuAction::Acknowledge, text!(language, "window-briefing-acknowledge")),
        MenuRow::button(MenuAction::PrintBriefing, text!(language, "window-briefing-print")),
        MenuRow::button(MenuAction::Back, text!(language, "window-back")),
    ]
}

/// A block of the page: a heading and its paragraphs.
type Block<'a> = (String, &'a [String]);

pub fn page(pen: &mut PageWriter, (job, drawing): (&JobOffer, Option<&Arc<JobDrawing>>), rows: &[MenuRow], focus: usize) {
    let whole = pen.width - 2.0 * LEFT;
    let language = pen.style().language;
    pen.title((LEFT, 0.08), whole, &text!(language, "window-briefing-title", job = job.title.as_str()));
    let columns = columns(&job.briefing, language);
    let is_narrow = pen.is_narrow();
    let drawn = if is_narrow { whole } else { DRAWINGS_SHARE * whole };
    let texts = match drawing {
        Some(_) if !is_narrow => whole - drawn - COLUMN_GAP,
        Some(_) | None => whole,
    };
    let width = if is_narrow { whole } else { 0.5 * (texts - COLUMN_GAP) };
    // A page that fits has its menu at the bottom. Otherwise, it is scrolled, and has its menu at the top, where it is always seen first.
    let pictures = &job.briefing.pictures;
    let menu_height = menu::columns_height(whole, rows);
    let room = 1.0 - TOP - menu_height - 2.0 * MENU_GAP;
    let fits = fitting_size(&columns, width, room).filter(|_| !is_narrow && pen.height >= 1.0 && pictures.is_empty());
    let first = if fits.is_some() { TOP } else { TOP + menu_height + MENU_GAP };
    let mut bottom = first;
    for (k, column) in columns.iter().enumerate() {
        let (x, top) = if is_narrow { (LEFT, bottom) } else { (LEFT + (width + COLUMN_GAP) * k as f64, first) };
        bottom = draw_column(pen, ((x, top), width), column, fits.unwrap_or(SMALL_TEXT_SIZE)).max(bottom);
    }
    if let Some(drawing) = drawing {
        let (place, room) = if is_narrow { ((LEFT, bottom), f64::INFINITY) } else { ((LEFT + whole - drawn, first), room) };
        bottom = draw_site(pen, drawing, (place, drawn), room).max(bottom);
    }
    if !pictures.is_empty() {
        draw_pictures(pen, pictures, ((LEFT, bottom + PICTURE_GAP), whole));
    }
    let menu_top = if fits.is_some() { 1.0 - menu_height - MENU_GAP } else { TOP };
    menu::draw_columns(pen, (LEFT, menu_top), whole, rows, focus);
}

/// Draws the site one drawing below the other, as high as they are, or lower if there is less room. Returns the y position below.
fn draw_site(pen: &mut PageWriter, drawing: &JobDrawing, ((x, top), width): ((f64, f64), f64), room: f64) -> f64 {
    let language = pen.style().language;
    let caption_height = LINE_SPACING * CAPTION_SIZE;
    let (least, most) = DRAWING_HEIGHTS;
    let heights = (0..drawing.count()).map(|k| (width * drawing.height_ratio(k)).clamp(least * width, most * width));
    let heights: Vec<f64> = heights.collect();
    let gaps = (caption_height + DRAWING_GAP) * heights.len() as f64;
    let shrink = ((room - gaps) / heights.iter().sum::<f64>()).clamp(0.0, 1.0);
    let mut y = top;
    for (k, height) in heights.into_iter().enumerate() {
        let caption = drawing.caption(k, language).unwrap_or_default();
        let size = fitted(&caption, CAPTION_SIZE, width);
        pen.text((x, y + 0.5 * caption_height), TextAlign::Left, size, HudColor::Yellow, caption);
        y += caption_height;
        pen.job_drawing((drawing, k), (x, y), (width, shrink * height));
        y += shrink * height + DRAWING_GAP;
    }
    y
}

/// Draws the instructor's pictures in rows. Returns the y position below.
fn draw_pictures(pen: &mut PageWriter, pictures: &[BriefingImage], ((x, top), width): ((f64, f64), f64)) -> f64 {
    let count = if pen.is_narrow() { 1 } else { pictures.len().clamp(1, PICTURES_PER_ROW) };
    let column = (width + PICTURE_GAP) / count as f64 - PICTURE_GAP;
    let mut y = top;
    for row in pictures.chunks(count) {
        let mut bottom = y;
        for (k, picture) in row.iter().enumerate() {
            let place = (x + (column + PICTURE_GAP) * k as f64, y);
            bottom = draw_picture(pen, picture, (place, column)).max(bottom);
        }
        y = bottom + PICTURE_GAP;
    }
    y
}

/// Draws a picture in its own shape, as wide as its column or lower, with its caption below. Returns the y position below.
fn draw_picture(pen: &mut PageWriter, picture: &BriefingImage, ((x, top), width): ((f64, f64), f64)) -> f64 {
    let ratio = picture.height_ratio();
    let height = (width * ratio).min(MAX_PICTURE_HEIGHT);
    pen.picture_from(PictureSource::File(picture.path.clone()), (x, top), (height / ratio, height));
    let half_line = 0.5 * LINE_SPACING * CAPTION_SIZE;
    let first = top + height + PICTURE_CAPTION_GAP + half_line;
    pen.lines((x, first), width, CAPTION_SIZE, HudColor::White, &picture.caption) - half_line
}

fn columns(briefing: &JobBriefing, language: Language) -> [Vec<Block<'_>>; 2] {
    // Both columns have about the same length.
    let left: Vec<Block<'_>> = vec![
        (text!(language, "window-briefing-site-check"), &briefing.site_check),
        (text!(language, "window-briefing-tasks"), &briefing.tasks),
        (text!(language, "window-briefing-conditions"), &briefing.conditions),
    ];
    let right: Vec<Block<'_>> = vec![
        (text!(language, "window-briefing-hazards"), &briefing.hazards),
        (text!(language, "window-briefing-counts"), &briefing.counts),
        (text!(language, "window-briefing-notes"), &briefing.notes),
    ];
    [left, right].map(|column| column.into_iter().filter(|(_, lines)| !lines.is_empty()).collect())
}

/// Returns the largest font size at which both columns fit into a height, if there is one.
fn fitting_size(columns: &[Vec<Block<'_>>; 2], width: f64, room: f64) -> Option<f64> {
    let fits = |size: &f64| columns.iter().all(|column| column_height(column, width, *size) <= room);
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
