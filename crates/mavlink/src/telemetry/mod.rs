//! What came over the wire, made into frames: a MAVLink frame becomes a [`sample::Sample`], samples become a
//! [`timeline::Flight`] (sorted, gaps known), and a flight is read at the scorer's rate as [`frame::Frame`]s. [`tlog`] is the
//! file format in between, [`log_stream`] reads it in pieces. Read by monitor, pilot, view and report; knows nothing of the scoring.

pub mod frame;
pub mod log_stream;
pub mod navigation;
mod rows;
pub mod sample;
pub mod signal;
pub mod timeline;
pub mod tlog;

pub use frame::Frame;
pub use navigation::{Navigation, NavigationReader};
pub use sample::Sample;
pub use timeline::{Flight, Timeline};
