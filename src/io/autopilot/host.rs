//! Runs one vehicle's external autopilot: starts its process, watches it, starts it again on request, and records which one flew.

use super::config::{AutopilotConfig, AutopilotKind};
use super::find::{AutopilotProgram, find};
use super::flight_controller::{FlightController, FrameUse};
use super::process::{AutopilotProcess, OUTPUT_FILE, search_path, write_files};
use super::record;
use crate::errors::{AppError, AutopilotFailure};
use crate::io::serial::SerialDevice;
use spandrel_mavlink::codec::ReceivedFrame;
use spandrel_mavlink::dialect::MavMessage;
use spandrel_sitl::backend::launch::{Launch, shell_quoted};
use spandrel_sitl::endpoint::relay::FirmwareVersion;
use spandrel_sitl::sim::{AutopilotState, Sim};
use std::path::PathBuf;
use std::time::Duration;

/// Wall time without an answer after which a warning is logged.
const SILENCE_WARNING: Duration = Duration::from_secs(2);
/// Interval between checks of the process: a system call that is not needed in every tick.
const EXIT_CHECK_INTERVAL: Duration = Duration::from_millis(200);

/// State of the exchange that the watch measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    /// The process has not connected.
    Connecting,
    /// The process has connected but has not answered.
    FirstAnswer,
    /// An answer is outstanding.
    Waiting,
    /// No answer is outstanding.
    Answered,
}

/// One vehicle's external autopilot.
#[derive(Debug)]
pub struct AutopilotHost {
    kind: AutopilotKind,
    program: Option<AutopilotProgram>,
    flight_controller: Option<(SerialDevice, FlightController)>,
    launch: Launch,
    folder: PathBuf,
    /// Whether the user starts the process.
    wait: bool,
    timeout: Duration,
    process: Option<AutopilotProcess>,
    stage: (Stage, Duration),
    warned: bool,
    last_exit_check: Duration,
    starts: u32,
    recorded: Option<String>,
    /// Whether the record has a version, and its number of parameters.
    recorded_amount: (bool, usize),
    logged: Option<FirmwareVersion>,
}

impl AutopilotHost {
    /// Finds the program and writes the files of the process.
    ///
    /// # Errors
    /// Returns an error if the program is not found or a file cannot be written.
    pub fn new(config: &AutopilotConfig, launch: Launch, folder: PathBuf) -> Result<Self, AppError> {
        let program = find(config.kind, config.location.as_deref());
        let program = if config.wait { program.ok() } else { Some(program?) };
        write_files(&launch, &folder)?;
        Ok(Self::stopped(config, launch, folder, program))
    }

    /// Writes the files for a flight controller on a serial port. No process is started.
    ///
    /// # Errors
    /// Returns an error if a file cannot be written.
    pub fn of_flight_controller(
        config: &AutopilotConfig,
        device: SerialDevice,
        launch: Launch,
        folder: PathBuf,
        system_id: u8,
    ) -> Result<Self, AppError> {
        write_files(&launch, &folder)?;
        for file in launch.files.iter().filter(|_| config.keeps_folder) {
            tracing::info!("parameters for the flight controller: {}", folder.join(&file.name).display());
        }
        let flight_controller = Some((device, FlightController::new(system_id)));
        Ok(Self { flight_controller, ..Self::stopped(config, launch, folder, None) })
    }

    fn stopped(config: &AutopilotConfig, launch: Launch, folder: PathBuf, program: Option<AutopilotProgram>) -> Self {
        Self {
            kind: config.kind,
            program,
            flight_controller: None,
            launch,
            folder,
            wait: config.wait,
            timeout: config.timeout,
            process: None,
            stage: (Stage::Connecting, Duration::ZERO),
            warned: false,
            last_exit_check: Duration::ZERO,
            starts: 0,
            recorded: None,
            recorded_amount: (false, 0),
            logged: None,
        }
    }

    /// Returns whether the autopilot runs on a flight controller.
    pub fn is_flight_controller(&self) -> bool {
        self.flight_controller.is_some()
    }

    /// Returns the messages that are due for a flight controller.
    pub fn messages(&mut self, wall: Duration) -> Vec<MavMessage> {
        self.flight_controller.as_mut().map_or_else(Vec::new, |(_, controller)| controller.messages(wall))
    }

    /// Takes a frame of a flight controller.
    pub fn handle_frame(&mut self, frame: &ReceivedFrame, wall: Duration) -> FrameUse {
        self.flight_controller.as_mut().map_or(FrameUse::Forward, |(_, controller)| controller.handle(frame, wall))
    }

    /// Records that a flight controller has started again.
    pub fn finish_reboot(&mut self) {
        if let Some((_, controller)) = &mut self.flight_controller {
            controller.finish_reboot();
        }
    }

    /// Starts the process or, if the user starts it, prints the command.
    ///
    /// # Errors
    /// Returns an error if the process cannot be started.
    pub fn start(&mut self, wall: Duration) -> Result<(), AppError> {
        self.stage = (Stage::Connecting, wall);
        self.warned = false;
        self.starts += 1;
        if self.is_flight_controller() {
            return Ok(());
        }
        match &self.program {
            Some(program) if !self.wait => {
                self.process = Some(AutopilotProcess::start(self.kind, program, &self.launch, &self.folder, self.starts == 1)?);
            }
            _ => self.print_command(),
        }
        Ok(())
    }

    /// Ends the process and starts another one, or reboots the flight controller.
    ///
    /// # Errors
    /// Returns an error if the process cannot be started.
    pub fn restart(&mut self, reason: &str, wall: Duration) -> Result<(), AppError> {
        tracing::info!("restarting {}: {reason}", self.name());
        if let Some((_, controller)) = &mut self.flight_controller {
            controller.begin_reboot(wall);
        }
        if let Some(mut process) = self.process.take() {
            process.end();
        }
        self.start(wall)
    }

    /// Prints the command with which the user starts the autopilot.
    fn print_command(&self) {
        let name = self.kind.name();
        let again = if self.starts > 1 { "End the running process and start it again with" } else { "Start it with" };
        let (program, path) = match &self.program {
            Some(program) => (program.binary.display().to_string(), search_path(program, &self.folder)),
            None => (format!("{}-BINARY", name.to_uppercase()), None),
        };
        let path: Vec<_> = path.map(|path| ("PATH".to_owned(), path.to_string_lossy().into_owned())).into_iter().collect();
        let etc = self.program.as_ref().and_then(|program| program.etc.as_ref());
        let etc: Vec<_> = etc.map(|etc| etc.to_string_lossy().into_owned()).into_iter().collect();
        let line = self.launch.command_line(self.starts == 1, &program, &path, &etc);
        let folder = std::fs::canonicalize(&self.folder).unwrap_or_else(|_| self.folder.clone());
        eprintln!("Waiting for {name}. {again}:\n(cd {} && env {line})", shell_quoted(&folder.to_string_lossy()));
    }

    /// Checks the process and the progress of the exchange.
    ///
    /// # Errors
    /// Returns an error if the process has exited, does not connect, or does not answer.
    pub fn check(&mut self, core: &Sim, wall: Duration) -> Result<(), AppError> {
        let Some(state) = core.autopilot_state() else { return Ok(()) };
        self.check_exit(wall)?;
        let stage = match state {
            AutopilotState::Disconnected => Stage::Connecting,
            AutopilotState::Starting { has_answered: false, .. } => Stage::FirstAnswer,
            AutopilotState::Starting { is_waiting, .. } | AutopilotState::Running { is_waiting } => {
                // A flight controller sends motor commands all the time.
                if is_waiting || self.is_flight_controller() { Stage::Waiting } else { Stage::Answered }
            }
        };
        if stage != self.stage.0 || stage == Stage::Answered {
            self.stage = (stage, wall);
            self.warned = false;
            return Ok(());
        }
        self.check_silence(stage, wall.saturating_sub(self.stage.1))
    }

    /// Records what bytes from the autopilot have changed. An answer ends a silence even if the next readings are sent at once; bytes that
    /// are no answer don't. A flight controller's motor commands answer no particular readings, so all of them count.
    pub fn note_bytes(&mut self, before: Option<AutopilotState>, after: Option<AutopilotState>, wall: Duration) {
        if self.is_flight_controller() || is_answer(before, after) {
            self.note_progress(wall);
        }
    }

    /// Records that the time so far is no silence of the autopilot.
    pub fn note_progress(&mut self, wall: Duration) {
        self.stage.1 = wall;
        self.warned = false;
    }

    fn check_exit(&mut self, wall: Duration) -> Result<(), AppError> {
        if wall.saturating_sub(self.last_exit_check) < EXIT_CHECK_INTERVAL {
            return Ok(());
        }
        self.last_exit_check = wall;
        match self.process.as_mut().and_then(AutopilotProcess::exit_status) {
            Some(status) => Err(self.failure(AutopilotFailure::Exited, &format!("exited ({status})"))),
            None => Ok(()),
        }
    }

    fn check_silence(&mut self, stage: Stage, silent: Duration) -> Result<(), AppError> {
        let seconds = self.timeout.as_secs();
        let is_controller = self.is_flight_controller();
        let (failure, what) = match stage {
            Stage::Connecting if self.waits_for_user() => return Ok(()),
            Stage::Connecting if is_controller => (AutopilotFailure::NoAnswer, format!("has not rebooted within {seconds} s")),
            Stage::Connecting => (AutopilotFailure::NoAnswer, format!("has not connected to the simulator within {seconds} s")),
            Stage::FirstAnswer if is_controller => (
                AutopilotFailure::NoAnswer,
                format!(
                    "has not sent motor commands within {seconds} s: set SYS_HITL to 1, select a HIL airframe, restart it, and \
                     check the baud rate (docs: \"A flight controller on your desk\")"
                ),
            ),
            Stage::FirstAnswer => {
                (AutopilotFailure::NoAnswer, format!("has connected but has not sent motor commands within {seconds} s"))
            }
            Stage::Waiting if is_controller => (AutopilotFailure::Silent, format!("has not sent motor commands for {seconds} s")),
            Stage::Waiting => (AutopilotFailure::Silent, format!("has not answered for {seconds} s")),
            Stage::Answered => return Ok(()),
        };
        if silent > self.timeout {
            return Err(self.failure(failure, &what));
        }
        if stage == Stage::Waiting && silent > SILENCE_WARNING && !std::mem::replace(&mut self.warned, true) {
            let effect = if is_controller { "its motors are stopped" } else { "simulation time is stopped" };
            tracing::warn!("{} has not answered for {} s; {effect}", self.name(), SILENCE_WARNING.as_secs());
        }
        Ok(())
    }

    /// Returns whether only the user can continue.
    fn waits_for_user(&self) -> bool {
        self.wait || self.flight_controller.as_ref().is_some_and(|(_, controller)| controller.needs_user())
    }

    /// Returns the name in messages.
    fn name(&self) -> String {
        match &self.flight_controller {
            Some((device, _)) => format!("the flight controller on {device}"),
            None => self.kind.name().to_owned(),
        }
    }

    /// Creates the error for a closed connection.
    pub fn disconnected(&self) -> AppError {
        let what = if self.is_flight_controller() { "has disconnected" } else { "has closed its connection to the simulator" };
        self.failure(AutopilotFailure::Exited, what)
    }

    /// Creates an error that names the file with the output.
    fn failure(&self, failure: AutopilotFailure, what: &str) -> AppError {
        let output = if self.process.is_some() {
            format!("; its output is in {}", self.folder.join(OUTPUT_FILE).display())
        } else {
            String::new()
        };
        AppError::Autopilot(failure, format!("{} {what}{output}", self.name()))
    }

    /// Logs the version of the autopilot, with a warning if Spandrel has not been flown with it.
    pub fn log_version(&mut self, core: &Sim) {
        let Some(version) = core.autopilot_report().and_then(|report| report.version) else { return };
        if self.logged == Some(version) {
            return;
        }
        self.logged = Some(version);
        let name = self.kind.name();
        tracing::info!("{name} {} ({})", version.number_text(), version.hash_text());
        let [first, last] = self.kind.tested_versions();
        let [major, minor, _] = version.number;
        if [major, minor] < first || [major, minor] > last {
            let text = |[major, minor]: [u8; 2]| format!("{major}.{minor}");
            tracing::warn!("Spandrel has been flown with {name} {} to {} only", text(first), text(last));
        }
    }

    /// Writes which autopilot flew, with its version and parameters, if this is not recorded yet. A process that starts again has not
    /// reported everything, so its report replaces a record only when it contains as much.
    pub fn record(&mut self, core: &Sim) {
        let Some(report) = core.autopilot_report() else { return };
        let (has_version, parameters) = (report.version.is_some(), report.parameters.len());
        let (had_version, had_parameters) = self.recorded_amount;
        if self.recorded.is_some() && ((had_version && !has_version) || parameters < had_parameters) {
            return;
        }
        self.recorded_amount = (has_version, parameters);
        let text = record::text(self.kind, report, &self.launch.parameters);
        if self.recorded.as_ref() == Some(&text) {
            return;
        }
        if let Err(error) = record::write(&self.folder, &text) {
            tracing::warn!("{error}");
        }
        self.recorded = Some(text);
    }
}

/// Returns whether the exchange has progressed from one state to another: the first answer or the one that was outstanding has arrived.
fn is_answer(before: Option<AutopilotState>, after: Option<AutopilotState>) -> bool {
    let has_answered =
        |state| !matches!(state, AutopilotState::Disconnected | AutopilotState::Starting { has_answered: false, .. });
    let is_waiting =
        |state| matches!(state, AutopilotState::Starting { is_waiting: true, .. } | AutopilotState::Running { is_waiting: true });
    let (Some(before), Some(after)) = (before, after) else { return false };
    has_answered(after) && (!has_answered(before) || (is_waiting(before) && !is_waiting(after)))
}
