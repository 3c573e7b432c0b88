//! MAVLink as Spandrel speaks it, without sockets: bytes to frames and back ([`codec`]), signing ([`signing`]), routing ([`router`]), file
//! transfer ([`ftp`]), units ([`units`]), the contract between vehicle and monitor ([`contract`]), and what a flight's messages add up to ([`telemetry`]).
//!
//! Bytes that belong to no frame are counted and skipped; nothing panics on them. Telemetry goes three steps: a frame becomes a
//! [`telemetry::sample::Sample`], samples become a [`telemetry::timeline::Timeline`] with its gaps marked, and the timeline gives scored
//! frames at a fixed rate. A recorded log ([`telemetry::tlog`]) takes the same way as a live link, so both give the same numbers.
//!
//! ```
//! use spandrel_mavlink::codec::{Decoder, Encoder};
//! use spandrel_mavlink::dialect::{HEARTBEAT_DATA, MavMessage};
//!
//! let mut station = Encoder::new(255, 190);
//! let bytes = station.encode(&MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
//!
//! let mut decoder = Decoder::new();
//! let frames = decoder.datagram(&bytes);
//! assert_eq!(frames[0].system_id, 255);
//! assert!(matches!(frames[0].message, Some(MavMessage::HEARTBEAT(_))));
//!
//! // Noise is skipped and counted.
//! assert!(decoder.datagram(b"no frame").is_empty());
//! assert_eq!(decoder.bad_bytes(), 8);
//! ```

pub mod ardupilotmega;
pub mod codec;
pub mod contract;
pub mod ftp;
pub mod note;
pub mod router;
pub mod signing;
pub mod station;
pub mod telemetry;
pub mod units;

pub use mavlink::dialects::common as dialect;
