//! Sockets of an external autopilot: its simulator interface and its MAVLink link. Both accept only peers on this machine.

use super::link_event::LinkEvent;
use super::net::{NetEvent, SocketHub, SocketId};
use super::simulator_socket::{LOOPBACK, PORT_OPTION, SimulatorProtocol, SimulatorSocket};
use crate::errors::AppError;
use std::net::SocketAddr;

/// Result of handling a network event.
#[derive(Debug, PartialEq)]
pub enum Handled {
    /// The event belonged to the autopilot and led to these changes.
    Changes(Vec<LinkEvent>),
    /// The event belongs to another link.
    NotMine(NetEvent),
}

/// Sockets of one external autopilot.
#[derive(Debug)]
pub struct AutopilotSockets {
    /// Socket of the simulator interface.
    pub simulator: SimulatorSocket,
    mavlink: SocketId,
    mavlink_peer: Option<SocketAddr>,
    link: u32,
}

impl AutopilotSockets {
    /// Opens the sockets. `link` is the number of the MAVLink link.
    ///
    /// # Errors
    /// Returns an error if a port cannot be opened.
    pub fn open(hub: &mut SocketHub, protocol: SimulatorProtocol, port: u16, link: u32) -> Result<Self, AppError> {
        let simulator = SimulatorSocket::open(protocol, port)?;
        Ok(Self { simulator, mavlink: hub.bind(LOOPBACK, 0, PORT_OPTION)?, mavlink_peer: None, link })
    }

    /// Returns the port for the autopilot's MAVLink messages.
    pub fn mavlink_port(&self, hub: &SocketHub) -> u16 {
        hub.port(self.mavlink)
    }

    /// Returns the number of the MAVLink link.
    pub fn link(&self) -> u32 {
        self.link
    }

    /// Sends MAVLink frames to the autopilot, once its address is known.
    pub fn send_mavlink(&self, hub: &mut SocketHub, bytes: &[u8]) {
        if let Some(peer) = self.mavlink_peer {
            hub.send(self.mavlink, peer, bytes);
        }
    }

    /// Closes the connection to the simulator interface.
    pub fn disconnect(&mut self) {
        self.mavlink_peer = None;
        self.simulator.disconnect();
    }

    /// Handles a network event if it belongs to the autopilot's MAVLink link.
    pub fn handle_event(&mut self, event: NetEvent) -> Handled {
        match event {
            NetEvent::Datagram { socket, from, bytes } if socket == self.mavlink => {
                self.mavlink_peer = Some(from);
                Handled::Changes(vec![LinkEvent::Bytes { link: self.link, bytes }])
            }
            other @ (NetEvent::Datagram { .. } | NetEvent::Connected(..) | NetEvent::Bytes(..) | NetEvent::Closed(_)) => {
                Handled::NotMine(other)
            }
        }
    }
}
