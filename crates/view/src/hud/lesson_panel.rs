//! The current step of a lesson, in place of the task panel: what to do, how, how much of it is done, and what went wrong.

use super::metrics::{EDGE_MARGIN, SMALL_FONT_SIZE};
use super::pane::Pane;
use super::state::{Hud, LessonDisplay};
use super::task_panel::{LINE_HEIGHT, PADDING, PanelDetail, WIDTH, height_words, way_items};
use super::text_metrics::{text_width, wrap_text};
use super::{DrawItem, HudColor, TextAlign};
use spandrel_mavlink::contract::guidance::WayTo;
use spandrel_mavlink::contract::lesson::{LessonStatus, LessonTask};

/// Largest number of lines for what to do, how, and what went wrong; in the full and in the brief panel.
const MAX_LINES: [usize; 3] = [1, 2, 2];
const BRIEF_MAX_LINES: [usize; 3] = [2, 0, 1];
/// Height of the progress bar.
const BAR_HEIGHT: f64 = 0.012;

/// Returns how a step is done; `{binding}` stands for the name of a key.
#[must_use]
pub fn how_to(task: LessonTask) -> &'static str {
    match task {
        LessonTask::Arm => "Press {arm}. The propellers start to turn.",
        LessonTask::TakeOff => "Press {take_off}, or hold {up} to climb.",
        LessonTask::Hover => "Fly to the ring, then release all keys: the drone stays.",
        LessonTask::Turn => "Hold {turn_left} or {turn_right}.",
        LessonTask::FlyPath => "Follow the ribbon through the gates: {forward}{left}{back}{right}, {up} and {down}.",
        LessonTask::StopAt => "Release the keys early: the drone needs room to stop.",
        LessonTask::TiltCamera => "Press {gimbal_up} or {gimbal_down}.",
        LessonTask::Lamp => "Press {lamp}.",
        LessonTask::Photograph => "Bring the defect between the corner marks and press {snapshot}.",
        LessonTask::FlyHome => "The white square on the compass shows the way.",
        LessonTask::Land => "Press {land} above the pad, or hold {down} until the motors stop.",
        LessonTask::Done => "You are ready for the first drill.",
    }
}

/// Returns the panel with its upper edge at `top`; empty without a lesson.
pub(super) fn lesson_panel(hud: &Hud, pane: Pane, (detail, top): (PanelDetail, f64)) -> Vec<DrawItem> {
    let Some(LessonDisplay { status, how, remark }) = &hud.lesson else { return Vec::new() };
    let units = hud.style.units;
    let most = match detail {
        PanelDetail::Full => MAX_LINES,
        PanelDetail::Brief => BRIEF_MAX_LINES,
        PanelDetail::None => return Vec::new(),
    };
    let (left, right) = (pane.width - EDGE_MARGIN - WIDTH, pane.width - EDGE_MARGIN);
    let (from, to) = (left + PADDING, right - PADDING);
    let fits = |line: &str| text_width(line, SMALL_FONT_SIZE) <= to - from;
    let texts = [
        (title(status), HudColor::Gray, 1),
        (capitalized(&units.words(&status.instruction())), HudColor::White, most[0]),
        (how.clone(), HudColor::Gray, most[1]),
        (units.words(remark.as_deref().unwrap_or_default()), HudColor::Yellow, most[2]),
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
        items.extend(way_items(&WayTo { up_m: 0.0, ..*way }, units, pane, (from, middle(lines.len()))));
        let y = middle(lines.len() + 1);
        items.push(pane.text((from, y), TextAlign::Left, SMALL_FONT_SIZE, HudColor::Gray, "height"));
        items.push(pane.text((to, y), TextAlign::Right, SMALL_FONT_SIZE, HudColor::White, height_words(way.up_m, units)));
    }
    items.push(pane.fill(&rectangle((from, bar), (to - from, BAR_HEIGHT)), HudColor::InputField));
    if status.progress > 0.0 {
        let width = (to - from) * status.progress.clamp(0.0, 1.0);
        items.push(pane.fill(&rectangle((from, bar), (width, BAR_HEIGHT)), HudColor::Green));
    }
    items
}

fn title(status: &LessonStatus) -> String {
    if status.is_done() { "Lesson complete".to_owned() } else { format!("Step {} of {}", status.step, status.steps) }
}

/// Returns the words as a sentence with a degree sign.
fn capitalized(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().map(|letter| letter.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}", letters.as_str().replace(" deg", "°"))
}

fn rectangle((x, y): (f64, f64), (width, height): (f64, f64)) -> [(f64, f64); 4] {
    [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
}
