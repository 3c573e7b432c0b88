//! Ports that a vehicle opens, and addresses that it sends to from startup.

use super::serial::SerialDevice;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};

/// One vehicle's ports and fixed peers.
#[derive(Debug, Clone)]
pub struct VehiclePorts {
    /// MAVLink system ID.
    pub system_id: u8,
    /// Local address to bind.
    pub listen: IpAddr,
    /// UDP port for ground stations; 0 for any free port.
    pub gcs: Option<u16>,
    /// UDP port for payload clients; 0 for any free port.
    pub payload: Option<u16>,
    /// TCP port for ground stations; 0 for any free port.
    pub tcp: Option<u16>,
    /// Serial ports.
    pub serial: Vec<SerialDevice>,
    /// Ground stations to send to.
    pub stations: Vec<SocketAddr>,
    /// SDK to send to.
    pub sdk: Option<SocketAddr>,
    /// Monitor to send to.
    pub monitor: Option<SocketAddr>,
    /// Data rate limit of each link to a ground station, bytes/s.
    pub gcs_limit: Option<u32>,
}

/// Returns the address of one of this machine's ports.
pub fn local(port: u16) -> SocketAddr {
    SocketAddr::from((Ipv4Addr::LOCALHOST, port))
}
