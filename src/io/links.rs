//! The vehicle's links: configured destinations that it sends to from startup, peers that connect to its UDP ports, TCP
//! clients and serial ports.

use super::autopilot_sockets::{AutopilotSockets, Handled};
use super::clock::Stopwatch;
use super::flight_controller_port::FlightControllerPort;
use super::link_event::LinkEvent;
use super::net::{NetEvent, SocketHub, SocketId, StreamId, StreamOrigin};
use super::serial::SerialDevice;
use super::simulator_socket::SimulatorProtocol;
use super::vehicle_ports::VehiclePorts;
use crate::errors::AppError;
use spandrel_mavlink::codec::Decoder;
use spandrel_sitl::endpoint::LinkKind;
use std::collections::{BTreeMap, VecDeque};
use std::net::SocketAddr;
use std::time::Duration;

/// Time after which a silent learned peer is removed.
const SILENCE_TIMEOUT: Duration = Duration::from_secs(15);
/// Maximum number of learned peers per port, so that a flood of source addresses cannot exhaust memory or block another
/// port's peers.
const MAX_LEARNED_PEERS: usize = 64;

#[derive(Debug)]
enum LinkRoute {
    Fixed { socket: SocketId, peer: SocketAddr },
    Learned { socket: SocketId, peer: SocketAddr, heard: Duration },
    Stream { stream: StreamId, decoder: Decoder },
}

/// Connection to an external autopilot: its simulator interface and its MAVLink link.
#[derive(Debug)]
enum AutopilotConnection {
    Process(AutopilotSockets),
    FlightController(FlightControllerPort),
}

/// All of a vehicle's links.
#[derive(Debug)]
pub struct Links {
    hub: SocketHub,
    kinds_by_socket: BTreeMap<SocketId, LinkKind>,
    routes: BTreeMap<u32, LinkRoute>,
    links_by_peer: BTreeMap<(SocketId, SocketAddr), u32>,
    links_by_stream: BTreeMap<StreamId, u32>,
    lockstep: Vec<SocketAddr>,
    limit: Option<f64>,
    changes: VecDeque<LinkEvent>,
    autopilot: Option<AutopilotConnection>,
    opened: u32,
    bad_bytes: u64,
    stopwatch: Stopwatch,
    /// Ports in use, as announced to the parent process.
    pub bound: serde_json::Value,
}

impl Links {
    /// Opens all ports and the links to the configured destinations. Link numbers are the same in every run.
    ///
    /// # Errors
    /// Returns an error if a port cannot be opened, or a lockstep peer is not a configured destination.
    pub fn open(ports: &VehiclePorts, lockstep: &[SocketAddr]) -> Result<Self, AppError> {
        let mut hub = SocketHub::new();
        let bind = |hub: &mut SocketHub, port: Option<u16>, flag| port.map(|port| hub.bind(ports.listen, port, flag)).transpose();
        let gcs = bind(&mut hub, ports.gcs, "--gcs-port")?;
        let payload = bind(&mut hub, ports.payload, "--payload-port")?;
        let sdk = bind(&mut hub, ports.sdk.map(|_| 0), "--sdk")?;
        let tcp = ports.tcp.map(|port| hub.serve(ports.listen, port, "--tcp-port")).transpose()?;
        for device in &ports.serial {
            hub.serve_serial(device, StreamOrigin::Serial)?;
        }
        let port = |socket: Option<SocketId>| socket.map(|socket| hub.port(socket));
        let bound = serde_json::json!({ "system_id": ports.system_id, "gcs_port": port(gcs), "payload_port": port(payload), "tcp_port": tcp });
        let kinds_by_socket = [(gcs, LinkKind::GroundStation), (payload, LinkKind::Payload), (sdk, LinkKind::Sdk)];
        let mut links = Self {
            hub,
            kinds_by_socket: kinds_by_socket.into_iter().filter_map(|(socket, kind)| Some((socket?, kind))).collect(),
            routes: BTreeMap::new(),
            links_by_peer: BTreeMap::new(),
            links_by_stream: BTreeMap::new(),
            lockstep: lockstep.to_vec(),
            limit: ports.gcs_limit.map(f64::from),
            changes: VecDeque::new(),
            autopilot: None,
            opened: 0,
            bad_bytes: 0,
            stopwatch: Stopwatch::start(),
            bound,
        };
        let fixed = ports.stations.iter().map(|peer| (gcs, *peer));
        let fixed = fixed.chain(ports.monitor.map(|peer| (payload.or(gcs), peer))).chain(ports.sdk.map(|peer| (sdk, peer)));
        for (socket, peer) in fixed {
            if let Some(socket) = socket {
                links.add(socket, peer, None);
            }
        }
        links.check_lockstep_peers()?;
        Ok(links)
    }

    /// Opens the simulator interface and the MAVLink link of an external autopilot, on the loopback interface. A `port` of 0
    /// selects any free port. Returns the number of the simulator interface's port and of the port for the autopilot's MAVLink
    /// messages.
    ///
    /// # Errors
    /// Returns an error if a port cannot be opened.
    pub fn serve_autopilot(&mut self, protocol: SimulatorProtocol, port: u16) -> Result<(u16, u16), AppError> {
        let link = self.next_number();
        let sockets = AutopilotSockets::open(&mut self.hub, protocol, port, link)?;
        let ports = (sockets.simulator.port(), sockets.mavlink_port(&self.hub));
        self.autopilot = Some(AutopilotConnection::Process(sockets));
        self.announce_autopilot(link);
        Ok(ports)
    }

    /// Opens the serial port of a flight controller, which carries both its simulator interface and its MAVLink link.
    ///
    /// # Errors
    /// Returns an error if the port cannot be opened.
    pub fn serve_flight_controller(&mut self, device: &SerialDevice) -> Result<(), AppError> {
        let link = self.next_number();
        self.hub.serve_serial(device, StreamOrigin::FlightController)?;
        self.autopilot = Some(AutopilotConnection::FlightController(FlightControllerPort::new(link)));
        self.announce_autopilot(link);
        Ok(())
    }

    /// Announces the autopilot's MAVLink link, whose capacity the simulator does not limit: it sends little on it.
    fn announce_autopilot(&mut self, link: u32) {
        let kind = LinkKind::Autopilot;
        self.changes.push_back(LinkEvent::Opened { link, kind, lockstep: false, learned: false, limit: None });
    }

    /// Queues bytes for the autopilot's simulator interface. [`Self::flush_autopilot`] sends them.
    pub fn send_to_autopilot(&mut self, bytes: Vec<u8>) {
        match &mut self.autopilot {
            Some(AutopilotConnection::Process(sockets)) => sockets.simulator.send(&bytes),
            Some(AutopilotConnection::FlightController(port)) => port.send(&self.hub, bytes),
            None => {}
        }
    }

    /// Sends the bytes that are queued for the autopilot's simulator interface.
    pub fn flush_autopilot(&mut self) {
        match &mut self.autopilot {
            Some(AutopilotConnection::Process(sockets)) => sockets.simulator.flush(),
            Some(AutopilotConnection::FlightController(_)) | None => {}
        }
    }

    /// Closes the connection to an autopilot's simulator interface, so that another process can connect. The serial port of a
    /// flight controller stays open.
    pub fn disconnect_autopilot(&mut self) {
        match &mut self.autopilot {
            Some(AutopilotConnection::Process(sockets)) => sockets.disconnect(),
            Some(AutopilotConnection::FlightController(_)) | None => {}
        }
    }

    fn check_lockstep_peers(&self) -> Result<(), AppError> {
        let called = |peer: &SocketAddr| self.links_by_peer.keys().any(|(_, known)| known == peer);
        match self.lockstep.iter().find(|peer| !called(peer)) {
            Some(peer) => Err(AppError::invalid(format!(
                "--lockstep {peer}: not a destination of the vehicle; also specify it with --gcs, --sdk or --monitor-port"
            ))),
            None => Ok(()),
        }
    }

    /// Waits up to `wait` for an event.
    pub fn wait(&mut self, wait: Duration) {
        if !self.changes.is_empty() {
            return;
        }
        if let Some(arrival) = self.hub.next(wait) {
            self.handle_event(arrival, self.stopwatch.elapsed());
        }
        // Without a wait, the caller reads the queue between two steps. The answers that a step needs come from `wait_for_answer`.
        if !wait.is_zero()
            && let Some(AutopilotConnection::Process(sockets)) = &mut self.autopilot
        {
            self.changes.extend(sockets.simulator.poll());
        }
    }

    /// Waits up to `wait` for the autopilot's answer or for another event. Other events may be noticed 2 ms late.
    pub fn wait_for_answer(&mut self, wait: Duration) {
        match &mut self.autopilot {
            Some(AutopilotConnection::Process(sockets)) => self.changes.extend(sockets.simulator.wait()),
            Some(AutopilotConnection::FlightController(_)) | None => self.wait(wait),
        }
    }

    /// Returns the next event, if there is one.
    pub fn poll(&mut self) -> Option<LinkEvent> {
        if self.changes.is_empty() {
            self.wait(Duration::ZERO);
        }
        self.changes.pop_front()
    }

    /// Removes learned peers that have been silent for too long.
    pub fn drop_silent_peers(&mut self) {
        self.drop_peers_silent_at(self.stopwatch.elapsed());
    }

    fn drop_peers_silent_at(&mut self, wall: Duration) {
        let silent = |(link, route): (&u32, &LinkRoute)| match route {
            LinkRoute::Learned { heard, .. } if wall.saturating_sub(*heard) > SILENCE_TIMEOUT => Some(*link),
            LinkRoute::Learned { .. } | LinkRoute::Fixed { .. } | LinkRoute::Stream { .. } => None,
        };
        let silent: Vec<u32> = self.routes.iter().filter_map(silent).collect();
        for link in silent {
            if let Some(LinkRoute::Learned { socket, peer, .. }) = self.routes.remove(&link) {
                tracing::info!("{peer} disconnected after {} s of silence", SILENCE_TIMEOUT.as_secs());
                self.links_by_peer.remove(&(socket, peer));
                self.changes.push_back(LinkEvent::Closed { link });
            }
        }
    }

    /// Sends bytes to a link.
    pub fn send(&mut self, link: u32, bytes: Vec<u8>) {
        match self.routes.get(&link) {
            Some(LinkRoute::Fixed { socket, peer } | LinkRoute::Learned { socket, peer, .. }) => {
                self.hub.send(*socket, *peer, &bytes)
            }
            Some(LinkRoute::Stream { stream, .. }) => self.hub.send_stream(*stream, bytes),
            None => match &self.autopilot {
                Some(AutopilotConnection::Process(sockets)) if sockets.link() == link => {
                    sockets.send_mavlink(&mut self.hub, &bytes)
                }
                Some(AutopilotConnection::FlightController(port)) if port.link() == link => port.send(&self.hub, bytes),
                Some(AutopilotConnection::Process(_) | AutopilotConnection::FlightController(_)) | None => {}
            },
        }
    }

    /// Returns the number of bytes from TCP clients and serial ports that were not part of a frame. The vehicle counts such bytes
    /// in datagrams.
    pub fn bad_bytes(&self) -> u64 {
        let from_controller = match &self.autopilot {
            Some(AutopilotConnection::FlightController(port)) => port.bad_bytes(),
            Some(AutopilotConnection::Process(_)) | None => 0,
        };
        self.bad_bytes + from_controller
    }

    /// Returns the number of events and frames dropped because a queue was full.
    pub fn take_dropped(&self) -> u64 {
        self.hub.dropped()
    }

    fn next_number(&mut self) -> u32 {
        self.opened += 1;
        self.opened
    }

    /// Adds a configured peer, or a learned peer if `heard` contains the time of its first datagram.
    fn add(&mut self, socket: SocketId, peer: SocketAddr, heard: Option<Duration>) -> u32 {
        let link = self.next_number();
        let route = heard.map_or(LinkRoute::Fixed { socket, peer }, |heard| LinkRoute::Learned { socket, peer, heard });
        self.routes.insert(link, route);
        self.links_by_peer.insert((socket, peer), link);
        let kind = self.kinds_by_socket.get(&socket).copied().unwrap_or(LinkKind::GroundStation);
        let limit = self.limit.filter(|_| kind == LinkKind::GroundStation);
        let lockstep = self.lockstep.contains(&peer);
        self.changes.push_back(LinkEvent::Opened { link, kind, lockstep, learned: heard.is_some(), limit });
        link
    }

    fn handle_event(&mut self, arrival: NetEvent, wall: Duration) {
        let handled = match &mut self.autopilot {
            Some(AutopilotConnection::Process(sockets)) => sockets.handle_event(arrival),
            Some(AutopilotConnection::FlightController(port)) => port.handle_event(arrival),
            None => Handled::NotMine(arrival),
        };
        let arrival = match handled {
            Handled::Changes(changes) => {
                self.changes.extend(changes);
                return;
            }
            Handled::NotMine(arrival) => arrival,
        };
        match arrival {
            NetEvent::Datagram { socket, from, bytes } => self.handle_datagram(socket, from, bytes, wall),
            NetEvent::Connected(stream, origin) => self.add_stream(stream, &origin),
            NetEvent::Bytes(stream, bytes) => {
                let Some(link) = self.links_by_stream.get(&stream).copied() else { return };
                let Some(LinkRoute::Stream { decoder, .. }) = self.routes.get_mut(&link) else { return };
                let before = decoder.bad_bytes();
                let frames = decoder.push(&bytes).into_iter();
                self.changes.extend(frames.map(|frame| LinkEvent::Bytes { link, bytes: frame.bytes }));
                self.bad_bytes += decoder.bad_bytes() - before;
            }
            NetEvent::Closed(stream) => {
                let Some(link) = self.links_by_stream.remove(&stream) else { return };
                self.routes.remove(&link);
                self.changes.push_back(LinkEvent::Closed { link });
            }
        }
    }

    fn add_stream(&mut self, stream: StreamId, origin: &StreamOrigin) {
        if self.links_by_stream.len() >= MAX_LEARNED_PEERS {
            tracing::warn!("rejected {origin}: {MAX_LEARNED_PEERS} clients are already connected");
            self.hub.drop_stream(stream);
            return;
        }
        let link = self.next_number();
        tracing::info!("{origin} has connected");
        let (kind, limit) = match origin {
            StreamOrigin::Tcp(_) => (LinkKind::Tcp, self.limit),
            StreamOrigin::Serial(device) => (LinkKind::Serial, Some(device.capacity_bytes_s())),
            StreamOrigin::FlightController(_) => (LinkKind::Autopilot, None),
        };
        self.routes.insert(link, LinkRoute::Stream { stream, decoder: Decoder::new() });
        self.links_by_stream.insert(stream, link);
        self.changes.push_back(LinkEvent::Opened { link, kind, lockstep: false, learned: false, limit });
    }

    /// Adds a new peer if it sends MAVLink and its port has fewer than the maximum number of peers.
    fn add_peer(&mut self, socket: SocketId, from: SocketAddr, bytes: &[u8], wall: Duration) -> Option<u32> {
        if !is_mavlink(bytes) {
            tracing::debug!("ignored a datagram without a MAVLink message from unknown address {from}");
            self.bad_bytes += bytes.len() as u64;
            return None;
        }
        let on_socket = |route: &&LinkRoute| matches!(route, LinkRoute::Learned { socket: other, .. } if *other == socket);
        if self.routes.values().filter(on_socket).count() >= MAX_LEARNED_PEERS {
            tracing::debug!("rejected {from}: {MAX_LEARNED_PEERS} peers are already connected to this port");
            return None;
        }
        tracing::info!("{from} has connected");
        Some(self.add(socket, from, Some(wall)))
    }

    fn handle_datagram(&mut self, socket: SocketId, from: SocketAddr, bytes: Vec<u8>, wall: Duration) {
        let link = match self.links_by_peer.get(&(socket, from)) {
            Some(link) => *link,
            None => {
                let Some(link) = self.add_peer(socket, from, &bytes, wall) else { return };
                link
            }
        };
        if let Some(LinkRoute::Learned { heard, .. }) = self.routes.get_mut(&link) {
            *heard = wall;
        }
        self.changes.push_back(LinkEvent::Bytes { link, bytes });
    }
}

/// Returns true if a datagram contains a known message with a correct checksum.
fn is_mavlink(bytes: &[u8]) -> bool {
    Decoder::new().datagram(bytes).iter().any(|frame| frame.message.is_some())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::vehicle_ports::local;
    use spandrel_mavlink::codec::Encoder;
    use spandrel_mavlink::station;
    use std::net::UdpSocket;

    fn heartbeat_frame() -> Vec<u8> {
        Encoder::new(255, 190).encode(&station::heartbeat())
    }

    /// Returns settings that use any free ports and these ground stations.
    fn ephemeral(stations: &[SocketAddr]) -> VehiclePorts {
        VehiclePorts {
            system_id: 1,
            listen: local(0).ip(),
            gcs: Some(0),
            payload: Some(0),
            tcp: None,
            serial: Vec::new(),
            stations: stations.to_vec(),
            sdk: None,
            monitor: None,
            gcs_limit: None,
        }
    }

    #[test]
    fn wire_new_peers_are_learned_and_get_replies() {
        let mut links = Links::open(&ephemeral(&[]), &[]).unwrap();
        let port = u16::try_from(links.bound["payload_port"].as_u64().unwrap()).unwrap();
        let sidecar = UdpSocket::bind(local(0)).unwrap();
        // Non-MAVLink data does not add a peer.
        sidecar.send_to(b"h", local(port)).unwrap();
        sidecar.send_to(&heartbeat_frame(), local(port)).unwrap();
        let (watch, limit) = (Stopwatch::start(), Duration::from_secs(60));
        while links.changes.is_empty() && watch.elapsed() < limit {
            links.wait(Duration::from_secs(1));
        }
        let opened = LinkEvent::Opened { link: 1, kind: LinkKind::Payload, lockstep: false, learned: true, limit: None };
        assert_eq!((links.poll(), links.bad_bytes()), (Some(opened), 1));
        assert_eq!(links.poll(), Some(LinkEvent::Bytes { link: 1, bytes: heartbeat_frame() }));
        links.send(1, b"welcome".to_vec());
        let mut heard = [0u8; 16];
        let (len, from) = sidecar.recv_from(&mut heard).unwrap();
        assert_eq!((&heard[..len], from.port()), (b"welcome".as_slice(), port));
    }

    #[test]
    fn exact_lockstep_peers_must_be_configured_destinations() {
        let Err(error) = Links::open(&ephemeral(&[]), &[local(9)]) else { panic!("accepted") };
        assert!(error.to_string().contains("--lockstep 127.0.0.1:9"));
        let args = ephemeral(&[local(9)]);
        let mut links = Links::open(&args, &[local(9)]).unwrap();
        let opened = LinkEvent::Opened { link: 1, kind: LinkKind::GroundStation, lockstep: true, learned: false, limit: None };
        assert_eq!(links.poll(), Some(opened));
    }

    /// Returns links with one configured peer, and the socket for ground stations.
    fn called(peer: &str) -> (Links, SocketId) {
        let mut links = Links::open(&ephemeral(&[peer.parse().unwrap()]), &[]).unwrap();
        assert!(matches!(links.poll(), Some(LinkEvent::Opened { link: 1, .. })));
        let socket = *links.kinds_by_socket.iter().find(|(_, kind)| **kind == LinkKind::GroundStation).unwrap().0;
        (links, socket)
    }

    /// Simulates a datagram from a port. Returns the link and whether it is new.
    fn note_received(links: &mut Links, socket: SocketId, port: u16, at_s: u64) -> Option<(u32, bool)> {
        links.handle_event(NetEvent::Datagram { socket, from: local(port), bytes: heartbeat_frame() }, Duration::from_secs(at_s));
        let new = matches!(links.changes.front(), Some(LinkEvent::Opened { .. }));
        let changes = std::mem::take(&mut links.changes);
        changes.iter().find_map(|change| if let LinkEvent::Bytes { link, .. } = change { Some((*link, new)) } else { None })
    }

    #[test]
    fn exact_only_silent_learned_peers_are_removed() {
        let (mut links, socket) = called("127.0.0.1:9");
        let (silent, speaking) = (4_001, 4_002);
        assert_eq!(note_received(&mut links, socket, silent, 100), Some((2, true)));
        assert_eq!(note_received(&mut links, socket, speaking, 100), Some((3, true)));
        assert_eq!(note_received(&mut links, socket, speaking, 110), Some((3, false)));
        links.drop_peers_silent_at(Duration::from_secs(100) + SILENCE_TIMEOUT);
        assert!(links.changes.is_empty(), "not yet");
        links.drop_peers_silent_at(Duration::from_secs(101) + SILENCE_TIMEOUT);
        assert_eq!(std::mem::take(&mut links.changes), [LinkEvent::Closed { link: 2 }]);
        assert_eq!(note_received(&mut links, socket, silent, 120), Some((4, true)), "a new link");
        links.drop_peers_silent_at(Duration::from_secs(1_000_000));
        let closed = [3, 4].map(|link| LinkEvent::Closed { link });
        assert_eq!(std::mem::take(&mut links.changes), closed, "but not the configured destination");
        assert_eq!(note_received(&mut links, socket, 9, 2_000_000), Some((1, false)));
    }

    #[test]
    fn regress_flood_on_one_port_does_not_block_another() {
        let mut links = Links::open(&ephemeral(&[local(9)]), &[]).unwrap();
        assert!(matches!(links.poll(), Some(LinkEvent::Opened { link: 1, .. })));
        let of = |links: &Links, kind| *links.kinds_by_socket.iter().find(|(_, other)| **other == kind).unwrap().0;
        let (stations, sidecars) = (of(&links, LinkKind::GroundStation), of(&links, LinkKind::Payload));
        for port in 10_000..10_000 + 2 * MAX_LEARNED_PEERS as u16 {
            links.handle_event(
                NetEvent::Datagram { socket: sidecars, from: local(port), bytes: vec![0xFD] },
                Duration::from_secs(1),
            );
        }
        assert_eq!((links.changes.len(), links.bad_bytes()), (0, 2 * MAX_LEARNED_PEERS as u64));
        assert_eq!(note_received(&mut links, sidecars, 4_001, 1), Some((2, true)));
        let taken = (10_000..11_000).filter_map(|port| note_received(&mut links, stations, port, 1)).count();
        assert_eq!(taken, MAX_LEARNED_PEERS);
        assert!(note_received(&mut links, sidecars, 4_002, 1).is_some_and(|(_, new)| new));
        assert_eq!(note_received(&mut links, stations, 4_003, 1), None);
    }

    #[test]
    fn exact_new_peers_are_limited_and_time_out() {
        let (mut links, socket) = called("127.0.0.1:9");
        assert_eq!(note_received(&mut links, socket, 4_000, 1), Some((2, true)));
        let taken: usize = (10_000..60_000).filter_map(|port| note_received(&mut links, socket, port, 2)).count();
        let all = MAX_LEARNED_PEERS + 1;
        assert_eq!(
            (taken, links.routes.len(), links.links_by_peer.len()),
            (MAX_LEARNED_PEERS - 1, all, all),
            "including the configured destination"
        );
        assert_eq!(note_received(&mut links, socket, 4_000, 3), Some((2, false)), "known peers are still received");
        assert_eq!(note_received(&mut links, socket, 9, 3), Some((1, false)), "and so is the configured destination");
        assert_eq!(note_received(&mut links, socket, 4_003, 3), None, "new peers are not");
        links.drop_peers_silent_at(Duration::from_secs(3) + SILENCE_TIMEOUT);
        links.changes.clear();
        assert_eq!((links.routes.len(), links.links_by_peer.len()), (2, 2), "the flood's peers have been removed");
        assert!(note_received(&mut links, socket, 4_003, 19).is_some_and(|(_, new)| new));
    }
}
