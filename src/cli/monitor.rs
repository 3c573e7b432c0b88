//! `spandrel monitor`: runs the sans-IO monitor with its sockets, clock and session folder.

use super::args::{self, JobArgs};
use super::ports::MONITOR_PORT;
use super::table;
use crate::errors::{AppError, EXIT_CODES};
use crate::io::addresses;
use crate::io::append_file::WriteError;
use crate::io::clock::{self, Stopwatch};
use crate::io::files::{self, ScenarioFile, VehicleFile};
use crate::io::net::{NetEvent, SocketHub, SocketId};
use crate::io::pacing::SimulationSpeed;
use crate::io::progress::ProgressLog;
use crate::io::report;
use crate::io::session_folder::{SessionFolder, StoredSession};
use crate::io::stop::StopRequest;
use crate::io::trainee_id::TraineeId;
use crate::io::user_language::user_language;
use crate::records::reliability_beside;
use serde_json::json;
use spandrel_mavlink::dialect::MavSeverity;
use spandrel_model::time::SimTime;
use spandrel_monitor::folder::SessionInfo;
use spandrel_monitor::sidecar::build_site;
use spandrel_monitor::{AssessError, AssessedSession, Monitor, MonitorConfig, export};
use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;
use std::time::Duration;

/// Maximum time to wait for a datagram, because the core must be updated every 100 ms.
const MAX_DATAGRAM_WAIT: Duration = Duration::from_millis(50);
/// Interval at which received data is written to disk.
const FLUSH_INTERVAL: Duration = Duration::from_millis(250);
/// Time without data after which the vehicle may use another address.
const SILENCE_TIMEOUT: Duration = Duration::from_secs(3);
/// Interval between warnings to the pilot while the disk cannot be written.
const WARNING_INTERVAL: Duration = Duration::from_secs(30);
/// Maximum number of datagrams processed before replies are sent.
const MAX_BATCH_LEN: usize = 256;

/// Monitor a flight and score it
///
/// Receives the vehicle's MAVLink telemetry, warns the pilot with status texts (off path, too close, speeding, crash,
/// battery), and writes the session folder. When the session ends (landing near the ground team, empty battery, time
/// limit, or collision with a person or vehicle), it writes the assessment. It uses only the telemetry. To resume after
/// the monitor was killed, use --session DIR. While the disk is full, it keeps telemetry in memory, warns the pilot,
/// and retries.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel monitor --trainee anna                      score instance 0 of the simulator (UDP 14030)
  spandrel monitor --connect 127.0.0.1:14280 --port 0  connect an additional monitor to the vehicle's payload port
  spandrel monitor --session sessions/20260801T...     resume in flight after the monitor was killed

{EXIT_CODES}"))]
pub struct Args {
    #[command(flatten)]
    job: JobArgs,
    /// Folder where the session folder is created
    #[arg(long, value_name = "DIR", default_value = "sessions")]
    sessions: PathBuf,
    /// Trainee ID: letters, digits, '-' and '_', at most 32 characters
    #[arg(long, value_name = "ID", default_value = "anonymous")]
    trainee: TraineeId,
    /// Purpose of the flight, saved in session.json [default: not recorded]
    #[arg(long, value_name = "PURPOSE")]
    purpose: Option<args::Purpose>,
    /// Time at which the trainee acknowledged the briefing's site check, microseconds since 1970-01-01 UTC, saved in session.json
    /// [default: not recorded]
    #[arg(long, value_name = "US")]
    site_check_unix_us: Option<u64>,
    /// Ignored, because the monitor takes the time from the telemetry; accepted for compatibility with train and demo
    #[arg(long, value_name = "X|max")]
    speed: Option<SimulationSpeed>,
    /// Resume this session after its monitor was killed (uses the folder's scenario, vehicle and trainee)
    #[arg(long, value_name = "DIR")]
    session: Option<PathBuf>,
    /// Vehicle instance: sets the default port
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=200))]
    instance: u8,
    /// UDP port to listen on, 0 for any free port [default: 14030 + instance]
    #[arg(long, value_name = "PORT")]
    port: Option<u16>,
    /// Send to the vehicle at this address instead of waiting for its first datagram
    #[arg(long, value_name = "HOST:PORT", value_parser = addresses::address)]
    connect: Option<SocketAddr>,
    /// Local address to bind
    #[arg(long, value_name = "ADDR", default_value = "127.0.0.1", value_parser = addresses::listen)]
    listen: IpAddr,
    /// Print one line of JSON {"port", "session"} on standard output at startup, and do not print the table at the end
    #[arg(long)]
    announce: bool,
    /// Stop when standard input closes (for a parent process)
    #[arg(long)]
    leash: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if files or ports are invalid, or the session cannot be scored.
pub fn run(args: &Args) -> Result<(), AppError> {
    let stop = StopRequest::install(args.leash)?;
    // The folder is created last, after the files have been read and the port has been opened, so an error leaves
    // nothing behind.
    let start = SessionStart::read(args)?;
    let mut hub = SocketHub::new();
    let port = args.port.unwrap_or(MONITOR_PORT + u16::from(args.instance));
    let socket = hub.bind(args.listen, port, "--port")?;
    let (config, monitor, folder) = start.open(args)?;
    if args.announce {
        println!("{}", json!({ "port": hub.port(socket), "session": folder.path() }));
    }
    tracing::info!("listening on UDP {}, writing {}", hub.port(socket), folder.path().display());
    let watch = Stopwatch::start();
    let defects_saved = config.scenario.defects.placed.is_some();
    let site_check_unix_us = args.site_check_unix_us.or_else(|| start.recorded_site_check_unix_us());
    let mut shell = MonitorProcess {
        hub,
        socket,
        peer: args.connect,
        last_datagram_time: Duration::ZERO,
        monitor,
        folder,
        defects_saved,
        site_check_unix_us,
        session_json_saved: false,
        last_flush: Duration::ZERO,
        last_warning_time: None,
        stopwatch: watch,
    };
    shell.save_and_report();
    let mut progress = ProgressLog::start("waiting for the vehicle");
    while shell.monitor.finished().is_none() {
        if stop.is_requested() || shell.monitor.refused().is_some() {
            shell.monitor.close();
        } else {
            shell.step();
        }
        progress.report(|| shell.status_line());
    }
    progress.finish();
    shell.end(args.announce, &stop)
}

/// A new session, or an existing session to resume.
enum SessionStart {
    New(Box<(ScenarioFile, VehicleFile)>),
    Resumed(PathBuf, Box<StoredSession>),
}

impl SessionStart {
    /// Reads the files without writing anything.
    fn read(args: &Args) -> Result<Self, AppError> {
        match &args.session {
            Some(path) => Ok(Self::Resumed(path.clone(), Box::new(StoredSession::read(path)?))),
            None => Ok(Self::New(Box::new((args.job.load_scenario()?, files::vehicle(&args.job.vehicle)?)))),
        }
    }

    /// Returns the time of the site check that the resumed session has recorded.
    fn recorded_site_check_unix_us(&self) -> Option<u64> {
        match self {
            Self::New(_) => None,
            Self::Resumed(_, stored) => stored.site_check_unix_us,
        }
    }

    fn open(&self, args: &Args) -> Result<(MonitorConfig, Monitor, SessionFolder), AppError> {
        let config = |scenario: &ScenarioFile, vehicle: &VehicleFile, trainee: &str, purpose, started_unix_us| MonitorConfig {
            scenario: scenario.scenario.clone(),
            vehicle: vehicle.vehicle.clone(),
            trainee: trainee.to_owned(),
            purpose,
            started_unix_us,
            system_id: args.instance + 1,
            seed: args.job.seed,
            survey_builder: build_site,
        };
        match self {
            Self::New(files) => {
                let (scenario, vehicle) = files.as_ref();
                let started_unix_us = clock::unix_us();
                let folder = SessionFolder::create(&args.sessions, args.trainee.as_str(), started_unix_us, scenario, vehicle)?;
                let purpose = args.purpose.map(|purpose| purpose.word().to_owned());
                let config = config(scenario, vehicle, args.trainee.as_str(), purpose, started_unix_us);
                Ok((config.clone(), Monitor::new(config), folder))
            }
            Self::Resumed(path, stored) => {
                let folder = SessionFolder::resume(path, stored)?;
                let purpose = stored.purpose.clone();
                let config = config(&stored.scenario, &stored.vehicle, &stored.trainee, purpose, stored.started_unix_us);
                let monitor = Monitor::resume(config.clone(), &stored.log)
                    .map_err(|error| AppError::failed(format!("{}: cannot read the telemetry: {error}", path.display())))?;
                Ok((config, monitor, folder))
            }
        }
    }
}

struct MonitorProcess {
    hub: SocketHub,
    socket: SocketId,
    peer: Option<SocketAddr>,
    last_datagram_time: Duration,
    monitor: Monitor,
    folder: SessionFolder,
    /// True after the seed and the placed defects have been saved in `scenario.toml`.
    defects_saved: bool,
    /// Wall time of the site check, for `session.json`.
    site_check_unix_us: Option<u64>,
    /// True if `session.json` is up to date.
    session_json_saved: bool,
    last_flush: Duration,
    /// Time of the last disk warning; `None` while the disk can be written.
    last_warning_time: Option<Duration>,
    stopwatch: Stopwatch,
}

impl MonitorProcess {
    /// Processes received data, sends the core's replies and saves its records.
    fn step(&mut self) {
        let mut wait = MAX_DATAGRAM_WAIT;
        for _ in 0..MAX_BATCH_LEN {
            let Some(arrival) = self.hub.next(wait) else { break };
            wait = Duration::ZERO;
            self.handle_event(&arrival);
        }
        let wall = self.stopwatch.elapsed();
        self.monitor.handle_timeout(SimTime::from_s(wall.as_secs_f64()));
        self.write_records();
        self.save_when_due();
        self.send();
    }

    fn handle_event(&mut self, arrival: &NetEvent) {
        let NetEvent::Datagram { from, bytes, .. } = arrival else { return };
        let wall = self.stopwatch.elapsed();
        if self.peer != Some(*from) {
            let current_is_alive = self.peer.is_some() && wall.saturating_sub(self.last_datagram_time) < SILENCE_TIMEOUT;
            if current_is_alive {
                tracing::debug!("ignored a datagram from another address: {from}");
                return;
            }
            if !self.monitor.is_from_vehicle(bytes) {
                tracing::debug!("ignored a datagram from {from}: the sender is not the vehicle");
                return;
            }
            tracing::info!("receiving from {from}");
            self.peer = Some(*from);
        }
        self.last_datagram_time = wall;
        self.monitor.handle_datagram(bytes);
    }

    fn send(&mut self) {
        while let Some(bytes) = self.monitor.poll_transmit() {
            if let Some(peer) = self.peer {
                self.hub.send(self.socket, peer, &bytes);
            }
        }
    }

    /// Adds the core's records to the session folder.
    fn write_records(&mut self) {
        while let Some(record) = self.monitor.poll_record() {
            self.folder.record(record);
        }
    }

    fn save_when_due(&mut self) {
        if self.stopwatch.elapsed().saturating_sub(self.last_flush) >= FLUSH_INTERVAL {
            self.save_and_report();
        }
    }

    fn save_and_report(&mut self) {
        self.last_flush = self.stopwatch.elapsed();
        let saved = self.save();
        self.report_disk(saved.err());
    }

    /// Writes all pending data.
    fn save(&mut self) -> Result<(), WriteError> {
        self.folder.flush()?;
        if !self.defects_saved
            && let (Some(seed), Some(survey)) = (self.monitor.seed(), self.monitor.survey())
        {
            self.folder.resolve(seed, survey.defects())?;
            self.defects_saved = true;
            self.session_json_saved = false;
        }
        if !self.session_json_saved {
            let (monitor, site_check_unix_us) = (&self.monitor, self.site_check_unix_us);
            self.folder.write_session_json(|scenario, vehicle, utc, starts| SessionInfo {
                site_check_unix_us,
                ..monitor.session_info(scenario, vehicle, utc, starts)
            })?;
            self.session_json_saved = true;
        }
        Ok(())
    }

    /// Logs disk errors (repeatedly while they last) and the recovery, and notifies the pilot of both.
    fn report_disk(&mut self, refused: Option<WriteError>) {
        let wall = self.stopwatch.elapsed();
        match refused {
            None if self.last_warning_time.take().is_some() => {
                tracing::info!("recording to disk resumed");
                self.monitor.notify_pilot("Recording resumed", MavSeverity::MAV_SEVERITY_INFO);
            }
            Some(refused) if self.last_warning_time.is_none_or(|last| wall.saturating_sub(last) >= WARNING_INTERVAL) => {
                self.last_warning_time = Some(wall);
                let (pending, dropped) = (self.folder.pending() / 1000, self.folder.dropped());
                tracing::warn!("{refused}; {pending} kB in memory, {dropped} records lost; retrying");
                let words = if refused.is_disk_full() { "Disk full: recording paused" } else { "Disk error: recording paused" };
                self.monitor.notify_pilot(words, MavSeverity::MAV_SEVERITY_ERROR);
            }
            None | Some(_) => {}
        }
    }

    /// Writes the complete session. If the disk fails, retries until a stop is requested.
    fn complete(&mut self, json: Option<&str>, stop: &StopRequest) -> Result<(), AppError> {
        loop {
            self.write_records();
            self.session_json_saved = false;
            let saved = self.save().and_then(|()| json.map_or(Ok(()), |json| self.folder.write_assessment(json)));
            match saved {
                Err(refused) if stop.is_requested() => return Err(refused.into()),
                saved => {
                    let done = saved.is_ok();
                    self.report_disk(saved.err());
                    self.send();
                    if done {
                        return Ok(());
                    }
                }
            }
            // The vehicle is still sending, so keep draining the receive queue and sending heartbeats.
            self.step();
        }
    }

    fn end(&mut self, announce: bool, stop: &StopRequest) -> Result<(), AppError> {
        if self.hub.dropped() > 0 {
            tracing::warn!("dropped {} datagrams because the queue was full", self.hub.dropped());
        }
        let json = self.outcome().ok().map(|assessed_session| export::json_text(&assessed_session.assessment));
        self.send();
        self.complete(json.as_deref(), stop)?;
        // The report reads the telemetry again; keeping the flight in memory as well would double memory use.
        self.monitor.free_flight_data();
        // The scores are saved; the report can be written again later.
        let advice = json.as_ref().and_then(|_| {
            let written = report::write(self.folder.path(), user_language(), &|job| reliability_beside(self.folder.path(), job));
            written.inspect_err(|error| tracing::warn!("cannot write the report: {error}")).ok()
        });
        if let Err(refused) = self.folder.sync() {
            tracing::warn!("{refused}; a power failure could damage the session");
        }
        let assessed_session = self.outcome()?;
        if !announce {
            print!("{}", table::scores_text(&json!(assessed_session.assessment), advice.as_ref()));
            table::print_locations(self.folder.path());
        }
        Ok(())
    }

    fn outcome(&self) -> Result<&AssessedSession, AppError> {
        let place = self.folder.path().display();
        match self.monitor.finished() {
            Some(Ok(assessed_session)) => Ok(assessed_session),
            Some(Err(error @ (AssessError::OtherScenario { .. } | AssessError::OtherSeed { .. }))) => {
                Err(AppError::invalid(format!(
                    "{error}: use the same --scenario and --seed for the simulator and the monitor (telemetry is in {place})"
                )))
            }
            Some(Err(error)) => Err(AppError::failed(format!("{error} (telemetry is in {place})"))),
            None => Err(AppError::failed(format!("the session has not ended (telemetry is in {place})"))),
        }
    }

    fn status_line(&self) -> String {
        let monitor = &self.monitor;
        let Some(flown) = monitor.flight_time() else {
            return if self.peer.is_some() { "connected, on the ground".into() } else { "waiting for the vehicle".into() };
        };
        let seconds = flown.ms() / 1000;
        let task = monitor.task().map_or("off path".to_owned(), |task| format!("on task {task}"));
        let battery = monitor.battery_pct().map_or(String::new(), |pct| format!(", battery {pct:.0}%"));
        format!("flight time {:02}:{:02}, {task}{battery}", seconds / 60, seconds % 60)
    }
}
