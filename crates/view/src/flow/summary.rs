//! Result page: four scores, links to the report and questionnaire, and the next steps.

use super::menu::{self, MenuAction, MenuRow};
use super::pipe::{FlightSummary, SCORE_NAMES};
use super::sheet::{PageWriter, SMALL_TEXT_SIZE, TEXT_SIZE, TITLE_SIZE, text_width};
use crate::hud::{HudColor, TextAlign};

/// Checks whether a browser can open the address.
fn is_openable(address: &str) -> bool {
    ["http://", "https://", "file://"].iter().any(|start| address.starts_with(start))
}

/// Returns the menu rows for a result.
pub fn rows(ended: Option<&FlightSummary>) -> Vec<MenuRow> {
    let mut rows = Vec::new();
    if ended.is_some_and(|ended| ended.report.is_some()) {
        rows.push(MenuRow::button(MenuAction::Report, "Open report"));
    }
    if ended.is_some_and(|ended| is_openable(&ended.questionnaire)) {
        rows.push(MenuRow::button(MenuAction::OpenQuestionnaire, "Open questionnaire"));
    }
    rows.push(MenuRow::button(MenuAction::FlyAgain, "Fly again"));
    rows.push(MenuRow::button(MenuAction::ChooseOther, "Choose another job"));
    rows.push(MenuRow::button(MenuAction::Quit, "Quit"));
    rows
}

pub fn page(pen: &mut PageWriter, ended: Option<&FlightSummary>, rows: &[MenuRow], focus: usize) {
    let left = 0.04;
    let half = 0.52 * pen.width;
    let Some(ended) = ended else { return };
    let (title, note) = match &ended.completion {
        Some(words) if !ended.complete => (words.as_str(), format!("{}. Scores for the part you flew:", ended.why)),
        _ => ("Flight ended", ended.why.clone()),
    };
    // Shrinks the headline to fit on one line; its length depends on the job.
    let height = TITLE_SIZE.min((pen.width - 2.0 * left) / text_width(title, 1.0));
    pen.text((left, 0.08), TextAlign::Left, height, HudColor::White, title);
    pen.lines((left, 0.155), pen.width - 2.0 * left, SMALL_TEXT_SIZE, HudColor::Gray, &note);
    for (k, (name, score)) in SCORE_NAMES.iter().zip(&ended.scores).enumerate() {
        bar(pen, (left, 0.21 + 0.085 * k as f64), half, name, score.map(|score| score.pct));
    }
    let overall = match ended.overall {
        Some((sum, most)) => Some(format!("overall  {sum:.1} of {most:.0}")),
        None => ended.scores.iter().all(Option::is_none).then(|| "no scores".to_owned()),
    };
    let mut y = if overall.is_some() { 0.64 } else { 0.58 };
    if let Some(words) = overall {
        pen.text((left, 0.59), TextAlign::Left, 1.3 * TEXT_SIZE, HudColor::White, words);
    }
    if let Some(verdict) = &ended.verdict {
        y = pen.lines((left, y), half, SMALL_TEXT_SIZE, HudColor::White, verdict);
    }
    y = y.max(0.68) + 0.02;
    for (name, address) in
        [("report", ended.report.as_deref().unwrap_or("not available")), ("questionnaire", ended.questionnaire.as_str())]
    {
        pen.text((left, y), TextAlign::Left, SMALL_TEXT_SIZE, HudColor::Yellow, name);
        y = pen.lines((left + 0.26, y), pen.width - left - 0.30, SMALL_TEXT_SIZE, HudColor::White, address) + 0.02;
    }
    menu::draw(pen, (left + half + 0.08, 0.20), pen.width - half - 2.0 * left - 0.08, rows, focus);
}

/// Draws a score as a bar from 0 to 100 with its value.
fn bar(pen: &mut PageWriter, (x, y): (f64, f64), width: f64, name: &str, pct: Option<f64>) {
    const BAR_HEIGHT: f64 = 0.05;
    let (from, full) = (x + 0.28, width - 0.44);
    pen.text((x, y + 0.5 * BAR_HEIGHT), TextAlign::Left, TEXT_SIZE, HudColor::White, name);
    pen.panel((from, y), (full, BAR_HEIGHT), HudColor::InputField);
    let Some(pct) = pct else {
        pen.text((from + 0.02, y + 0.5 * BAR_HEIGHT), TextAlign::Left, SMALL_TEXT_SIZE, HudColor::Gray, "not applicable");
        return;
    };
    let long = full * (pct / 100.0).clamp(0.0, 1.0);
    if long > 0.0 {
        pen.fill(&[(from, y), (from + long, y), (from + long, y + BAR_HEIGHT), (from, y + BAR_HEIGHT)], HudColor::Blue);
    }
    pen.text((x + width - 0.02, y + 0.5 * BAR_HEIGHT), TextAlign::Right, TEXT_SIZE, HudColor::White, format!("{pct:.1}"));
}
