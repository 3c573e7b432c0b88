//! A vehicle's network and serial ports, from the command line.

use crate::io::addresses::{self, Destination, PortChoice};
use crate::io::serial::SerialDevice;
use crate::io::vehicle_ports::{VehiclePorts, local};
use std::net::{IpAddr, SocketAddr};

const GCS_TARGET_PORT: u16 = 14550;
const SDK_TARGET_PORT: u16 = 14540;
const GCS_PORT: u16 = 18570;
const PAYLOAD_PORT: u16 = 14280;
/// UDP port of the first instance's monitor; each further instance uses the next port.
pub const MONITOR_PORT: u16 = 14030;
const TCP_PORT: u16 = 5760;
/// A vehicle's port options.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Ports")]
pub struct PortArgs {
    /// Vehicle instance (0 to 200): sets the system ID to 1 + N and increases default ports
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=200))]
    pub instance: u8,
    /// Ground station to send telemetry to from startup, or none; may be repeated [default: 127.0.0.1:14550]
    #[arg(long, value_name = "HOST:PORT|none")]
    pub gcs: Vec<Destination>,
    /// SDK to send telemetry to from startup, or none [default: 127.0.0.1:14540 + instance]
    #[arg(long, value_name = "HOST:PORT|none")]
    pub sdk: Option<Destination>,
    /// UDP port for incoming ground stations, or none [default: 18570 + instance]
    #[arg(long, value_name = "PORT|none")]
    pub gcs_port: Option<PortChoice>,
    /// UDP port for incoming payload clients (monitors, recorders), or none [default: 14280 + instance]
    #[arg(long, value_name = "PORT|none")]
    pub payload_port: Option<PortChoice>,
    /// UDP port on this machine where the monitor listens, or none [default: 14030 + instance]
    #[arg(long, value_name = "PORT|none")]
    pub monitor_port: Option<PortChoice>,
    /// TCP port for ground stations, or none [default: 5760 + 10 x instance]
    #[arg(long, value_name = "PORT|none")]
    pub tcp_port: Option<PortChoice>,
    /// Serial port with a radio or cable, such as /dev/ttyUSB0:57600; may be repeated. Its capacity in bytes/s is
    /// one-tenth of its baud rate. In sim with --autopilot px4: the port of the flight controller that flies the aircraft
    #[arg(long, value_name = "DEVICE:BAUD")]
    pub serial: Vec<SerialDevice>,
    /// Data rate limit in bytes/s for each UDP or TCP link to a ground station; streams and parameter downloads slow
    /// down accordingly [default: no limit]
    #[arg(long, value_name = "BYTES_S", value_parser = clap::value_parser!(u32).range(500..=100_000_000))]
    pub gcs_limit: Option<u32>,
    /// Local address to bind: 127.0.0.1 for this machine only, 0.0.0.0 for all network interfaces
    #[arg(long, value_name = "ADDR", default_value = "127.0.0.1", value_parser = addresses::listen)]
    pub listen: IpAddr,
    /// Default ports: the fixed numbers above, or any free ports (then --gcs and --sdk have no default values)
    #[arg(long, value_name = "fixed|ephemeral", default_value = "fixed", value_parser = ["fixed", "ephemeral"])]
    pub ports: String,
}

impl PortArgs {
    /// Returns whether ports without a number are any free ports.
    pub fn ephemeral(&self) -> bool {
        self.ports == "ephemeral"
    }

    fn port_for_instance(&self, first: u16) -> u16 {
        first + u16::from(self.instance)
    }

    /// Returns the ports of the vehicle that follows `more` positions after this one in the same process. All port
    /// numbers shift, except those that the system chooses. Only the first vehicle has serial ports.
    pub fn for_vehicle(&self, more: u8) -> Self {
        let port = |port: PortChoice, step: u16| match port {
            PortChoice::Number(number @ 1..) => PortChoice::Number(number.saturating_add(step * u16::from(more))),
            PortChoice::Number(0) | PortChoice::None => port,
        };
        let sdk = |target: Destination| match target {
            Destination::Address(mut address) => {
                address.set_port(address.port().saturating_add(u16::from(more)));
                Destination::Address(address)
            }
            Destination::None => Destination::None,
        };
        Self {
            instance: self.instance + more,
            sdk: self.sdk.map(sdk),
            gcs_port: self.gcs_port.map(|given| port(given, 1)),
            payload_port: self.payload_port.map(|given| port(given, 1)),
            monitor_port: self.monitor_port.map(|given| port(given, 1)),
            tcp_port: self.tcp_port.map(|given| port(given, 10)),
            serial: if more == 0 { self.serial.clone() } else { Vec::new() },
            ..self.clone()
        }
    }

    fn port(&self, given: Option<PortChoice>, first: u16) -> Option<u16> {
        match given {
            Some(PortChoice::None) => None,
            Some(PortChoice::Number(port)) => Some(port),
            None if self.ephemeral() => Some(0),
            None => Some(self.port_for_instance(first)),
        }
    }

    /// Returns the addresses of the ground stations to send telemetry to from startup.
    pub fn ground_stations(&self) -> Vec<SocketAddr> {
        let given = self.gcs.iter().filter_map(|target| match target {
            Destination::None => None,
            Destination::Address(address) => Some(*address),
        });
        if self.gcs.is_empty() && !self.ephemeral() { vec![local(GCS_TARGET_PORT)] } else { given.collect() }
    }

    /// Returns the address of the SDK to send telemetry to from startup.
    pub fn sdk(&self) -> Option<SocketAddr> {
        match self.sdk {
            Some(Destination::Address(address)) => Some(address),
            Some(Destination::None) => None,
            None if self.ephemeral() => None,
            None => Some(local(self.port_for_instance(SDK_TARGET_PORT))),
        }
    }

    /// Returns the monitor's UDP port on this machine, or 0 if there is none.
    pub fn monitor_port(&self) -> u16 {
        match self.monitor_port {
            Some(PortChoice::Number(port)) => port,
            Some(PortChoice::None) => 0,
            None if self.ephemeral() => 0,
            None => self.port_for_instance(MONITOR_PORT),
        }
    }

    fn tcp(&self) -> Option<u16> {
        match self.tcp_port {
            Some(PortChoice::None) => None,
            Some(PortChoice::Number(port)) => Some(port),
            None if self.ephemeral() => None,
            None => Some(TCP_PORT + 10 * u16::from(self.instance)),
        }
    }

    /// Returns the ports to open and the addresses to send to.
    pub fn resolve(&self) -> VehiclePorts {
        let stations = self.ground_stations();
        VehiclePorts {
            system_id: self.instance + 1,
            listen: self.listen,
            gcs: self.port(self.gcs_port, GCS_PORT).or((!stations.is_empty()).then_some(0)),
            payload: self.port(self.payload_port, PAYLOAD_PORT),
            tcp: self.tcp(),
            serial: self.serial.clone(),
            stations,
            sdk: self.sdk(),
            monitor: Some(self.monitor_port()).filter(|port| *port != 0).map(local),
            gcs_limit: self.gcs_limit,
        }
    }

    /// Formats the options as command-line arguments for a child process, without the monitor's port.
    pub fn to_args(&self) -> Vec<String> {
        let mut out = vec!["--instance".to_owned(), self.instance.to_string(), "--listen".to_owned(), self.listen.to_string()];
        out.extend(["--ports".to_owned(), self.ports.clone()]);
        let target = |target: &Destination| match target {
            Destination::None => "none".to_owned(),
            Destination::Address(address) => address.to_string(),
        };
        let port = |port: &PortChoice| match port {
            PortChoice::None => "none".to_owned(),
            PortChoice::Number(number) => number.to_string(),
        };
        let mut flag = |name: &str, value: String| out.extend([name.to_owned(), value]);
        self.gcs.iter().for_each(|gcs| flag("--gcs", target(gcs)));
        self.sdk.iter().for_each(|sdk| flag("--sdk", target(sdk)));
        self.serial.iter().for_each(|device| flag("--serial", device.to_string()));
        self.gcs_limit.iter().for_each(|limit| flag("--gcs-limit", limit.to_string()));
        for (name, given) in [("--gcs-port", self.gcs_port), ("--payload-port", self.payload_port), ("--tcp-port", self.tcp_port)]
        {
            given.iter().for_each(|given| flag(name, port(given)));
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Debug, Parser)]
    struct TestArgs {
        #[command(flatten)]
        ports: PortArgs,
    }

    fn parse(words: &[&str]) -> PortArgs {
        TestArgs::parse_from(["test"].iter().chain(words)).ports
    }

    #[test]
    fn exact_default_ports_shift_with_the_instance() {
        let args = parse(&[]);
        assert_eq!(args.ground_stations(), [local(14550)]);
        assert_eq!((args.sdk(), args.monitor_port(), args.tcp()), (Some(local(14540)), 14030, Some(5760)));
        assert_eq!((args.port(None, GCS_PORT), args.port(None, PAYLOAD_PORT)), (Some(18570), Some(14280)));
        let args = parse(&["--instance", "3"]);
        assert_eq!((args.sdk(), args.monitor_port(), args.tcp()), (Some(local(14543)), 14033, Some(5790)));
        assert_eq!((args.port(None, GCS_PORT), args.port(None, PAYLOAD_PORT)), (Some(18573), Some(14283)));
        assert_eq!(args.ground_stations(), [local(14550)]);
    }

    #[test]
    fn exact_child_process_arguments_round_trip() {
        let args = parse(&[
            "--instance",
            "2",
            "--gcs",
            "none",
            "--sdk",
            "127.0.0.1:9",
            "--tcp-port",
            "none",
            "--gcs-port",
            "0",
            "--gcs-limit",
            "900",
            "--serial",
            "/dev/x:9600",
        ]);
        let words = args.to_args();
        let again = parse(&words.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(format!("{again:?}"), format!("{args:?}"));
    }

    #[test]
    fn exact_additional_vehicles_get_shifted_ports() {
        let args = parse(&["--sdk", "127.0.0.1:9000", "--tcp-port", "7000", "--gcs-port", "0", "--serial", "/dev/ttyS1:57600"])
            .for_vehicle(2);
        assert_eq!((args.instance, args.sdk(), args.tcp(), args.monitor_port()), (2, Some(local(9002)), Some(7020), 14032));
        assert_eq!((args.port(args.gcs_port, GCS_PORT), args.port(None, PAYLOAD_PORT)), (Some(0), Some(14282)));
        assert!(args.serial.is_empty());
    }
}
