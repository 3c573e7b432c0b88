//! Arguments that several subcommands share, with their allowed ranges.

use super::clock;
use spandrel_model::scenario::Scenario;
use spandrel_sitl::endpoint::flavour as endpoint;
use spandrel_view::flow::pipe;
use std::net::{IpAddr, SocketAddr, ToSocketAddrs};
use std::str::FromStr;

/// Maximum seed: MAVLink messages carry it as a signed 32-bit integer.
const SEED_MAX: u64 = i32::MAX as u64;

/// Scenario, aircraft and seed of a flight.
#[derive(Debug, Clone, clap::Args)]
pub struct JobArgs {
    /// Scenario: a file, or the name of a shipped one
    #[arg(long, value_name = "FILE|NAME", default_value = "two-bridges")]
    pub scenario: String,
    /// Aircraft: a file, or the name of a shipped one
    #[arg(long, value_name = "FILE|NAME", default_value = "phantom2")]
    pub vehicle: String,
    /// Seed for everything random (defects, traffic, gusts, sensor noise), 0 to 2147483647 [default: the scenario's, else a new one]
    #[arg(long, value_name = "N", value_parser = seed, allow_negative_numbers = true)]
    pub seed: Option<u64>,
}

impl JobArgs {
    /// Returns the requested seed, else the scenario's, else a new one.
    pub fn seed_for(&self, scenario: &Scenario) -> u64 {
        self.seed.or(scenario.seed).unwrap_or_else(random_seed)
    }
}

/// Parses a seed for `--seed`, 0 to 2147483647.
pub fn seed(text: &str) -> Result<u64, String> {
    text.parse().ok().filter(|seed| *seed <= SEED_MAX).ok_or_else(|| format!("'{text}' is not a seed (allowed: 0 to {SEED_MAX})"))
}

/// Returns a new seed from the wall clock.
pub fn random_seed() -> u64 {
    spandrel_model::random::RandomStream::new(clock::unix_us(), "session seed").bits() & SEED_MAX
}

/// Autopilot protocol that the vehicle uses toward its clients.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Flavour {
    /// PX4; best supported by ground stations and SDKs
    Px4,
    /// ArduCopter: its modes, parameter names, missions that begin with home, streams on request
    Ardupilot,
    /// The MAVLink standard only: QGroundControl shows the vehicle, but offers no flight modes and no guided flight
    Generic,
}

impl Flavour {
    /// Returns the autopilot protocol.
    pub fn display_name(self) -> &'static endpoint::Flavour {
        match self {
            Self::Px4 => &endpoint::px4::FLAVOUR,
            Self::Ardupilot => &endpoint::ardupilot::FLAVOUR,
            Self::Generic => &endpoint::generic::FLAVOUR,
        }
    }

    /// Returns the option as arguments for a child process.
    pub fn to_args(self) -> Vec<String> {
        vec!["--flavour".to_owned(), self.display_name().name.to_owned()]
    }
}

/// Purpose of a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Purpose {
    /// You can pause or restart
    Practice,
    /// One attempt: no pause, restart or map
    Assessment,
}

impl Purpose {
    /// Converts to the type that the window and the session files use.
    pub fn display_name(self) -> pipe::Purpose {
        match self {
            Self::Practice => pipe::Purpose::Practice,
            Self::Assessment => pipe::Purpose::Assessment,
        }
    }

    /// Returns the purpose as one word.
    pub fn word(self) -> &'static str {
        self.display_name().word()
    }
}

/// A destination address, or none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Destination {
    /// Nothing is sent (`none` on the command line).
    None,
    /// Address to send to.
    Address(SocketAddr),
}

impl FromStr for Destination {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        if text == "none" { Ok(Self::None) } else { address(text).map(Self::Address) }
    }
}

/// Parses and resolves HOST:PORT; prefers IPv4 to IPv6.
pub fn address(text: &str) -> Result<SocketAddr, String> {
    let mut found: Vec<SocketAddr> =
        text.to_socket_addrs().map_err(|error| format!("'{text}' is not HOST:PORT, for example 127.0.0.1:14550 ({error})"))?.collect();
    found.sort_by_key(|address| !address.is_ipv4());
    found.into_iter().find(|address| address.port() != 0).ok_or_else(|| format!("'{text}' has no usable address and port"))
}

/// A port number, or none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PortChoice {
    /// The port stays closed (`none` on the command line).
    None,
    /// A port number; 0 lets the system choose a free one.
    Number(u16),
}

impl FromStr for PortChoice {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        if text == "none" {
            return Ok(Self::None);
        }
        text.parse().map(Self::Number).map_err(|_| format!("'{text}' is not a port (allowed: 0 to 65535, or none)"))
    }
}

/// Trainee ID, valid in folder names and records.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TraineeId(String);

impl TraineeId {
    /// Returns the ID as text.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl FromStr for TraineeId {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let fits = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        let starts = text.starts_with(|c: char| c.is_ascii_alphanumeric());
        if starts && text.len() <= 32 && text.chars().all(fits) {
            return Ok(Self(text.to_owned()));
        }
        Err(format!("'{text}' is not a trainee ID (allowed: 1 to 32 letters, digits, '-' or '_', starting with a letter or digit)"))
    }
}

/// Parses the local address to bind.
pub fn listen(text: &str) -> Result<IpAddr, String> {
    text.parse().map_err(|_| format!("'{text}' is not an IP address (127.0.0.1 for this machine only, 0.0.0.0 for all networks)"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_trainee_ids_stay_harmless_in_paths() {
        for good in ["anna", "t-07", "A_1", "7"] {
            assert_eq!(good.parse::<TraineeId>().map(|id| id.0), Ok(good.to_owned()));
        }
        for bad in ["", "-x", "../up", "a b", "é", "a/b", "123456789012345678901234567890123"] {
            assert!(bad.parse::<TraineeId>().is_err(), "{bad}");
        }
    }

    #[test]
    fn exact_targets_and_ports_parse() {
        assert_eq!("none".parse(), Ok(Destination::None));
        assert_eq!("127.0.0.1:14550".parse(), Ok(Destination::Address(SocketAddr::from(([127, 0, 0, 1], 14550)))));
        assert!("14550".parse::<Destination>().is_err());
        assert!("127.0.0.1:0".parse::<Destination>().is_err());
        assert_eq!("0".parse(), Ok(PortChoice::Number(0)));
        assert_eq!("none".parse(), Ok(PortChoice::None));
        assert!("70000".parse::<PortChoice>().is_err());
    }

    #[test]
    fn exact_seeds_fit_the_wire() {
        assert_eq!(seed("2147483647"), Ok(2_147_483_647));
        assert!(seed("2147483648").is_err());
        assert!(seed("-1").is_err());
        assert!(random_seed() <= SEED_MAX);
    }
}
