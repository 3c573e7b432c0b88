//! Result page: what to do better, the four scores, links to the report and questionnaire, and the next steps.

use super::menu::{self, MenuAction, MenuRow};
use super::pipe::{FlightSummary, LessonProgress, SCORE_NAMES};
use super::sheet::{LINE_SPACING, PageWriter, SMALL_TEXT_SIZE, TEXT_SIZE};
use crate::hud::{HudColor, TextAlign};
use spandrel_text::terms::score_title;
use spandrel_text::{Language, text};

/// Largest number of lines about requirements that were not met.
const MAX_REQUIREMENTS: usize = 6;
/// Left margin.
const LEFT: f64 = 0.04;
/// Vertical distance between the bars of two scores.
const BAR_SPACING: f64 = 0.055;
/// Smallest width for a score's name and bar on one line, and height of the name above the bar otherwise.
const MIN_BAR_LINE_WIDTH: f64 = 0.66;
const NAME_HEIGHT: f64 = 0.05;

/// Checks whether a browser can open the address.
fn is_openable(address: &str) -> bool {
    ["http://", "https://", "file://"].iter().any(|start| address.starts_with(start))
}

/// Returns the menu rows for a result. `moment` is the index of the selected moment.
pub fn rows(ended: Option<&FlightSummary>, moment: usize, language: Language) -> Vec<MenuRow> {
    let watched = ended.is_some_and(|ended| ended.watched);
    let mut rows = Vec::new();
    // First, so that Enter flies it.
    if let Some(next) = ended.and_then(|ended| ended.next.as_ref()) {
        let job = next.title.as_str();
        let words = if watched {
            text!(language, "window-result-fly-yourself", job = job)
        } else {
            text!(language, "window-result-fly-next", job = job)
        };
        rows.push(MenuRow::button(MenuAction::FlyNext, words));
    }
    if ended.is_some_and(|ended| ended.report.is_some()) {
        rows.push(MenuRow::button(MenuAction::Report, text!(language, "window-result-open-report")));
    }
    let moments = ended.map_or(&[][..], |ended| &ended.moments);
    if let Some(shown) = moments.get(moment) {
        let (time, number) = (shown.time.as_str(), moment + 1);
        let value = text!(language, "window-result-moment-number", time = time, number = number, count = moments.len());
        rows.push(MenuRow::choice(MenuAction::Moment, text!(language, "window-result-moment"), value));
    }
    if ended.is_some_and(|ended| is_openable(&ended.questionnaire)) {
        rows.push(MenuRow::button(MenuAction::OpenQuestionnaire, text!(language, "window-result-open-questionnaire")));
    }
    let again = if watched { text!(language, "window-result-watch-again") } else { text!(language, "window-result-fly-again") };
    rows.push(MenuRow::button(MenuAction::FlyAgain, again));
    rows.push(MenuRow::button(MenuAction::ChooseOther, text!(language, "window-result-choose")));
    rows.push(MenuRow::button(MenuAction::Quit, text!(language, "window-start-quit")));
    rows
}

/// Returns the names of the four scores, in the order of [`SCORE_NAMES`].
fn score_titles(language: Language) -> [String; 4] {
    SCORE_NAMES.map(|name| score_title(name, language))
}

pub fn page(pen: &mut PageWriter, ended: Option<&FlightSummary>, rows: &[MenuRow], focus: usize) {
    let Some(ended) = ended else { return };
    let whole = pen.width - 2.0 * LEFT;
    let half = if pen.is_narrow() { whole } else { 0.52 * pen.width };
    let top = headline(pen, ended);
    let top = to_do_better(pen, &ended.advice, top) + 0.03;
    let bottom = if ended.lesson.is_some() { top } else { scores(pen, (LEFT, top), half, ended) };
    let bottom = locations(pen, bottom + 0.02, half, ended);
    if pen.is_narrow() {
        menu::draw(pen, (LEFT, bottom + 0.02), whole, rows, focus);
    } else {
        let room = (whole - half - 0.08, pen.height - 0.02);
        menu::draw_above(pen, (LEFT + half + 0.08, top), room, rows, focus);
    }
}

/// Draws how much of the job was done and why the flight ended, and returns the y position below.
fn headline(pen: &mut PageWriter, ended: &FlightSummary) -> f64 {
    let language = pen.style().language;
    if let Some(lesson) = ended.lesson {
        let title = lesson_title(lesson, language);
        pen.title((LEFT, 0.08), pen.width - 2.0 * LEFT, &title);
        return pen.lines((LEFT, 0.155), pen.width - 2.0 * LEFT, SMALL_TEXT_SIZE, HudColor::Gray, &ended.why);
    }
    let (title, note) = match &ended.completion {
        Some(words) if !ended.complete => (words.clone(), text!(language, "window-result-part", why = ended.why.as_str())),
        Some(words) => (words.clone(), ended.why.clone()),
        None => (text!(language, "window-result-title"), ended.why.clone()),
    };
    let whole = pen.width - 2.0 * LEFT;
    // The headline's length depends on the job.
    pen.title((LEFT, 0.08), whole, &title);
    let y = pen.lines((LEFT, 0.155), whole, SMALL_TEXT_SIZE, HudColor::Gray, &note);
    match &ended.standing {
        Some(words) => pen.lines((LEFT, y), whole, SMALL_TEXT_SIZE, HudColor::White, words),
        None => y,
    }
}

fn lesson_title(lesson: LessonProgress, language: Language) -> String {
    if lesson.is_complete() {
        text!(language, "window-result-lesson-done")
    } else {
        text!(language, "window-result-lesson-steps", done = lesson.done, steps = lesson.steps)
    }
}

/// Draws the sentences on what to do better, and returns the y position below.
fn to_do_better(pen: &mut PageWriter, advice: &[String], top: f64) -> f64 {
    if advice.is_empty() {
        return top;
    }
    pen.text(
        (LEFT, top + 0.02),
        TextAlign::Left,
        SMALL_TEXT_SIZE,
        HudColor::Yellow,
        text!(pen.style().language, "window-result-advice"),
    );
    let indent = if advice.len() > 1 { 0.045 } else { 0.0 };
    let mut y = top + 0.07;
    for (k, words) in advice.iter().enumerate() {
        if advice.len() > 1 {
            pen.text((LEFT, y), TextAlign::Left, SMALL_TEXT_SIZE, HudColor::Yellow, (k + 1).to_string());
        }
        y = pen.lines((LEFT + indent, y), pen.width - 2.0 * LEFT - indent, SMALL_TEXT_SIZE, HudColor::White, words) + 0.006;
    }
    y
}

/// Draws the four scores, their sum and the verdict, and returns the y position below.
fn scores(pen: &mut PageWriter, (left, top): (f64, f64), width: f64, ended: &FlightSummary) -> f64 {
    let spacing = if width < MIN_BAR_LINE_WIDTH { BAR_SPACING + NAME_HEIGHT } else { BAR_SPACING };
    let language = pen.style().language;
    for (k, (name, score)) in score_titles(language).iter().zip(&ended.scores).enumerate() {
        bar(pen, (left, top + spacing * k as f64), width, name, score.map(|score| score.pct));
    }
    let mut y = top + spacing * ended.scores.len() as f64 + 0.02;
    let overall = match ended.overall {
        Some((sum, most)) => {
            Some(text!(language, "window-result-overall", sum = format!("{sum:.1}"), most = format!("{most:.0}")))
        }
        None => ended.scores.iter().all(Option::is_none).then(|| text!(language, "window-result-no-scores")),
    };
    if let Some(words) = overall {
        pen.text((left, y), TextAlign::Left, TEXT_SIZE, HudColor::White, words);
        y += LINE_SPACING * TEXT_SIZE;
    }
    if let Some(words) = &ended.verdict {
        y = pen.lines((left, y), width, SMALL_TEXT_SIZE, HudColor::White, words);
    }
    requirements(pen, (left, y), width, &ended.unmet)
}

/// Draws the requirements that were not met, and returns the y position below.
fn requirements(pen: &mut PageWriter, (left, top): (f64, f64), width: f64, unmet: &[String]) -> f64 {
    const INDENT: f64 = 0.03;
    let language = pen.style().language;
    // More would hide the rows below in a narrow window; the report lists all.
    let listed = if unmet.len() > MAX_REQUIREMENTS { MAX_REQUIREMENTS - 1 } else { unmet.len() };
    let rest = unmet.len() - listed;
    let more = (rest > 0).then(|| text!(language, "window-result-more-unmet", count = rest));
    let mut y = top;
    for words in unmet.iter().take(listed).chain(more.as_ref()) {
        pen.text((left, y), TextAlign::Left, SMALL_TEXT_SIZE, HudColor::Gray, "–");
        y = pen.lines((left + INDENT, y), width - INDENT, SMALL_TEXT_SIZE, HudColor::White, words);
    }
    y
}

/// Draws what no button opens, and how far the recommendation reaches, and returns the y position below.
fn locations(pen: &mut PageWriter, y: f64, width: f64, ended: &FlightSummary) -> f64 {
    let mut y = y;
    let language = pen.style().language;
    let report = ended.report.is_none().then(|| text!(language, "window-result-not-available"));
    if let Some(words) = report {
        pen.text((LEFT, y), TextAlign::Left, SMALL_TEXT_SIZE, HudColor::Yellow, text!(language, "window-result-report"));
        let (indent, down) = if width < MIN_BAR_LINE_WIDTH { (0.0, LINE_SPACING * SMALL_TEXT_SIZE) } else { (0.24, 0.0) };
        y = pen.lines((LEFT + indent, y + down), width - indent, SMALL_TEXT_SIZE, HudColor::White, &words);
    }
    if ended.next.as_ref().is_some_and(|next| next.from_last_session) {
        y = pen.lines((LEFT, y), width, SMALL_TEXT_SIZE, HudColor::Gray, &text!(language, "window-start-from-last-session"));
    }
    y
}

/// Draws a score as a bar from 0 to 100 with its value.
fn bar(pen: &mut PageWriter, (x, y): (f64, f64), width: f64, name: &str, pct: Option<f64>) {
    const BAR_HEIGHT: f64 = 0.042;
    pen.text((x, y + 0.5 * BAR_HEIGHT), TextAlign::Left, TEXT_SIZE, HudColor::White, name);
    // In a narrow window, the bar stands below its name.
    let is_narrow = width < MIN_BAR_LINE_WIDTH;
    let y = if is_narrow { y + NAME_HEIGHT } else { y };
    let (from, full) = if is_narrow { (x, width - 0.16) } else { (x + 0.28, width - 0.44) };
    pen.panel((from, y), (full, BAR_HEIGHT), HudColor::InputField);
    let Some(pct) = pct else {
        let words = text!(pen.style().language, "window-result-not-applicable");
        pen.text((from + 0.02, y + 0.5 * BAR_HEIGHT), TextAlign::Left, SMALL_TEXT_SIZE, HudColor::Gray, words);
        return;
    };
    let long = full * (pct / 100.0).clamp(0.0, 1.0);
    if long > 0.0 {
        pen.fill(&[(from, y), (from + long, y), (from + long, y + BAR_HEIGHT), (from, y + BAR_HEIGHT)], HudColor::Blue);
    }
    pen.text((x + width - 0.02, y + 0.5 * BAR_HEIGHT), TextAlign::Right, TEXT_SIZE, HudColor::White, format!("{pct:.1}"));
}
