//! The current step of a lesson, in place of the task panel: what to do, how, how much of it is done, and what went wrong.

use super::lesson_words::{instruction, title};
use super::metrics::{EDGE_MARGIN, SMALL_FONT_SIZE};
use super::pane::Pane;
use super::state::{Hud, LessonDisplay};
use super::style::DisplayStyle;
use super::task_panel::{LINE_HEIGHT, PADDING, PanelDetail, SEPARATOR, WIDTH, height_words, way_items, way_words};
use super::text_metrics::{text_width, wrap_text};
use super::{DrawItem, HudColor, TextAlign};
use spandrel_text::monitor_texts::remark_words;
use spandrel_text::text;

/// Largest number of lines for what to do, how, and what went wrong; in the full and in the brief panel.
const MAX_LINES: [usize; 3] = [2, 5, 2];
const BRIEF_MAX_LINES: [usize; 3] = [2, 0, 1];
/// Height of the progress bar.
const BAR_HEIGHT: f64 = 0.012;

/// Returns the panel with its upper edge at `top`; empty without a lesson.
pub(super) fn lesson_panel(hud: &Hud, pane: Pane, (detail, top): (PanelDetail, f64)) -> Vec<DrawItem> {
    let Some(LessonDisplay { status, how, remark }) = &hud.lesson else { return Vec::new() };
    let (language, units) = (hud.style.language, hud.style.units);
    let remark = remark.as_deref().map(|remark| units.words(&remark_words(remark, language))).unwrap_or_default();
    let most = match detail {
        PanelDetail::Full => MAX_LINES,
        PanelDetail::Brief => BRIEF_MAX_LINES,
        PanelDetail::None => return Vec::new(),
    };
    let (left, right) = (pane.width - EDGE_MARGIN - WIDTH, pane.width - EDGE_MARGIN);
    let (from, to) = (left + PADDING, right - PADDING);
    let fits = |line: &str| text_width(line, SMALL_FONT_SIZE) <= to - from;
    let texts = [
        (title(status, language), HudColor::Gray, 1),
        (instruction(status, units, language), HudColor::White, most[0]),
        (how.clone(), HudColor::Gray, most[1]),
        (remark, HudColor::Yellow, most[2]),
    ];
    let texts = texts.into_iter().filter(|(words, _, most)| !words.is_empty() && *most > 0);
    let lines: Vec<(String, HudColor)> =
        texts.flat_map(|(words, color, most)| wrap_text(&words, most, fits).into_iter().map(move |line| (line, color))).collect();
    // The way and the height.
    let rows = lines.len() + if status.way.is_some() { 2 } else { 0 };
    let bar = top + PADDING + LINE_HEIGHT * rows as f64 + 0.006;
    let mut items = vec![pane.panel((left, top), (right, bar + BAR_HEIGHT + PADDING))];
    let middle = |row: usize| top + PADDING + LINE_HEIGHT * (row as f64 + 0.5);
    for (row, (words, color)) in lines.iter().enumerate() {
        items.push(pane.text((from, middle(row)), TextAlign::Left, SMALL_FONT_SIZE, *color, words.clone()));
    }
    if let Some(way) = &status.way {
        items.extend(way_items(way, hud.style, pane, (from, to, middle(lines.len()))));
        let y = middle(lines.len() + 1);
        let height = (text!(language, "flight-panel-height"), height_words(way.up_m, hud.style), HudColor::White);
        items.extend(pane.name_and_value((from, to), y, SMALL_FONT_SIZE, height));
    }
    items.push(pane.fill(&rectangle((from, bar), (to - from, BAR_HEIGHT)), HudColor::InputField));
    if status.progress > 0.0 {
        let width = (to - from) * status.progress.clamp(0.0, 1.0);
        items.push(pane.fill(&rectangle((from, bar), (width, BAR_HEIGHT)), HudColor::Green));
    }
    items
}

/// Returns the current step, what to do with the way, how, and what went wrong, as lines.
pub(super) fn lesson_lines(lesson: &LessonDisplay, style: DisplayStyle) -> [(String, HudColor); 4] {
    let (status, language) = (&lesson.status, style.language);
    let way = status.way.as_ref().map(|way| [way_words(way, style), height_words(way.up_m, style)]);
    let to_do = [instruction(status, style.units, language)].into_iter().chain(way.into_iter().flatten());
    let remark = lesson.remark.as_deref().map(|remark| style.units.words(&remark_words(remark, language)));
    [
        (format!("{}{SEPARATOR}{:.0}%", title(status, language), (100.0 * status.progress).floor()), HudColor::Gray),
        (to_do.collect::<Vec<_>>().join(SEPARATOR), HudColor::White),
        (lesson.how.clone(), HudColor::Gray),
        (remark.unwrap_or_default(), HudColor::Yellow),
    ]
}

fn rectangle((x, y): (f64, f64), (width, height): (f64, f64)) -> [(f64, f64); 4] {
    [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
}
