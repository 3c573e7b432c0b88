//! From a choice to a flight and its scores: which page the window shows, what its keys and clicks do there, and what is told to `train`.
//! Pure: presses and messages in, pages and orders out.

mod controls;
mod menu;
mod names;
mod over;
mod page;
mod paused;
pub mod pipe;
mod press;
mod rows;
pub mod sheet;
mod start;
#[cfg(test)]
mod tests;
mod tutorial;

pub use controls::Controls;
pub use menu::{Deed, Kind, Row};
pub use names::Names;
pub use page::{Order, Page, Press, Tune};
pub use sheet::Sheet;
pub use tutorial::PICTURES;

use crate::arrange::Arrangement;
use crate::hud::Point;
use pipe::{Choice, Ended, Flying, FromWindow, Offers, Purpose, ToWindow};
use std::collections::{BTreeSet, VecDeque};

/// Where the window stands.
#[derive(Debug, Clone)]
pub struct Flow {
    page: Page,
    focus: usize,
    offers: Option<Offers>,
    choice: Choice,
    /// The controller as it stands.
    pub controls: Controls,
    flying: Option<Flying>,
    ended: Option<Ended>,
    words: Option<String>,
    /// Who has read the tutorial, or flown a practice, in this window.
    taught: BTreeSet<String>,
    names: Names,
    /// What is waited for.
    awaited: &'static str,
    /// How the views share the window.
    pub arrangement: Arrangement,
    /// The pause was asked for to begin anew.
    anew: bool,
    sound: bool,
    out: VecDeque<Order>,
}

impl Flow {
    /// Nothing is known yet. `sound`: it is on; `names`: of the keys.
    #[must_use]
    pub fn new(sound: bool, names: Names) -> Self {
        Self {
            page: Page::Opening,
            focus: 0,
            offers: None,
            choice: Choice { trainee: String::new(), scenario: String::new(), purpose: Purpose::Practice },
            controls: Controls::default(),
            flying: None,
            ended: None,
            words: None,
            taught: BTreeSet::new(),
            names,
            awaited: "",
            arrangement: Arrangement::default(),
            anew: false,
            sound,
            out: VecDeque::new(),
        }
    }

    /// A flight that is watched without anybody who leads it: no page but the flight.
    #[must_use]
    pub fn watching(sound: bool, names: Names) -> Self {
        Self { page: Page::Flight, ..Self::new(sound, names) }
    }

    /// What is shown.
    #[must_use]
    pub fn page(&self) -> Page {
        self.page
    }

    /// The choice as it stands.
    #[must_use]
    pub fn choice(&self) -> &Choice {
        &self.choice
    }

    /// The keys that fly are tried: they do nothing else on this page.
    #[must_use]
    pub fn tries_keys(&self) -> bool {
        self.page == Page::Controls && !self.controls.is_there()
    }

    /// The flight is seen under a question about it.
    #[must_use]
    pub fn asks(&self) -> bool {
        matches!(self.page, Page::Paused | Page::Leaving)
    }

    /// Time stands still.
    #[must_use]
    pub fn stands(&self) -> bool {
        self.page == Page::Paused
    }

    /// The reference paths may be shown.
    #[must_use]
    pub fn map(&self) -> bool {
        self.flying.as_ref().is_none_or(|flying| flying.choice.purpose == Purpose::Practice)
    }

    /// Words for the person, until the next press.
    #[must_use]
    pub fn words(&self) -> Option<&str> {
        self.words.as_deref()
    }

    /// Something went otherwise than was wished.
    pub fn note(&mut self, words: String) {
        self.words = Some(words);
    }

    /// Words that are told elsewhere.
    pub fn take_words(&mut self) -> Option<String> {
        self.words.take()
    }

    /// The next thing to do.
    pub fn poll(&mut self) -> Option<Order> {
        self.out.pop_front()
    }

    fn go(&mut self, page: Page) {
        (self.page, self.focus) = (page, 0);
    }

    fn tell(&mut self, message: FromWindow) {
        self.out.push_back(Order::Tell(message));
    }

    /// The controller as it stands now. A wizard that has ended leads back to the controller.
    pub fn look(&mut self, controls: Controls) {
        let wizard = controls.wizard.is_some();
        self.controls = controls;
        match self.page {
            Page::Controls if wizard => self.go(Page::Calibrating),
            Page::Calibrating if !wizard => self.go(Page::Controls),
            _ => {}
        }
        // A device that has gone takes rows with it.
        self.focus = self.focus.min(self.rows().len().saturating_sub(1));
    }

    /// `train` says something.
    pub fn hear(&mut self, message: ToWindow) {
        match message {
            ToWindow::Offers(offers) => {
                if self.offers.is_none() {
                    self.choice = offers.choice.clone();
                }
                self.offers = Some(offers);
                if self.page == Page::Opening {
                    self.go(Page::Start);
                }
            }
            ToWindow::Flying(flying) => {
                self.choice = flying.choice.clone();
                self.ended = None;
                self.words = None;
                self.anew = false;
                self.flying = Some(flying.clone());
                self.out.push_back(Order::Fly(Box::new(flying)));
                self.go(Page::Flight);
            }
            ToWindow::Paused { on: true } if self.page == Page::Flight => {
                self.go(Page::Paused);
                self.focus = usize::from(std::mem::take(&mut self.anew));
            }
            ToWindow::Paused { on: false } if self.page == Page::Paused => self.go(Page::Flight),
            ToWindow::Paused { .. } => {}
            ToWindow::Refused { words } => {
                self.words = Some(words);
                if self.page == Page::Waiting {
                    self.go(Page::Start);
                }
            }
            ToWindow::Ended(ended) => {
                self.ended = Some(ended);
                if let Some(flown) = self.flying.take().filter(|flown| flown.choice.purpose == Purpose::Practice) {
                    self.taught.insert(flown.choice.trainee);
                }
                self.out.push_back(Order::Land);
                self.go(Page::Over);
            }
        }
    }

    /// The key or the button for a pause was pressed: an assessment is asked whether it is to end.
    pub fn pause(&mut self) {
        match (self.page, &self.flying) {
            (Page::Paused, _) => self.tell(FromWindow::Resume),
            (Page::Flight, Some(flying)) if flying.choice.purpose == Purpose::Practice => self.tell(FromWindow::Pause),
            (Page::Flight, Some(_)) => self.go(Page::Leaving),
            (Page::Leaving, _) => self.go(Page::Flight),
            _ => {}
        }
    }

    /// The key for beginning anew was pressed: asked once more, on the page of the pause.
    pub fn restart(&mut self) {
        match (self.page, &self.flying) {
            (Page::Flight, Some(flying)) if flying.choice.purpose == Purpose::Practice => {
                self.anew = true;
                self.tell(FromWindow::Pause);
            }
            (Page::Flight, Some(_)) => self.words = Some("An assessment is flown through: it does not begin anew.".into()),
            (Page::Paused, _) => self.focus = 1,
            _ => {}
        }
    }

    /// A click at a place of a window of this aspect, shares to the right and down; true when something lies there.
    pub fn click(&mut self, place: Point, aspect: f64) -> bool {
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
        self.out.push_back(Order::Sound(self.sound));
    }
}
