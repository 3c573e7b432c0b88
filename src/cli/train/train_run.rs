//! The flights in one run of `train`: those chosen in the window, or the one specified on the command line.

use super::aircraft::{self, SelectedAircraft};
use super::args::{Args, camera_file};
use super::assigned;
use super::expert_ghost::BackgroundExpert;
use super::flight_processes::{FlightOutcome, FlightProcesses};
use super::loading::FlightStep;
use super::offers;
use super::picture_jobs::PictureJobs;
use super::planned;
use super::prompt::{PromptAnswer, TerminalPrompt};
use super::questionnaire_state;
use super::school::SchoolRoom;
use super::station::{StationLink, StationSetup};
use super::window::WindowProcess;
use crate::cli::invocation::typed;
use crate::cli::table::report_outcome;
use crate::errors::AppError;
use crate::io::addresses;
use crate::io::briefing_page::briefing_page;
use crate::io::clock;
use crate::io::files;
use crate::io::replace::replace;
use crate::io::report;
use crate::io::stop::StopRequest;
use crate::io::trainee_id::TraineeId;
use crate::io::user_language::user_language;
use crate::records::{Database, RecordsLocation};
use crate::web::{ListenConfig, ServerSetup, WatchedVehicle, WebServer};
use spandrel_model::site::Site;
use spandrel_text::{Language, text};
use spandrel_training::briefing::{self, Briefing};
use spandrel_view::flow::pipe::{FlightChoice, FlownBy, FromWindow, OrderedFlight, ToWindow, TraineeSummary};
use std::net::SocketAddr;
use std::path::Path;
use std::time::Duration;

/// File in the sessions' folder with the briefing that was printed last.
const PRINTED_BRIEFING: &str = "briefing.html";
/// Interval at which the window is checked.
const CHECK_INTERVAL: Duration = Duration::from_millis(50);

/// Web server and the vehicle that its live page shows.
struct ServedPages {
    server: WebServer,
    vehicle: Option<SocketAddr>,
}

/// A run of `spandrel train`.
pub struct TrainRun<'a> {
    args: &'a Args,
    /// Aircraft that is selected in the window, or flown.
    aircraft: SelectedAircraft,
    log: tracing::Level,
    stop: StopRequest,
    /// The window, while it is open.
    window: Option<WindowProcess>,
    /// True if the user closed the window; photographs can still be rendered on this computer.
    closed: bool,
    web: Option<ServedPages>,
    web_announced: bool,
    /// Language and aircraft of the offers in the window.
    offered_language: Option<Language>,
    offered_aircraft: Option<String>,
    pictures: PictureJobs,
    /// Processes of the last flight. Its vehicle stays connected until the next flight or the end of the run, so ground
    /// stations can download its logs.
    vehicle: Option<FlightProcesses>,
    prompt: TerminalPrompt,
    school: SchoolRoom,
    /// Connection to the server on which instructors start flights, if this computer is a station.
    station: Option<StationLink>,
    /// Ordered flight whose briefing the window shows.
    briefed: Option<FlightChoice>,
    /// The latest acknowledgement in the window.
    site_check: Option<SiteCheck>,
}

/// The acknowledgement of the site check in a briefing. It holds for each attempt at this flight.
struct SiteCheck {
    choice: FlightChoice,
    acknowledged_unix_us: u64,
}

/// What to do after a flight.
enum NextFlight {
    Fly(FlightChoice),
    /// The user has finished flying.
    Leave,
    /// No window is available for choosing the next flight.
    NoChoice,
}

impl<'a> TrainRun<'a> {
    /// Creates a run without starting anything.
    pub fn new(args: &'a Args, aircraft: SelectedAircraft, log: tracing::Level, stop: StopRequest) -> Self {
        Self {
            args,
            aircraft,
            log,
            stop,
            window: None,
            closed: false,
            web: None,
            web_announced: false,
            offered_language: None,
            offered_aircraft: None,
            pictures: PictureJobs::default(),
            vehicle: None,
            prompt: TerminalPrompt::default(),
            school: SchoolRoom::new(&args.sessions),
            station: None,
            briefed: None,
            site_check: None,
        }
    }

    /// Runs flights until the user quits.
    ///
    /// # Errors
    /// Returns an error if a flight cannot be started or scored; returns the last error.
    pub fn run(mut self) -> Result<(), AppError> {
        if let (Some(server), Some(name), Some(key)) = (&self.args.server, &self.args.station, &self.args.station_key) {
            let (server_ca, sessions) = (self.args.server_ca.as_deref(), self.args.sessions.as_path());
            self.station = Some(StationLink::start(&StationSetup { server, server_ca, name, key, sessions })?);
        }
        self.window = WindowProcess::open(self.args, self.log);
        let usual = FlightChoice {
            trainee: self.args.trainee.as_str().to_owned(),
            scenario: self.args.scenario_argument(),
            purpose: self.args.purpose.display_name(),
            by: FlownBy::Trainee,
            vehicle: self.args.vehicle.clone(),
        };
        let mut next = self.first_choice(&usual);
        let mut result = Ok(());
        let mut last = None;
        while let NextFlight::Fly(choice) = next {
            let done = self.fly(&choice);
            self.station.iter_mut().for_each(|station| station.report_end(done.as_ref().err()));
            let (flown, session) = match done {
                Ok(done) => done,
                // An error in the first flight ends the run, as it does without a window; later errors are shown in the
                // window, or on the server's page.
                Err(error) if last.is_none() && self.station.is_none() && !self.are_flights_chosen_in_window() => {
                    return Err(error);
                }
                Err(error) => {
                    tracing::warn!("cannot start the flight: {error}");
                    self.refuse(&error);
                    result = Err(error);
                    next = self.next_choice(&choice);
                    continue;
                }
            };
            result = flown;
            // Nobody answers questions about an expert's flight.
            last = (choice.by == FlownBy::Trainee).then_some(session).or(last);
            next = self.next_choice(&choice);
        }
        // A user who quits in the window has seen the results, and can still answer questions on the web pages.
        let seen = matches!(next, NextFlight::Leave) && !last.as_deref().is_some_and(questionnaire_state::has_unanswered);
        self.end_vehicle();
        if let Some(window) = self.window.take() {
            window.close();
        }
        if let (Some(session), false, true) = (&last, seen || self.prompt.has_quit, result.is_ok()) {
            self.keep_serving(session);
        }
        self.pictures.finish(&self.stop);
        result
    }

    /// Returns true if the window is open; drops a window that has exited.
    fn is_open(&mut self) -> bool {
        let Some(window) = &mut self.window else { return false };
        let open = window.is_open();
        if !open {
            self.closed |= window.closed;
            self.window = None;
        }
        open
    }

    /// Waits until the window appears. Returns false if it fails to open.
    fn wait_for_window(&mut self) -> bool {
        let ready = self.window.as_mut().is_some_and(|window| window.is_ready(&self.stop));
        self.is_open() && ready
    }

    /// Returns true if the window is shown on a display.
    fn has_display(&mut self) -> bool {
        self.is_open() && self.window.as_ref().is_some_and(|window| window.ready)
    }

    /// Returns true if the user can choose flights in the window.
    fn are_flights_chosen_in_window(&mut self) -> bool {
        self.web_announced && self.is_open()
    }

    /// Returns the language of the texts for the window.
    fn language(&self) -> Language {
        self.window.as_ref().map_or(Language::default(), |window| window.language)
    }

    fn send_to_window(&mut self, message: &ToWindow) {
        if let Some(window) = &mut self.window {
            window.send(message);
        }
    }

    /// Shows in the window what takes time.
    fn report(&mut self, step: FlightStep) {
        let language = self.language();
        show_step(&mut self.window, step, language);
    }

    /// Shows in the window why a flight cannot start.
    fn refuse(&mut self, error: &AppError) {
        let message = refusal(error, self.language());
        self.send_to_window(&message);
    }

    /// Returns true if the command line fixes the first flight, of which the window then shows only the briefing.
    fn is_fixed(&self) -> bool {
        self.args.scenario.is_some() && !self.args.choose
    }

    /// Returns the first choice: from the window or, without a window, from the command line.
    fn first_choice(&mut self, usual: &FlightChoice) -> NextFlight {
        if self.wait_for_window() {
            self.serve(None);
            self.offer(usual);
            if self.is_fixed() {
                tracing::info!("read the briefing in the window and confirm the site check there to start the flight");
                self.send_to_window(&ToWindow::Briefing);
            }
            match self.next_choice(usual) {
                NextFlight::NoChoice => {}
                next @ (NextFlight::Fly(_) | NextFlight::Leave) => return next,
            }
            // If the user closes the window, the run ends; if the window crashes, the run continues without it.
            if self.closed {
                return NextFlight::Leave;
            }
        }
        if self.stop.is_requested() {
            return NextFlight::Leave;
        }
        if !self.is_fixed() {
            if self.station.is_some() {
                return self.wait_for_order();
            }
            tracing::info!(
                "using the command line: {} flies {}; to change this, use --trainee, --scenario and --purpose",
                usual.trainee,
                usual.scenario
            );
        }
        match self.brief_at_terminal(usual) {
            Ok(()) if self.stop.is_requested() => NextFlight::Leave,
            // Starting the flight reports an unreadable file.
            Ok(()) | Err(_) => NextFlight::Fly(usual.clone()),
        }
    }

    /// Prints the briefing, and waits until a user at a terminal has confirmed the site check.
    fn brief_at_terminal(&mut self, choice: &FlightChoice) -> Result<(), AppError> {
        let scenario = files::scenario(&choice.scenario)?.scenario;
        let (vehicle, language) = (files::vehicle(&choice.vehicle)?.vehicle, user_language());
        let briefing = Briefing::new(&scenario, &vehicle, &Site::without_defects(&scenario), language);
        println!("{}", briefing::text::render(&briefing, language));
        if !self.prompt.can_ask() {
            return Ok(());
        }
        println!("{}", text!(language, "briefing-confirm"));
        while !self.stop.is_requested() {
            if let Some(is_confirmed) = self.prompt.confirmation() {
                let acknowledged_unix_us = clock::unix_us();
                self.site_check = is_confirmed.then(|| SiteCheck { choice: choice.clone(), acknowledged_unix_us });
                break;
            }
            std::thread::sleep(CHECK_INTERVAL);
        }
        Ok(())
    }

    /// Offers flights in the window, with the briefings for the selected aircraft. Returns what it offers the trainees.
    fn offer(&mut self, choice: &FlightChoice) -> Vec<TraineeSummary> {
        let database = planned::open_records(&self.args.sessions);
        self.offer_from(choice, database.as_ref())
    }

    /// Offers flights as [`Self::offer`] does, with the plans and assignments of a database.
    fn offer_from(&mut self, choice: &FlightChoice, database: Option<&Database>) -> Vec<TraineeSummary> {
        let web = self.web.as_ref().map(|web| web.server.address().to_owned());
        let language = self.language();
        let sessions = &self.args.sessions;
        let folders = offers::sessions_by_trainee(sessions);
        let mut offers = offers::flight_options((sessions, &folders, &self.aircraft), choice, web.as_deref(), language);
        offers.vehicles = aircraft::offered(&self.args.vehicle);
        planned::recommend(&mut offers.trainees, database, (sessions, &folders), language);
        assigned::put_first(&mut offers.trainees, database, sessions, language);
        offers::add_next_jobs(&mut offers, &self.aircraft, language);
        self.web_announced = true;
        (self.offered_language, self.offered_aircraft) = (Some(language), Some(self.aircraft.name.clone()));
        let trainees = offers.trainees.clone();
        self.send_to_window(&ToWindow::Offers(offers));
        trainees
    }

    /// Waits for the window's next choice.
    fn next_choice(&mut self, last: &FlightChoice) -> NextFlight {
        while let Some(window) = &mut self.window {
            while let Some(said) = window.receive() {
                let language = window.language;
                match said {
                    FromWindow::Again => {
                        self.settle_order(last);
                        return NextFlight::Fly(last.clone());
                    }
                    FromWindow::Declined => {
                        self.briefed = None;
                        decline(&mut self.station, text!(Language::English, "stations-refusal-declined"));
                    }
                    FromWindow::Quit => return NextFlight::Leave,
                    FromWindow::Acknowledged(choice) => {
                        self.site_check = Some(SiteCheck { choice, acknowledged_unix_us: clock::unix_us() });
                    }
                    FromWindow::School(request) => self.school.handle(request, language),
                    FromWindow::PrintBriefing(choice) => window.send(&printed_briefing(&choice, &self.args.sessions, language)),
                    FromWindow::Chosen(choice) => match validate_choice(&choice) {
                        Ok(()) => {
                            self.settle_order(&choice);
                            return NextFlight::Fly(choice);
                        }
                        Err(error) => window.send(&refusal(&error, language)),
                    },
                    FromWindow::Aircraft { name } => match SelectedAircraft::read(&name) {
                        Ok(aircraft) => self.aircraft = aircraft,
                        Err(error) => window.send(&refusal(&error, language)),
                    },
                    // Ignore late messages about a flight that has just ended.
                    FromWindow::Ready
                    | FromWindow::Language { .. }
                    | FromWindow::Showing
                    | FromWindow::Pause
                    | FromWindow::Resume
                    | FromWindow::Restart
                    | FromWindow::End => {}
                }
            }
            if self.are_offers_outdated() {
                let shown = self.briefed.clone().unwrap_or_else(|| last.clone());
                self.offer(&shown);
            }
            while let Some(message) = self.school.poll() {
                self.send_to_window(&message);
            }
            if let Some(choice) = self.ordered_flight() {
                self.brief(choice);
            }
            self.check_vehicle();
            self.pictures.advance();
            if self.stop.is_requested() {
                return NextFlight::NoChoice;
            }
            if self.is_open() {
                std::thread::sleep(CHECK_INTERVAL);
            }
        }
        if self.briefed.take().is_some() {
            decline(&mut self.station, text!(Language::English, "stations-refusal-window-closed"));
        }
        self.prompt_at_terminal(last)
    }

    /// Returns true if the window shows another language or aircraft than the offers.
    fn are_offers_outdated(&self) -> bool {
        self.offered_language.is_some_and(|offered| offered != self.language())
            || self.offered_aircraft.as_ref().is_some_and(|offered| *offered != self.aircraft.name)
    }

    /// Leads the trainee in the window to an ordered flight, which starts after the briefing, as a chosen one does.
    fn brief(&mut self, choice: FlightChoice) {
        let aircraft = SelectedAircraft::read(&choice.vehicle).ok();
        let job = |aircraft| offers::job_offer(choice.scenario.clone(), aircraft, self.language());
        match aircraft.as_ref().and_then(job) {
            Some(job) => {
                self.briefed = Some(choice.clone());
                self.station.iter_mut().for_each(StationLink::report_briefing);
                self.send_to_window(&ToWindow::Ordered(OrderedFlight { choice, job }));
            }
            // The files were readable a moment ago.
            None => decline(&mut self.station, format!("cannot read {}", choice.scenario)),
        }
    }

    /// Declines the ordered flight if the trainee starts another one.
    fn settle_order(&mut self, chosen: &FlightChoice) {
        if self.briefed.take().is_some_and(|ordered| ordered != *chosen) {
            decline(&mut self.station, text!(Language::English, "stations-refusal-other-flight"));
        }
    }

    /// Returns a flight that an instructor has ordered at this station.
    fn ordered_flight(&mut self) -> Option<FlightChoice> {
        self.station.as_mut().and_then(|station| station.next_flight(&self.args.vehicle))
    }

    /// Waits for an instructor's order at a station without a window.
    fn wait_for_order(&mut self) -> NextFlight {
        tracing::info!("waiting for an instructor to start a flight; press Ctrl-C to quit");
        while !self.stop.is_requested() {
            if let Some(choice) = self.ordered_flight() {
                return NextFlight::Fly(choice);
            }
            std::thread::sleep(CHECK_INTERVAL);
        }
        NextFlight::Leave
    }

    /// If there is no window, keeps the vehicle connected until the user answers at the terminal or a stop is
    /// requested.
    fn prompt_at_terminal(&mut self, last: &FlightChoice) -> NextFlight {
        if self.args.once || self.closed || self.vehicle.is_none() {
            let waits = self.station.is_some() && !self.args.once && !self.closed;
            return if waits { self.wait_for_order() } else { NextFlight::NoChoice };
        }
        println!("{}", self.prompt.help_text());
        if let (Some(web), Some(vehicle)) = (&self.web, &self.vehicle) {
            println!("questionnaire {}", offers::questionnaire(vehicle.session(), web.server.address()));
        }
        while self.vehicle.is_some() && !self.stop.is_requested() {
            if let Some(choice) = self.ordered_flight() {
                return NextFlight::Fly(choice);
            }
            match self.prompt.answer() {
                Some(PromptAnswer::Again) => return NextFlight::Fly(last.clone()),
                Some(PromptAnswer::Quit) => return NextFlight::Leave,
                None => {}
            }
            self.check_vehicle();
            self.pictures.advance();
            std::thread::sleep(CHECK_INTERVAL);
        }
        NextFlight::Leave
    }

    /// Drops a vehicle whose simulator has exited.
    fn check_vehicle(&mut self) {
        if let Some(status) = self.vehicle.as_mut().and_then(FlightProcesses::simulator_exit_status) {
            tracing::warn!("the simulator exited early ({status}): ground stations have lost the vehicle");
            self.vehicle = None;
        }
    }

    /// Ends the vehicle of the last flight. Returns the expert that still flies in the background; its flight ends with it.
    fn end_vehicle(&mut self) -> Option<BackgroundExpert> {
        let mut flight = self.vehicle.take()?;
        flight.finish();
        Some(flight.take_background_expert())
    }

    /// Runs the chosen flight to its end, including restarts. Returns the result and the session folder.
    fn fly(&mut self, choice: &FlightChoice) -> Result<(Result<(), AppError>, std::path::PathBuf), AppError> {
        loop {
            let expert = self.end_vehicle();
            let acknowledged = self.site_check.as_ref().filter(|check| check.choice == *choice);
            let site_check_unix_us = acknowledged.map(|check| check.acknowledged_unix_us);
            let language = self.language();
            let mut report = |step: FlightStep| show_step(&mut self.window, step, language);
            let mut flight = FlightProcesses::start(self.args, (choice, site_check_unix_us), self.log, language, &mut report)?;
            expert.into_iter().for_each(|expert| flight.take_over_expert(expert));
            self.station.iter_mut().for_each(|station| station.report_start(choice));
            self.serve(flight.port("payload_port"));
            if let Some(flying) = flight.started_message(self.args) {
                self.send_to_window(&flying);
            }
            let shown = self.has_display();
            if self.args.second_screen && shown {
                flight.open_second_window(self.args, self.log);
            }
            let web = self.web.as_ref().map(|web| web.server.address());
            print!("{}", flight.connection_info(self.args, web, shown));
            let outcome = flight.wait(&mut self.window, &self.stop);
            if matches!(outcome, FlightOutcome::Over) && self.stop.is_requested() {
                // After a stop request, the user cannot choose another flight.
                self.window.take().into_iter().for_each(WindowProcess::close);
            }
            self.report(FlightStep::Scores);
            flight.end_session();
            let session = flight.session().to_path_buf();
            if matches!(outcome, FlightOutcome::Restart) {
                tracing::info!("the attempt has ended; the recorded data is in {}", session.display());
                self.vehicle = Some(flight);
                continue;
            }
            if matches!(outcome, FlightOutcome::Over) && !self.stop.is_requested() {
                self.vehicle = Some(flight);
            }
            return Ok((self.end(choice, &session, outcome), session));
        }
    }

    /// Shows the result in the terminal and in the window.
    fn end(&mut self, choice: &FlightChoice, session: &Path, outcome: FlightOutcome) -> Result<(), AppError> {
        let told = report_outcome(session);
        if told.is_ok() {
            println!("questions     {}", typed(&format!("spandrel questionnaire {}", session.display())));
        }
        let is_lost = matches!(outcome, FlightOutcome::Lost(_));
        let result = match outcome {
            FlightOutcome::Lost(error) => Err(error),
            FlightOutcome::Over | FlightOutcome::Restart => told,
        };
        let open = self.is_open();
        // If the window has crashed, rendering does not work; after a stop request, the user should not have to wait
        // for photographs.
        if (open || self.closed) && result.is_ok() && !self.stop.is_requested() {
            self.pictures.draw_photographs(session);
            self.pictures.draw_video(session, self.args.video);
        }
        if open {
            self.report(FlightStep::Record);
            let database = planned::open_records(&self.args.sessions);
            if result.is_ok() {
                planned::import(session, database.as_ref());
            }
            self.report(FlightStep::NextFlights);
            let trainees = self.offer_from(choice, database.as_ref());
            let language = self.language();
            let web = self.web.as_ref().map(|web| web.server.address());
            let trouble = result.as_ref().err().filter(|_| is_lost).map(ToString::to_string);
            let mut ended = offers::flight_summary(session, web, trouble, language);
            match choice.by {
                FlownBy::Expert => ended = offers::watched(ended, &choice.scenario, language),
                FlownBy::Trainee => offers::offer_planned_job(&mut ended, &choice.trainee, &trainees),
            }
            self.send_to_window(&ToWindow::Ended(ended));
        }
        result
    }

    /// Serves the web pages for the sessions and for this vehicle's flight. The address stays the same throughout the
    /// run. A failure does not prevent the flight.
    fn serve(&mut self, vehicle: Option<SocketAddr>) {
        let addresses::PortChoice::Number(mut port) = self.args.web else { return };
        match self.web.take() {
            Some(web) if web.vehicle == vehicle => {
                self.web = Some(web);
                return;
            }
            Some(web) => port = port_from_url(web.server.address()).unwrap_or(port),
            None => {}
        }
        // The database is next to the sessions; its folder may not exist before the first session.
        let made = std::fs::create_dir_all(&self.args.sessions);
        let watched = vehicle.map(|vehicle| WatchedVehicle { vehicle, picture: Some(camera_file(self.args)) });
        let records_location = RecordsLocation::beside(&self.args.sessions);
        let setup = ServerSetup {
            records_location,
            scenarios: None,
            own_job: self.args.scenario.as_ref().map(std::path::PathBuf::from).filter(|file| file.is_file()),
            watched: watched.into_iter().collect(),
            wordings: Vec::new(),
            station_key: None,
        };
        let started = made
            .map_err(|error| AppError::failed(format!("{}: {error}", self.args.sessions.display())))
            .and_then(|()| WebServer::start(&ListenConfig::local(port), setup));
        match started {
            Ok(server) => self.web = Some(ServedPages { server, vehicle }),
            Err(error) => tracing::warn!("cannot serve the web pages: {error}"),
        }
    }

    /// Keeps the web pages available until the user answers at the terminal, because the user fills in the
    /// questionnaire after the flight.
    fn keep_serving(&mut self, session: &Path) {
        let (Some(web), true, false) = (&self.web, self.prompt.is_open(), self.stop.is_requested()) else { return };
        let address = offers::questionnaire(session, web.server.address());
        println!("questionnaire {address}   (available until you press Enter)");
        // Enter only stops the web pages; the run still waits for the photographs.
        while self.prompt.answer().is_none() && !self.stop.is_requested() {
            self.pictures.advance();
            std::thread::sleep(CHECK_INTERVAL);
        }
    }
}

fn show_step(window: &mut Option<WindowProcess>, step: FlightStep, language: Language) {
    if let Some(window) = window {
        window.send(&step.message(language));
    }
}

/// Reports to the server, if this computer is a station, why the ordered flight does not start.
fn decline(station: &mut Option<StationLink>, why: String) {
    if let Some(station) = station {
        station.decline(why);
    }
}

/// Returns the message for the window about a flight that cannot start. The details are in English, as in the log.
fn refusal(error: &AppError, language: Language) -> ToWindow {
    ToWindow::Refused { words: text!(language, "window-train-refused", error = error.to_string()) }
}

/// Writes the briefing of a flight as a page to print, and returns the message that opens it in the browser. The next one replaces it.
fn printed_briefing(choice: &FlightChoice, sessions: &Path, language: Language) -> ToWindow {
    let write = || -> Result<String, AppError> {
        let (job, aircraft) = (files::scenario(&choice.scenario)?, files::vehicle(&choice.vehicle)?);
        let file = sessions.join(PRINTED_BRIEFING);
        std::fs::create_dir_all(sessions)
            .map_err(|error| AppError::failed(format!("{}: cannot create the folder: {error}", sessions.display())))?;
        replace(&file, briefing_page(&job, &aircraft.vehicle, language)?.as_bytes())?;
        Ok(report::address(&file))
    };
    match write() {
        Ok(address) => ToWindow::OpenPage { address },
        Err(error) => ToWindow::Refused { words: text!(language, "window-train-no-briefing", error = error.to_string()) },
    }
}

/// Validates a choice made in the window in the same way as a choice on the command line.
fn validate_choice(choice: &FlightChoice) -> Result<(), AppError> {
    choice.trainee.parse::<TraineeId>().map_err(AppError::invalid)?;
    files::vehicle(&choice.vehicle)?;
    files::scenario(&choice.scenario).map(|_| ())
}

fn port_from_url(address: &str) -> Option<u16> {
    address.rsplit(':').next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::super::args::parse_args;
    use super::*;
    use spandrel_view::flow::pipe::Purpose;

    #[test]
    fn exact_printed_briefing_is_a_page_of_the_job_in_the_language_of_the_window() {
        let folder = tempfile::tempdir().unwrap();
        let sessions = folder.path().join("sessions");
        let choice = |scenario: &str| FlightChoice {
            trainee: "anna".into(),
            scenario: scenario.into(),
            purpose: Purpose::Practice,
            by: FlownBy::Trainee,
            vehicle: "phantom2".into(),
        };
        let ToWindow::OpenPage { address } = printed_briefing(&choice("drill-hover"), &sessions, Language::German) else {
            panic!()
        };
        let page = std::fs::read_to_string(sessions.join(PRINTED_BRIEFING)).unwrap();
        assert!(address.ends_with("/sessions/briefing.html") && page.contains("<html lang=\"de\""), "{address}");
        assert!(page.contains("Kontrolle des Einsatzorts"), "{page}");
        let ToWindow::Refused { words } = printed_briefing(&choice("no-job"), &sessions, Language::English) else { panic!() };
        assert!(words.starts_with("The briefing cannot be printed: ") && words.contains("no-job"), "{words}");
    }

    #[test]
    fn exact_crashed_window_is_dropped_before_flight() {
        let args = parse_args(&["--scenario", "drill-hover"]);
        let mut course =
            TrainRun::new(&args, SelectedAircraft::read("phantom2").unwrap(), tracing::Level::WARN, StopRequest::default());
        course.window = Some(WindowProcess::failing_process());
        let choice = FlightChoice {
            trainee: "anna".into(),
            scenario: "drill-hover".into(),
            purpose: Purpose::Practice,
            by: FlownBy::Trainee,
            vehicle: "phantom2".into(),
        };
        assert!(matches!(course.first_choice(&choice), NextFlight::Fly(flown) if flown == choice));
        assert!(course.window.is_none() && !course.has_display() && !course.closed);
        course.stop.request();
        assert!(matches!(course.first_choice(&choice), NextFlight::Leave), "no flight after a stop request");
    }
}
