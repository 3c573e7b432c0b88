//! Start page, where the user chooses trainee, job, aircraft, and purpose, and the waiting page.

use super::pipe::{JobOffer, Purpose, TraineeSummary};
use super::scroll::ScrollRange;
use super::sheet::{
    LINE_SPACING, PageLayout, PageWriter, PictureSource, SMALL_TEXT_SIZE, TEXT_SIZE, TITLE_SIZE, fitted, wrap_text,
};
use super::{Page, WindowFlow, briefing, controls, menu, paused, school, summary, tutorial};
use crate::hud::{DrawItem, HudColor, ScreenPoint, TextAlign, at};
use crate::job_picture;
use spandrel_text::text;

impl WindowFlow {
    /// Returns the page for a window with the given aspect ratio (width over height). During a flight, it contains only
    /// the button.
    #[must_use]
    pub fn sheet(&self, aspect: f64) -> PageLayout {
        if self.page == Page::Flight {
            return paused::button(self, PageWriter::new(aspect, self.style()));
        }
        let mut content = self.content(aspect);
        let range = self.scroll_range(&content, aspect);
        content.move_up(range.distance(self.scrolled));
        let mut page = PageLayout::default();
        if !self.is_dialog_open() {
            page.items.push(DrawItem::Fill { points: WHOLE_WINDOW.to_vec(), color: HudColor::PageBackground });
        }
        page.append(content);
        page.items.extend(range.bar(self.scrolled));
        page.append(self.notice_layout(aspect));
        page
    }

    /// Returns the notice; nothing without one, or over a flight.
    fn notice_layout(&self, aspect: f64) -> PageLayout {
        let mut pen = PageWriter::new(aspect, self.style());
        if let Some(words) = self.notice.as_ref().filter(|_| !self.is_dialog_open()) {
            draw_notice(&mut pen, words);
        }
        pen.done()
    }

    /// Scrolls the page by a fraction of the window's height.
    pub fn scroll(&mut self, by: f64, aspect: f64) {
        let range = self.scroll_range(&self.content(aspect), aspect);
        self.scrolled = range.distance(self.scrolled + by) - range.focused;
    }

    fn scroll_range(&self, content: &PageLayout, aspect: f64) -> ScrollRange {
        ScrollRange::of(content, self.follows_focus.then_some(self.focus), self.notice_layout(aspect).top().unwrap_or(1.0))
    }

    /// Returns the contents of the page, which may be higher than the window.
    fn content(&self, aspect: f64) -> PageLayout {
        let rows = self.rows();
        let mut pen = PageWriter::new(aspect, self.style());
        match self.page {
            Page::Paused => return paused::page(pen, &paused::pause_text(self.language()), &rows, self.focus),
            Page::ConfirmEnd => return paused::page(pen, &paused::end_text(self.language()), &rows, self.focus),
            Page::Start => self.start(&mut pen, &rows),
            Page::Controls | Page::Calibrating => controls::page(&mut pen, &self.controls, &rows, self.focus),
            Page::Tutorial(page, _) => tutorial::page(&mut pen, page, &rows, self.focus, &self.names),
            Page::Settings { .. } => self.draw_settings(&mut pen, &rows),
            Page::Keys { .. } => self.draw_keys(&mut pen, &rows),
            Page::Briefing => match self.chosen_job().filter(|_| self.is_briefing_current()) {
                Some(job) => briefing::page(&mut pen, (job, self.job_drawings.get(&job.name)), &rows, self.focus),
                None => waiting(&mut pen, &text!(self.language(), "window-waiting-briefing"), None),
            },
            Page::Results => summary::page(&mut pen, self.ended.as_ref(), &rows, self.focus),
            Page::School => {
                if let Some(shown) = &self.school {
                    school::page(&mut pen, shown, &rows, self.focus);
                }
            }
            Page::Waiting => waiting(&mut pen, &self.waiting_for.title(self.language()), self.loading.as_deref()),
            Page::Opening | Page::Flight => waiting(&mut pen, "Spandrel", None),
        }
        pen.done()
    }

    fn start(&self, pen: &mut PageWriter, rows: &[menu::MenuRow]) {
        let (left, narrow) = (0.04, pen.is_narrow());
        let whole = pen.width - 2.0 * left;
        pen.title((left, 0.08), whole, &text!(self.language(), "window-start-title"));
        let half = if narrow { whole } else { 0.56 * pen.width };
        let bottom = menu::draw_above(pen, (left, 0.145), (half, pen.height - HELP_ROOM), rows, self.focus);
        let help = text!(self.language(), "window-help");
        let bottom = pen.lines((left, bottom + 0.02), half, SMALL_TEXT_SIZE, HudColor::Gray, &help);
        let (x, top) = if narrow { (left, bottom + 0.04) } else { (left + half + 0.06, 0.165) };
        let width = if narrow { whole } else { pen.width - half - left - 0.08 };
        self.explain_choice(pen, (x, top), width);
    }

    /// Draws what the selected values mean, and the picture of the job.
    fn explain_choice(&self, pen: &mut PageWriter, (x, top): (f64, f64), width: f64) {
        let told = self.choice_explanation();
        let text_height = |words: &str| LINE_SPACING * SMALL_TEXT_SIZE * wrap_text(words, width, SMALL_TEXT_SIZE).len() as f64;
        let texts: f64 = told.iter().map(|(.., words)| HEADING_HEIGHT + text_height(words) + BLOCK_GAP).sum();
        // The picture takes the space that the texts leave.
        let room = pen.height - 0.03 - top - texts - BLOCK_GAP;
        let height = room.clamp(PICTURE_HEIGHTS.0, PICTURE_HEIGHTS.1).min(width / job_picture::ASPECT);
        let mut y = top;
        for (topic, head, words) in told {
            pen.text((x, y), TextAlign::Left, fitted(&head, TEXT_SIZE, width), HudColor::Yellow, head);
            y = pen.lines((x, y + HEADING_HEIGHT), width, SMALL_TEXT_SIZE, HudColor::White, &words) + BLOCK_GAP;
            if topic == Topic::Job {
                let place = (x, y - BLOCK_GAP - 0.3 * SMALL_TEXT_SIZE);
                pen.picture_from(PictureSource::Job(self.choice.scenario.clone()), place, (height * job_picture::ASPECT, height));
                y += height + BLOCK_GAP;
            }
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

    /// Checks whether the selected job's briefing is for the selected aircraft.
    pub(super) fn is_briefing_current(&self) -> bool {
        self.chosen_job().is_some_and(|job| job.vehicle == self.choice.vehicle)
    }

    /// Returns the name of the job whose picture or drawings the current page shows.
    #[must_use]
    pub fn job_to_draw(&self) -> Option<&str> {
        matches!(self.page, Page::Start | Page::Briefing).then_some(self.choice.scenario.as_str())
    }

    /// Returns a heading and an explanation for each selected value.
    fn choice_explanation(&self) -> Vec<(Topic, String, String)> {
        let language = self.language();
        let job = self.chosen_job().map_or(String::new(), |job| {
            let contents = format!("{} ({})", job.kind, job.name);
            if job.conditions.is_empty() || !self.is_briefing_current() {
                contents
            } else {
                format!("{contents} · {}", job.conditions)
            }
        });
        let purpose = match self.choice.purpose {
            Purpose::Practice => text!(language, "window-start-about-practice"),
            Purpose::Assessment => text!(language, "window-start-about-assessment"),
        };
        let mut told = vec![
            (Topic::Trainee, text!(language, "window-start-trainee"), self.about_trainee()),
            (Topic::Job, text!(language, "window-start-job"), job),
            (Topic::Purpose, text!(language, "window-start-purpose"), purpose),
        ];
        if let Some(web) = self.offers.as_ref().and_then(|offers| offers.web.as_ref()) {
            told.push((Topic::Web, text!(language, "window-start-web"), web.clone()));
        }
        told
    }

    /// Returns what is known about the selected trainee, as sentences.
    fn about_trainee(&self) -> String {
        let (language, person) = (self.language(), self.trainee_summary());
        let sessions = person.map_or(0, |person| person.sessions);
        let is_named = !self.choice.trainee.is_empty();
        let mut sentences = vec![match sessions {
            _ if !is_named => text!(language, "window-start-enter-name"),
            0 => text!(language, "window-start-no-sessions"),
            count => text!(language, "window-start-sessions", count = count),
        }];
        if is_named && self.needs_tutorial() {
            sentences.push(text!(language, "window-start-tutorial-first"));
        }
        if let Some(last) = person.and_then(|person| person.last.as_ref()) {
            sentences.push(text!(language, "window-start-last-flight", words = last.as_str()));
        }
        if person.and_then(|person| person.next.as_ref()).is_some_and(|next| next.from_last_session) {
            sentences.push(text!(language, "window-start-from-last-session"));
        }
        sentences.join(" ")
    }
}

/// Subject of an explanation on the start page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Topic {
    Trainee,
    Job,
    Purpose,
    Web,
}

/// Room for the help below the menu.
const HELP_ROOM: f64 = 0.105;
/// Height of a heading with its gap, and gap between two blocks.
const HEADING_HEIGHT: f64 = 0.052;
const BLOCK_GAP: f64 = 0.03;
/// Smallest and largest height of the job's picture.
const PICTURE_HEIGHTS: (f64, f64) = (0.12, 0.34);
/// Corners of the window.
const WHOLE_WINDOW: [ScreenPoint; 4] = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];

/// Draws a notice along the bottom of the page, over its content.
fn draw_notice(pen: &mut PageWriter, words: &str) {
    const MARGIN: f64 = 0.04;
    let (width, end) = (pen.width, pen.height - 0.015);
    let lines = wrap_text(words, width - 2.0 * MARGIN, TEXT_SIZE);
    let high = LINE_SPACING * TEXT_SIZE * lines.len() as f64 + 0.025;
    let top = (end - high).max(0.0);
    pen.panel((0.0, top), (width, (end - top).max(0.0)), HudColor::InputField);
    for (k, line) in lines.into_iter().enumerate() {
        let y = top + 0.0125 + LINE_SPACING * TEXT_SIZE * (k as f64 + 0.5);
        if y < end {
            pen.text((0.5 * width, y), TextAlign::Center, TEXT_SIZE, HudColor::Yellow, line);
        }
    }
}

/// Draws what the window waits for, and what is loading meanwhile.
fn waiting(pen: &mut PageWriter, words: &str, loading: Option<&str>) {
    let mut line = |y: f64, size: f64, words: &str| {
        let size = fitted(words, size, pen.width - 0.08);
        pen.text((0.5 * pen.width, y * pen.height), TextAlign::Center, size, HudColor::White, words);
    };
    line(0.45, TITLE_SIZE, words);
    if let Some(words) = loading {
        line(0.55, TEXT_SIZE, words);
    }
}
