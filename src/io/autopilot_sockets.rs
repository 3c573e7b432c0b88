//! Sockets of an external autopilot: its simulator interface and its MAVLink link. Both accept only peers on this machine.

use super::link_event::LinkEvent;
use super::net::{NetEvent, SocketHub, SocketId, StreamId, StreamOrigin};
use super::vehicle_ports::local;
use crate::errors::AppError;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};

const LOOPBACK: IpAddr = IpAddr::V4(Ipv4Addr::LOCALHOST);
/// Option that selects the port of the simulator interface.
const PORT_OPTION: &str = "--autopilot-port";

/// Transport of a simulator interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SimulatorProtocol {
    /// The autopilot connects over TCP (PX4).
    Tcp,
    /// The autopilot sends datagrams (ArduPilot).
    Udp,
}

#[derive(Debug)]
enum SimulatorSocket {
    Tcp { port: u16, stream: Option<StreamId> },
    Udp { socket: SocketId, peer: Option<SocketAddr> },
}

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
    simulator: SimulatorSocket,
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
        let simulator = match protocol {
            SimulatorProtocol::Tcp => {
                SimulatorSocket::Tcp { port: hub.serve_autopilot(LOOPBACK, port, PORT_OPTION)?, stream: None }
            }
            SimulatorProtocol::Udp => SimulatorSocket::Udp { socket: hub.bind(LOOPBACK, port, PORT_OPTION)?, peer: None },
        };
        Ok(Self { simulator, mavlink: hub.bind(LOOPBACK, 0, PORT_OPTION)?, mavlink_peer: None, link })
    }

    /// Returns the port of the simulator interface.
    pub fn simulator_port(&self, hub: &SocketHub) -> u16 {
        match self.simulator {
            SimulatorSocket::Tcp { port, .. } => port,
            SimulatorSocket::Udp { socket, .. } => hub.port(socket),
        }
    }

    /// Returns the port for the autopilot's MAVLink messages.
    pub fn mavlink_port(&self, hub: &SocketHub) -> u16 {
        hub.port(self.mavlink)
    }

    /// Returns the number of the MAVLink link.
    pub fn link(&self) -> u32 {
        self.link
    }

    /// Sends bytes to the simulator interface.
    pub fn send(&self, hub: &mut SocketHub, bytes: Vec<u8>) {
        match self.simulator {
            SimulatorSocket::Tcp { stream: Some(stream), .. } => hub.send_stream(stream, bytes),
            SimulatorSocket::Udp { socket, peer: Some(peer) } => hub.send(socket, peer, &bytes),
            SimulatorSocket::Tcp { stream: None, .. } | SimulatorSocket::Udp { peer: None, .. } => {}
        }
    }

    /// Sends MAVLink frames to the autopilot, once its address is known.
    pub fn send_mavlink(&self, hub: &mut SocketHub, bytes: &[u8]) {
        if let Some(peer) = self.mavlink_peer {
            hub.send(self.mavlink, peer, bytes);
        }
    }

    /// Closes the connection to the simulator interface.
    pub fn disconnect(&mut self, hub: &mut SocketHub) {
        self.mavlink_peer = None;
        match &mut self.simulator {
            SimulatorSocket::Tcp { stream, .. } => {
                if let Some(stream) = stream.take() {
                    hub.drop_stream(stream);
                }
            }
            SimulatorSocket::Udp { peer, .. } => *peer = None,
        }
    }

    /// Handles a network event if it belongs to the autopilot.
    pub fn handle_event(&mut self, event: NetEvent, hub: &mut SocketHub) -> Handled {
        match event {
            NetEvent::Datagram { socket, from, bytes } if socket == self.mavlink => {
                self.mavlink_peer = Some(from);
                Handled::Changes(vec![LinkEvent::Bytes { link: self.link, bytes }])
            }
            NetEvent::Datagram { socket, from, bytes } => match &mut self.simulator {
                SimulatorSocket::Udp { socket: own, peer } if *own == socket => {
                    // A restarted ArduPilot sends from another port.
                    let connected = peer.replace(from).is_none().then_some(LinkEvent::AutopilotConnected);
                    Handled::Changes(connected.into_iter().chain([LinkEvent::AutopilotBytes(bytes)]).collect())
                }
                SimulatorSocket::Udp { .. } | SimulatorSocket::Tcp { .. } => {
                    Handled::NotMine(NetEvent::Datagram { socket, from, bytes })
                }
            },
            NetEvent::Connected(stream, StreamOrigin::Autopilot(from)) => Handled::Changes(self.accept(stream, from, hub)),
            NetEvent::Bytes(stream, bytes) if self.is_connected_as(stream) => {
                Handled::Changes(vec![LinkEvent::AutopilotBytes(bytes)])
            }
            NetEvent::Closed(stream) if self.is_connected_as(stream) => {
                self.disconnect(hub);
                Handled::Changes(vec![LinkEvent::AutopilotClosed])
            }
            other @ (NetEvent::Connected(..) | NetEvent::Bytes(..) | NetEvent::Closed(_)) => Handled::NotMine(other),
        }
    }

    fn is_connected_as(&self, stream: StreamId) -> bool {
        matches!(self.simulator, SimulatorSocket::Tcp { stream: Some(own), .. } if own == stream)
    }

    /// Accepts a connection, or rejects it while another process is connected.
    fn accept(&mut self, new: StreamId, from: SocketAddr, hub: &mut SocketHub) -> Vec<LinkEvent> {
        match &mut self.simulator {
            SimulatorSocket::Tcp { stream: stream @ None, .. } => {
                *stream = Some(new);
                vec![LinkEvent::AutopilotConnected]
            }
            SimulatorSocket::Tcp { port, .. } => {
                tracing::warn!("rejected a second connection to the simulator interface ({}) from {from}", local(*port));
                hub.drop_stream(new);
                Vec::new()
            }
            SimulatorSocket::Udp { .. } => Vec::new(),
        }
    }
}
