//! Events on a vehicle's links.

use spandrel_mavlink::codec::ReceivedFrame;
use spandrel_sitl::endpoint::LinkKind;

/// A link change or received data.
#[derive(Debug, Clone, PartialEq)]
pub enum LinkEvent {
    /// A link was opened.
    Opened {
        /// Link number.
        link: u32,
        /// Link kind.
        kind: LinkKind,
        /// True if the peer runs in lockstep.
        lockstep: bool,
        /// True if the peer contacted the vehicle first; its source address may be forged.
        learned: bool,
        /// Link capacity, bytes/s, if limited.
        limit: Option<f64>,
    },
    /// A datagram, or one complete frame of a stream.
    Bytes {
        /// Link on which the data arrived.
        link: u32,
        /// Received MAVLink bytes.
        bytes: Vec<u8>,
    },
    /// A link was closed.
    Closed {
        /// Link number.
        link: u32,
    },
    /// An ordinary MAVLink frame from a flight controller on a serial port.
    FlightControllerFrame {
        /// Link number.
        link: u32,
        /// The frame.
        frame: Box<ReceivedFrame>,
    },
    /// An external autopilot connected to the simulator interface.
    AutopilotConnected,
    /// Bytes from the simulator interface.
    AutopilotBytes(Vec<u8>),
    /// The autopilot's connection to the simulator interface closed.
    AutopilotClosed,
}
