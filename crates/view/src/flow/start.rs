//! Start page, where the user chooses trainee, job, and purpose, and the waiting page.

use super::pipe::{JobOffer, Purpose, TraineeSummary};
use super::sheet::{LINE_SPACING, PageLayout, PageWriter, SMALL_TEXT_SIZE, TEXT_SIZE, TITLE_SIZE, wrap_text};
use super::{Page, WindowFlow, briefing, controls, menu, paused, school, summary, tutorial};
use crate::hud::{HudColor, TextAlign};

impl WindowFlow {
    /// Returns the page for a window with the given aspect ratio (width over height). During a flight, it contains only
    /// the button.
    #[must_use]
    pub fn sheet(&self, aspect: f64) -> PageLayout {
        let rows = self.rows();
        let mut pen = PageWriter::new(aspect);
        match self.page {
            Page::Flight => return paused::button(self, pen),
            Page::Paused => return paused::page(pen, &paused::PAUSE_TEXT, &rows, self.focus),
            Page::ConfirmEnd => return paused::page(pen, &paused::END_TEXT, &rows, self.focus),
            Page::Opening
            | Page::Start
            | Page::Controls
            | Page::Calibrating
            | Page::Tutorial(..)
            | Page::Briefing
            | Page::Waiting
            | Page::Results
            | Page::School => pen.ground(HudColor::PageBackground),
        }
        match self.page {
            Page::Start => self.start(&mut pen, &rows),
            Page::Controls | Page::Calibrating => controls::page(&mut pen, &self.controls, &rows, self.focus),
            Page::Tutorial(page, _) => tutorial::page(&mut pen, page, &rows, self.focus, &self.names),
            Page::Briefing => match self.chosen_job() {
                Some(job) => briefing::page(&mut pen, job, &rows, self.focus),
                None => waiting(&mut pen, self.waiting_for),
            },
            Page::Results => summary::page(&mut pen, self.ended.as_ref(), &rows, self.focus),
            Page::School => {
                if let Some(shown) = &self.school {
                    school::page(&mut pen, shown, &rows, self.focus);
                }
            }
            Page::Waiting => waiting(&mut pen, self.waiting_for),
            Page::Opening | Page::Flight | Page::Paused | Page::ConfirmEnd => waiting(&mut pen, "Spandrel"),
        }
        if let Some(words) = &self.notice {
            draw_notice(&mut pen, words);
        }
        pen.done()
    }

    fn start(&self, pen: &mut PageWriter, rows: &[menu::MenuRow]) {
        let left = 0.04;
        pen.text((left, 0.08), TextAlign::Left, TITLE_SIZE, HudColor::White, "Spandrel: inspect a bridge with a drone");
        let half = 0.56 * pen.width;
        menu::draw(pen, (left, 0.17), half, rows, self.focus);
        let help = "Up/down select, left/right change, Enter confirm; or click.";
        let bottom = 0.17 + menu::ROW_SPACING * rows.len() as f64;
        pen.text((left, bottom + 0.03), TextAlign::Left, SMALL_TEXT_SIZE, HudColor::Gray, help);
        let (x, width) = (left + half + 0.06, pen.width - half - left - 0.08);
        let mut y = 0.19;
        for (head, words) in self.choice_explanation() {
            pen.text((x, y), TextAlign::Left, TEXT_SIZE, HudColor::Yellow, head);
            y = pen.lines((x, y + 0.052), width, SMALL_TEXT_SIZE, HudColor::White, &words) + 0.03;
        }
    }

    /// Returns what is known about the selected trainee.
    pub(super) fn trainee_summary(&self) -> Option<&TraineeSummary> {
        self.offers.as_ref()?.trainees.iter().find(|person| person.name == self.choice.trainee)
    }

    /// Returns the selected job, if it is one of the offered ones.
    pub(super) fn chosen_job(&self) -> Option<&JobOffer> {
        self.offers.as_ref()?.scenarios.iter().find(|job| job.name == self.choice.scenario)
    }

    /// Returns a heading and an explanation for each selected value.
    fn choice_explanation(&self) -> Vec<(&'static str, String)> {
        let offers = self.offers.as_ref();
        let person = self.trainee_summary();
        let known = person.map_or(0, |person| person.sessions);
        let who = match known {
            _ if self.choice.trainee.is_empty() => "Enter a pseudonym, not a real name.".to_owned(),
            0 => "No sessions yet.".to_owned(),
            1 => "One session so far.".to_owned(),
            n => format!("{n} sessions so far."),
        };
        let new = !self.choice.trainee.is_empty() && self.needs_tutorial();
        let who = if new { format!("{who} Your first practice starts with a tutorial.") } else { who };
        let who = match person.and_then(|person| person.last.as_ref()) {
            Some(last) => format!("{who} Last flight: {last}"),
            None => who,
        };
        let job = self.chosen_job();
        let job = job.map_or(String::new(), |job| format!("{} ({})", job.kind, job.name));
        let purpose = match self.choice.purpose {
            Purpose::Practice => "You can pause and restart; the map shows the paths.",
            Purpose::Assessment => "One attempt: no pause, restart, or map.",
        };
        let mut told = vec![("Trainee", who), ("Job", job), ("Purpose", purpose.to_owned())];
        if let Some(web) = offers.and_then(|o| o.web.as_ref()) {
            told.push(("View sessions in browser", web.clone()));
        }
        told
    }
}

/// Draws a notice along the bottom of the page, over its content.
fn draw_notice(pen: &mut PageWriter, words: &str) {
    let (width, margin) = (pen.width, 0.04);
    let lines = wrap_text(words, width - 2.0 * margin, TEXT_SIZE);
    let high = LINE_SPACING * TEXT_SIZE * lines.len() as f64 + 0.025;
    let top = (0.985 - high).max(0.0);
    pen.panel((0.0, top), (width, high), HudColor::InputField);
    for (k, line) in lines.into_iter().enumerate() {
        let y = top + 0.0125 + LINE_SPACING * TEXT_SIZE * (k as f64 + 0.5);
        if y < 0.985 {
            pen.text((0.5 * width, y), TextAlign::Center, TEXT_SIZE, HudColor::Yellow, line);
        }
    }
}

fn waiting(pen: &mut PageWriter, words: &str) {
    let middle = 0.5 * pen.width;
    pen.text((middle, 0.45), TextAlign::Center, TITLE_SIZE, HudColor::White, words);
}
