//! Handles key presses and clicks on a page.

use super::menu::{MenuAction, MenuRow, RowKind};
use super::page::PendingOperation;
use super::pipe::{FlightChoice, FlightOptions, FlightSummary, FlownBy, FromWindow, NextJob, Purpose, SchoolRequest};
use super::settings::SettingChange;
use super::{ControllerStatus, KeyPress, Page, ProfileChange, WindowFlow, WindowRequest, tutorial};
use spandrel_text::text;

/// Maximum length of a pseudonym.
const MAX_NAME_LENGTH: usize = 32;
/// Longest flight that ends without a second press, s (estimate: nobody misses it).
const MAX_UNCONFIRMED_FLIGHT_S: f64 = 10.0;
/// Step sizes of the dead band and expo.
const DEAD_BAND_STEP: f64 = 0.01;
const EXPO_STEP: f64 = 0.1;

impl WindowFlow {
    /// Handles a key press or click.
    pub fn press(&mut self, press: KeyPress) {
        self.press_on_page(press);
        self.request_briefings();
    }

    fn press_on_page(&mut self, press: KeyPress) {
        self.notice = None;
        if self.is_awaiting_key() {
            // A click, because the host passes keys to `bind_key`.
            self.bind_key(Some("escape"));
            return;
        }
        (self.follows_focus, self.scrolled) = (true, 0.0);
        let confirmed = self.confirming.take();
        let is_name_edited = std::mem::take(&mut self.is_name_edited);
        let rows = self.rows();
        let last = rows.len().saturating_sub(1);
        let kind = rows.get(self.focus).map(|row| row.kind);
        match press {
            KeyPress::Up => self.focus = if self.focus == 0 { last } else { self.focus - 1 },
            KeyPress::Down => self.focus = if self.focus >= last { 0 } else { self.focus + 1 },
            // Left and right never press buttons, because a page may appear while a flight key is still pressed.
            KeyPress::Left | KeyPress::Right if matches!(kind, Some(RowKind::Button | RowKind::KeyBinding)) => {}
            KeyPress::Left => self.step(&rows, false),
            KeyPress::Right => self.step(&rows, true),
            KeyPress::Enter => self.activate(&rows, confirmed),
            KeyPress::Escape => self.back(),
            KeyPress::Backspace if kind == Some(RowKind::TextField) => {
                self.choice.trainee.pop();
                self.is_name_edited = true;
            }
            KeyPress::Char(sign) if kind == Some(RowKind::TextField) => self.type_character(sign, is_name_edited),
            KeyPress::Backspace | KeyPress::Char(_) => {}
            KeyPress::Row(row) if row < rows.len() => {
                self.focus = row;
                let is_button = matches!(rows[row].kind, RowKind::Button | RowKind::KeyBinding);
                if is_button || rows[row].action == MenuAction::Moment {
                    self.activate(&rows, confirmed);
                }
            }
            KeyPress::Step(row, on) if row < rows.len() => {
                self.focus = row;
                self.step(&rows, on);
            }
            KeyPress::Row(_) | KeyPress::Step(..) => {}
        }
    }

    /// Adds a character to the trainee's name. The first one replaces a name that was not entered, such as the one in use before.
    fn type_character(&mut self, sign: char, is_name_edited: bool) {
        let is_first = self.choice.trainee.is_empty() || !is_name_edited;
        let fits = sign.is_ascii_alphanumeric() || (!is_first && (sign == '-' || sign == '_'));
        // A character that is refused changes nothing.
        self.is_name_edited = is_name_edited || fits;
        if !fits {
            self.notice = Some(text!(self.language(), "window-start-name-characters"));
        } else if !is_first && self.choice.trainee.len() >= MAX_NAME_LENGTH {
            self.notice = Some(text!(self.language(), "window-start-name-length", count = MAX_NAME_LENGTH));
        } else {
            if is_first {
                self.choice.trainee.clear();
            }
            self.choice.trainee.push(sign);
        }
    }

    fn step(&mut self, rows: &[MenuRow], on: bool) {
        let Some(row) = rows.get(self.focus) else { return };
        let way = if on { 1.0 } else { -1.0 };
        let ControllerStatus { mode, dead_band, expo, .. } = self.controls;
        match row.action {
            MenuAction::Trainee => self.next_trainee(on),
            MenuAction::Scenario => self.next_scenario(on),
            MenuAction::Aircraft => self.next_aircraft(on),
            MenuAction::Purpose => {
                self.choice.purpose = match self.choice.purpose {
                    Purpose::Practice => Purpose::Assessment,
                    Purpose::Assessment => Purpose::Practice,
                };
            }
            MenuAction::Mode => {
                let mode = (mode - 1 + if on { 1 } else { 3 }) % 4 + 1;
                self.out.push_back(WindowRequest::ChangeProfile(ProfileChange::Mode(mode)));
            }
            MenuAction::DeadBand => {
                let dead_band = (dead_band + DEAD_BAND_STEP * way).clamp(0.0, 0.5);
                self.out.push_back(WindowRequest::ChangeProfile(ProfileChange::DeadBand(dead_band)));
            }
            MenuAction::Expo => {
                let expo = (expo + EXPO_STEP * way).clamp(0.0, 1.0);
                self.out.push_back(WindowRequest::ChangeProfile(ProfileChange::Expo(expo)));
            }
            MenuAction::Setting(setting) => self.step_setting(setting, on),
            MenuAction::Moment => {
                let count = self.ended.as_ref().map_or(1, |ended| ended.moments.len().max(1));
                self.moment = (self.moment + if on { 1 } else { count - 1 }) % count;
            }
            MenuAction::CheckController
            | MenuAction::OpenTutorial
            | MenuAction::School
            | MenuAction::Answer(_)
            | MenuAction::ContinueSchool
            | MenuAction::LeaveSchool
            | MenuAction::Settings
            | MenuAction::Keys
            | MenuAction::Key(_)
            | MenuAction::RestoreKeys
            | MenuAction::RestoreSettings
            | MenuAction::Quit
            | MenuAction::FindController
            | MenuAction::Calibrate
            | MenuAction::Fly
            | MenuAction::Acknowledge
            | MenuAction::PrintBriefing
            | MenuAction::KeepFlying
            | MenuAction::Back
            | MenuAction::Next
            | MenuAction::Skip
            | MenuAction::Confirm
            | MenuAction::Cancel
            | MenuAction::Resume
            | MenuAction::Restart
            | MenuAction::End
            | MenuAction::FlyAgain
            | MenuAction::FlyNext
            | MenuAction::WatchExpert
            | MenuAction::ChooseOther
            | MenuAction::Report
            | MenuAction::OpenQuestionnaire => {}
        }
    }

    fn next_trainee(&mut self, on: bool) {
        let Some(offers) = &self.offers else { return };
        let names: Vec<&str> = offers.trainees.iter().map(|person| person.name.as_str()).collect();
        if let Some(name) = adjacent_name(&names, &self.choice.trainee, on) {
            self.choice.trainee = name.to_owned();
        }
    }

    fn next_scenario(&mut self, on: bool) {
        let Some(offers) = &self.offers else { return };
        let names: Vec<&str> = offers.scenarios.iter().map(|job| job.name.as_str()).collect();
        if let Some(name) = adjacent_name(&names, &self.choice.scenario, on) {
            self.choice.scenario = name.to_owned();
        }
    }

    fn next_aircraft(&mut self, on: bool) {
        let Some(offers) = &self.offers else { return };
        let names: Vec<&str> = offers.vehicles.iter().map(|offer| offer.name.as_str()).collect();
        if let Some(name) = adjacent_name(&names, &self.choice.vehicle, on) {
            self.choice.vehicle = name.to_owned();
        }
    }

    /// Requests the briefings for the selected aircraft, if the chosen job's briefing is for another one.
    pub(super) fn request_briefings(&mut self) {
        let is_missing = self.chosen_job().is_some() && !self.is_briefing_current();
        if is_missing && self.requested_vehicle.as_ref() != Some(&self.choice.vehicle) {
            let name = self.choice.vehicle.clone();
            self.requested_vehicle = Some(name.clone());
            self.send(FromWindow::Aircraft { name });
        }
    }

    /// Checks whether the trainee has neither flown a practice session here nor read the tutorial. A lesson is the tutorial itself.
    pub(super) fn needs_tutorial(&self) -> bool {
        if self.chosen_job().is_some_and(|job| job.is_lesson) {
            return false;
        }
        let flown = |offers: &FlightOptions| offers.trainees.iter().any(|p| p.name == self.choice.trainee && p.practices > 0);
        !self.tutorial_done.contains(&self.choice.trainee) && !self.offers.as_ref().is_some_and(flown)
    }

    /// Returns whether an action of the pause page needs a second press, because it ends a flight that is more than a try.
    fn needs_confirmation(&self, confirmed: Option<MenuAction>, action: MenuAction) -> bool {
        self.page == Page::Paused && self.flown_s > MAX_UNCONFIRMED_FLIGHT_S && confirmed != Some(action)
    }

    fn activate(&mut self, rows: &[MenuRow], confirmed: Option<MenuAction>) {
        let Some(row) = rows.get(self.focus) else { return };
        match row.action {
            MenuAction::Restart | MenuAction::End if self.needs_confirmation(confirmed, row.action) => {
                self.confirming = Some(row.action);
            }
            MenuAction::Trainee
            | MenuAction::Scenario
            | MenuAction::Aircraft
            | MenuAction::Purpose
            | MenuAction::Mode
            | MenuAction::DeadBand
            | MenuAction::Expo
            | MenuAction::Setting(_) => {
                self.focus = (self.focus + 1).min(rows.len().saturating_sub(1));
            }
            MenuAction::CheckController | MenuAction::FlyNext | MenuAction::WatchExpert | MenuAction::School
                if self.choice.trainee.is_empty() =>
            {
                self.notice = Some(text!(self.language(), "window-start-name-first"));
            }
            MenuAction::CheckController => self.show_page(Page::Controls),
            MenuAction::OpenTutorial => self.show_page(Page::Tutorial(0, false)),
            MenuAction::School => self.begin_school(),
            MenuAction::Answer(number) => self.send(FromWindow::School(SchoolRequest::Answer(number))),
            MenuAction::ContinueSchool => self.send(FromWindow::School(SchoolRequest::Continue)),
            MenuAction::LeaveSchool => self.leave_school(),
            MenuAction::Settings => self.show_page(Page::Settings { in_flight: self.page == Page::Paused }),
            MenuAction::Keys => self.show_page(Page::Keys { in_flight: self.is_paused() }),
            MenuAction::Key(index) => self.await_key(index),
            MenuAction::RestoreKeys => self.restore_keys(),
            MenuAction::RestoreSettings => self.change(SettingChange::RestoreAll),
            MenuAction::FindController => self.out.push_back(WindowRequest::FindController),
            MenuAction::Calibrate => self.out.push_back(WindowRequest::Calibrate),
            MenuAction::Fly if self.choice.purpose == Purpose::Practice && self.needs_tutorial() => {
                self.show_page(Page::Tutorial(0, true))
            }
            MenuAction::Fly => self.brief(),
            MenuAction::Acknowledge => self.acknowledge(),
            MenuAction::PrintBriefing => self.send(FromWindow::PrintBriefing(self.choice.clone())),
            MenuAction::Back => self.back(),
            MenuAction::Next => self.turn_tutorial_page(),
            MenuAction::Skip => self.finish_tutorial(),
            MenuAction::Confirm => self.out.push_back(WindowRequest::Confirm),
            MenuAction::Cancel => self.out.push_back(WindowRequest::Cancel),
            MenuAction::KeepFlying => self.show_page(Page::Flight),
            MenuAction::Resume => self.send(FromWindow::Resume),
            MenuAction::Restart => {
                self.send_and_wait(PendingOperation::Simulator);
                self.send(FromWindow::Restart);
            }
            MenuAction::End => {
                self.send_and_wait(PendingOperation::Scoring);
                self.send(FromWindow::End);
            }
            MenuAction::FlyAgain => {
                self.send_and_wait(PendingOperation::Simulator);
                self.send(FromWindow::Again);
            }
            MenuAction::FlyNext => self.fly_next(),
            MenuAction::WatchExpert => self.watch_expert(),
            MenuAction::ChooseOther => self.show_page(Page::Start),
            MenuAction::Moment => self.open_moment(),
            MenuAction::Report => self.open(|ended| ended.report.clone()),
            MenuAction::OpenQuestionnaire => self.open(|ended| Some(ended.questionnaire.clone())),
            MenuAction::Quit => {
                self.send(FromWindow::Quit);
                self.out.push_back(WindowRequest::Close);
            }
        }
    }

    /// Opens the report at the selected moment.
    fn open_moment(&mut self) {
        let moment = self.moment;
        self.open(|ended| ended.moments.get(moment).map(|moment| moment.address.clone()));
    }

    /// Chooses the recommended job as a practice session, and continues to the controller check or, after a flight, to the
    /// briefing.
    fn fly_next(&mut self) {
        let Some(next) = self.next_job().cloned() else { return };
        self.choice =
            FlightChoice { scenario: next.scenario, purpose: Purpose::Practice, by: FlownBy::Trainee, ..self.choice.clone() };
        if self.page == Page::Results {
            self.brief();
        } else {
            self.show_page(Page::Controls);
        }
    }

    fn begin_school(&mut self) {
        self.send(FromWindow::School(SchoolRequest::Begin(self.choice.trainee.clone())));
        self.wait(PendingOperation::Pictures);
    }

    fn leave_school(&mut self) {
        self.end_school();
        self.show_page(Page::Start);
    }

    /// Returns the recommended job: after a flight, the one that follows from it.
    pub(super) fn next_job(&self) -> Option<&NextJob> {
        if self.page == Page::Results {
            return self.ended.as_ref()?.next.as_ref();
        }
        match self.trainee_summary() {
            Some(person) if person.next.is_some() => person.next.as_ref(),
            _ => self.offers.as_ref()?.lesson.as_ref(),
        }
    }

    /// Disconnects from the flight and waits for the simulator.
    fn send_and_wait(&mut self, awaited: PendingOperation) {
        self.out.push_back(WindowRequest::LeaveFlight);
        self.wait(awaited);
    }

    fn wait(&mut self, awaited: PendingOperation) {
        (self.waiting_for, self.loading) = (awaited, None);
        self.show_page(Page::Waiting);
    }

    /// Shows the briefing of the chosen job, or starts the flight if there is none.
    pub(super) fn brief(&mut self) {
        if self.chosen_job().is_some_and(|job| !job.briefing.is_empty()) {
            self.show_page(Page::Briefing);
        } else {
            self.choose();
        }
    }

    /// Acknowledges the site check of the briefing, and starts the flight.
    fn acknowledge(&mut self) {
        self.send(FromWindow::Acknowledged(self.choice.clone()));
        self.choose();
    }

    fn watch_expert(&mut self) {
        let choice = FlightChoice { purpose: Purpose::Practice, by: FlownBy::Expert, ..self.choice.clone() };
        self.send(FromWindow::Chosen(choice));
        self.wait(PendingOperation::Simulator);
    }

    fn choose(&mut self) {
        self.ordered = false;
        self.send(FromWindow::Chosen(self.choice.clone()));
        self.wait(PendingOperation::Simulator);
    }

    fn turn_tutorial_page(&mut self) {
        if let Page::Tutorial(page, flight) = self.page {
            if page + 1 < tutorial::PAGE_COUNT {
                self.show_page(Page::Tutorial(page + 1, flight));
            } else {
                self.finish_tutorial();
            }
        }
    }

    fn finish_tutorial(&mut self) {
        self.tutorial_done.insert(self.choice.trainee.clone());
        match self.page {
            Page::Tutorial(_, true) => self.brief(),
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
            | Page::School => self.show_page(Page::Start),
        }
    }

    fn open(&mut self, address: impl Fn(&FlightSummary) -> Option<String>) {
        if let Some(address) = self.ended.as_ref().and_then(address) {
            self.out.push_back(WindowRequest::Open(address));
        }
    }

    fn back(&mut self) {
        match self.page {
            Page::Controls => {
                self.decline_order();
                self.show_page(Page::Start);
            }
            Page::Tutorial(0, false) => self.show_page(Page::Start),
            Page::Keys { in_flight } => self.show_page(Page::Settings { in_flight }),
            Page::Settings { in_flight: true } => self.show_page(Page::Paused),
            Page::Settings { in_flight: false } => self.show_page(Page::Start),
            Page::Tutorial(0, true) | Page::Briefing => self.show_page(Page::Controls),
            Page::Tutorial(page, flight) => self.show_page(Page::Tutorial(page - 1, flight)),
            Page::Calibrating => self.out.push_back(WindowRequest::Cancel),
            Page::Paused => self.send(FromWindow::Resume),
            Page::ConfirmEnd => self.show_page(Page::Flight),
            Page::School => self.leave_school(),
            Page::Opening | Page::Start | Page::Waiting | Page::Flight | Page::Results => {}
        }
    }
}

/// Returns the next or previous name, wrapping around, or the first name if `name` is not in the list.
fn adjacent_name<'a>(names: &[&'a str], name: &str, on: bool) -> Option<&'a str> {
    let count = names.len();
    let at = names.iter().position(|known| *known == name);
    let next = match (at, on) {
        (None, _) => 0,
        (Some(at), true) => (at + 1) % count,
        (Some(at), false) => (at + count - 1) % count,
    };
    names.get(next).copied()
}
