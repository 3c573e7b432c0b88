//! Everything that one vehicle's external autopilot needs: its ports, its parameters and its working folder.

use super::config::AutopilotConfig;
use super::host::AutopilotHost;
use crate::errors::AppError;
use crate::io::serial::SerialDevice;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_model::vehicle::Vehicle;
use spandrel_sitl::backend::interface::SimulatorInterface;
use spandrel_sitl::backend::launch::LaunchSettings;
use spandrel_sitl::backend::px4::hil_plan::{ExtraSensors, HilPlan};
use spandrel_sitl::backend::px4::{self, Px4HilInterface};
use spandrel_sitl::endpoint::relay::RelayRules;
use std::net::{Ipv4Addr, UdpSocket};
use std::path::PathBuf;

/// The job, the aircraft and the site.
#[derive(Debug, Clone, Copy)]
pub struct SiteFacts<'a> {
    /// The job.
    pub scenario: &'a Scenario,
    /// The aircraft.
    pub vehicle: &'a Vehicle,
    /// The site.
    pub site: &'a Site,
}

/// One vehicle's external autopilot before its start.
#[derive(Debug)]
pub struct AutopilotSetup<'a> {
    config: &'a AutopilotConfig,
    settings: LaunchSettings,
    vehicle: &'a Vehicle,
    folder: PathBuf,
}

impl<'a> AutopilotSetup<'a> {
    /// Collects the settings. `ports` are the simulator interface's and the one for MAVLink messages. With several vehicles, each
    /// has a subfolder named by its system ID.
    ///
    /// # Errors
    /// Returns an error if the configured rate is not supported or no port is free.
    pub fn new(
        config: &'a AutopilotConfig,
        facts: &SiteFacts<'a>,
        instance: u8,
        (simulator_port, mavlink_port): (u16, u16),
        client_speed_factor: f64,
        several: bool,
    ) -> Result<Self, AppError> {
        let (team, rules) = (&facts.scenario.ground_team, &facts.scenario.rules);
        let settings = LaunchSettings {
            instance,
            simulator_port,
            mavlink_port,
            autopilot_port: free_port()?,
            client_speed_factor,
            rate_hz: config.rate_hz()?,
            home: facts.site.plane().geo_from_enu(team.pad_m),
            home_heading_deg: team.pad_heading_deg,
            battery_thresholds_pct: (rules.low_battery_pct, rules.critical_battery_pct),
        };
        let folder = if several { config.folder.join((instance + 1).to_string()) } else { config.folder.clone() };
        Ok(Self { config, settings, vehicle: facts.vehicle, folder })
    }

    /// Creates the simulator's side of the interface.
    ///
    /// # Errors
    /// Returns an error if the autopilot does not take readings at the configured rate, or a serial port is too slow.
    pub fn interface(&self, vehicle: &Vehicle) -> Result<Box<dyn SimulatorInterface>, AppError> {
        match &self.config.flight_controller {
            Some(device) => hil_interface(vehicle, self.settings.instance, device),
            None => self.config.kind.interface(vehicle, &self.settings),
        }
    }

    /// Returns the differences on MAVLink that the simulator must know.
    pub fn relay_rules(&self) -> RelayRules {
        self.config.kind.relay_rules()
    }

    /// Finds the program and writes its files. For a flight controller, writes the file with its parameters.
    ///
    /// # Errors
    /// Returns an error if the program is not found, the autopilot does not support the aircraft, or a file cannot be written.
    pub fn host(self) -> Result<AutopilotHost, AppError> {
        if let Some(device) = &self.config.flight_controller {
            let launch = px4::hil_launch(self.vehicle, &self.settings);
            return AutopilotHost::of_flight_controller(
                self.config,
                device.clone(),
                launch,
                self.folder,
                self.settings.instance + 1,
            );
        }
        let launch = self.config.kind.launch(self.vehicle, &self.settings)?;
        AutopilotHost::new(self.config, launch, self.folder)
    }
}

/// Returns a free UDP port on the loopback interface for the autopilot's end of its MAVLink link.
fn free_port() -> Result<u16, AppError> {
    let bound = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).and_then(|socket| socket.local_addr());
    bound.map(|address| address.port()).map_err(|error| AppError::failed(format!("no free UDP port: {error}")))
}

/// Creates the interface to a flight controller.
fn hil_interface(vehicle: &Vehicle, instance: u8, device: &SerialDevice) -> Result<Box<dyn SimulatorInterface>, AppError> {
    let Some(interface) = Px4HilInterface::new(vehicle, instance + 1, device.capacity_bytes_s()) else {
        let least_baud = SerialDevice::baud_for(HilPlan::min_capacity_bytes_s(&vehicle.sensors));
        return Err(AppError::invalid(format!(
            "--serial {device}: too slow for hardware in the loop, which needs at least {least_baud} baud; use 921600"
        )));
    };
    let plan = interface.plan();
    let extra = match plan.extra {
        ExtraSensors::None => "no range finders",
        ExtraSensors::Below => "the range finder below and the flow sensor",
        ExtraSensors::All => "all range finders and the flow sensor",
    };
    tracing::info!("flight controller on {device}: inertial readings at {:.0} Hz, GNSS, and {extra}", plan.rate_hz);
    Ok(Box::new(interface))
}
