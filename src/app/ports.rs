//! The vehicle's ports and who is behind them: fixed targets that are called unasked, peers learned by their source address, TCP clients.

use super::args::{self, Port, Target};
use super::clock::Stopwatch;
use super::errors::AppError;
use super::net::{Arrival, Hub, SocketId, StreamId};
use crate::mav::codec::Decoder;
use std::collections::{BTreeMap, VecDeque};
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::time::Duration;

const GCS_TARGET: u16 = 14550;
const SDK_TARGET: u16 = 14540;
const GCS_PORT: u16 = 18570;
const PAYLOAD_PORT: u16 = 14280;
const TCP_PORT: u16 = 5760;
/// A learned peer that is silent this long is forgotten.
const FORGET: Duration = Duration::from_secs(15);
/// Peers that are learned at most: a flood of source addresses must not grow without bound.
const LEARNED_MAX: usize = 64;

/// Ports of the vehicle.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Ports")]
pub struct PortArgs {
    /// Vehicle instance, 0 to 200: system id 1 + N, and every default port moves
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=200))]
    pub instance: u8,
    /// Ground station that is called unasked, or none; may be repeated [default: 127.0.0.1:14550]
    #[arg(long, value_name = "HOST:PORT|none")]
    pub gcs: Vec<Target>,
    /// SDK that is called unasked, or none [default: 127.0.0.1:14540 + instance]
    #[arg(long, value_name = "HOST:PORT|none")]
    pub sdk: Option<Target>,
    /// UDP port for ground stations that dial in, or none [default: 18570 + instance]
    #[arg(long, value_name = "PORT|none")]
    pub gcs_port: Option<Port>,
    /// UDP port for sidecars that dial in, or none [default: 14280 + instance]
    #[arg(long, value_name = "PORT|none")]
    pub payload_port: Option<Port>,
    /// UDP port on this machine where the monitor listens, or none [default: 14030 + instance]
    #[arg(long, value_name = "PORT|none")]
    pub monitor_port: Option<Port>,
    /// TCP port for ground stations, or none [default: 5760 + 10 x instance]
    #[arg(long, value_name = "PORT|none")]
    pub tcp_port: Option<Port>,
    /// Local address to bind: 127.0.0.1 for this machine only, 0.0.0.0 for all networks
    #[arg(long, value_name = "ADDR", default_value = "127.0.0.1", value_parser = args::listen)]
    pub listen: IpAddr,
    /// Where ports come from unless given: the fixed numbers above, or free ones and nobody called
    #[arg(long, value_name = "fixed|ephemeral", default_value = "fixed", value_parser = ["fixed", "ephemeral"])]
    pub ports: String,
}

impl PortArgs {
    fn ephemeral(&self) -> bool {
        self.ports == "ephemeral"
    }

    fn moved(&self, first: u16) -> u16 {
        first + u16::from(self.instance)
    }

    fn port(&self, given: Option<Port>, first: u16) -> Option<u16> {
        match given {
            Some(Port::None) => None,
            Some(Port::Number(port)) => Some(port),
            None if self.ephemeral() => Some(0),
            None => Some(self.moved(first)),
        }
    }

    /// Ground stations that are called.
    pub fn ground_stations(&self) -> Vec<SocketAddr> {
        let given = self.gcs.iter().filter_map(|target| match target {
            Target::None => None,
            Target::Address(address) => Some(*address),
        });
        if self.gcs.is_empty() && !self.ephemeral() { vec![local(GCS_TARGET)] } else { given.collect() }
    }

    /// The SDK that is called.
    pub fn sdk(&self) -> Option<SocketAddr> {
        match self.sdk {
            Some(Target::Address(address)) => Some(address),
            Some(Target::None) => None,
            None if self.ephemeral() => None,
            None => Some(local(self.moved(SDK_TARGET))),
        }
    }

    /// Where the monitor listens.
    pub fn monitor_port(&self) -> u16 {
        match self.monitor_port {
            Some(Port::Number(port)) => port,
            Some(Port::None) => 0,
            None if self.ephemeral() => 0,
            None => self.moved(super::monitor::FIRST_PORT),
        }
    }

    fn tcp(&self) -> Option<u16> {
        match self.tcp_port {
            Some(Port::None) => None,
            Some(Port::Number(port)) => Some(port),
            None if self.ephemeral() => None,
            None => Some(TCP_PORT + 10 * u16::from(self.instance)),
        }
    }

    /// As arguments of a child process, without the monitor's port.
    pub fn to_args(&self) -> Vec<String> {
        let mut out = vec!["--instance".to_owned(), self.instance.to_string(), "--listen".to_owned(), self.listen.to_string()];
        out.extend(["--ports".to_owned(), self.ports.clone()]);
        let target = |target: &Target| match target {
            Target::None => "none".to_owned(),
            Target::Address(address) => address.to_string(),
        };
        let port = |port: &Port| match port {
            Port::None => "none".to_owned(),
            Port::Number(number) => number.to_string(),
        };
        let mut flag = |name: &str, value: String| out.extend([name.to_owned(), value]);
        self.gcs.iter().for_each(|gcs| flag("--gcs", target(gcs)));
        self.sdk.iter().for_each(|sdk| flag("--sdk", target(sdk)));
        for (name, given) in [("--gcs-port", self.gcs_port), ("--payload-port", self.payload_port), ("--tcp-port", self.tcp_port)]
        {
            given.iter().for_each(|given| flag(name, port(given)));
        }
        out
    }
}

fn local(port: u16) -> SocketAddr {
    SocketAddr::from((Ipv4Addr::LOCALHOST, port))
}

/// What kind of peer is behind a link.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Face {
    /// A ground station over UDP.
    GroundStation,
    /// A ground station over TCP.
    Tcp,
    /// An SDK or another onboard program.
    Sdk,
    /// The monitor and other sidecars.
    Payload,
}

/// What happened to links.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Change {
    /// A peer is there from now on.
    Opened {
        /// Its link.
        link: u32,
        /// Its kind.
        face: Face,
        /// It is asked to keep step.
        lockstep: bool,
    },
    /// Bytes: a datagram, or one whole frame of a stream.
    Bytes {
        /// From which link.
        link: u32,
        /// What.
        bytes: Vec<u8>,
    },
    /// The peer is gone.
    Closed {
        /// Its link.
        link: u32,
    },
}

#[derive(Debug)]
enum Route {
    Fixed { socket: SocketId, peer: SocketAddr },
    Learned { socket: SocketId, peer: SocketAddr, heard: Duration },
    Stream { stream: StreamId, decoder: Decoder },
}

/// All links of the vehicle.
#[derive(Debug)]
pub struct Links {
    hub: Hub,
    faces: BTreeMap<SocketId, Face>,
    routes: BTreeMap<u32, Route>,
    by_peer: BTreeMap<(SocketId, SocketAddr), u32>,
    by_stream: BTreeMap<StreamId, u32>,
    lockstep: Vec<SocketAddr>,
    changes: VecDeque<Change>,
    opened: u32,
    bad_bytes: u64,
    watch: Stopwatch,
    /// The ports that were bound, as announced.
    pub bound: serde_json::Value,
}

impl Links {
    /// Opens every port and the links to those who are called unasked. Fixed links are numbered in one order in every run.
    ///
    /// # Errors
    /// When a port cannot be opened, or a lockstep peer is not among those who are called.
    pub fn open(args: &PortArgs, lockstep: &[SocketAddr]) -> Result<Self, AppError> {
        let mut hub = Hub::new();
        let bind = |hub: &mut Hub, port: Option<u16>, flag| port.map(|port| hub.bind(args.listen, port, flag)).transpose();
        let stations = args.ground_stations();
        let gcs = bind(&mut hub, args.port(args.gcs_port, GCS_PORT).or((!stations.is_empty()).then_some(0)), "--gcs-port")?;
        let payload = bind(&mut hub, args.port(args.payload_port, PAYLOAD_PORT), "--payload-port")?;
        let sdk = bind(&mut hub, args.sdk().map(|_| 0), "--sdk")?;
        let tcp = args.tcp().map(|port| hub.serve(args.listen, port, "--tcp-port")).transpose()?;
        let port = |socket: Option<SocketId>| socket.map(|socket| hub.port(socket));
        let bound = serde_json::json!({ "gcs_port": port(gcs), "payload_port": port(payload), "tcp_port": tcp });
        let faces = [(gcs, Face::GroundStation), (payload, Face::Payload), (sdk, Face::Sdk)];
        let mut links = Self {
            hub,
            faces: faces.into_iter().filter_map(|(socket, face)| Some((socket?, face))).collect(),
            routes: BTreeMap::new(),
            by_peer: BTreeMap::new(),
            by_stream: BTreeMap::new(),
            lockstep: lockstep.to_vec(),
            changes: VecDeque::new(),
            opened: 0,
            bad_bytes: 0,
            watch: Stopwatch::start(),
            bound,
        };
        let monitor = Some(args.monitor_port()).filter(|port| *port != 0).map(local);
        let fixed = stations.iter().map(|peer| (gcs, *peer));
        let fixed = fixed.chain(monitor.map(|peer| (payload.or(gcs), peer))).chain(args.sdk().map(|peer| (sdk, peer)));
        for (socket, peer) in fixed {
            if let Some(socket) = socket {
                links.add(socket, peer, true);
            }
        }
        links.all_in_step_are_called()?;
        Ok(links)
    }

    fn all_in_step_are_called(&self) -> Result<(), AppError> {
        let called = |peer: &SocketAddr| self.by_peer.keys().any(|(_, known)| known == peer);
        match self.lockstep.iter().find(|peer| !called(peer)) {
            Some(peer) => Err(AppError::wrong(format!(
                "--lockstep {peer} names nobody who is called: name it with --gcs, --sdk or --monitor-port as well"
            ))),
            None => Ok(()),
        }
    }

    /// Waits at most so long for something to happen.
    pub fn wait(&mut self, wait: Duration) {
        if !self.changes.is_empty() {
            return;
        }
        if let Some(arrival) = self.hub.next(wait) {
            self.take(arrival);
        }
    }

    /// The next change.
    pub fn poll(&mut self) -> Option<Change> {
        if self.changes.is_empty() {
            self.wait(Duration::ZERO);
        }
        self.changes.pop_front()
    }

    /// Forgets learned peers that have gone silent.
    pub fn forget_silent(&mut self) {
        let wall = self.watch.elapsed();
        let silent = |(link, route): (&u32, &Route)| match route {
            Route::Learned { heard, .. } if wall.saturating_sub(*heard) > FORGET => Some(*link),
            Route::Learned { .. } | Route::Fixed { .. } | Route::Stream { .. } => None,
        };
        let silent: Vec<u32> = self.routes.iter().filter_map(silent).collect();
        for link in silent {
            if let Some(Route::Learned { socket, peer, .. }) = self.routes.remove(&link) {
                tracing::info!("{peer} has been silent for {} s and is forgotten", FORGET.as_secs());
                self.by_peer.remove(&(socket, peer));
                self.changes.push_back(Change::Closed { link });
            }
        }
    }

    /// Sends to one link.
    pub fn send(&mut self, link: u32, bytes: Vec<u8>) {
        match self.routes.get(&link) {
            Some(Route::Fixed { socket, peer } | Route::Learned { socket, peer, .. }) => self.hub.send(*socket, *peer, &bytes),
            Some(Route::Stream { stream, .. }) => self.hub.send_stream(*stream, bytes),
            None => {}
        }
    }

    /// Bytes of TCP clients that belonged to no frame; those of datagrams the vehicle counts.
    pub fn bad_bytes(&self) -> u64 {
        self.bad_bytes
    }

    /// What found a queue full.
    pub fn dropped(&self) -> u64 {
        self.hub.dropped()
    }

    fn number(&mut self) -> u32 {
        self.opened += 1;
        self.opened
    }

    fn add(&mut self, socket: SocketId, peer: SocketAddr, fixed: bool) -> u32 {
        let link = self.number();
        let heard = self.watch.elapsed();
        let route = if fixed { Route::Fixed { socket, peer } } else { Route::Learned { socket, peer, heard } };
        self.routes.insert(link, route);
        self.by_peer.insert((socket, peer), link);
        let face = self.faces.get(&socket).copied().unwrap_or(Face::GroundStation);
        self.changes.push_back(Change::Opened { link, face, lockstep: self.lockstep.contains(&peer) });
        link
    }

    fn take(&mut self, arrival: Arrival) {
        match arrival {
            Arrival::Datagram { socket, from, bytes } => self.take_datagram(socket, from, bytes),
            Arrival::Connected(stream, from) => {
                let link = self.number();
                tracing::info!("TCP client {from} is connected");
                self.routes.insert(link, Route::Stream { stream, decoder: Decoder::new() });
                self.by_stream.insert(stream, link);
                self.changes.push_back(Change::Opened { link, face: Face::Tcp, lockstep: false });
            }
            Arrival::Bytes(stream, bytes) => {
                let Some(link) = self.by_stream.get(&stream).copied() else { return };
                let Some(Route::Stream { decoder, .. }) = self.routes.get_mut(&link) else { return };
                let before = decoder.bad_bytes();
                let frames = decoder.push(&bytes).into_iter();
                self.changes.extend(frames.map(|frame| Change::Bytes { link, bytes: frame.bytes }));
                self.bad_bytes += decoder.bad_bytes() - before;
            }
            Arrival::Closed(stream) => {
                let Some(link) = self.by_stream.remove(&stream) else { return };
                self.routes.remove(&link);
                self.changes.push_back(Change::Closed { link });
            }
        }
    }

    fn take_datagram(&mut self, socket: SocketId, from: SocketAddr, bytes: Vec<u8>) {
        let link = match self.by_peer.get(&(socket, from)) {
            Some(link) => *link,
            None if self.by_peer.len() >= LEARNED_MAX => {
                tracing::debug!("{from} is not let in: {LEARNED_MAX} peers are connected");
                return;
            }
            None => {
                tracing::info!("{from} has dialled in");
                self.add(socket, from, false)
            }
        };
        let wall = self.watch.elapsed();
        if let Some(Route::Learned { heard, .. }) = self.routes.get_mut(&link) {
            *heard = wall;
        }
        self.changes.push_back(Change::Bytes { link, bytes });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;
    use std::net::UdpSocket;

    #[derive(Debug, Parser)]
    struct Line {
        #[command(flatten)]
        ports: PortArgs,
    }

    fn parse(words: &[&str]) -> PortArgs {
        Line::parse_from(["test"].iter().chain(words)).ports
    }

    #[test]
    fn exact_default_ports_are_those_of_the_design_and_move_with_the_instance() {
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
    fn exact_a_childs_arguments_read_back_the_same() {
        let args = parse(&["--instance", "2", "--gcs", "none", "--sdk", "127.0.0.1:9", "--tcp-port", "none", "--gcs-port", "0"]);
        let words = args.to_args();
        let again = parse(&words.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(format!("{again:?}"), format!("{args:?}"));
    }

    #[test]
    fn wire_a_stranger_is_learned_by_its_address_and_answered() {
        let mut links = Links::open(&parse(&["--ports", "ephemeral"]), &[]).unwrap();
        let port = u16::try_from(links.bound["payload_port"].as_u64().unwrap()).unwrap();
        let sidecar = UdpSocket::bind(local(0)).unwrap();
        sidecar.send_to(b"hello", local(port)).unwrap();
        links.wait(Duration::from_secs(60));
        assert_eq!(links.poll(), Some(Change::Opened { link: 1, face: Face::Payload, lockstep: false }));
        assert_eq!(links.poll(), Some(Change::Bytes { link: 1, bytes: b"hello".to_vec() }));
        links.send(1, b"welcome".to_vec());
        let mut heard = [0u8; 16];
        let (len, from) = sidecar.recv_from(&mut heard).unwrap();
        assert_eq!((&heard[..len], from.port()), (b"welcome".as_slice(), port));
    }

    #[test]
    fn exact_a_lockstep_peer_that_nobody_calls_is_refused() {
        let Err(error) = Links::open(&parse(&["--ports", "ephemeral"]), &[local(9)]) else { panic!("accepted") };
        assert!(error.to_string().contains("--lockstep 127.0.0.1:9"));
        let args = parse(&["--ports", "ephemeral", "--gcs", "127.0.0.1:9"]);
        let mut links = Links::open(&args, &[local(9)]).unwrap();
        assert_eq!(links.poll(), Some(Change::Opened { link: 1, face: Face::GroundStation, lockstep: true }));
    }
}
