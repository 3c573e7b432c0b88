//! Links of a vehicle: UDP sockets on the loopback interface, mailboxes read by Python, and telemetry logs.

use spandrel_mavlink::codec::Decoder;
use spandrel_mavlink::telemetry::tlog;
use spandrel_sitl::endpoint::{LinkId, LinkKind};
use spandrel_sitl::sim::Sim;
use std::collections::{BTreeMap, VecDeque};
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::path::Path;

/// First link ID for Python; link 1 belongs to the test harness.
const FIRST_LINK_ID: u32 = 2;
/// Maximum size of a UDP datagram, bytes.
const MAX_DATAGRAM_BYTES: usize = 65_535;
/// Maximum number of datagrams in a mailbox, enough for a few minutes of all streams. When it is full, the oldest are
/// dropped.
const MAX_MAILBOX_DATAGRAMS: usize = 50_000;

/// Link transport.
#[derive(Debug)]
enum Transport {
    Udp { socket: UdpSocket, peer: SocketAddr },
    Mailbox(VecDeque<Vec<u8>>),
    Log(Log),
}

/// A telemetry log being written.
#[derive(Debug)]
struct Log {
    file: BufWriter<File>,
    decoder: Decoder,
    failure: Option<io::Error>,
}

impl Log {
    /// Writes each frame of a datagram as a record; stops after a write error.
    fn write(&mut self, timestamp_us: u64, datagram: &[u8]) {
        for frame in self.decoder.datagram(datagram) {
            if self.failure.is_none() {
                self.failure = self.file.write_all(&tlog::record(timestamp_us, &frame.bytes)).err();
            }
        }
    }

    fn finish(mut self) -> io::Result<()> {
        self.failure.map_or_else(|| self.file.flush(), Err)
    }
}

/// All transports, by link ID.
#[derive(Debug)]
pub struct Links {
    transports: BTreeMap<LinkId, Transport>,
    next: u32,
    buffer: Vec<u8>,
}

impl Links {
    /// Creates an empty set of links.
    pub fn new() -> Self {
        Self { transports: BTreeMap::new(), next: FIRST_LINK_ID, buffer: vec![0; MAX_DATAGRAM_BYTES] }
    }

    fn add(&mut self, way: Transport) -> LinkId {
        let link = LinkId(self.next);
        self.next += 1;
        self.transports.insert(link, way);
        link
    }

    /// Opens a UDP socket on a free loopback port. Returns the link ID and the port.
    pub fn open_udp(&mut self, sim: &mut Sim, kind: LinkKind, peer: SocketAddr, lockstep: bool) -> io::Result<(LinkId, u16)> {
        let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0))?;
        socket.set_nonblocking(true)?;
        let port = socket.local_addr()?.port();
        let link = self.add(Transport::Udp { socket, peer });
        sim.open_link(link, kind, lockstep);
        Ok((link, port))
    }

    /// Opens a mailbox.
    pub fn open_mailbox(&mut self, sim: &mut Sim, kind: LinkKind) -> LinkId {
        let link = self.add(Transport::Mailbox(VecDeque::new()));
        sim.open_link(link, kind, false);
        link
    }

    /// Opens a link that writes the monitor's telemetry to a new file.
    pub fn open_log(&mut self, sim: &mut Sim, path: &Path) -> io::Result<LinkId> {
        let log = Log { file: BufWriter::new(File::create(path)?), decoder: Decoder::new(), failure: None };
        let link = self.add(Transport::Log(log));
        sim.open_link(link, LinkKind::Payload, false);
        Ok(link)
    }

    /// Closes a link. Errors if it does not exist, or if its log could not be written.
    pub fn close(&mut self, sim: &mut Sim, link: LinkId) -> io::Result<()> {
        sim.close_link(link);
        match self.transports.remove(&link) {
            Some(Transport::Log(log)) => log.finish(),
            Some(Transport::Udp { .. } | Transport::Mailbox(_)) => Ok(()),
            None => Err(io::Error::new(io::ErrorKind::NotConnected, format!("link {} is closed", link.0))),
        }
    }

    /// Returns whether the link is a mailbox.
    pub fn is_mailbox(&self, link: LinkId) -> bool {
        matches!(self.transports.get(&link), Some(Transport::Mailbox(_)))
    }

    /// Returns and removes the datagrams in a mailbox, oldest first; `None` if the link is not a mailbox.
    pub fn take(&mut self, link: LinkId) -> Option<Vec<Vec<u8>>> {
        match self.transports.get_mut(&link)? {
            Transport::Mailbox(mail) => Some(mail.drain(..).collect()),
            Transport::Udp { .. } | Transport::Log(_) => None,
        }
    }

    /// Delivers a datagram from the vehicle. Logs use `timestamp_us`, µs since the Unix epoch, as its timestamp. UDP send
    /// errors are ignored, because peers come and go.
    pub fn deliver(&mut self, link: LinkId, bytes: Vec<u8>, timestamp_us: u64) {
        match self.transports.get_mut(&link) {
            Some(Transport::Udp { socket, peer }) => {
                let _ = socket.send_to(&bytes, *peer);
            }
            Some(Transport::Mailbox(mail)) => {
                if mail.len() == MAX_MAILBOX_DATAGRAMS {
                    mail.pop_front();
                }
                mail.push_back(bytes);
            }
            Some(Transport::Log(log)) => log.write(timestamp_us, &bytes),
            None => {}
        }
    }

    /// Passes all received datagrams to the vehicle. Datagrams from addresses other than the link's peer are ignored.
    pub fn receive(&mut self, sim: &mut Sim) {
        for (link, way) in &self.transports {
            let Transport::Udp { socket, peer } = way else { continue };
            while let Some((len, from)) = next(socket, &mut self.buffer) {
                if *peer == from {
                    sim.handle_datagram(*link, &self.buffer[..len]);
                }
            }
        }
    }
}

/// Returns the next datagram. Skips connection-refused errors caused by earlier sends.
fn next(socket: &UdpSocket, buffer: &mut [u8]) -> Option<(usize, SocketAddr)> {
    loop {
        match socket.recv_from(buffer) {
            Ok(got) => return Some(got),
            Err(error) if error.kind() == io::ErrorKind::ConnectionRefused => {}
            Err(_) => return None,
        }
    }
}
