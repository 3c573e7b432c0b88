//! MAVLink interface of the simulated vehicle.
#![allow(clippy::unwrap_used, reason = "a test")]

mod after_landing;
mod answers;
mod camera;
mod camera_settings;
mod circles;
mod copter;
mod copter_guided;
mod copter_modes;
mod copter_pilots;
mod copter_plans;
mod failures;
mod fence;
mod flavors;
mod impaired;
mod impaired_files;
mod items;
mod landed_states;
mod local_frame;
mod long_commands;
mod manual;
mod mount;
mod network;
mod offboard;
mod parameters;
mod payload;
mod plans;
mod practice;
mod px4_events;
mod px4_setup;
mod ranges;
mod refusals;
mod restart_and_logs;
mod signing;
mod simple_clients;
mod vehicle;
