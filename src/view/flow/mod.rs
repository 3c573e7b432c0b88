//! From a choice to a flight and its scores: which page the window shows, what its keys and clicks do there, and what is told to `train`.
//! Pure: presses and messages in, pages and orders out.

mod controls;
mod menu;
mod over;
mod paused;
pub mod pipe;
mod rows;
pub mod sheet;
mod start;
#[cfg(test)]
mod tests;
mod tutorial;

pub use controls::Controls;
pub use menu::{Deed, Kind, Row};
pub use sheet::Sheet;
pub use tutorial::PICTURES;

use crate::view::hud::Point;
use pipe::{Choice, Ended, Flying, FromWindow, Offers, Purpose, ToWindow};
use std::collections::VecDeque;

/// Most signs of a pseudonym, as everywhere.
const NAME_MAX: usize = 32;
/// Steps of dead band and expo.
const FINE: f64 = 0.01;
const COARSE: f64 = 0.1;

/// What a person did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Press {
    /// One row up.
    Up,
    /// One row down.
    Down,
    /// The value before.
    Left,
    /// The next value.
    Right,
    /// Do it.
    Enter,
    /// Back, or on, whatever is harmless.
    Escape,
    /// Without the last sign.
    Backspace,
    /// A sign was typed.
    Sign(char),
    /// A row was clicked.
    Row(usize),
    /// An arrow beside a row's value was clicked: back, or on.
    Step(usize, bool),
}

/// What is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Page {
    /// Nothing is known yet.
    Opening,
    /// Who flies what.
    Start,
    /// The controller is tried.
    Controls,
    /// And calibrated.
    Calibrating,
    /// So many pages of the tutorial have been turned; whether a flight follows.
    Tutorial(usize, bool),
    /// The simulator starts.
    Waiting,
    /// The flight itself.
    Flight,
    /// It stands still.
    Paused,
    /// Scores.
    Over,
}

/// What the window is to do.
#[derive(Debug, Clone, PartialEq)]
pub enum Order {
    /// Say this to `train`.
    Tell(FromWindow),
    /// Show this flight.
    Fly(Box<Flying>),
    /// Let go of the flight.
    Land,
    /// Look for a controller again.
    Look,
    /// Begin to calibrate.
    Calibrate,
    /// The wizard's Enter.
    Confirm,
    /// Leave the wizard.
    Cancel,
    /// Change and keep the profile: stick mode, dead band, expo.
    Profile(i64, f64, f64),
    /// Show an address in a browser.
    Open(String),
    /// Sound on or off.
    Sound(bool),
    /// Close the window.
    Close,
}

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
    taught: bool,
    /// The pause was asked for to begin anew.
    anew: bool,
    sound: bool,
    out: VecDeque<Order>,
}

impl Flow {
    /// Nothing is known yet. `sound`: it is on.
    #[must_use]
    pub fn new(sound: bool) -> Self {
        Self {
            page: Page::Opening,
            focus: 0,
            offers: None,
            choice: Choice { trainee: String::new(), scenario: String::new(), purpose: Purpose::Practice },
            controls: Controls::default(),
            flying: None,
            ended: None,
            words: None,
            taught: false,
            anew: false,
            sound,
            out: VecDeque::new(),
        }
    }

    /// A flight that is watched without anybody who leads it: no page but the flight.
    #[must_use]
    pub fn watching(sound: bool) -> Self {
        Self { page: Page::Flight, ..Self::new(sound) }
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
                self.flying = None;
                self.taught = true;
                self.out.push_back(Order::Land);
                self.go(Page::Over);
            }
        }
    }

    /// The key or the button for a pause was pressed.
    pub fn pause(&mut self) {
        match (self.page, &self.flying) {
            (Page::Paused, _) => self.tell(FromWindow::Resume),
            (Page::Flight, Some(flying)) if flying.choice.purpose == Purpose::Practice => self.tell(FromWindow::Pause),
            (Page::Flight, Some(_)) => self.words = Some("An assessment is flown through: it is not paused.".into()),
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

    /// A key or a click on a page.
    pub fn press(&mut self, press: Press) {
        self.words = None;
        let rows = self.rows();
        let last = rows.len().saturating_sub(1);
        let kind = rows.get(self.focus).map(|row| row.kind);
        match press {
            Press::Up => self.focus = if self.focus == 0 { last } else { self.focus - 1 },
            Press::Down => self.focus = if self.focus >= last { 0 } else { self.focus + 1 },
            Press::Left if kind == Some(Kind::Button) => self.back(),
            Press::Right if kind == Some(Kind::Button) => self.activate(&rows),
            Press::Left => self.step(&rows, false),
            Press::Right => self.step(&rows, true),
            Press::Enter => self.activate(&rows),
            Press::Escape => self.back(),
            Press::Backspace if kind == Some(Kind::Typed) => {
                self.choice.trainee.pop();
            }
            Press::Sign(sign) if kind == Some(Kind::Typed) => self.typed(sign),
            Press::Backspace | Press::Sign(_) => {}
            Press::Row(row) if row < rows.len() => {
                self.focus = row;
                if rows[row].kind == Kind::Button {
                    self.activate(&rows);
                }
            }
            Press::Step(row, on) if row < rows.len() => {
                self.focus = row;
                self.step(&rows, on);
            }
            Press::Row(_) | Press::Step(..) => {}
        }
    }

    fn typed(&mut self, sign: char) {
        let fits = sign.is_ascii_alphanumeric() || (!self.choice.trainee.is_empty() && (sign == '-' || sign == '_'));
        if !fits {
            self.words = Some("A pseudonym has letters, digits, '-' and '_', and begins with a letter or a digit.".into());
        } else if self.choice.trainee.len() >= NAME_MAX {
            self.words = Some(format!("A pseudonym has at most {NAME_MAX} signs."));
        } else {
            self.choice.trainee.push(sign);
        }
    }

    fn step(&mut self, rows: &[Row], on: bool) {
        let Some(row) = rows.get(self.focus) else { return };
        let way = if on { 1.0 } else { -1.0 };
        let Controls { mode, dead_band, expo, .. } = self.controls;
        match row.deed {
            Deed::Trainee => self.next_trainee(on),
            Deed::Scenario => self.next_scenario(on),
            Deed::Purpose => {
                self.choice.purpose = match self.choice.purpose {
                    Purpose::Practice => Purpose::Assessment,
                    Purpose::Assessment => Purpose::Practice,
                };
            }
            Deed::Mode => {
                let mode = (mode - 1 + if on { 1 } else { 3 }) % 4 + 1;
                self.out.push_back(Order::Profile(mode, dead_band, expo));
            }
            Deed::DeadBand => {
                let dead_band = (dead_band + FINE * way).clamp(0.0, 0.5);
                self.out.push_back(Order::Profile(mode, dead_band, expo));
            }
            Deed::Expo => {
                let expo = (expo + COARSE * way).clamp(0.0, 1.0);
                self.out.push_back(Order::Profile(mode, dead_band, expo));
            }
            _ => {}
        }
    }

    fn next_trainee(&mut self, on: bool) {
        let Some(offers) = &self.offers else { return };
        let names: Vec<&str> = offers.trainees.iter().map(|person| person.name.as_str()).collect();
        if let Some(name) = neighbour(&names, &self.choice.trainee, on) {
            self.choice.trainee = name.to_owned();
        }
    }

    fn next_scenario(&mut self, on: bool) {
        let Some(offers) = &self.offers else { return };
        let names: Vec<&str> = offers.scenarios.iter().map(|job| job.name.as_str()).collect();
        if let Some(name) = neighbour(&names, &self.choice.scenario, on) {
            self.choice.scenario = name.to_owned();
        }
    }

    /// Whoever has never flown here reads the tutorial before the first practice.
    fn is_new(&self) -> bool {
        let flown = |offers: &Offers| offers.trainees.iter().any(|p| p.name == self.choice.trainee && p.sessions > 0);
        !self.taught && self.choice.purpose == Purpose::Practice && !self.offers.as_ref().is_some_and(flown)
    }

    fn activate(&mut self, rows: &[Row]) {
        let Some(row) = rows.get(self.focus) else { return };
        match row.deed {
            Deed::Trainee | Deed::Scenario | Deed::Purpose | Deed::Mode | Deed::DeadBand | Deed::Expo => {
                self.focus = (self.focus + 1).min(rows.len().saturating_sub(1));
            }
            Deed::Check if self.choice.trainee.is_empty() => self.words = Some("Type a pseudonym first.".into()),
            Deed::Check => self.go(Page::Controls),
            Deed::Learn => self.go(Page::Tutorial(0, false)),
            Deed::Sound => self.toggle_sound(),
            Deed::Look => self.out.push_back(Order::Look),
            Deed::Calibrate => self.out.push_back(Order::Calibrate),
            Deed::Fly if self.is_new() => self.go(Page::Tutorial(0, true)),
            Deed::Fly => self.choose(),
            Deed::Back => self.back(),
            Deed::Next => self.turn(),
            Deed::Skip => self.taught_enough(),
            Deed::Confirm => self.out.push_back(Order::Confirm),
            Deed::Cancel => self.out.push_back(Order::Cancel),
            Deed::Resume => self.tell(FromWindow::Resume),
            Deed::Restart => {
                self.leave();
                self.tell(FromWindow::Restart);
            }
            Deed::End => {
                self.leave();
                self.tell(FromWindow::End);
            }
            Deed::Again => {
                self.leave();
                self.tell(FromWindow::Again);
            }
            Deed::Other => self.go(Page::Start),
            Deed::Report => self.open(|ended| ended.report.clone()),
            Deed::Questions => self.open(|ended| Some(ended.questionnaire.clone())),
            Deed::Quit => {
                self.tell(FromWindow::Quit);
                self.out.push_back(Order::Close);
            }
        }
    }

    /// The simulator works at what comes next.
    fn leave(&mut self) {
        self.out.push_back(Order::Land);
        self.go(Page::Waiting);
    }

    fn choose(&mut self) {
        self.tell(FromWindow::Chosen(self.choice.clone()));
        self.go(Page::Waiting);
    }

    fn turn(&mut self) {
        if let Page::Tutorial(page, flight) = self.page {
            if page + 1 < tutorial::PAGES {
                self.go(Page::Tutorial(page + 1, flight));
            } else {
                self.taught_enough();
            }
        }
    }

    fn taught_enough(&mut self) {
        self.taught = true;
        match self.page {
            Page::Tutorial(_, true) => self.choose(),
            _ => self.go(Page::Start),
        }
    }

    fn open(&mut self, address: impl Fn(&Ended) -> Option<String>) {
        if let Some(address) = self.ended.as_ref().and_then(address) {
            self.out.push_back(Order::Open(address));
        }
    }

    fn back(&mut self) {
        match self.page {
            Page::Controls | Page::Tutorial(0, false) => self.go(Page::Start),
            Page::Tutorial(0, true) => self.go(Page::Controls),
            Page::Tutorial(page, flight) => self.go(Page::Tutorial(page - 1, flight)),
            Page::Calibrating => self.out.push_back(Order::Cancel),
            Page::Paused => self.tell(FromWindow::Resume),
            Page::Opening | Page::Start | Page::Waiting | Page::Flight | Page::Over => {}
        }
    }
}

/// The name beside this one, round the end; the first for a name that is not among them.
fn neighbour<'a>(names: &[&'a str], name: &str, on: bool) -> Option<&'a str> {
    let count = names.len();
    let at = names.iter().position(|known| *known == name);
    let next = match (at, on) {
        (None, _) => 0,
        (Some(at), true) => (at + 1) % count,
        (Some(at), false) => (at + count - 1) % count,
    };
    names.get(next).copied()
}
