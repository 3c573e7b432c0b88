//! Telemetry processing: a MAVLink frame becomes a [`sample::Sample`], samples become a [`timeline::Flight`] (sorted,
//! with known gaps), and a flight is resampled at the scoring rate into [`frame::Frame`]s. [`tlog`] is the format of
//! log files, and [`log_stream`] reads them in chunks. Monitor, pilot, view and report use this module. It does not
//! depend on scoring.

mod block_list;
pub mod frame;
pub mod log_stream;
pub mod navigation;
pub mod sample;
pub mod signal;
pub mod timeline;
pub mod tlog;

pub use frame::Frame;
pub use navigation::{BatteryReport, GnssReport, Navigation, NavigationReader};
pub use sample::Sample;
pub use timeline::{Flight, Timeline};
