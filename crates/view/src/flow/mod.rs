//! From a choice to a flight and its scores: which page the window shows, what its keys and clicks do there, and what is told to `train`.
//! Pure: presses and messages in, pages and orders out.

mod controls;
mod menu;
mod names;
mod page;
mod paused;
pub mod pipe;
mod press;
mod rows;
pub mod sheet;
mod start;
mod summary;
#[cfg(test)]
mod tests;
mod tutorial;

pub use controls::ControllerStatus;
pub use menu::{MenuAction, MenuRow, RowKind};
pub use names::KeyNames;
pub use page::{KeyPress, Page, ProfileChange, WindowRequest};
pub use sheet::PageLayout;
pub use tutorial::PICTURES;

use crate::arrange::ViewLayout;
use crate::hud::ScreenPoint;
use pipe::{FlightChoice, FlightOptions, FlightStarted, FlightSummary, FromWindow, Purpose, ToWindow};
use std::collections::{BTreeSet, VecDeque};

/// Where the window stands.
#[derive(Debug, Clone)]
pub struct WindowFlow {
    page: Page,
    focus: usize,
    offers: Option<FlightOptions>,
    choice: FlightChoice,
    /// The controller as it stands.
    pub controls: ControllerStatus,
    flying: Option<FlightStarted>,
    ended: Option<FlightSummary>,
    notice: Option<String>,
    /// Who has read the tutorial, or flown a practice, in this window.
    tutorial_done: BTreeSet<String>,
    names: KeyNames,
    /// What is waited for.
    waiting_for: &'static str,
    /// How the views share the window.
    pub arrangement: ViewLayout,
    /// The pause was asked for to begin anew.
    restart_requested: bool,
    sound: bool,
    out: VecDeque<WindowRequest>,
}

impl WindowFlow {
    /// Nothing is known yet. `sound`: it is on; `names`: of the keys.
    #[must_use]
    pub fn new(sound: bool, names: KeyNames) -> Self {
        Self {
            page: Page::Opening,
            focus: 0,
            offers: None,
            choice: FlightChoice { trainee: String::new(), scenario: String::new(), purpose: Purpose::Practice },
            controls: ControllerStatus::default(),
            flying: None,
            ended: None,
            notice: None,
            tutorial_done: BTreeSet::new(),
            names,
            waiting_for: "",
            arrangement: ViewLayout::default(),
            restart_requested: false,
            sound,
            out: VecDeque::new(),
        }
    }

    /// A flight that is watched without anybody who leads it: no page but the flight.
    #[must_use]
    pub fn watch_only(sound: bool, names: KeyNames) -> Self {
        Self { page: Page::Flight, ..Self::new(sound, names) }
    }

    /// What is shown.
    #[must_use]
    pub fn page(&self) -> Page {
        self.page
    }

    /// The choice as it stands.
    #[must_use]
    pub fn choice(&self) -> &FlightChoice {
        &self.choice
    }

    /// The keys that fly are tried: they do nothing else on this page.
    #[must_use]
    pub fn is_key_test(&self) -> bool {
        self.page == Page::Controls && !self.controls.is_connected()
    }

    /// The flight is seen under a question about it.
    #[must_use]
    pub fn is_asking(&self) -> bool {
        matches!(self.page, Page::Paused | Page::Leaving)
    }

    /// Time stands still.
    #[must_use]
    pub fn is_paused(&self) -> bool {
        self.page == Page::Paused
    }

    /// The reference paths may be shown.
    #[must_use]
    pub fn shows_map(&self) -> bool {
        self.flying.as_ref().is_none_or(|flying| flying.choice.purpose == Purpose::Practice)
    }

    /// Words for the person, until the next press.
    #[must_use]
    pub fn notice(&self) -> Option<&str> {
        self.notice.as_deref()
    }

    /// Something went otherwise than was wished.
    pub fn show_notice(&mut self, words: String) {
        self.notice = Some(words);
    }

    /// Words that are told elsewhere.
    pub fn take_notice(&mut self) -> Option<String> {
        self.notice.take()
    }

    /// The next thing to do.
    pub fn poll(&mut self) -> Option<WindowRequest> {
        self.out.pop_front()
    }

    fn show_page(&mut self, page: Page) {
        (self.page, self.focus) = (page, 0);
    }

    fn send(&mut self, message: FromWindow) {
        self.out.push_back(WindowRequest::Tell(message));
    }

    /// The controller as it stands now. A wizard that has ended leads back to the controller.
    pub fn update_controls(&mut self, controls: ControllerStatus) {
        let wizard = controls.wizard.is_some();
        self.controls = controls;
        match self.page {
            Page::Controls if wizard => self.show_page(Page::Calibrating),
            Page::Calibrating if !wizard => self.show_page(Page::Controls),
            _ => {}
        }
        // A device that has gone takes rows with it.
        self.focus = self.focus.min(self.rows().len().saturating_sub(1));
    }

    /// `train` says something.
    pub fn handle_message(&mut self, message: ToWindow) {
        match message {
            ToWindow::Offers(offers) => {
                if self.offers.is_none() {
                    self.choice = offers.choice.clone();
                }
                self.offers = Some(offers);
                if self.page == Page::Opening {
                    self.show_page(Page::Start);
                }
            }
            ToWindow::Flying(flying) => {
                self.choice = flying.choice.clone();
                self.ended = None;
                self.notice = None;
                self.restart_requested = false;
                self.flying = Some(flying.clone());
                self.out.push_back(WindowRequest::Fly(Box::new(flying)));
                self.show_page(Page::Flight);
            }
            ToWindow::Paused { on: true } if self.page == Page::Flight => {
                self.show_page(Page::Paused);
                self.focus = usize::from(std::mem::take(&mut self.restart_requested));
            }
            ToWindow::Paused { on: false } if self.page == Page::Paused => self.show_page(Page::Flight),
            ToWindow::Paused { .. } => {}
            ToWindow::Refused { words } => {
                self.notice = Some(words);
                if self.page == Page::Waiting {
                    self.show_page(Page::Start);
                }
            }
            ToWindow::Ended(ended) => {
                self.ended = Some(ended);
                if let Some(flown) = self.flying.take().filter(|flown| flown.choice.purpose == Purpose::Practice) {
                    self.tutorial_done.insert(flown.choice.trainee);
                }
                self.out.push_back(WindowRequest::Land);
                self.show_page(Page::Over);
            }
        }
    }

    /// The key or the button for a pause was pressed: an assessment is asked whether it is to end.
    pub fn pause(&mut self) {
        match (self.page, &self.flying) {
            (Page::Paused, _) => self.send(FromWindow::Resume),
            (Page::Flight, Some(flying)) if flying.choice.purpose == Purpose::Practice => self.send(FromWindow::Pause),
            (Page::Flight, Some(_)) => self.show_page(Page::Leaving),
            (Page::Leaving, _) => self.show_page(Page::Flight),
            _ => {}
        }
    }

    /// The key for beginning anew was pressed: asked once more, on the page of the pause.
    pub fn restart(&mut self) {
        match (self.page, &self.flying) {
            (Page::Flight, Some(flying)) if flying.choice.purpose == Purpose::Practice => {
                self.restart_requested = true;
                self.send(FromWindow::Pause);
            }
            (Page::Flight, Some(_)) => self.notice = Some("An assessment is flown through: it does not begin anew.".into()),
            (Page::Paused, _) => self.focus = 1,
            _ => {}
        }
    }

    /// A click at a place of a window of this aspect, shares to the right and down; true when something lies there.
    pub fn click(&mut self, place: ScreenPoint, aspect: f64) -> bool {
        // What was drawn last lies on top.
        let spots = self.sheet(aspect).spots;
        let Some(spot) = spots.iter().rev().find(|spot| spot.holds(place)) else { return false };
        if self.page == Page::Flight {
            self.pause();
        } else {
            self.press(spot.press);
        }
        true
    }

    /// Sound on or off.
    pub fn toggle_sound(&mut self) {
        self.sound = !self.sound;
        self.out.push_back(WindowRequest::Sound(self.sound));
    }
}
