//! Arguments that select the autopilot.

use super::ports::PortArgs;
use crate::errors::AppError;
use crate::io::autopilot::config::{AutopilotConfig, AutopilotKind};
use crate::io::serial::SerialDevice;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Working folder of an external autopilot in the session folder, so that it is erased with the session.
pub const AUTOPILOT_FOLDER: &str = "autopilot";

/// The autopilot that flies the aircraft.
#[derive(Debug, Clone, clap::Args)]
pub struct AutopilotArgs {
    /// Autopilot that flies the aircraft: the built-in one, or PX4 or ArduPilot in a process of its own
    #[arg(long, value_name = "NAME", default_value = "builtin")]
    pub autopilot: AutopilotChoice,
    /// PX4's SITL program, or its source or build folder [default: SPANDREL_PX4, or px4 on the search path]
    #[arg(long, value_name = "DIR|BINARY")]
    pub px4: Option<PathBuf>,
    /// ArduPilot's SITL program arducopter, or its source or build folder [default: SPANDREL_ARDUPILOT, or arducopter on
    /// the search path]
    #[arg(long, value_name = "DIR|BINARY")]
    pub ardupilot: Option<PathBuf>,
    /// Do not start the autopilot: print the command, and wait until you have started it
    #[arg(long)]
    pub wait: bool,
    /// Rate at which the autopilot gets sensor readings, Hz: 250, 500 or 1000 for PX4, 1000 or 500 for ArduPilot [default: the first of these]
    #[arg(long, value_name = "HZ")]
    pub autopilot_rate: Option<u32>,
    /// Port of the simulator interface on this machine, 0 for any free port [default: 4560 + instance for PX4, 9002 + 10 x
    /// instance for ArduPilot; any free port with --ports ephemeral]
    #[arg(long, value_name = "PORT")]
    pub autopilot_port: Option<u16>,
    /// Time in s of wall time (1 to 3600) within which the autopilot must connect, start answering, and answer each time
    /// after that
    #[arg(long, value_name = "SECONDS", default_value_t = 30, value_parser = clap::value_parser!(u32).range(1..=3600))]
    pub autopilot_timeout: u32,
    /// Working folder of the autopilot's process, for its output, its logs and a record of its version and parameters
    /// [default: a temporary folder]
    #[arg(long, value_name = "DIR")]
    pub autopilot_dir: Option<PathBuf>,
}

/// Autopilot, with the names used on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum AutopilotChoice {
    /// Spandrel's own; reproducible, and nothing else to install
    Builtin,
    /// A real PX4
    Px4,
    /// A real ArduPilot (copter)
    Ardupilot,
}

impl AutopilotArgs {
    /// Returns the external autopilot; `None` for the built-in one.
    pub fn kind(&self) -> Option<AutopilotKind> {
        match self.autopilot {
            AutopilotChoice::Builtin => None,
            AutopilotChoice::Px4 => Some(AutopilotKind::Px4),
            AutopilotChoice::Ardupilot => Some(AutopilotKind::ArduPilot),
        }
    }

    /// Returns the configuration of the external autopilot, with its working folder; `None` for the built-in one.
    ///
    /// # Errors
    /// Returns an error if an option does not apply to the selected autopilot.
    pub fn config(&self, folder: &Path, ports: &PortArgs) -> Result<Option<AutopilotConfig>, AppError> {
        let Some(kind) = self.kind() else {
            let given = [(self.wait, "--wait"), (self.autopilot_rate.is_some(), "--autopilot-rate")];
            return match given.iter().find(|(given, _)| *given) {
                Some((_, option)) => Err(AppError::invalid(format!("{option} needs --autopilot px4 or ardupilot"))),
                None => Ok(None),
            };
        };
        let location = match kind {
            AutopilotKind::Px4 => self.px4.clone(),
            AutopilotKind::ArduPilot => self.ardupilot.clone(),
        };
        let (wait, rate_hz, folder) = (self.wait, self.autopilot_rate, folder.to_owned());
        let timeout = Duration::from_secs(u64::from(self.autopilot_timeout));
        let flight_controller = self.flight_controller(ports)?;
        let keeps_folder = self.autopilot_dir.is_some();
        Ok(Some(AutopilotConfig { kind, location, flight_controller, wait, rate_hz, folder, keeps_folder, timeout }))
    }

    /// Returns the serial port of a flight controller: with PX4, --serial is its link and not a telemetry radio.
    ///
    /// # Errors
    /// Returns an error if an option does not apply to a flight controller.
    pub fn flight_controller(&self, ports: &PortArgs) -> Result<Option<SerialDevice>, AppError> {
        let Some(device) = ports.serial.first().filter(|_| self.autopilot == AutopilotChoice::Px4) else { return Ok(None) };
        let conflicts = [
            (ports.serial.len() > 1, "a second --serial", "one flight controller flies one vehicle"),
            (self.px4.is_some(), "--px4", "no process is started"),
            (self.wait, "--wait", "no process is started"),
            (self.autopilot_rate.is_some(), "--autopilot-rate", "the rate follows from the baud rate"),
            (self.autopilot_port.is_some(), "--autopilot-port", "the readings use the serial port"),
        ];
        match conflicts.iter().find(|(given, ..)| *given) {
            Some((_, option, why)) => Err(AppError::invalid(format!(
                "{option} does not apply to a flight controller (--autopilot px4 with --serial): {why}"
            ))),
            None => Ok(Some(device.clone())),
        }
    }

    /// Returns the port of the simulator interface for a vehicle; 0 for any free port.
    pub fn port(&self, kind: AutopilotKind, instance: u8, more: u8, ephemeral: bool) -> u16 {
        match self.autopilot_port {
            Some(0) => 0,
            Some(port) => port.saturating_add(kind.port_step() * u16::from(more)),
            None if ephemeral => 0,
            None => kind.first_port() + kind.port_step() * u16::from(instance),
        }
    }

    /// Formats the options as command-line arguments for a child process whose autopilot works in `folder`.
    pub fn to_args(&self, folder: &Path) -> Vec<String> {
        let Some(kind) = self.kind() else { return Vec::new() };
        let name = match kind {
            AutopilotKind::Px4 => "px4",
            AutopilotKind::ArduPilot => "ardupilot",
        };
        let mut out = vec!["--autopilot".to_owned(), name.to_owned()];
        let mut flag =
            |name: &str, value: Option<String>| out.extend(value.into_iter().flat_map(|value| [name.to_owned(), value]));
        let text = |path: &PathBuf| path.display().to_string();
        flag("--px4", self.px4.as_ref().map(text));
        flag("--ardupilot", self.ardupilot.as_ref().map(text));
        flag("--autopilot-rate", self.autopilot_rate.map(|rate| rate.to_string()));
        flag("--autopilot-port", self.autopilot_port.map(|port| port.to_string()));
        flag("--autopilot-timeout", Some(self.autopilot_timeout.to_string()));
        flag("--autopilot-dir", Some(self.autopilot_dir.clone().unwrap_or_else(|| folder.to_owned()).display().to_string()));
        if self.wait {
            out.push("--wait".to_owned());
        }
        out
    }
}
