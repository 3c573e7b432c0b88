//! A flight that an instructor has ordered at this station. The window leads to it as to a chosen one: controller check, tutorial
//! if necessary, and the briefing, which the trainee acknowledges.

use super::page::PendingOperation;
use super::pipe::{FromWindow, JobOffer, OrderedFlight, SchoolRequest};
use super::{Page, WindowFlow, WindowRequest};
use spandrel_text::text;

impl WindowFlow {
    /// Leaves the current page and begins with the controller check of an ordered flight.
    pub(super) fn begin_ordered(&mut self, order: OrderedFlight) {
        self.leave_for_order();
        let OrderedFlight { choice, job } = order;
        let (language, title) = (self.language(), job.title.clone());
        self.add_job(job);
        let (trainee, purpose) = (choice.trainee.as_str(), choice.purpose.title(language));
        self.notice = Some(text!(language, "window-ordered", trainee = trainee, job = title, purpose = purpose));
        (self.choice, self.ordered) = (choice, true);
        self.show_page(Page::Controls);
    }

    /// Ends what is in progress on the current page.
    fn leave_for_order(&mut self) {
        match self.page {
            Page::Calibrating => self.out.push_back(WindowRequest::Cancel),
            Page::School => self.end_school(),
            Page::Waiting if self.waiting_for == PendingOperation::Pictures => self.end_school(),
            Page::Opening
            | Page::Start
            | Page::Controls
            | Page::Tutorial(..)
            | Page::Settings { .. }
            | Page::Keys { .. }
            | Page::Briefing
            | Page::Waiting
            | Page::Flight
            | Page::Paused
            | Page::ConfirmEnd
            | Page::Results => {}
        }
    }

    pub(super) fn end_school(&mut self) {
        self.school = None;
        self.send(FromWindow::School(SchoolRequest::Leave));
    }

    /// Adds a job to the offers, in place of one with the same name.
    fn add_job(&mut self, job: JobOffer) {
        if let Some(offers) = &mut self.offers {
            offers.scenarios.retain(|other| other.name != job.name);
            offers.scenarios.push(job);
        }
    }

    /// Declines the ordered flight, if there is one, because the trainee has left its pages.
    pub(super) fn decline_order(&mut self) {
        if std::mem::take(&mut self.ordered) {
            self.send(FromWindow::Declined);
            self.notice = Some(text!(self.language(), "window-ordered-declined"));
        }
    }
}
