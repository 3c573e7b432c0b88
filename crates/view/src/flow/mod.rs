//! State machine of the window, from the start page through the flight to the scores: current page, keys, clicks, and
//! messages to `spandrel train`. It has no side effects: it consumes inputs and messages and produces pages and
//! requests.

mod briefing;
mod controls;
mod menu;
mod names;
mod ordered;
mod page;
mod paused;
pub mod pipe;
mod press;
mod rows;
mod school;
mod scroll;
mod settings;
mod settings_page;
pub mod sheet;
mod start;
mod summary;
#[cfg(test)]
mod tests;
mod tutorial;

pub use controls::ControllerStatus;
pub use menu::{MenuAction, MenuRow, RowKind};
pub use names::{ControlNames, KeyNames};
pub use page::{KeyPress, Page, ProfileChange, WindowRequest};
pub use settings::{KeyFunction, Setting, SettingChange, SettingsStatus};
pub use sheet::{PageLayout, PictureSource};
pub use tutorial::PICTURES;

use crate::arrange::ViewLayout;
use crate::hud::{JobDrawing, ScreenPoint};
use crate::path_guide::PathAids;
use page::PendingOperation;
use pipe::{
    FlightChoice, FlightOptions, FlightStarted, FlightSummary, FlownBy, FromWindow, GhostFlight, Purpose, SchoolPage, ToWindow,
};
use spandrel_text::{Language, text};
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::Arc;

/// Names of the keys that select and activate the rows of a page.
const PAGE_KEYS: [&str; 2] = ["enter", "tab"];

/// State of the window.
#[derive(Debug, Clone)]
pub struct WindowFlow {
    page: Page,
    focus: usize,
    offers: Option<FlightOptions>,
    choice: FlightChoice,
    /// Current state of the controller.
    pub controls: ControllerStatus,
    flying: Option<FlightStarted>,
    ended: Option<FlightSummary>,
    /// Index of the moment that the end page offers to show.
    moment: usize,
    /// Page of the defect school, while it is open.
    school: Option<SchoolPage>,
    notice: Option<String>,
    /// Trainees who have read the tutorial or flown a practice session in this window.
    tutorial_done: BTreeSet<String>,
    names: KeyNames,
    /// The operation in progress.
    waiting_for: PendingOperation,
    /// Words for what is loading meanwhile, if it is known.
    loading: Option<String>,
    /// Whether an instructor has ordered the selected flight.
    ordered: bool,
    /// Layout of the views.
    pub arrangement: ViewLayout,
    /// Layout before the large map.
    before_map: ViewLayout,
    /// Aspect ratio (width over height) of the flight's camera.
    pub camera_aspect: f64,
    /// Time since lift-off, s.
    pub flown_s: f64,
    /// Whether the pause was requested for a restart.
    restart_requested: bool,
    /// Action of the pause page that the next press confirms.
    confirming: Option<MenuAction>,
    /// Whether the last key changed the trainee's name, so that the next one continues it.
    is_name_edited: bool,
    sound: bool,
    settings: SettingsStatus,
    /// Index of the function whose key the user is about to press.
    awaited_key: Option<usize>,
    /// Distance by which the user has scrolled the page, beyond what the focus needs, as a fraction of the window's height.
    scrolled: f64,
    /// Whether the page is scrolled to the focused row: not before the user has moved the focus.
    follows_focus: bool,
    /// Aircraft whose briefings were requested.
    requested_vehicle: Option<String>,
    /// Drawings of the jobs' sites that are ready, by the jobs' names.
    job_drawings: BTreeMap<String, Arc<JobDrawing>>,
    out: VecDeque<WindowRequest>,
}

impl Default for WindowFlow {
    fn default() -> Self {
        Self::new()
    }
}

impl WindowFlow {
    /// Creates the initial state, with default settings.
    #[must_use]
    pub fn new() -> Self {
        Self {
            page: Page::Opening,
            focus: 0,
            offers: None,
            choice: FlightChoice::default(),
            controls: ControllerStatus::default(),
            flying: None,
            ended: None,
            moment: 0,
            school: None,
            notice: None,
            tutorial_done: BTreeSet::new(),
            names: KeyNames::default(),
            waiting_for: PendingOperation::Simulator,
            loading: None,
            ordered: false,
            arrangement: ViewLayout::default(),
            before_map: ViewLayout::default(),
            camera_aspect: 4.0 / 3.0,
            flown_s: 0.0,
            restart_requested: false,
            confirming: None,
            is_name_edited: false,
            sound: true,
            settings: SettingsStatus::default(),
            awaited_key: None,
            scrolled: 0.0,
            follows_focus: false,
            requested_vehicle: None,
            job_drawings: BTreeMap::new(),
            out: VecDeque::new(),
        }
    }

    /// Adds the drawings of a job's site for its briefing.
    pub fn add_job_drawing(&mut self, job: String, drawing: JobDrawing) {
        self.job_drawings.insert(job, Arc::new(drawing));
    }

    /// Creates the state for watching a flight without controlling it; it shows only the flight page.
    #[must_use]
    pub fn watch_only() -> Self {
        Self { page: Page::Flight, ..Self::new() }
    }

    /// Returns the current page.
    #[must_use]
    pub fn page(&self) -> Page {
        self.page
    }

    /// Returns the current selection.
    #[must_use]
    pub fn choice(&self) -> &FlightChoice {
        &self.choice
    }

    /// Checks whether this page tests the flight keys, which then have no other effect.
    #[must_use]
    pub fn is_key_test(&self) -> bool {
        self.page == Page::Controls && !self.controls.is_connected()
    }

    /// Checks whether a key only tests the stick that it moves. Enter and Tab always act on the page, so that it can be left
    /// without a mouse.
    #[must_use]
    pub fn only_tests(&self, key: &str, moves_stick: bool) -> bool {
        self.is_key_test() && moves_stick && !PAGE_KEYS.contains(&key)
    }

    /// Checks whether a dialog is shown over the flight.
    #[must_use]
    pub fn is_dialog_open(&self) -> bool {
        matches!(self.page, Page::Paused | Page::ConfirmEnd)
    }

    /// Checks whether the simulation is paused.
    #[must_use]
    pub fn is_paused(&self) -> bool {
        self.page == Page::Paused || self.settings_origin() == Some(true)
    }

    /// Checks whether the reference paths may be shown.
    #[must_use]
    pub fn shows_map(&self) -> bool {
        self.flying.as_ref().is_none_or(|flying| flying.choice.purpose == Purpose::Practice)
    }

    /// Shows the map large, or the layout before it. `is_enabled` is false if this window shows no map at all.
    pub fn toggle_large_map(&mut self, is_enabled: bool) {
        if self.arrangement == ViewLayout::Map {
            self.leave_large_map();
        } else if !self.shows_map() {
            self.show_notice(text!(self.language(), "window-flight-map-assessment"));
        } else if !is_enabled {
            self.show_notice(text!(self.language(), "window-flight-map-off"));
        } else {
            self.before_map = std::mem::replace(&mut self.arrangement, ViewLayout::Map);
        }
    }

    /// Shows the layout before the large map.
    pub fn leave_large_map(&mut self) {
        if self.arrangement == ViewLayout::Map {
            self.arrangement = self.before_map;
        }
    }

    /// Returns how much of the path is drawn into the pictures: nothing in an assessment, and less for better pilots.
    #[must_use]
    pub fn path_aids(&self) -> PathAids {
        match &self.flying {
            Some(flying) if flying.choice.purpose == Purpose::Assessment => PathAids::None,
            Some(flying) => flying.path_aids,
            None => PathAids::Full,
        }
    }

    /// Returns the earlier flight that a ghost may repeat; `None` in an assessment.
    #[must_use]
    pub fn ghost(&self) -> Option<&GhostFlight> {
        self.flying.as_ref().filter(|flying| flying.choice.purpose == Purpose::Practice)?.ghost.as_ref()
    }

    /// Explains why there is no ghost.
    pub fn explain_missing_ghost(&mut self) {
        let language = self.language();
        let words = match &self.flying {
            Some(flying) if flying.choice.purpose == Purpose::Assessment => text!(language, "window-flight-ghost-assessment"),
            Some(flying) if flying.choice.by == FlownBy::Expert => text!(language, "window-flight-ghost-expert"),
            Some(flying) if flying.is_ghost_outdated => text!(language, "window-flight-ghost-changed"),
            Some(_) => text!(language, "window-flight-ghost-not-ready"),
            None => text!(language, "window-flight-ghost-no-session"),
        };
        self.show_notice(words);
    }

    /// Returns the language of all texts.
    #[must_use]
    pub fn language(&self) -> Language {
        self.style().language
    }

    /// Returns the display names of the keys.
    #[must_use]
    pub fn key_names(&self) -> &KeyNames {
        &self.names
    }

    /// Returns the names of what the trainee flies with.
    #[must_use]
    pub fn control_names(&self) -> ControlNames<'_> {
        ControlNames::new(&self.names, &self.controls, self.language())
    }

    /// Returns the current notice for the user; the next key or click clears it.
    #[must_use]
    pub fn notice(&self) -> Option<&str> {
        self.notice.as_deref()
    }

    /// Shows a notice, such as an error.
    pub fn show_notice(&mut self, words: String) {
        self.notice = Some(words);
    }

    /// Returns the notice and clears it, so that it can be shown elsewhere.
    pub fn take_notice(&mut self) -> Option<String> {
        self.notice.take()
    }

    /// Returns the next pending request.
    pub fn poll(&mut self) -> Option<WindowRequest> {
        self.out.pop_front()
    }

    fn show_page(&mut self, page: Page) {
        (self.page, self.focus) = (page, 0);
        (self.scrolled, self.follows_focus, self.awaited_key) = (0.0, false, None);
        self.confirming = None;
    }

    fn send(&mut self, message: FromWindow) {
        self.out.push_back(WindowRequest::Send(message));
    }

    /// Updates the controller's state. When the wizard ends, returns to the controller page.
    pub fn update_controls(&mut self, controls: ControllerStatus) {
        let wizard = controls.wizard.is_some();
        self.controls = controls;
        match self.page {
            Page::Controls if wizard => self.show_page(Page::Calibrating),
            Page::Calibrating if !wizard => self.show_page(Page::Controls),
            Page::Opening
            | Page::Start
            | Page::Controls
            | Page::Calibrating
            | Page::Tutorial(..)
            | Page::Settings { .. }
            | Page::Keys { .. }
            | Page::Briefing
            | Page::Waiting
            | Page::Flight
            | Page::Paused
            | Page::ConfirmEnd
            | Page::Results
            | Page::School => {}
        }
        // Disconnecting a device removes rows from the page.
        self.focus = self.focus.min(self.rows().len().saturating_sub(1));
    }

    /// Handles a message from `spandrel train`.
    pub fn handle_message(&mut self, message: ToWindow) {
        self.handle_message_on_page(message);
        self.request_briefings();
    }

    fn handle_message_on_page(&mut self, message: ToWindow) {
        match message {
            ToWindow::Offers(offers) => {
                if self.offers.is_none() {
                    self.choice = offers.choice.clone();
                }
                self.offers = Some(offers);
                self.requested_vehicle = None;
                if self.page == Page::Opening {
                    self.show_page(Page::Start);
                }
            }
            ToWindow::Ordered(order) => self.begin_ordered(order),
            ToWindow::Briefing => self.brief(),
            ToWindow::Flying(flying) => {
                // After an expert's flight, the trainee's own choice is still selected.
                if flying.choice.by == FlownBy::Trainee {
                    self.choice = flying.choice.clone();
                }
                self.ended = None;
                self.notice = None;
                self.leave_large_map();
                (self.restart_requested, self.ordered, self.flown_s) = (false, false, 0.0);
                self.flying = Some(flying.clone());
                self.out.push_back(WindowRequest::ShowFlight(Box::new(flying)));
                self.show_page(Page::Flight);
            }
            ToWindow::Paused { on: true } if self.page == Page::Flight => {
                self.show_page(Page::Paused);
                if std::mem::take(&mut self.restart_requested) {
                    self.ask_to_restart();
                }
            }
            ToWindow::Paused { on: false } if self.is_paused() => self.show_page(Page::Flight),
            ToWindow::Paused { .. } => {}
            ToWindow::Refused { words } => {
                self.notice = Some(words);
                if self.page == Page::Waiting {
                    self.show_page(Page::Start);
                }
            }
            ToWindow::Ghost(ghost) => {
                if let Some(flying) = &mut self.flying {
                    self.out.push_back(WindowRequest::LoadGhost(ghost.telemetry.clone()));
                    flying.ghost = Some(ghost);
                }
            }
            ToWindow::Ended(ended) => {
                (self.ended, self.moment) = (Some(ended), 0);
                if let Some(flown) = self
                    .flying
                    .take()
                    .filter(|flown| flown.choice.purpose == Purpose::Practice && flown.choice.by == FlownBy::Trainee)
                {
                    self.tutorial_done.insert(flown.choice.trainee);
                }
                self.out.push_back(WindowRequest::LeaveFlight);
                self.show_page(Page::Results);
            }
            // A page that arrives after the user has left the school is dropped.
            ToWindow::School(shown) if matches!(self.page, Page::Waiting | Page::School) => {
                self.school = Some(shown);
                self.show_page(Page::School);
            }
            ToWindow::School(_) => {}
            ToWindow::OpenPage { address } => self.out.push_back(WindowRequest::Open(address)),
            ToWindow::Loading { words } => self.loading = Some(words),
        }
    }

    /// Handles the pause key or button. In an assessment, it asks whether to end the session.
    pub fn pause(&mut self) {
        match (self.page, &self.flying) {
            (Page::Paused, _) => self.send(FromWindow::Resume),
            (Page::Flight, Some(flying)) if flying.choice.purpose == Purpose::Practice => self.send(FromWindow::Pause),
            (Page::Flight, Some(_)) => self.show_page(Page::ConfirmEnd),
            (Page::ConfirmEnd, _) => self.show_page(Page::Flight),
            _ => {}
        }
    }

    /// Selects the restart on the pause page; the next press confirms it.
    fn ask_to_restart(&mut self) {
        self.focus = self.rows().iter().position(|row| row.action == MenuAction::Restart).unwrap_or_default();
        self.confirming = Some(MenuAction::Restart);
    }

    /// Handles the restart key: pauses and asks for confirmation, which a second press gives.
    pub fn restart(&mut self) {
        match (self.page, &self.flying) {
            (Page::Flight, Some(flying)) if flying.choice.purpose == Purpose::Practice => {
                self.restart_requested = true;
                self.send(FromWindow::Pause);
            }
            (Page::Flight, Some(_)) => self.notice = Some(text!(self.language(), "window-paused-no-restart")),
            (Page::Paused, _) if self.confirming == Some(MenuAction::Restart) => self.press(KeyPress::Enter),
            (Page::Paused, _) => self.ask_to_restart(),
            _ => {}
        }
    }

    /// Handles a click at a position, given in fractions of the window, in a window with the given aspect ratio.
    /// Returns whether the click hit a control.
    pub fn click(&mut self, place: ScreenPoint, aspect: f64) -> bool {
        // The last item drawn is on top.
        let spots = self.sheet(aspect).click_areas;
        let Some(spot) = spots.iter().rev().find(|spot| spot.contains(place)) else { return false };
        if self.page == Page::Flight {
            self.pause();
        } else {
            self.press(spot.press);
        }
        true
    }

    /// Turns sound on or off.
    pub fn toggle_sound(&mut self) {
        self.sound = !self.sound;
        self.out.push_back(WindowRequest::Sound(self.sound));
    }
}
