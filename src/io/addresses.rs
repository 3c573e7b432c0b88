//! Parses the addresses and ports that users specify.

use std::net::{IpAddr, SocketAddr, ToSocketAddrs};
use std::str::FromStr;

/// Destination address, or none.
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

/// Parses and resolves HOST:PORT. Prefers IPv4 addresses to IPv6 addresses.
pub fn address(text: &str) -> Result<SocketAddr, String> {
    let mut found: Vec<SocketAddr> = text
        .to_socket_addrs()
        .map_err(|error| format!("'{text}' is not HOST:PORT, for example 127.0.0.1:14550 ({error})"))?
        .collect();
    found.sort_by_key(|address| !address.is_ipv4());
    found
        .into_iter()
        .find(|address| address.port() != 0)
        .ok_or_else(|| format!("'{text}' does not resolve to a usable address and port"))
}

/// Port number, or none.
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

/// Parses the local address to bind to.
pub fn listen(text: &str) -> Result<IpAddr, String> {
    text.parse().map_err(|_| format!("'{text}' is not an IP address (127.0.0.1 for this machine only, 0.0.0.0 for all networks)"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_destinations_and_ports_parse() {
        assert_eq!("none".parse(), Ok(Destination::None));
        assert_eq!("127.0.0.1:14550".parse(), Ok(Destination::Address(SocketAddr::from(([127, 0, 0, 1], 14550)))));
        assert!("14550".parse::<Destination>().is_err());
        assert!("127.0.0.1:0".parse::<Destination>().is_err());
        assert_eq!("0".parse(), Ok(PortChoice::Number(0)));
        assert_eq!("none".parse(), Ok(PortChoice::None));
        assert!("70000".parse::<PortChoice>().is_err());
    }
}
