//! Socket of an external autopilot's simulator interface. The vehicle's thread reads and writes it without a helper thread: the
//! exchange runs in lockstep, so every handover to another thread would delay every step.

use super::clock::Stopwatch;
use super::link_event::LinkEvent;
use super::net::{ERROR_DELAY, MAX_DATAGRAM_BYTES, listen, port_in_use};
use super::vehicle_ports::local;
use crate::errors::AppError;
use std::io::{ErrorKind, Read, Write};
use std::net::{IpAddr, Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

/// Simulator interfaces accept only peers on this machine.
pub const LOOPBACK: IpAddr = IpAddr::V4(Ipv4Addr::LOCALHOST);
/// Option that selects the port of the simulator interface.
pub const PORT_OPTION: &str = "--autopilot-port";
/// Maximum time to wait for an answer before the other sockets are read.
const MAX_ANSWER_WAIT: Duration = Duration::from_millis(2);
/// Time to poll for an answer before the thread sleeps. Most answers arrive earlier, and waking a thread takes about as long as
/// answering does.
const POLL_TIME: Duration = Duration::from_micros(200);
/// Maximum time that a connection with a full buffer delays the vehicle.
const MAX_SEND_WAIT: Duration = Duration::from_millis(1);
/// Maximum amount of unsent data. An autopilot that does not read loses further messages.
const MAX_UNSENT_BYTES: usize = 1 << 20;

/// Transport of a simulator interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SimulatorProtocol {
    /// The autopilot connects over TCP (PX4).
    Tcp,
    /// The autopilot sends datagrams (ArduPilot).
    Udp,
}

#[derive(Debug)]
enum Transport {
    Tcp { accepted: Receiver<(TcpStream, SocketAddr)>, stream: Option<TcpStream>, unsent: Vec<u8> },
    Udp { socket: UdpSocket, peer: Option<SocketAddr> },
}

/// The simulator interface's socket, which serves one autopilot at a time.
#[derive(Debug)]
pub struct SimulatorSocket {
    port: u16,
    transport: Transport,
    buffer: Vec<u8>,
}

/// Result of one read.
enum Received {
    Bytes(Vec<u8>, Option<SocketAddr>),
    Nothing,
    Closed,
}

impl Received {
    fn is_nothing(&self) -> bool {
        matches!(self, Self::Nothing)
    }
}

impl SimulatorSocket {
    /// Opens a port on the loopback interface; 0 selects any free port.
    ///
    /// # Errors
    /// Returns an error if the port cannot be opened.
    pub fn open(protocol: SimulatorProtocol, port: u16) -> Result<Self, AppError> {
        let (port, transport) = match protocol {
            SimulatorProtocol::Tcp => {
                let (listener, bound) = listen(LOOPBACK, port, PORT_OPTION)?;
                let (sender, accepted) = channel();
                std::thread::spawn(move || accept_streams(&listener, &sender));
                (bound, Transport::Tcp { accepted, stream: None, unsent: Vec::new() })
            }
            SimulatorProtocol::Udp => {
                let failed = |error| port_in_use("UDP", LOOPBACK, port, PORT_OPTION, &error);
                let socket = UdpSocket::bind((LOOPBACK, port)).map_err(failed)?;
                socket.set_read_timeout(Some(MAX_ANSWER_WAIT)).map_err(failed)?;
                let bound = socket.local_addr().map_err(failed)?.port();
                (bound, Transport::Udp { socket, peer: None })
            }
        };
        Ok(Self { port, transport, buffer: vec![0; MAX_DATAGRAM_BYTES] })
    }

    /// Returns the port number.
    pub fn port(&self) -> u16 {
        self.port
    }

    /// Queues bytes for the autopilot, if it is connected. Datagrams are sent at once, each by itself.
    pub fn send(&mut self, bytes: &[u8]) {
        match &mut self.transport {
            Transport::Tcp { stream: Some(_), unsent, .. } if unsent.len() <= MAX_UNSENT_BYTES => unsent.extend(bytes),
            Transport::Udp { socket, peer: Some(peer) } => {
                if let Err(error) = socket.send_to(bytes, *peer)
                    && error.kind() != ErrorKind::ConnectionRefused
                {
                    tracing::debug!("cannot send to the autopilot at {peer}: {error}");
                }
            }
            Transport::Tcp { .. } | Transport::Udp { peer: None, .. } => {}
        }
    }

    /// Sends the queued bytes in one piece, so that the autopilot wakes up once for all readings of a step.
    pub fn flush(&mut self) {
        let Transport::Tcp { stream: Some(stream), unsent, .. } = &mut self.transport else { return };
        while !unsent.is_empty() {
            match stream.write(unsent) {
                Ok(len) => drop(unsent.drain(..len)),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                // The buffer is full: the rest follows with the next readings. A closed connection is reported when it is read.
                Err(_) => return,
            }
        }
    }

    /// Waits briefly for data from the autopilot.
    pub fn wait(&mut self) -> Vec<LinkEvent> {
        let mut events = self.accept();
        if self.is_connected() {
            let early = self.receive_without_sleep();
            let received = if early.is_nothing() { self.receive() } else { early };
            events.extend(self.events(received));
        }
        events
    }

    /// Polls for data for a short time and lets other threads run meanwhile.
    fn receive_without_sleep(&mut self) -> Received {
        if !self.set_nonblocking(true) {
            return Received::Nothing;
        }
        let watch = Stopwatch::start();
        let mut received = self.receive();
        while received.is_nothing() && watch.elapsed() < POLL_TIME {
            std::thread::yield_now();
            received = self.receive();
        }
        self.set_nonblocking(false);
        received
    }

    /// Returns the data that has arrived, without waiting.
    pub fn poll(&mut self) -> Vec<LinkEvent> {
        let mut events = self.accept();
        if self.set_nonblocking(true) {
            loop {
                let received = self.receive();
                if received.is_nothing() {
                    break;
                }
                events.extend(self.events(received));
            }
            self.set_nonblocking(false);
        }
        events
    }

    /// Closes the connection, so that another process can connect.
    pub fn disconnect(&mut self) {
        match &mut self.transport {
            Transport::Tcp { stream, unsent, .. } => {
                if let Some(stream) = stream.take() {
                    // An error means that the connection is already closed.
                    let _ = stream.shutdown(Shutdown::Both);
                }
                unsent.clear();
            }
            Transport::Udp { peer, .. } => *peer = None,
        }
    }

    fn is_connected(&self) -> bool {
        match &self.transport {
            Transport::Tcp { stream, .. } => stream.is_some(),
            Transport::Udp { peer, .. } => peer.is_some(),
        }
    }

    /// Returns false if there is nothing to read from.
    fn set_nonblocking(&self, nonblocking: bool) -> bool {
        match &self.transport {
            Transport::Tcp { stream, .. } => stream.as_ref().is_some_and(|stream| stream.set_nonblocking(nonblocking).is_ok()),
            Transport::Udp { socket, .. } => socket.set_nonblocking(nonblocking).is_ok(),
        }
    }

    /// Takes new connections. While a process is connected, others are rejected.
    fn accept(&mut self) -> Vec<LinkEvent> {
        let Transport::Tcp { accepted, stream, .. } = &mut self.transport else { return Vec::new() };
        let mut events = Vec::new();
        while let Ok((new, from)) = accepted.try_recv() {
            if stream.is_some() {
                tracing::warn!("rejected a second connection to the simulator interface ({}) from {from}", local(self.port));
            } else {
                *stream = Some(new);
                events.push(LinkEvent::AutopilotConnected);
            }
        }
        events
    }

    fn receive(&mut self) -> Received {
        let result = match &mut self.transport {
            Transport::Tcp { stream: Some(stream), .. } => stream.read(&mut self.buffer).map(|len| (len, None)),
            Transport::Tcp { stream: None, .. } => return Received::Nothing,
            Transport::Udp { socket, .. } => socket.recv_from(&mut self.buffer).map(|(len, from)| (len, Some(from))),
        };
        match result {
            Ok((0, None)) => Received::Closed,
            Ok((len, from)) => Received::Bytes(self.buffer[..len].to_vec(), from),
            Err(error) if is_temporary(error.kind()) => Received::Nothing,
            Err(_) if matches!(self.transport, Transport::Tcp { .. }) => Received::Closed,
            Err(_) => {
                std::thread::sleep(ERROR_DELAY);
                Received::Nothing
            }
        }
    }

    fn events(&mut self, received: Received) -> Vec<LinkEvent> {
        match (received, &mut self.transport) {
            (Received::Bytes(bytes, Some(from)), Transport::Udp { peer, .. }) => {
                // A restarted ArduPilot sends from another port.
                let connected = peer.replace(from).is_none().then_some(LinkEvent::AutopilotConnected);
                connected.into_iter().chain([LinkEvent::AutopilotBytes(bytes)]).collect()
            }
            (Received::Bytes(bytes, _), _) => vec![LinkEvent::AutopilotBytes(bytes)],
            (Received::Closed, _) => {
                self.disconnect();
                vec![LinkEvent::AutopilotClosed]
            }
            (Received::Nothing, _) => Vec::new(),
        }
    }
}

/// Returns whether reading can continue: no data yet, or, on UDP, an earlier datagram that nobody received.
fn is_temporary(kind: ErrorKind) -> bool {
    matches!(kind, ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted | ErrorKind::ConnectionRefused)
}

fn accept_streams(listener: &TcpListener, accepted: &Sender<(TcpStream, SocketAddr)>) {
    loop {
        let Ok((stream, from)) = listener.accept() else {
            std::thread::sleep(ERROR_DELAY);
            continue;
        };
        let configured = stream
            .set_nodelay(true)
            .and_then(|()| stream.set_read_timeout(Some(MAX_ANSWER_WAIT)))
            .and_then(|()| stream.set_write_timeout(Some(MAX_SEND_WAIT)));
        if let Err(error) = configured {
            tracing::warn!("autopilot at {from}: {error}");
            continue;
        }
        if accepted.send((stream, from)).is_err() {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::clock::Stopwatch;

    /// Prevents a failing test from hanging.
    const TEST_TIMEOUT: Duration = Duration::from_secs(60);

    /// Reads until there are `count` events.
    fn events(socket: &mut SimulatorSocket, count: usize) -> Vec<LinkEvent> {
        let (watch, mut events) = (Stopwatch::start(), Vec::new());
        while events.len() < count && watch.elapsed() < TEST_TIMEOUT {
            events.extend(socket.wait());
            events.extend(socket.poll());
        }
        events
    }

    #[test]
    fn wire_tcp_autopilot_connects_exchanges_bytes_and_disconnects() {
        let mut socket = SimulatorSocket::open(SimulatorProtocol::Tcp, 0).unwrap();
        socket.send(b"nobody gets this");
        let mut autopilot = TcpStream::connect((LOOPBACK, socket.port())).unwrap();
        assert_eq!(events(&mut socket, 1), [LinkEvent::AutopilotConnected]);
        socket.send(b"readings, ");
        socket.send(b"more readings");
        socket.flush();
        let mut received = [0; 23];
        autopilot.read_exact(&mut received).unwrap();
        assert_eq!(&received, b"readings, more readings");
        autopilot.write_all(b"commands").unwrap();
        drop(autopilot);
        assert_eq!(events(&mut socket, 2), [LinkEvent::AutopilotBytes(b"commands".to_vec()), LinkEvent::AutopilotClosed]);
        let _again = TcpStream::connect((LOOPBACK, socket.port())).unwrap();
        assert_eq!(events(&mut socket, 1), [LinkEvent::AutopilotConnected]);
    }

    #[test]
    fn wire_second_tcp_connection_is_rejected() {
        let mut socket = SimulatorSocket::open(SimulatorProtocol::Tcp, 0).unwrap();
        let mut first = TcpStream::connect((LOOPBACK, socket.port())).unwrap();
        assert_eq!(events(&mut socket, 1), [LinkEvent::AutopilotConnected]);
        let mut second = TcpStream::connect((LOOPBACK, socket.port())).unwrap();
        let watch = Stopwatch::start();
        second.set_read_timeout(Some(MAX_ANSWER_WAIT)).unwrap();
        let mut end = second.read(&mut [0]);
        while matches!(&end, Err(error) if is_temporary(error.kind())) && watch.elapsed() < TEST_TIMEOUT {
            assert_eq!(socket.poll(), []);
            end = second.read(&mut [0]);
        }
        assert_eq!(end.unwrap_or(0), 0, "the second connection is closed");
        first.write_all(b"still here").unwrap();
        assert_eq!(events(&mut socket, 1), [LinkEvent::AutopilotBytes(b"still here".to_vec())]);
    }

    #[test]
    fn wire_autopilot_that_does_not_read_loses_messages_but_does_not_block() {
        let mut socket = SimulatorSocket::open(SimulatorProtocol::Tcp, 0).unwrap();
        let autopilot = TcpStream::connect((LOOPBACK, socket.port())).unwrap();
        assert_eq!(events(&mut socket, 1), [LinkEvent::AutopilotConnected]);
        let message = vec![7; MAX_UNSENT_BYTES];
        // Far more than a loopback connection buffers.
        for _ in 0..100 {
            socket.send(&message);
            socket.flush();
        }
        let Transport::Tcp { unsent, .. } = &socket.transport else { panic!("TCP was opened") };
        assert!(!unsent.is_empty() && unsent.len() <= 2 * MAX_UNSENT_BYTES);
        drop(autopilot);
        assert_eq!(events(&mut socket, 1), [LinkEvent::AutopilotClosed]);
    }

    #[test]
    fn wire_udp_autopilot_is_answered_at_its_latest_address() {
        let mut socket = SimulatorSocket::open(SimulatorProtocol::Udp, 0).unwrap();
        let sent = |bytes: &[u8]| LinkEvent::AutopilotBytes(bytes.to_vec());
        let autopilot = UdpSocket::bind((LOOPBACK, 0)).unwrap();
        autopilot.send_to(b"servos", (LOOPBACK, socket.port())).unwrap();
        assert_eq!(events(&mut socket, 2), [LinkEvent::AutopilotConnected, sent(b"servos")]);
        drop(autopilot);
        socket.send(b"nobody gets this");
        let restarted = UdpSocket::bind((LOOPBACK, 0)).unwrap();
        restarted.send_to(b"restarted", (LOOPBACK, socket.port())).unwrap();
        assert_eq!(events(&mut socket, 1), [sent(b"restarted")]);
        socket.send(b"readings");
        let mut buffer = [0; 16];
        let (len, _) = restarted.recv_from(&mut buffer).unwrap();
        assert_eq!(&buffer[..len], b"readings");
    }
}
