//! One flight after the other: what the window asks for, or what the command line says, once.

use super::flight::{Flight, Outcome};
use super::offers;
use super::photographs::Photographs;
use super::prompt::{Answer, Prompt};
use super::questions;
use super::window::Window;
use super::{Args, USUAL, camera, tell};
use crate::args::{self, TraineeId};
use crate::errors::AppError;
use crate::files;
use crate::records::Place;
use crate::stop::Stop;
use crate::web::{ListenArgs, Server, Setup, Watched};
use spandrel_view::flow::pipe::{Choice, FromWindow, ToWindow};
use std::net::SocketAddr;
use std::path::Path;
use std::time::Duration;

/// Between two looks at the window.
const LOOK: Duration = Duration::from_millis(50);

/// The pages of the sessions, and whose live flight they show.
struct Pages {
    server: Server,
    vehicle: Option<SocketAddr>,
}

/// A run of `train`.
pub struct Course<'a> {
    args: &'a Args,
    log: tracing::Level,
    stop: Stop,
    /// The window while it is there.
    window: Option<Window>,
    /// Somebody closed the window: this machine draws, although none is there any more.
    closed: bool,
    web: Option<Pages>,
    told: bool,
    photographs: Photographs,
    /// The vehicle of the last flight. It stays connected until the next flight or the end of the run: ground stations download its logs.
    vehicle: Option<Flight>,
    prompt: Prompt,
}

/// What comes after a flight.
enum Next {
    Fly(Choice),
    /// Somebody wants no further flight.
    Leave,
    /// There is no window that could ask.
    Nobody,
}

impl<'a> Course<'a> {
    /// Nothing is started yet.
    pub fn new(args: &'a Args, log: tracing::Level, stop: Stop) -> Self {
        Self {
            args,
            log,
            stop,
            window: None,
            closed: false,
            web: None,
            told: false,
            photographs: Photographs::default(),
            vehicle: None,
            prompt: Prompt::default(),
        }
    }

    /// Flies as often as is asked for.
    ///
    /// # Errors
    /// When a flight cannot be started or scored: the last one's error.
    pub fn run(mut self) -> Result<(), AppError> {
        self.window = Window::open(self.args, self.log);
        let usual = Choice {
            trainee: self.args.trainee.as_str().to_owned(),
            scenario: self.args.scenario.clone().unwrap_or_else(|| USUAL.to_owned()),
            purpose: self.args.purpose.said(),
        };
        let mut next = if self.args.choose || self.args.scenario.is_none() { self.first(&usual) } else { self.given(&usual) };
        let mut result = Ok(());
        let mut last = None;
        while let Next::Fly(choice) = next {
            let (flown, session) = match self.fly(&choice) {
                Ok(done) => done,
                // The first flight's error ends the run, as it does without a window; later ones are told in the window.
                Err(error) if last.is_none() && !self.asks() => return Err(error),
                Err(error) => {
                    tracing::warn!("no flight: {error}");
                    self.say(&ToWindow::Refused { words: error.to_string() });
                    result = Err(error);
                    next = self.next(&choice);
                    continue;
                }
            };
            result = flown;
            last = Some(session);
            next = self.next(&choice);
        }
        // Who leaves by the window has seen the end; what is still asked is answered from the pages.
        let seen = matches!(next, Next::Leave) && !last.as_deref().is_some_and(questions::are_open);
        self.end_vehicle();
        if let Some(window) = self.window.take() {
            window.close();
        }
        if let (Some(session), false, true) = (&last, seen || self.prompt.answered, result.is_ok()) {
            self.linger(session);
        }
        self.photographs.finish(&self.stop);
        result
    }

    /// There is a window; one that is over is let go of.
    fn is_open(&mut self) -> bool {
        let Some(window) = &mut self.window else { return false };
        let open = window.is_open();
        if !open {
            self.closed |= window.closed;
            self.window = None;
        }
        open
    }

    /// Waits until the window stands; false when there is none that does.
    fn stands(&mut self) -> bool {
        let ready = self.window.as_mut().is_some_and(|window| window.is_ready(&self.stop));
        self.is_open() && ready
    }

    /// The window stands on a display.
    fn shows(&mut self) -> bool {
        self.is_open() && self.window.as_ref().is_some_and(|window| window.ready)
    }

    /// The window asks, and not the command line alone.
    fn asks(&mut self) -> bool {
        self.told && self.is_open()
    }

    fn say(&mut self, message: &ToWindow) {
        if let Some(window) = &mut self.window {
            window.tell(message);
        }
    }

    /// The command line's choice, once the window stands or is known not to: nobody flies before there is something to see.
    fn given(&mut self, usual: &Choice) -> Next {
        self.stands();
        if self.stop.asked() { Next::Leave } else { Next::Fly(usual.clone()) }
    }

    /// The first choice: the window's, or without one the command line's.
    fn first(&mut self, usual: &Choice) -> Next {
        if self.stands() {
            self.serve(None);
            self.offer(usual);
            match self.next(usual) {
                Next::Nobody => {}
                next => return next,
            }
            // Who closes the window wants no flight; one that breaks off is done without.
            if self.closed {
                return Next::Leave;
            }
        }
        if self.stop.asked() {
            return Next::Leave;
        }
        tracing::info!(
            "nobody is asked: {} flies {}; say --trainee, --scenario and --purpose for another choice",
            usual.trainee,
            usual.scenario
        );
        Next::Fly(usual.clone())
    }

    fn offer(&mut self, choice: &Choice) {
        let web = self.web.as_ref().map(|web| web.server.address().to_owned());
        let offers = offers::offers(&self.args.sessions, choice, web.as_deref());
        self.told = true;
        self.say(&ToWindow::Offers(offers));
    }

    /// Waits for what the window asks for next.
    fn next(&mut self, last: &Choice) -> Next {
        while let Some(window) = &mut self.window {
            while let Some(said) = window.hear() {
                match said {
                    FromWindow::Again => return Next::Fly(last.clone()),
                    FromWindow::Quit => return Next::Leave,
                    FromWindow::Chosen(choice) => match checked(&choice) {
                        Ok(()) => return Next::Fly(choice),
                        Err(error) => window.tell(&ToWindow::Refused { words: error.to_string() }),
                    },
                    // What belongs to a flight that has just ended by itself.
                    FromWindow::Ready | FromWindow::Pause | FromWindow::Resume | FromWindow::Restart | FromWindow::End => {}
                }
            }
            self.check_vehicle();
            if self.stop.asked() {
                return Next::Nobody;
            }
            if self.is_open() {
                std::thread::sleep(LOOK);
            }
        }
        self.ask_at_terminal(last)
    }

    /// Keeps the vehicle connected when no window can ask what comes next, until the trainee answers at the terminal or interrupts.
    fn ask_at_terminal(&mut self, last: &Choice) -> Next {
        if self.args.once || self.closed || self.vehicle.is_none() {
            return Next::Nobody;
        }
        println!("{}", self.prompt.words());
        if let (Some(web), Some(vehicle)) = (&self.web, &self.vehicle) {
            println!("in a browser  {}", offers::ended(vehicle.session(), Some(web.server.address()), None).questionnaire);
        }
        while self.vehicle.is_some() && !self.stop.asked() {
            match self.prompt.answer() {
                Some(Answer::Again) => return Next::Fly(last.clone()),
                Some(Answer::Quit) => return Next::Leave,
                None => {}
            }
            self.check_vehicle();
            std::thread::sleep(LOOK);
        }
        Next::Leave
    }

    /// Drops a vehicle that has ended by itself.
    fn check_vehicle(&mut self) {
        if let Some(status) = self.vehicle.as_mut().and_then(Flight::vehicle_ended) {
            tracing::warn!("the simulator ended early ({status}): ground stations have lost the vehicle");
            self.vehicle = None;
        }
    }

    fn end_vehicle(&mut self) {
        if let Some(mut flight) = self.vehicle.take() {
            flight.finish();
        }
    }

    /// One flight, begun anew as often as is wished, to its end. Gives how it went and its folder.
    fn fly(&mut self, choice: &Choice) -> Result<(Result<(), AppError>, std::path::PathBuf), AppError> {
        loop {
            self.end_vehicle();
            let mut flight = Flight::start(self.args, choice, self.log)?;
            self.serve(flight.port("payload_port"));
            if let Some(flying) = flight.flying(self.args) {
                self.say(&flying);
            }
            let shown = self.shows();
            let web = self.web.as_ref().map(|web| web.server.address());
            print!("{}", flight.told(self.args, web, shown));
            let outcome = flight.wait(&mut self.window, &self.stop);
            if matches!(outcome, Outcome::Over) && self.stop.asked() {
                // Who interrupts is not asked again.
                self.window.take().into_iter().for_each(Window::close);
            }
            flight.end_session();
            let session = flight.session().to_path_buf();
            if matches!(outcome, Outcome::Restart) {
                tracing::info!("this attempt ended; what was recorded is in {}", session.display());
                flight.finish();
                continue;
            }
            if matches!(outcome, Outcome::Over) && !self.stop.asked() {
                self.vehicle = Some(flight);
            }
            return Ok((self.end(choice, &session, outcome), session));
        }
    }

    /// Tells the end at the terminal and in the window.
    fn end(&mut self, choice: &Choice, session: &Path, outcome: Outcome) -> Result<(), AppError> {
        let told = tell(session);
        if told.is_ok() {
            println!("questions     spandrel questionnaire {}", session.display());
        }
        let result = match outcome {
            Outcome::Lost(error) => Err(error),
            Outcome::Over | Outcome::Restart => told,
        };
        let open = self.is_open();
        // Where the window broke off nothing can be drawn; who interrupts waits for no pictures.
        if (open || self.closed) && result.is_ok() && !self.stop.asked() {
            self.photographs.draw(session);
        }
        if open {
            self.offer(choice);
            let web = self.web.as_ref().map(|web| web.server.address());
            let trouble = result.as_ref().err().map(ToString::to_string);
            let ended = offers::ended(session, web, trouble);
            self.say(&ToWindow::Ended(ended));
        }
        result
    }

    /// Serves the pages of the sessions and of this vehicle's flight, from one address throughout. Without them one flies all the same.
    fn serve(&mut self, vehicle: Option<SocketAddr>) {
        let args::Port::Number(mut port) = self.args.web else { return };
        match self.web.take() {
            Some(web) if web.vehicle == vehicle => {
                self.web = Some(web);
                return;
            }
            Some(web) => port = port_of(web.server.address()).unwrap_or(port),
            None => {}
        }
        // The records lie beside the sessions; the first session may not have begun.
        let made = std::fs::create_dir_all(&self.args.sessions);
        let watched = vehicle.map(|vehicle| Watched { vehicle, picture: Some(camera(self.args)) });
        let place = Place { sessions: vec![self.args.sessions.clone()], database: None };
        let setup = Setup { place, scenarios: None, watched: watched.into_iter().collect(), wordings: Vec::new() };
        let started = made
            .map_err(|error| AppError::failed(format!("{}: {error}", self.args.sessions.display())))
            .and_then(|()| Server::start(&ListenArgs::local(port), setup));
        match started {
            Ok(server) => self.web = Some(Pages { server, vehicle }),
            Err(error) => tracing::warn!("no web pages: {error}"),
        }
    }

    /// Keeps the pages for whoever sits at the terminal: the questionnaire comes after the flight.
    fn linger(&mut self, session: &Path) {
        let (Some(web), true, false) = (&self.web, self.prompt.is_open(), self.stop.asked()) else { return };
        let address = offers::ended(session, Some(web.server.address()), None).questionnaire;
        println!("in a browser  {address}   (the pages stay until you press Enter)");
        // Enter ends the pages alone: the photographs are still waited for.
        while self.prompt.answer().is_none() && !self.stop.asked() {
            std::thread::sleep(LOOK);
        }
    }
}

/// A choice of the window is as good as one of the command line.
fn checked(choice: &Choice) -> Result<(), AppError> {
    choice.trainee.parse::<TraineeId>().map_err(AppError::wrong)?;
    files::scenario(&choice.scenario).map(|_| ())
}

fn port_of(address: &str) -> Option<u16> {
    address.rsplit(':').next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::super::tests::parsed;
    use super::*;
    use spandrel_view::flow::pipe::Purpose;

    #[test]
    fn exact_a_window_that_breaks_off_is_let_go_of_before_the_flight_is_told() {
        let args = parsed(&["--scenario", "drill-hover"]);
        let mut course = Course::new(&args, tracing::Level::WARN, Stop::default());
        course.window = Some(Window::broken());
        let choice = Choice { trainee: "anna".into(), scenario: "drill-hover".into(), purpose: Purpose::Practice };
        assert!(matches!(course.given(&choice), Next::Fly(flown) if flown == choice));
        assert!(course.window.is_none() && !course.shows() && !course.closed);
        course.stop.ask();
        assert!(matches!(course.given(&choice), Next::Leave), "who interrupts wants no flight");
    }
}
