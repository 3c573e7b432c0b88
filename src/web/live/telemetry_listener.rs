//! Listener thread, which subscribes to one vehicle's payload port.

use super::command_queue::{CommandQueue, INSTRUCTOR_COMPONENT, INSTRUCTOR_SYSTEM};
use super::instructor_command::InstructorCommand;
use super::{flight_owner, picture};
use crate::errors::AppError;
use crate::io::clock::Stopwatch;
use crate::io::net::{NetEvent, SocketHub, SocketId};
use crate::web::lock::lock;
use crate::web::scenario_library as scenarios;
use serde_json::Value;
use spandrel_mavlink::codec::{Decoder, Encoder};
use spandrel_mavlink::dialect::{MavAutopilot, MavMessage};
use spandrel_mavlink::station;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_text::{Language, Translated};
use spandrel_training::report::plots::job::{job_plan, job_side, job_south};
use spandrel_training::terms::scenario_title;
use spandrel_training::web::live::{DrawingView, JobDrawings};
use spandrel_training::web::live_state::{JobIdentity, LiveFlightState};
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::path::PathBuf;
use std::sync::mpsc::Receiver;
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::sync::watch;

/// Interval between page updates.
const UPDATE_INTERVAL: Duration = Duration::from_millis(200);
/// Maximum time to wait for a datagram.
const MAX_DATAGRAM_WAIT: Duration = Duration::from_millis(50);
/// Heartbeat interval. The vehicle drops silent subscribers.
const HEARTBEAT_INTERVAL: Duration = Duration::from_secs(1);
/// Time without telemetry after which a vehicle is considered silent.
const SILENCE_TIMEOUT: Duration = Duration::from_secs(3);
/// Maximum number of datagrams processed per cycle.
const MAX_BATCH_LEN: usize = 256;

/// Files and folders that the listener reads.
#[derive(Debug, Clone)]
pub struct ListenerPaths {
    /// Sessions folders, which contain the scenarios of ongoing flights.
    pub sessions: Vec<PathBuf>,
    /// Folder for uploaded scenarios.
    pub scenarios: PathBuf,
    /// File to which a window saves the camera's view.
    pub picture: Option<PathBuf>,
}

/// Listener for one vehicle.
pub struct LiveListener {
    hub: SocketHub,
    socket: SocketId,
    vehicle: SocketAddr,
    flight: LiveFlightState,
    encoder: Encoder,
    commands: CommandQueue,
    /// Scenario that was not found, and the time of the last search for it.
    not_found: Option<(JobIdentity, Duration)>,
    /// Time of the last search for the trainee.
    last_trainee_search: Option<Duration>,
    known: SharedFlightInfo,
    paths: ListenerPaths,
}

/// Flight state that the pages read.
#[derive(Debug, Clone, Default)]
pub struct SharedFlightInfo {
    /// The scenario's drawings.
    pub drawings: Arc<Mutex<Option<Translated<JobDrawings>>>>,
    /// The current flight's trainee.
    pub trainee: Arc<Mutex<Option<String>>>,
}

impl SharedFlightInfo {
    /// Returns the scenario's drawings in a language; `None` until the scenario is known.
    pub fn drawings_in(&self, language: Language) -> Option<JobDrawings> {
        lock(&self.drawings).as_ref().map(|drawings| drawings.get(language).clone())
    }
}

impl LiveListener {
    /// Opens a socket for a vehicle.
    ///
    /// # Errors
    /// Returns an error if the socket cannot be opened.
    pub fn open(vehicle: SocketAddr, known: SharedFlightInfo, paths: ListenerPaths) -> Result<Self, AppError> {
        let ip: IpAddr = match vehicle.ip() {
            ip if ip.is_loopback() => ip,
            IpAddr::V4(_) => Ipv4Addr::UNSPECIFIED.into(),
            IpAddr::V6(_) => Ipv6Addr::UNSPECIFIED.into(),
        };
        let mut hub = SocketHub::new();
        let socket = hub.bind(ip, 0, "--vehicle")?;
        let (watch, encoder, commands) =
            (LiveFlightState::new(), Encoder::new(INSTRUCTOR_SYSTEM, INSTRUCTOR_COMPONENT), CommandQueue::default());
        Ok(Self {
            hub,
            socket,
            vehicle,
            flight: watch,
            encoder,
            commands,
            not_found: None,
            last_trainee_search: None,
            known,
            paths,
        })
    }

    /// Listens until the server stops.
    pub fn listen(&mut self, moments: &watch::Sender<Translated<String>>, commands: &Receiver<InstructorCommand>) {
        let clock = Stopwatch::start();
        let (mut heard, mut beat, mut told) = (None, None, None);
        let due = |last: Option<Duration>, every: Duration| last.is_none_or(|last| clock.elapsed() >= last + every);
        // The channel closes when the server and all its pages have been dropped.
        while !moments.is_closed() {
            if self.receive() {
                heard = Some(clock.elapsed());
            }
            if due(beat, HEARTBEAT_INTERVAL) {
                beat = Some(clock.elapsed());
                self.send(&station::companion_heartbeat());
            }
            for order in commands.try_iter() {
                self.commands.push(order);
            }
            self.send_due_commands(clock.elapsed());
            self.find_scenario(clock.elapsed());
            let lives = heard.is_some_and(|heard: Duration| clock.elapsed() < heard + SILENCE_TIMEOUT);
            self.find_trainee(lives, clock.elapsed());
            if due(told, UPDATE_INTERVAL) {
                told = Some(clock.elapsed());
                moments.send_replace(Translated::new(|language| self.moment(lives, language).to_string()));
            }
        }
    }

    fn moment(&self, heard: bool, language: Language) -> Value {
        let mut moment = self.flight.to_json(heard, language);
        moment["picture"] = self.paths.picture.as_deref().and_then(picture::version).into();
        moment
    }

    /// Processes received datagrams. Returns true if any of them came from the vehicle.
    fn receive(&mut self) -> bool {
        let (mut wait, mut spoke) = (MAX_DATAGRAM_WAIT, false);
        for _ in 0..MAX_BATCH_LEN {
            let Some(arrival) = self.hub.next(wait) else { break };
            wait = Duration::ZERO;
            let NetEvent::Datagram { from, bytes, .. } = arrival else { continue };
            // Datagrams from other addresses could be forged.
            if from != self.vehicle {
                continue;
            }
            for frame in Decoder::new().datagram(&bytes) {
                self.flight.handle_frame(&frame);
                if let Some(report) = self.commands.handle_frame(&frame) {
                    self.flight.push_message("warn", |language| report.words(language));
                }
                spoke = true;
            }
        }
        spoke
    }

    fn send_due_commands(&mut self, now: Duration) {
        let Some(system) = self.flight.system else { return };
        let cast = self.flight.autopilot == Some(MavAutopilot::MAV_AUTOPILOT_ARDUPILOTMEGA);
        let (frames, reports) = self.commands.poll_frames(now, &mut self.encoder, system, cast);
        for frame in frames {
            self.hub.send(self.socket, self.vehicle, &frame);
        }
        for report in reports {
            self.flight.push_message("info", |language| report.words(language));
        }
    }

    fn send(&mut self, message: &MavMessage) {
        let bytes = self.encoder.encode(message);
        self.hub.send(self.socket, self.vehicle, &bytes);
    }

    /// Finds the scenario with the vehicle's checksum: shipped, uploaded, or in a recent session folder.
    fn find_scenario(&mut self, now: Duration) {
        let Some(key) = self.flight.announced_job().filter(|key| self.flight.job() != Some(*key)) else { return };
        if self.not_found.is_some_and(|(other, at)| other == key && now < at + SILENCE_TIMEOUT) {
            return;
        }
        let Some(scenario) = self.read_scenario(key.crc) else {
            self.not_found = Some((key, now));
            return;
        };
        let drawings = draw_scenario(&scenario, key);
        *lock(&self.known.drawings) = Some(drawings);
        self.flight.set_job(key, &scenario);
    }

    /// Updates the trainee regularly, because another trainee may fly next.
    fn find_trainee(&mut self, lives: bool, now: Duration) {
        if self.last_trainee_search.is_some_and(|at| now < at + SILENCE_TIMEOUT) {
            return;
        }
        self.last_trainee_search = Some(now);
        let flown = self.flight.announced_job().filter(|_| lives);
        *lock(&self.known.trainee) = flown.and_then(|key| flight_owner::current_trainee(&self.paths.sessions, key));
    }

    fn read_scenario(&self, crc: u32) -> Option<Scenario> {
        let ListenerPaths { sessions, scenarios: uploads, .. } = &self.paths;
        let known = scenarios::all(uploads).iter().find_map(|job| job.variant_with_crc(crc));
        known.or_else(|| {
            let here: Vec<PathBuf> = sessions.iter().filter(|folder| folder.is_dir()).cloned().collect();
            let folders = crate::records::session_folders(&here).ok()?;
            // The newest folders come last.
            folders.iter().rev().take(20).find_map(|folder| {
                let scenario = crate::io::session_folder::StoredSession::read_scenario(folder).ok()?.scenario;
                (scenario.crc == crc).then_some(scenario)
            })
        })
    }
}

fn draw_scenario(scenario: &Scenario, key: JobIdentity) -> Translated<JobDrawings> {
    let site = Site::build(scenario, key.seed);
    Translated::new(|language| draw_site(scenario, &site, key, language))
}

/// Draws a site. The language is that of the title and of the drawings' labels.
fn draw_site(scenario: &Scenario, site: &Site, key: JobIdentity, language: Language) -> JobDrawings {
    let mut drawings = vec![(DrawingView::Above, job_plan(scenario, site, language).into_string())];
    for bridge in &scenario.bridges {
        drawings.push((DrawingView::Side(bridge.name.clone()), job_side(scenario, site, bridge, language).into_string()));
    }
    if scenario.bridges.is_empty() {
        drawings.push((DrawingView::South, job_south(scenario, site, language).into_string()));
    }
    let title = scenario_title(&scenario.name, &scenario.title, language);
    JobDrawings { key: format!("{:08x}-{}", key.crc, key.seed), title, drawings }
}
