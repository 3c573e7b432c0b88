//! Link identity, link kind, and outgoing datagrams.

/// Identifies a link; assigned by the host.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct LinkId(pub u32);

/// Kind of peer, which determines the default rates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinkKind {
    /// A ground station over UDP.
    GroundStation,
    /// An SDK or companion computer.
    Sdk,
    /// A payload process, such as the monitor.
    Payload,
    /// A ground station over TCP.
    Tcp,
    /// A radio or a cable on a serial port.
    Serial,
    /// The autopilot itself, if it runs in another process.
    Autopilot,
}

/// A datagram to send.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Transmit {
    /// The link to send it on.
    pub link: LinkId,
    /// One or more complete frames.
    pub bytes: Vec<u8>,
}
