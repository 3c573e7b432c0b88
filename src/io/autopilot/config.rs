//! Configuration of an external autopilot.

use crate::errors::AppError;
use crate::io::serial::SerialDevice;
use crate::io::simulator_socket::SimulatorProtocol;
use spandrel_model::vehicle::Vehicle;
use spandrel_sitl::backend::ardupilot::{self, ArduPilotInterface};
use spandrel_sitl::backend::interface::SimulatorInterface;
use spandrel_sitl::backend::launch::{Launch, LaunchSettings};
use spandrel_sitl::backend::px4::{self, Px4Interface};
use spandrel_sitl::endpoint::params::param_view;
use spandrel_sitl::endpoint::relay::RelayRules;
use std::path::PathBuf;
use std::time::Duration;

/// Sender from which ArduPilot up to 4.6 accepts sticks (SYSID_MYGCS, 255 by default), with the component ID of ground stations.
const ARDUPILOT_STICK_SENDER: (u8, u8) = (255, 190);

/// An autopilot program that runs as a process of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AutopilotKind {
    /// PX4, over TCP in lockstep.
    Px4,
    /// ArduPilot's copter, with JSON over UDP.
    ArduPilot,
}

/// How an external autopilot is run.
#[derive(Debug, Clone)]
pub struct AutopilotConfig {
    /// Which autopilot.
    pub kind: AutopilotKind,
    /// Location of the program, from the command line.
    pub location: Option<PathBuf>,
    /// Serial port of a flight controller that runs the autopilot; `None` if a process on this machine runs it.
    pub flight_controller: Option<SerialDevice>,
    /// Whether the user starts the program.
    pub wait: bool,
    /// Rate of the readings, Hz; `None` for the autopilot's default.
    pub rate_hz: Option<u32>,
    /// Working directory of the process.
    pub folder: PathBuf,
    /// Whether that folder is kept.
    pub keeps_folder: bool,
    /// Wall time within which the autopilot must connect, answer for the first time, and answer each time after that.
    pub timeout: Duration,
}

impl AutopilotKind {
    /// Returns the name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Px4 => "PX4",
            Self::ArduPilot => "ArduPilot",
        }
    }

    /// Returns the first port of the simulator interface. Each further vehicle adds [`Self::port_step`].
    pub fn first_port(self) -> u16 {
        match self {
            Self::Px4 => 4560,
            Self::ArduPilot => 9002,
        }
    }

    /// Returns the distance between the ports of two vehicles.
    pub fn port_step(self) -> u16 {
        match self {
            Self::Px4 => 1,
            Self::ArduPilot => 10,
        }
    }

    /// Returns the versions that Spandrel has been flown with (docs/src/measured/autopilots.md): the first and the last one, major and
    /// minor number.
    pub fn tested_versions(self) -> [[u8; 2]; 2] {
        match self {
            Self::Px4 => [[1, 16], [1, 16]],
            Self::ArduPilot => [[4, 6], [4, 7]],
        }
    }

    /// Returns the transport of the simulator interface.
    pub fn protocol(self) -> SimulatorProtocol {
        match self {
            Self::Px4 => SimulatorProtocol::Tcp,
            Self::ArduPilot => SimulatorProtocol::Udp,
        }
    }

    /// Returns the rates of the readings that the autopilot supports, Hz; the first one is the default.
    pub fn rates_hz(self) -> &'static [f64] {
        match self {
            Self::Px4 => &px4::RATES_HZ,
            Self::ArduPilot => &ardupilot::RATES_HZ,
        }
    }

    /// Returns the differences on MAVLink that the simulator must know.
    pub fn relay_rules(self) -> RelayRules {
        match self {
            Self::Px4 => {
                RelayRules { params: &param_view::PX4, restarts_by_process: true, roi_above_sea_level: true, stick_sender: None }
            }
            Self::ArduPilot => RelayRules {
                params: &param_view::COPTER,
                restarts_by_process: false,
                roi_above_sea_level: false,
                stick_sender: Some(ARDUPILOT_STICK_SENDER),
            },
        }
    }

    /// Creates the simulator's side of the interface.
    ///
    /// # Errors
    /// Returns an error if the autopilot does not take readings at the configured rate.
    pub fn interface(self, vehicle: &Vehicle, settings: &LaunchSettings) -> Result<Box<dyn SimulatorInterface>, AppError> {
        match self {
            Self::Px4 => match Px4Interface::new(vehicle, settings.rate_hz) {
                Some(interface) => Ok(Box::new(interface)),
                None => Err(AppError::invalid(format!("PX4 does not take readings at {} Hz", settings.rate_hz))),
            },
            Self::ArduPilot => Ok(Box::new(ArduPilotInterface::new(vehicle, settings))),
        }
    }

    /// Returns the command line, the environment and the files for the process.
    ///
    /// # Errors
    /// Returns an error if the autopilot does not support the aircraft.
    pub fn launch(self, vehicle: &Vehicle, settings: &LaunchSettings) -> Result<Launch, AppError> {
        match self {
            Self::Px4 => Ok(px4::launch(vehicle, settings)),
            Self::ArduPilot => ardupilot::launch(vehicle, settings).map_err(|error| AppError::invalid(error.to_string())),
        }
    }
}

impl AutopilotConfig {
    /// Returns the rate of the readings, Hz.
    ///
    /// # Errors
    /// Returns an error if the autopilot does not support the configured rate.
    pub fn rate_hz(&self) -> Result<f64, AppError> {
        let allowed = self.kind.rates_hz();
        let rate_hz = self.rate_hz.map_or(allowed[0], f64::from);
        if allowed.contains(&rate_hz) {
            return Ok(rate_hz);
        }
        let list = allowed.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
        Err(AppError::invalid(format!("--autopilot-rate {rate_hz}: {} takes readings at {list} Hz", self.kind.name())))
    }
}
