//! Spandrel's MAVLink implementation, without network I/O: framing ([`codec`]), signing ([`signing`]), routing ([`router`]), file
//! transfer ([`ftp`]), unit conversions ([`units`]), the interface between vehicle and monitor ([`contract`]), and telemetry
//! processing ([`telemetry`]).
//!
//! Invalid bytes are counted and skipped, and never cause a panic. Telemetry is processed in three steps: a frame
//! becomes a [`telemetry::sample::Sample`], samples become a [`telemetry::timeline::Timeline`] with known gaps, and the
//! timeline is resampled to scoring frames at a fixed rate. Recorded logs ([`telemetry::tlog`]) and live links are
//! processed by the same code, so their results are identical.
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
//! // Invalid bytes are skipped and counted.
//! assert!(decoder.datagram(b"no frame").is_empty());
//! assert_eq!(decoder.bad_bytes(), 8);
//! ```

pub mod ardupilotmega;
mod checksum;
pub mod codec;
pub mod contract;
pub mod ftp;
pub mod instructor_note;
pub mod router;
pub mod signing;
pub mod station;
pub mod telemetry;
pub mod units;

pub use mavlink::dialects::common as dialect;
