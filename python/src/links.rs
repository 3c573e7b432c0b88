//! Ways in and out of a vehicle: UDP sockets on the loopback, and mailboxes that Python empties.

use spandrel_sitl::endpoint::{LinkId, LinkKind};
use spandrel_sitl::sim::Sim;
use std::collections::{BTreeMap, VecDeque};
use std::io;
use std::net::{Ipv4Addr, SocketAddr, UdpSocket};

/// The harness's own link is 1; those of Python count from here.
const FIRST: u32 = 2;
/// The longest datagram that UDP carries, bytes.
const DATAGRAM: usize = 65_535;
/// Datagrams that a mailbox keeps, some minutes of all streams; the oldest are dropped.
const MAILBOX: usize = 50_000;

/// One way in and out.
#[derive(Debug)]
enum Way {
    Udp { socket: UdpSocket, kind: LinkKind, lockstep: bool, peer: Option<SocketAddr> },
    Mailbox(VecDeque<Vec<u8>>),
}

/// All of them by link.
#[derive(Debug)]
pub struct Links {
    ways: BTreeMap<LinkId, Way>,
    next: u32,
    buffer: Vec<u8>,
}

impl Links {
    /// None yet.
    pub fn new() -> Self {
        Self { ways: BTreeMap::new(), next: FIRST, buffer: vec![0; DATAGRAM] }
    }

    fn add(&mut self, way: Way) -> LinkId {
        let link = LinkId(self.next);
        self.next += 1;
        self.ways.insert(link, way);
        link
    }

    /// Opens a socket on a free loopback port. Without a peer, the sender of the first datagram is the peer. Returns link and port.
    pub fn open_udp(&mut self, sim: &mut Sim, kind: LinkKind, peer: Option<SocketAddr>, lockstep: bool) -> io::Result<(LinkId, u16)> {
        let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0))?;
        socket.set_nonblocking(true)?;
        let port = socket.local_addr()?.port();
        let link = self.add(Way::Udp { socket, kind, lockstep, peer });
        if peer.is_some() {
            sim.open_link(link, kind, lockstep);
        }
        Ok((link, port))
    }

    /// Opens a mailbox.
    pub fn open_mailbox(&mut self, sim: &mut Sim, kind: LinkKind) -> LinkId {
        let link = self.add(Way::Mailbox(VecDeque::new()));
        sim.open_link(link, kind, false);
        link
    }

    /// Closes a link; false when there is none.
    pub fn close(&mut self, sim: &mut Sim, link: LinkId) -> bool {
        sim.close_link(link);
        self.ways.remove(&link).is_some()
    }

    /// Whether the link is a mailbox.
    pub fn is_mailbox(&self, link: LinkId) -> bool {
        matches!(self.ways.get(&link), Some(Way::Mailbox(_)))
    }

    /// The datagrams in a mailbox, oldest first; `None` for a link that is none.
    pub fn take(&mut self, link: LinkId) -> Option<Vec<Vec<u8>>> {
        match self.ways.get_mut(&link)? {
            Way::Mailbox(mail) => Some(mail.drain(..).collect()),
            Way::Udp { .. } => None,
        }
    }

    /// Sends a datagram of the vehicle. Nobody there is no failure: UDP peers come and go.
    pub fn deliver(&mut self, link: LinkId, bytes: Vec<u8>) {
        match self.ways.get_mut(&link) {
            Some(Way::Udp { socket, peer: Some(peer), .. }) => {
                let _ = socket.send_to(&bytes, *peer);
            }
            Some(Way::Mailbox(mail)) => {
                if mail.len() == MAILBOX {
                    mail.pop_front();
                }
                mail.push_back(bytes);
            }
            Some(Way::Udp { peer: None, .. }) | None => {}
        }
    }

    /// Hands everything that has arrived to the vehicle. Datagrams from others than a link's peer are ignored.
    pub fn receive(&mut self, sim: &mut Sim) {
        for (link, way) in &mut self.ways {
            let Way::Udp { socket, kind, lockstep, peer } = way else { continue };
            while let Some((len, from)) = next(socket, &mut self.buffer) {
                if peer.is_none() {
                    *peer = Some(from);
                    sim.open_link(*link, *kind, *lockstep);
                }
                if *peer == Some(from) {
                    sim.handle_datagram(*link, &self.buffer[..len]);
                }
            }
        }
    }
}

/// The next datagram. A refusal that an earlier one met is skipped.
fn next(socket: &UdpSocket, buffer: &mut [u8]) -> Option<(usize, SocketAddr)> {
    loop {
        match socket.recv_from(buffer) {
            Ok(got) => return Some(got),
            Err(error) if error.kind() == io::ErrorKind::ConnectionRefused => {}
            Err(_) => return None,
        }
    }
}
