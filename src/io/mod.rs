//! I/O for the subcommands: sockets, links, clocks, files, serial ports, child processes, pacing, stores and
//! controllers.

pub mod addresses;
pub mod answers;
pub mod append_file;
pub mod children;
pub mod clock;
pub mod controller;
pub mod files;
pub mod flight_logs;
pub mod key;
pub mod links;
pub mod log_check;
pub mod log_file;
pub mod logging;
pub mod mcap;
pub mod net;
pub mod pacing;
pub mod params;
pub mod parquet;
pub mod pause;
pub mod plan_rules;
#[cfg(feature = "view")]
pub mod png;
pub mod progress;
pub mod replace;
pub mod report;
pub mod scoring;
pub mod serial;
pub mod session_folder;
pub mod shell;
pub mod signing_store;
pub mod stop;
pub mod store;
pub mod trainee_id;
pub mod vehicle_ports;
