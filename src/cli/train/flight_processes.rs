//! The simulator and monitor processes of one flight, and the window's requests during the flight.

use super::args::Args;
use super::connection_info::connection_instructions;
use super::expert_ghost::{BackgroundExpert, GhostJob};
use super::loading::FlightStep;
use super::offers;
use super::window::WindowProcess;
use crate::cli::args::{JobArgs, common_args};
use crate::cli::autopilot_args::AUTOPILOT_FOLDER;
use crate::errors::AppError;
use crate::io::children::{Child, early_exit};
use crate::io::files;
use crate::io::pause::{PAUSE_LINE, RESUME_LINE};
use crate::io::stop::StopRequest;
use serde_json::Value;
use spandrel_text::{Language, text};
use spandrel_view::flow::pipe::{FlightChoice, FlightStarted, FlownBy, FromWindow, GhostFlight, Purpose, ToWindow};
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::path::{Path, PathBuf};
use std::process::ExitStatus;
use std::time::Duration;

/// Interval at which the child processes are checked.
const CHECK_INTERVAL: Duration = Duration::from_millis(50);
/// Folder for the vehicle's files and flight logs inside the session folder, so that they are erased with the session.
const VEHICLE_FILES_FOLDER: &str = "vehicle";
/// Maximum number of monitor restarts per flight.
const MAX_MONITOR_RESTARTS: u32 = 10;

/// The processes of a running flight.
pub struct FlightProcesses {
    monitor: Child,
    sim: Child,
    /// The window on the second screen.
    second_window: Option<Child>,
    /// The synthetic expert, if the trainee watches.
    expert: Option<Child>,
    /// Arguments for starting it once the window shows the flight.
    expert_args: Option<Vec<String>>,
    /// Ports and seed that the simulator announced, as JSON.
    pub ports: Value,
    /// Address that the simulator listens on.
    host: IpAddr,
    session: PathBuf,
    choice: FlightChoice,
    title: String,
    paused: bool,
    /// Flight that a ghost repeats.
    ghost: Option<GhostFlight>,
    /// Whether the trainee's own flights are of an earlier version of the job.
    is_ghost_outdated: bool,
    /// The expert that flies for the ghost.
    background_expert: BackgroundExpert,
    /// Arguments for restarting the monitor with the same session and port.
    monitor_restart_args: Vec<String>,
    monitor_restarts: u32,
}

/// Reason why the wait for a flight ended.
pub enum FlightOutcome {
    /// The session ended, or the user ended it.
    Over,
    /// The flight must be restarted.
    Restart,
    /// A process exited unexpectedly.
    Lost(AppError),
}

impl FlightProcesses {
    /// Starts the processes. The session records when the site check was acknowledged, in µs since the Unix epoch. `report` gets
    /// each step before it begins.
    ///
    /// # Errors
    /// Returns an error if files or ports are invalid.
    pub fn start(
        args: &Args,
        (choice, site_check_unix_us): (&FlightChoice, Option<u64>),
        log: tracing::Level,
        language: Language,
        report: &mut dyn FnMut(FlightStep),
    ) -> Result<Self, AppError> {
        report(FlightStep::Job);
        let job = args.job(choice);
        let title = files::scenario(&job.scenario)?.scenario.title;
        let ghost = available_ghost(args, choice, language);
        let common = common_args(&job, log);
        let expert_args = expert_args(&common);
        let monitor_args = [common.clone(), monitor_args(args, choice, site_check_unix_us)].concat();
        let with_port = |port: String| [monitor_args.clone(), vec!["--port".to_owned(), port]].concat();
        report(FlightStep::Monitor);
        let mut monitor = Child::start("monitor", &with_port(args.ports.monitor_port().to_string()))?;
        let announced = monitor.read_announcement()?;
        let session = PathBuf::from(announced["session"].as_str().unwrap_or_default());
        let monitor_port = announced["port"].as_u64().unwrap_or_default().to_string();
        let monitor_restart_args =
            [with_port(monitor_port.clone()), vec!["--session".to_owned(), session.display().to_string()]].concat();
        let files = session.join(VEHICLE_FILES_FOLDER).display().to_string();
        let sim_args = [
            common,
            args.ports.to_args(),
            args.flavor.to_args(),
            args.autopilot.to_args(&session.join(AUTOPILOT_FOLDER)),
            vec!["--speed".into(), args.speed.to_string(), "--monitor-port".into(), monitor_port],
            vec!["--files".into(), files, "--after-crash".into(), "scenario".into()],
            vec!["--practice-controls".into(), practice_controls(choice).into()],
        ];
        report(FlightStep::Simulator);
        let mut sim = Child::start("sim", &sim_args.concat())?;
        let ports = sim.read_announcement()?;
        let listen = args.ports.listen;
        let here = if listen.is_unspecified() { IpAddr::V4(Ipv4Addr::LOCALHOST) } else { listen };
        let vehicle = ports["gcs_port"].as_u64().map(|port| format!("{here}:{port}"));
        let expert_args = match (choice.by, vehicle) {
            (FlownBy::Trainee, _) => None,
            (FlownBy::Expert, Some(vehicle)) => Some([expert_args, vec!["--connect".to_owned(), vehicle]].concat()),
            (FlownBy::Expert, None) => {
                return Err(AppError::invalid("the expert needs the ground station port, but --gcs-port is none"));
            }
        };
        Ok(Self {
            monitor,
            sim,
            second_window: None,
            expert: None,
            expert_args,
            ports,
            host: here,
            session,
            choice: choice.clone(),
            title,
            paused: false,
            ghost: ghost.flight,
            is_ghost_outdated: ghost.is_outdated,
            background_expert: BackgroundExpert::new(ghost.job),
            monitor_restart_args,
            monitor_restarts: 0,
        })
    }

    /// Opens the window on the second screen. The flight goes on if that fails, or if the user closes it.
    pub fn open_second_window(&mut self, args: &Args, log: tracing::Level) {
        let Some(payload) = self.port("payload_port") else { return };
        let seed = self.ports["seed"].as_u64();
        let mut words = common_args(&JobArgs { seed, ..args.job(&self.choice) }, log);
        words.extend(["--connect".to_owned(), payload.to_string()]);
        words.extend(["--layout", "inspector-only", "--second-screen", "--no-sound"].map(str::to_owned));
        words.extend(args.quality.iter().flat_map(|quality| ["--quality".to_owned(), quality.clone()]));
        words.extend(args.keys.iter().flat_map(|file| ["--keys".to_owned(), file.display().to_string()]));
        match self.choice.purpose {
            Purpose::Practice => {
                words.extend(["--path".to_owned(), offers::path_aids(&args.sessions, &self.choice.trainee).word().to_owned()]);
            }
            Purpose::Assessment => words.push("--no-map".to_owned()),
        }
        let opened = Child::start("view", &words);
        self.second_window = opened.inspect_err(|error| tracing::warn!("no window on the second screen: {error}")).ok();
    }

    /// Returns the session folder.
    pub fn session(&self) -> &Path {
        &self.session
    }

    /// Returns the address of one of the vehicle's ports on this machine.
    pub fn port(&self, key: &str) -> Option<SocketAddr> {
        let port = self.ports[key].as_u64().and_then(|port| u16::try_from(port).ok())?;
        Some(SocketAddr::new(self.host, port))
    }

    /// Returns the message that tells the window to show the flight.
    pub fn started_message(&self, args: &Args) -> Option<ToWindow> {
        Some(ToWindow::Flying(FlightStarted {
            choice: self.choice.clone(),
            seed: self.ports["seed"].as_u64().unwrap_or_default(),
            connect: self.port("payload_port")?,
            // A trainee who watches does not move the sticks.
            fly: self.port("gcs_port").filter(|_| self.choice.by == FlownBy::Trainee),
            path_aids: offers::path_aids(&args.sessions, &self.choice.trainee),
            ghost: self.ghost.clone(),
            is_ghost_outdated: self.is_ghost_outdated,
        }))
    }

    /// Continues the expert's flight of an earlier attempt, if it is the same job.
    pub fn take_over_expert(&mut self, earlier: BackgroundExpert) {
        self.background_expert.take_over(earlier);
    }

    /// Returns the expert that flies in the background, for the next attempt.
    pub fn take_background_expert(&mut self) -> BackgroundExpert {
        std::mem::take(&mut self.background_expert)
    }

    /// Returns the instructions for connecting ground stations and scripts.
    pub fn connection_info(&self, args: &Args, web: Option<&str>, window: bool) -> String {
        connection_instructions((&self.title, &self.choice.scenario), &args.ports, &self.ports, &self.session, (web, window))
    }

    /// Waits until the session ends, a stop is requested, or a process exits unexpectedly. Meanwhile, handles the
    /// window's requests.
    pub fn wait(&mut self, window: &mut Option<WindowProcess>, stop: &StopRequest) -> FlightOutcome {
        if window.is_none() {
            self.start_expert();
        }
        loop {
            if let Some(window) = window {
                let wishes: Vec<FromWindow> = std::iter::from_fn(|| window.receive()).collect();
                for wish in wishes {
                    if let Some(outcome) = self.handle_window_message(&wish, window) {
                        return outcome;
                    }
                }
                if let Some(ghost) = self.background_expert.poll() {
                    window.send(&ToWindow::Ghost(ghost));
                }
                if !window.is_open() && self.paused {
                    // Without the window, the user would be unable to resume.
                    self.set_paused(false);
                }
            }
            if stop.is_requested() {
                return FlightOutcome::Over;
            }
            if let Some(status) = self.expert.as_mut().and_then(Child::exit_status).filter(|status| !status.success()) {
                return FlightOutcome::Lost(early_exit("expert", status));
            }
            match self.monitor.exit_status() {
                Some(status) if exited_normally(status) => return FlightOutcome::Over,
                Some(status) => {
                    if let Err(error) = self.restart_monitor(status) {
                        return FlightOutcome::Lost(error);
                    }
                }
                None => {}
            }
            if let Some(status) = self.sim.exit_status() {
                return FlightOutcome::Lost(early_exit("simulator", status));
            }
            std::thread::sleep(CHECK_INTERVAL);
        }
    }

    fn handle_window_message(&mut self, wish: &FromWindow, window: &mut WindowProcess) -> Option<FlightOutcome> {
        let practice = self.choice.purpose == Purpose::Practice;
        match wish {
            // An order is declined before the flight begins.
            FromWindow::Ready
            | FromWindow::Language { .. }
            | FromWindow::Aircraft { .. }
            | FromWindow::Declined
            | FromWindow::PrintBriefing(_)
            | FromWindow::Acknowledged(_) => {}
            FromWindow::Showing => {
                self.start_expert();
                self.background_expert.start();
            }
            FromWindow::Pause | FromWindow::Resume if practice => {
                self.set_paused(*wish == FromWindow::Pause);
                window.send(&ToWindow::Paused { on: self.paused });
            }
            FromWindow::Restart if practice => return Some(FlightOutcome::Restart),
            FromWindow::End => return Some(FlightOutcome::Over),
            FromWindow::Pause | FromWindow::Resume | FromWindow::Restart => {
                window.send(&ToWindow::Refused { words: text!(window.language, "window-train-not-in-assessment") });
            }
            FromWindow::Chosen(_) | FromWindow::Again | FromWindow::Quit | FromWindow::School(_) => {
                window.send(&ToWindow::Refused { words: text!(window.language, "window-train-in-flight") });
            }
        }
        None
    }

    /// Starts the synthetic expert, if the trainee watches and it does not fly yet.
    fn start_expert(&mut self) {
        let Some(expert_args) = self.expert_args.take() else { return };
        match Child::start("pilot", &expert_args) {
            Ok(expert) => self.expert = Some(expert),
            Err(error) => tracing::warn!("the expert cannot fly: {error}"),
        }
    }

    fn set_paused(&mut self, still: bool) {
        self.paused = still;
        self.sim.send_line(if still { PAUSE_LINE } else { RESUME_LINE });
        tracing::info!("{}", if still { "simulation paused" } else { "simulation resumed" });
    }

    /// Restarts a monitor that crashed during the flight; it reads the session's telemetry and continues.
    fn restart_monitor(&mut self, status: ExitStatus) -> Result<(), AppError> {
        self.monitor_restarts += 1;
        if self.monitor_restarts > MAX_MONITOR_RESTARTS {
            return Err(AppError::failed(format!(
                "the monitor crashed {} times, the last time with {status}",
                self.monitor_restarts
            )));
        }
        tracing::warn!("the monitor crashed ({status}); restarting it on the same session");
        self.monitor = Child::start("monitor", &self.monitor_restart_args)?;
        self.monitor.read_announcement().map(|_| ())
    }

    /// Stops the monitor, which then scores the session and completes its folder. The vehicle stays connected.
    pub fn end_session(&mut self) {
        // The results are in the main window.
        self.second_window = None;
        self.monitor.finish();
        if let Some(mut expert) = self.expert.take() {
            expert.finish();
        }
        if self.paused {
            self.set_paused(false);
        }
    }

    /// Returns the simulator's exit status, if it has exited.
    pub fn simulator_exit_status(&mut self) -> Option<ExitStatus> {
        self.sim.exit_status()
    }

    /// Stops both processes; the session is saved.
    pub fn finish(&mut self) {
        self.monitor.finish();
        if let Some(expert) = &mut self.expert {
            expert.finish();
        }
        self.sim.finish();
    }
}

/// Returns true if a monitor exited on its own, false if it was killed or crashed.
fn exited_normally(status: ExitStatus) -> bool {
    status.code().is_some_and(|code| (0..=2).contains(&code))
}

/// The ghost of a practice.
#[derive(Default)]
struct AvailableGhost {
    /// Flight that it repeats.
    flight: Option<GhostFlight>,
    /// Whether the trainee's own flights are of an earlier version of the job.
    is_outdated: bool,
    /// Job that the expert flies for it, if there is no flight yet.
    job: Option<GhostJob>,
}

fn available_ghost(args: &Args, choice: &FlightChoice, language: Language) -> AvailableGhost {
    let practices = choice.purpose == Purpose::Practice && choice.by == FlownBy::Trainee;
    let job = files::scenario(&choice.scenario).ok().filter(|_| practices).zip(files::vehicle(&choice.vehicle).ok());
    let Some((scenario, vehicle)) = job else { return AvailableGhost::default() };
    let recorded = offers::recorded_ghost(&args.sessions, &choice.trainee, &scenario, language);
    let is_outdated = recorded.is_outdated;
    if recorded.flight.is_some() {
        return AvailableGhost { flight: recorded.flight, is_outdated, job: None };
    }
    let words = offers::expert_ghost_words(is_outdated, language);
    let job = GhostJob::new(&args.sessions, scenario.scenario, vehicle.vehicle, words);
    let flight = job.as_ref().and_then(GhostJob::flown);
    AvailableGhost { job: job.filter(|_| flight.is_none()), flight, is_outdated }
}

/// Returns whether the flight can be frozen and rewound.
fn practice_controls(choice: &FlightChoice) -> &'static str {
    match choice.purpose {
        Purpose::Practice => "on",
        Purpose::Assessment => "off",
    }
}

fn expert_args(common: &[String]) -> Vec<String> {
    [common, &["--skill", "expert"].map(str::to_owned)].concat()
}

fn monitor_args(args: &Args, choice: &FlightChoice, site_check_unix_us: Option<u64>) -> Vec<String> {
    let mut words = [
        "--sessions",
        &args.sessions.display().to_string(),
        "--trainee",
        match choice.by {
            FlownBy::Trainee => &choice.trainee,
            FlownBy::Expert => offers::EXPERT_ID,
        },
        "--purpose",
        choice.purpose.word(),
        "--instance",
        &args.ports.instance.to_string(),
    ]
    .map(str::to_owned)
    .to_vec();
    words.extend(site_check_unix_us.into_iter().flat_map(|time| ["--site-check-unix-us".to_owned(), time.to_string()]));
    words
}
