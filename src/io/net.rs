//! Collects the data from all sockets in one queue. One thread per socket drains the kernel's buffer while the core
//! computes. The queue is bounded; data that does not fit is dropped and counted. A misbehaving peer cannot stop a
//! reader thread.

use super::serial::{self, SerialDevice};
use crate::errors::AppError;
use std::collections::BTreeMap;
use std::io::{ErrorKind, Read, Write};
use std::net::{IpAddr, Shutdown, SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::time::Duration;

/// Maximum number of events waiting for the core: about ten seconds of traffic on a busy link.
const EVENT_QUEUE_LEN: usize = 16_384;
/// Maximum number of frames waiting for a slow TCP client; further frames are dropped.
const STREAM_QUEUE_LEN: usize = 2_048;
/// Delay after an unexpected socket error, to avoid a busy loop if a network interface is broken.
pub(super) const ERROR_DELAY: Duration = Duration::from_millis(50);
/// Buffer size, larger than any UDP payload.
pub(super) const MAX_DATAGRAM_BYTES: usize = 65_536;

/// Identifies a UDP socket.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct SocketId(usize);

/// Identifies a TCP connection or a serial port.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct StreamId(u32);

#[cfg(test)]
impl StreamId {
    /// Creates an ID for a test without sockets.
    pub fn for_test(number: u32) -> Self {
        Self(number)
    }
}

/// Origin of a byte stream.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum StreamOrigin {
    /// A client that connected over TCP.
    Tcp(SocketAddr),
    /// A device on a serial port.
    Serial(SerialDevice),
    /// A flight controller on a serial port.
    FlightController(SerialDevice),
}

impl std::fmt::Display for StreamOrigin {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Tcp(from) => write!(f, "TCP client {from}"),
            Self::Serial(device) => write!(f, "serial port {device}"),
            Self::FlightController(device) => write!(f, "flight controller on {device}"),
        }
    }
}

/// A socket event.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NetEvent {
    /// A datagram was received.
    Datagram {
        /// Socket that received it.
        socket: SocketId,
        /// Sender's address.
        from: SocketAddr,
        /// Datagram payload.
        bytes: Vec<u8>,
    },
    /// A client connected, or a serial port was opened.
    Connected(StreamId, StreamOrigin),
    /// Bytes were received on a stream.
    Bytes(StreamId, Vec<u8>),
    /// The stream was closed.
    Closed(StreamId),
}

/// An entry of the event queue.
enum QueuedEvent {
    Event(NetEvent),
    Client(StreamId, StreamOrigin, StreamWriter),
}

/// Write side of a stream.
#[derive(Debug)]
struct StreamWriter {
    queue: SyncSender<Vec<u8>>,
    socket: Option<TcpStream>,
}

impl Drop for StreamWriter {
    fn drop(&mut self) {
        // This also stops the reader thread. An error means that the connection is already closed.
        let _ = self.socket.as_ref().map(|socket| socket.shutdown(Shutdown::Both));
    }
}

/// Reports a new stream to the core. Returns the channel of frames to send, or `None` if the core has stopped.
fn register_stream(
    stream: StreamId,
    origin: StreamOrigin,
    socket: Option<TcpStream>,
    queue: &SyncSender<QueuedEvent>,
) -> Option<Receiver<Vec<u8>>> {
    let (sender, frames) = sync_channel(STREAM_QUEUE_LEN);
    queue.send(QueuedEvent::Client(stream, origin, StreamWriter { queue: sender, socket })).ok()?;
    Some(frames)
}

/// All sockets of one process.
#[derive(Debug)]
pub struct SocketHub {
    sender: SyncSender<QueuedEvent>,
    receiver: Receiver<QueuedEvent>,
    sockets: Vec<UdpSocket>,
    streams: BTreeMap<StreamId, StreamWriter>,
    serial_count: u32,
    dropped: Arc<AtomicU64>,
    reported_errors: BTreeMap<SocketAddr, ErrorKind>,
}

impl std::fmt::Debug for QueuedEvent {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Event(arrival) => arrival.fmt(f),
            Self::Client(stream, from, _) => write!(f, "Client({stream:?}, {from})"),
        }
    }
}

impl SocketHub {
    /// Creates a hub without sockets.
    pub fn new() -> Self {
        let (sender, receiver) = sync_channel(EVENT_QUEUE_LEN);
        let dropped = Arc::new(AtomicU64::new(0));
        Self {
            sender,
            receiver,
            sockets: Vec::new(),
            streams: BTreeMap::new(),
            serial_count: 0,
            dropped,
            reported_errors: BTreeMap::new(),
        }
    }

    /// Binds a UDP port (0 for any free one). If the port is in use, the error message mentions the `flag` option.
    ///
    /// # Errors
    /// Returns an error if the port cannot be bound.
    pub fn bind(&mut self, ip: IpAddr, port: u16, flag: &str) -> Result<SocketId, AppError> {
        let socket = UdpSocket::bind((ip, port)).map_err(|error| port_in_use("UDP", ip, port, flag, &error))?;
        let reader = socket.try_clone().map_err(|error| AppError::failed(format!("UDP port {port}: {error}")))?;
        let id = SocketId(self.sockets.len());
        self.sockets.push(socket);
        let (queue, dropped) = (self.sender.clone(), self.dropped.clone());
        std::thread::spawn(move || read_datagrams(&reader, id, &queue, &dropped));
        Ok(id)
    }

    /// Listens for TCP clients and returns the port number.
    ///
    /// # Errors
    /// Returns an error if the port cannot be bound.
    pub fn serve(&self, ip: IpAddr, port: u16, flag: &str) -> Result<u16, AppError> {
        let (listener, bound) = listen(ip, port, flag)?;
        let queue = self.sender.clone();
        std::thread::spawn(move || accept_clients(&listener, &queue));
        Ok(bound)
    }

    /// Opens a serial port, and reopens it whenever it disconnects. `origin` is the kind of device on it.
    ///
    /// # Errors
    /// Returns an error if the port cannot be opened.
    pub fn serve_serial(&mut self, device: &SerialDevice, origin: fn(SerialDevice) -> StreamOrigin) -> Result<(), AppError> {
        let port = device.open().map_err(|error| AppError::failed(format!("--serial {device}: {error}")))?;
        // Serial ports are numbered downward from the maximum to avoid collisions with the numbers of TCP clients.
        let stream = StreamId(u32::MAX - self.serial_count);
        self.serial_count += 1;
        let (queue, device) = (self.sender.clone(), device.clone());
        std::thread::spawn(move || {
            let give = |bytes: &[u8]| queue.send(QueuedEvent::Event(NetEvent::Bytes(stream, bytes.to_vec()))).is_ok();
            let begin = || register_stream(stream, origin(device.clone()), None, &queue);
            let end = || queue.send(QueuedEvent::Event(NetEvent::Closed(stream))).is_ok();
            serial::run_with_reconnect(&device, port, begin, give, end);
        });
        Ok(())
    }

    /// Closes a TCP connection or stops using a serial port.
    pub fn drop_stream(&mut self, stream: StreamId) {
        self.streams.remove(&stream);
    }

    /// Returns the port number of a socket.
    pub fn port(&self, socket: SocketId) -> u16 {
        self.sockets.get(socket.0).and_then(|socket| socket.local_addr().ok()).map_or(0, |address| address.port())
    }

    /// Returns the next event, or `None` if there is none within this time.
    pub fn next(&mut self, wait: Duration) -> Option<NetEvent> {
        let inner = if wait.is_zero() { self.receiver.try_recv().ok() } else { self.receiver.recv_timeout(wait).ok() };
        match inner? {
            QueuedEvent::Event(arrival) => {
                if let NetEvent::Closed(stream) = arrival {
                    self.streams.remove(&stream);
                }
                Some(arrival)
            }
            QueuedEvent::Client(stream, from, writer) => {
                self.streams.insert(stream, writer);
                Some(NetEvent::Connected(stream, from))
            }
        }
    }

    /// Sends a datagram. A peer that is not listening yet is not an error; any other error is logged once per peer.
    pub fn send(&mut self, socket: SocketId, to: SocketAddr, bytes: &[u8]) {
        let Some(socket) = self.sockets.get(socket.0) else { return };
        let Err(error) = socket.send_to(bytes, to) else { return };
        let kind = error.kind();
        if kind != ErrorKind::ConnectionRefused && self.reported_errors.insert(to, kind) != Some(kind) {
            tracing::warn!("cannot send to {to}: {error} (by default only this machine can be reached; see --listen)");
        }
    }

    /// Sends to a stream. A client that does not read its data loses frames, but never blocks the sender.
    pub fn send_stream(&self, stream: StreamId, bytes: Vec<u8>) {
        let Some(writer) = self.streams.get(&stream) else { return };
        if let Err(TrySendError::Full(_)) = writer.queue.try_send(bytes) {
            self.dropped.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Returns the number of events and frames dropped because a queue was full.
    pub fn dropped(&self) -> u64 {
        self.dropped.load(Ordering::Relaxed)
    }
}

/// Listens on a TCP port (0 for any free one) and returns its number. If the port is in use, the error message mentions the `flag`
/// option.
///
/// # Errors
/// Returns an error if the port cannot be bound.
pub fn listen(ip: IpAddr, port: u16, flag: &str) -> Result<(TcpListener, u16), AppError> {
    let listener = TcpListener::bind((ip, port)).map_err(|error| port_in_use("TCP", ip, port, flag, &error))?;
    let bound = listener.local_addr().map_or(port, |address| address.port());
    Ok((listener, bound))
}

/// Creates the error for a port that cannot be opened.
pub fn port_in_use(kind: &str, ip: IpAddr, port: u16, flag: &str, error: &std::io::Error) -> AppError {
    match error.kind() {
        ErrorKind::AddrInUse => AppError::failed(format!(
            "{kind} port {port} on {ip} is in use, perhaps by another simulator or ground station: choose another one with {flag} or \
             --instance (port 0 selects any free port)"
        )),
        ErrorKind::AddrNotAvailable => AppError::invalid(format!("{ip} is not an address of this machine (--listen)")),
        ErrorKind::PermissionDenied => AppError::failed(format!("no permission to open {kind} port {port} ({flag})")),
        _ => AppError::failed(format!("cannot open {kind} port {port} on {ip}: {error}")),
    }
}

fn read_datagrams(socket: &UdpSocket, id: SocketId, queue: &SyncSender<QueuedEvent>, dropped: &AtomicU64) {
    let mut buffer = vec![0u8; MAX_DATAGRAM_BYTES];
    loop {
        match socket.recv_from(&mut buffer) {
            Ok((len, from)) => {
                let arrival = NetEvent::Datagram { socket: id, from, bytes: buffer[..len].to_vec() };
                match queue.try_send(QueuedEvent::Event(arrival)) {
                    Ok(()) => {}
                    Err(TrySendError::Full(_)) => {
                        dropped.fetch_add(1, Ordering::Relaxed);
                    }
                    Err(TrySendError::Disconnected(_)) => return,
                }
            }
            // ICMP "port unreachable" in response to an earlier datagram: the peer is not listening.
            Err(error) if matches!(error.kind(), ErrorKind::ConnectionRefused | ErrorKind::ConnectionReset) => {}
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(_) => std::thread::sleep(ERROR_DELAY),
        }
    }
}

fn accept_clients(listener: &TcpListener, queue: &SyncSender<QueuedEvent>) {
    for number in 0.. {
        let Ok((socket, from)) = listener.accept() else {
            std::thread::sleep(ERROR_DELAY);
            continue;
        };
        if serve_client(StreamId(number), socket, StreamOrigin::Tcp(from), queue).is_err() {
            tracing::warn!("TCP client {from} disconnected during connection setup");
        }
    }
}

fn serve_client(
    stream: StreamId,
    socket: TcpStream,
    origin: StreamOrigin,
    queue: &SyncSender<QueuedEvent>,
) -> std::io::Result<()> {
    socket.set_nodelay(true)?;
    let (mut to_read, mut to_write) = (socket.try_clone()?, socket.try_clone()?);
    let Some(frames) = register_stream(stream, origin, Some(socket), queue) else { return Ok(()) };
    std::thread::spawn(move || {
        for frame in frames {
            if to_write.write_all(&frame).is_err() {
                break;
            }
        }
    });
    let queue = queue.clone();
    std::thread::spawn(move || {
        let mut buffer = [0u8; 4096];
        while let Ok(len @ 1..) = to_read.read(&mut buffer) {
            if queue.send(QueuedEvent::Event(NetEvent::Bytes(stream, buffer[..len].to_vec()))).is_err() {
                return;
            }
        }
        // Fails only if the core has stopped, which needs no report.
        let _ = queue.send(QueuedEvent::Event(NetEvent::Closed(stream)));
    });
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::Ipv4Addr;

    const LOOPBACK: IpAddr = IpAddr::V4(Ipv4Addr::LOCALHOST);
    /// Prevents a failing test from hanging.
    const TEST_TIMEOUT: Duration = Duration::from_secs(60);

    #[test]
    fn wire_datagrams_pass_between_two_hubs() {
        let (mut a, mut b) = (SocketHub::new(), SocketHub::new());
        let (from, to) = (a.bind(LOOPBACK, 0, "--a").unwrap(), b.bind(LOOPBACK, 0, "--b").unwrap());
        a.send(from, (LOOPBACK, b.port(to)).into(), b"hello");
        let expected = NetEvent::Datagram { socket: to, from: (LOOPBACK, a.port(from)).into(), bytes: b"hello".to_vec() };
        assert_eq!(b.next(TEST_TIMEOUT), Some(expected));
    }

    #[test]
    fn wire_port_in_use_error_mentions_the_option() {
        let mut hub = SocketHub::new();
        let first = hub.bind(LOOPBACK, 0, "--a").unwrap();
        let port = hub.port(first);
        let Err(error) = hub.bind(LOOPBACK, port, "--payload-port") else { panic!("bound twice") };
        let message = error.to_string();
        assert!(message.contains("in use") && message.contains("--payload-port") && message.contains(&port.to_string()));
    }

    #[test]
    fn wire_sending_to_closed_port_is_not_an_error() {
        let mut hub = SocketHub::new();
        let gone = { UdpSocket::bind((LOOPBACK, 0)).unwrap().local_addr().unwrap() };
        let socket = hub.bind(LOOPBACK, 0, "--a").unwrap();
        for _ in 0..10 {
            hub.send(socket, gone, b"anybody?");
        }
        let itself = (LOOPBACK, hub.port(socket)).into();
        hub.send(socket, itself, b"still here");
        assert!(matches!(hub.next(TEST_TIMEOUT), Some(NetEvent::Datagram { bytes, .. }) if bytes == b"still here"));
    }

    #[test]
    fn wire_tcp_client_connects_exchanges_bytes_and_disconnects() {
        let mut hub = SocketHub::new();
        let port = hub.serve(LOOPBACK, 0, "--tcp-port").unwrap();
        let mut client = TcpStream::connect((LOOPBACK, port)).unwrap();
        let Some(NetEvent::Connected(stream, StreamOrigin::Tcp(_))) = hub.next(TEST_TIMEOUT) else { panic!("nobody connected") };
        client.write_all(b"in").unwrap();
        assert_eq!(hub.next(TEST_TIMEOUT), Some(NetEvent::Bytes(stream, b"in".to_vec())));
        hub.send_stream(stream, b"out".to_vec());
        let mut received = [0u8; 3];
        client.read_exact(&mut received).unwrap();
        assert_eq!(&received, b"out");
        drop(client);
        assert_eq!(hub.next(TEST_TIMEOUT), Some(NetEvent::Closed(stream)));
    }
}
